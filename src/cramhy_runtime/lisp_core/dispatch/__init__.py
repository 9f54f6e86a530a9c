"""Generic functions: which methods a call runs, in which order, and what is said when none applies.

``generic_functions.py`` finds and calls methods, ``methods.py`` describes one, ``method_combination.py`` puts those that apply into
order. ``open_functions.py`` makes generic functions of Python functions that users may extend.
"""
