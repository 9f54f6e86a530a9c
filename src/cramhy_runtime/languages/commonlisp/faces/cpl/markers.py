"""Names that mean something only in a certain place: ``retry`` in a failure handler, ``succeed`` in a goal (cpl.md 1.3).

There are names without a definition, nine in CRAM; macros give them one locally, or look for them. Called anywhere else they are, there as
here, undefined functions, but here the error says where they belong. The names of counters are no variables, so such a call does
not evaluate them first.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import UndefinedFunction, lisp_list
from ...packages.face_definition import define_face
from cramhy_runtime.lisp_core.packages import sym
from cramhy_runtime.cpl.symbols import CPL_IMPL

_COUNTERS = "belongs inside (with-retry-counters ((name count)...) ...), for the name of one of its counters."
_PATH = "is a mark in the paths of the task tree, {}, and no function."
WHERE = {
    "RETRY": "(retry) belongs inside (with-failure-handling (clause...) ...), in a clause or in the body.",
    "DO-RETRY": f"(do-retry name form...) {_COUNTERS}",
    "RESET-COUNTER": f"(reset-counter name) {_COUNTERS}",
    "GET-COUNTER": f"(get-counter name) {_COUNTERS}",
    "SUCCEED": "(succeed value...) belongs inside the body of a goal: (def-goal (name pattern...) ...).",
    "POLICY-GET": "(policy-get 'name) belongs inside the clauses of a policy: (define-policy name (parameter...) (:check ...)).",
    "POLICY-SETF": "(policy-setf 'name value) belongs inside the clauses of a policy: (define-policy name (parameter...) (:init ...)).",
    "TAG": "A tag is written with the keyword, (:tag name form...), inside (with-tags ...) or a plan function or goal.",
    "TAGGED": "TAGGED " + _PATH.format("as in (task '((tagged name)))"),
    "GOAL": "GOAL " + _PATH.format("as in ((goal (name . pattern)))") + " A goal is called by its own name: (name argument...).",
    "GOAL-CONTEXT": "GOAL-CONTEXT " + _PATH.format("as in ((goal-context (name . pattern)))"),
}
"""Name of a marker → where it is allowed and what for."""


def marker_called(name):
    """The error of the marker ``name`` in a place where it means nothing."""
    return name.function()


def define():
    """Let calls of the markers tell where they belong."""
    define_face("CRAMHY", functions={"marker-called": marker_called})
    quoted, called = sym("QUOTE"), sym("CRAMHY::MARKER-CALLED")
    for name, where in WHERE.items():
        marker = CPL_IMPL.intern(name)
        marker.compiler_data = {
            **(marker.compiler_data or {}),
            "advice": where,
            "compiler-macro": lambda form, env, marker=marker: (
                lisp_list(called, lisp_list(quoted, marker)) if isinstance(marker.function, UndefinedFunction) else form
            ),
        }
