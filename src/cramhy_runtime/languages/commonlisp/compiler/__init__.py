"""The compiler: Lisp forms → nodes → core Hy forms → Python.

``environment.py`` knows what names mean, ``analyze.py`` and ``special_forms.py`` turn forms into ``nodes.py``, ``generate.py``
turns nodes into the forms of ``core.py``, ``constants.py`` keeps the objects that code refers to, and ``support.py`` is what the
code calls. ``facts.py`` and ``kinds.py`` tell what is known of values before the program runs, and ``arithmetic/`` makes Python's operators
of it. ``python_code.py`` makes Python of core forms, or Hy does, in a ``.hy`` file. ``compilation_unit.py`` keeps the warnings
until it is known whether they hold. ``evaluation/evaluator.py`` puts it together.
"""
