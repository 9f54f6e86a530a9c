"""Common Lisp: data, reader, compiler to Hy, conditions, printer, CLOS.

The parts, in the order in which a form passes them: ``text_reader`` and its neighbours read it; ``macros`` and ``compiler`` make
Hy of it, ``hy_backend`` lets Hy make Python; ``evaluator``, ``loader`` and ``systems`` run it. ``data``, ``packages``,
``conditions`` and ``dynamic`` are the ground of all. The functions of the standard are in modules by chapter (``lists``,
``sequences``, ``arithmetic``, ``classes`` …); ``package`` says which symbol names which of them.
"""
