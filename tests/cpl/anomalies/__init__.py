"""Faults at every park point of plans that use the whole language."""
