"""The utilities of CRAM, package ``cram-utilities`` (``cut``): what plans and Prolog share and neither of them is.

Lazy lists (``lazy_lists``) and pattern matching (``patterns``, ``compiled_patterns``), on which Prolog is built; threads and what they
wait for (``threads``, ``locks``, ``semaphores``, ``queues``, ``barriers``, on the waiting lines of ``wait_queue``), made of the kernel's
tasks; ``quad_trees`` and the ``small_functions``; ``symbols``, the Lisp package. Source: prolog.md section 13, cpl.md section 13.

Two tools are for this library only: ``generated_functions`` makes Python functions of text, for messages, patterns, Prolog and nets of
fluents, and ``records`` makes classes of records, for the compiler of Lisp.
"""
