"""The compiler: Lisp forms → nodes → core Hy forms → Python.

``environment.py`` knows what names mean, ``analyze.py`` and ``special_forms.py`` turn forms into ``nodes.py``, ``generate.py``
turns nodes into Hy models, ``constants.py`` keeps the objects that code refers to, and ``support.py`` is what the code calls.
Hy does the rest. ``lisp/evaluator.py`` puts it together.
"""
