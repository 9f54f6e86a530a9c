"""Openings that compute with numbers: operators, quotients, functions of numbers, elements of arrays.

``operations.py`` has operands and operations, ``quotients.py``, ``sums.py``, ``comparisons.py``, ``functions.py`` and ``elements.py`` build
on it, and ``versions.py`` says which functions get a second body for the arguments that they are written for.
"""
