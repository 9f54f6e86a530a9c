"""Fluents: values that plans wait for, and nets of them.

Where the parts are: `fluents` the values · `nets` what is computed from them · `formulas` how · `pulse_fluents` · `operators` functions
of fluents · `python_operators` the same as Python writes them.
"""
