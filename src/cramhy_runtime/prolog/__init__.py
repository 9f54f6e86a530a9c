"""CRAM's Prolog: terms, unification, clauses compiled to Python, built-ins, fact groups, rete; and ``cram-utilities``: the lazy lists
and patterns on which they are built, and threads, locks, semaphores, queues, mailboxes and barriers (on ``lines``, lines of tasks that
wait). Sources: reference pages ``prolog.md`` and ``cpl.md`` 13.

For other rooms the interface is `cramhy_runtime.prolog.query` (ask) and `cramhy_runtime.prolog.natives` (define predicates).
"""
