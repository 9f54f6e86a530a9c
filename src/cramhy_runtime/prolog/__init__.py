"""CRAM's Prolog: terms, unification, clauses compiled to Python, built-ins, fact groups, rete; built on the lazy
lists and patterns of the room ``utilities``. Source: reference page ``prolog.md``.

For other rooms the interface is `cramhy_runtime.prolog.query` (ask) and `cramhy_runtime.prolog.natives` (define predicates).
"""
