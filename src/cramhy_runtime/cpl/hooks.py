"""Hooks: places where the plan language calls out to whoever wants to know.

In CRAM a hook is a generic function whose applicable methods *all* run, and whose value is the list of their results (cpl.md
section 11). Nothing is called, and nothing is paid for, when nobody has added a method. From Lisp:
``(defmethod on-fail my-name ((datum t)) ...)``, whose qualifier may be any symbol. From Python: ``on_fail.add(function)``.
"""

from __future__ import annotations

from ..lisp import classes as _classes  # noqa: F401  before `generic`, which it imports
from ..lisp.data import Symbol, one
from ..lisp.generic import add_method, generic, remove_method
from . import symbols  # noqa: F401  the packages must exist


class Hook:
    """The hook ``name`` (``"PACKAGE::NAME"``). True when it has methods; calling it runs them, the most specific first."""

    def __init__(self, name, lambda_list):
        self.function = generic(name, lambda_list, combination="COMMON-LISP::HOOKS")
        self.name = self.function.__lisp_name__
        self._added = {}

    def add(self, function, key=None):
        """Run ``function`` whenever the hook is called. A method with the same ``key`` is replaced."""
        key = function if key is None else key
        self.remove(key)
        specializers = [object] * self.function.shape.required
        self._added[key] = add_method(self.function, [Symbol(str(key))], specializers, function, uses_next=False)
        return function

    def remove(self, key):
        """Forget the method added under ``key`` (or the function itself); unknown ones are ignored."""
        method = self._added.pop(key, None)
        if method is not None:
            remove_method(self.function, method)

    def __bool__(self):
        return bool(self.function.methods)

    def __call__(self, *arguments):
        """The list of the methods' results (a Python list)."""
        return list(one(self.function(*arguments)) or ()) if self.function.methods else []

    def first(self, *arguments):
        """Run all methods; the first result, or ``None``: the id that the matching end hook gets."""
        results = self(*arguments)
        return results[0] if results else None


on_make_fluent_hook = Hook("CPL-IMPL::ON-MAKE-FLUENT-HOOK", "(fluent allow-tracing max-tracing-freq)")
on_top_level_setup_hook = Hook("CPL-IMPL::ON-TOP-LEVEL-SETUP-HOOK", "(top-level-name task-tree)")
on_top_level_cleanup_hook = Hook("CPL-IMPL::ON-TOP-LEVEL-CLEANUP-HOOK", "(top-level-name)")
on_def_top_level_plan_hook = Hook("CPL-IMPL::ON-DEF-TOP-LEVEL-PLAN-HOOK", "(plan-name)")
on_fail = Hook("CPL-IMPL::ON-FAIL", "(datum)")
on_preparing_named_top_level = Hook("CPL-IMPL::ON-PREPARING-NAMED-TOP-LEVEL", "(name)")
on_finishing_named_top_level = Hook("CPL-IMPL::ON-FINISHING-NAMED-TOP-LEVEL", "(id)")
on_begin_execute_tag_task = Hook("CPL-IMPL::ON-BEGIN-EXECUTE-TAG-TASK", "(task)")
on_finish_execute_tag_task = Hook("CPL-IMPL::ON-FINISH-EXECUTE-TAG-TASK", "(id)")
on_preparing_task_execution = Hook("CPL-IMPL::ON-PREPARING-TASK-EXECUTION",
                                   "(name log-parameters log-pattern lambda-list parameters)")
on_finishing_task_execution = Hook("CPL-IMPL::ON-FINISHING-TASK-EXECUTION", "(id)")
on_with_failure_handling_begin = Hook("CPL-IMPL::ON-WITH-FAILURE-HANDLING-BEGIN", "(clauses)")
on_with_failure_handling_end = Hook("CPL-IMPL::ON-WITH-FAILURE-HANDLING-END", "(id)")
on_with_failure_handling_handled = Hook("CPL-IMPL::ON-WITH-FAILURE-HANDLING-HANDLED", "(id)")
on_with_failure_handling_rethrown = Hook("CPL-IMPL::ON-WITH-FAILURE-HANDLING-RETHROWN", "(id)")
on_with_policy_begin = Hook("CPL-IMPL::ON-WITH-POLICY-BEGIN", "(name parameters)")
on_with_policy_end = Hook("CPL-IMPL::ON-WITH-POLICY-END", "(id success)")
