"""The compiler: Lisp forms → nodes → core Hy forms → Python.

``environment.py`` knows what names mean, ``analyze.py`` and ``special_forms.py`` turn forms into ``nodes.py``, ``generator/``
turns nodes into the forms of ``core.py``, ``constants.py`` keeps the objects that code refers to, and ``support.py`` is what the
code calls. The generator is plain: optimisations are ``openings/`` and ``arithmetic/``, which offer shorter code, and ``passes.py`` says
which of them are on. ``facts.py`` and ``kinds.py`` tell what is known of values before the program runs. ``python_code.py`` makes Python of
core forms, or Hy does, in a ``.hy`` file. ``compilation_unit.py`` keeps the warnings until it is known whether they hold.
``evaluation/evaluator.py`` puts it together.
"""
