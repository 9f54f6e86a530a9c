"""The part of the generator that computes with numbers: operators, quotients, functions of numbers, elements of arrays.

``operations.py`` has operands, sums, products and comparisons, ``quotients.py``, ``functions.py`` and ``elements.py`` build on it, and
``versions.py`` says which functions get a second body for the arguments that they are written for.
"""
