"""Fluents: values that plans wait for, and nets of them.

Where the parts are: `fluents` the values and the nets · `pulse_fluents` · `operators` functions of fluents · `python_operators` the same
as Python writes them.
"""
