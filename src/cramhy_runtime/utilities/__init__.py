"""The utilities of CRAM, package ``cram-utilities`` (``cut``): what plans and Prolog share and neither of them is.

Lazy lists (``lazy_lists``) and pattern matching (``patterns``), on which Prolog is built; threads and what they wait for (``threads``,
``locks``, ``semaphores``, ``queues``, ``barriers``, on the waiting lines of ``lines``), made of the kernel's tasks; ``quad_trees``,
``file_cache`` and the ``small_functions``; ``package``, the Lisp face. Source: prolog.md section 13, cpl.md section 13.
"""
