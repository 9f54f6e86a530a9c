"""The tests of the plans, for pytest."""
