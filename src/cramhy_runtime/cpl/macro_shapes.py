"""The shapes of the plan language's macros, for the report of a call that has another one (cpl.md; written as those of the standard
macros in ``lisp/evaluation/macro_shapes.py``: ``[x]`` may be left out, ``...`` repeats).
"""

from __future__ import annotations

from .symbols import CPL_IMPL

SHAPES = """
(declare-goal name (parameter...) form...)
(def-cpl-parameter name [value ["documentation"]])
(def-cram-function name (parameter...) ["documentation"] form...)
(def-goal (name pattern...) ["documentation"] form...)
(def-top-level-cram-function name (parameter...) ["documentation"] form...)
(define-policy name (parameter...) ["documentation"] clause...)
(define-task-variable name [value ["documentation"]] [:type type] [:init-function function])
(make-policy name (parameter...) ["documentation"] clause...)
(named-top-level (:name name) form...)
(on-suspension form body-form...)
(par-loop (variable list) form...)
(partial-order (step...) (:order before after)...)
(try-each-in-order (variable list) form...)
(whenever (fluent) form...)
(with-failure-handling ((type (failure) form...)...) form...)
(with-named-policies ((name (argument...))...) form...)
(with-named-policy name (argument...) form...)
(with-policies ((policy (argument...))...) form...)
(with-policy policy (argument...) form...)
(with-retry-counters ((counter value)...) form...)
(with-task ([:name name] [:class class]) form...)
(with-task-suspended (task [:reason text]) form...)
""".strip().splitlines()


def define():
    """Let the names of the macros know how they are written."""
    for shape in SHAPES:
        name = CPL_IMPL.intern(shape.split()[0].strip("(").upper())
        name.compiler_data = {**(name.compiler_data or {}), "shape": shape}
