"""Submissions that are alike although names were changed and definitions moved.

Each list in a program has a shape: its operator and the shapes of what is in it, without the names that the program itself defines or
binds. Shapes are compared as sets, so their order in the file does not count. What all students were given, and what most of them wrote,
counts little or nothing.

Where the parts are: ``shapes`` (programs as sets of shapes) · ``pairs`` (comparing them).
"""
