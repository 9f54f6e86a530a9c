"""The plain generator: from nodes to core forms, one function for each kind of node. It knows no optimisation.

``output.py`` has the `Generator`, ``values.py``, ``calls.py``, ``exits.py`` and ``functions.py`` enter in its tables what is made of each
kind of node. `toplevel` is the entry.
"""
