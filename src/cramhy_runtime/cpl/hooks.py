"""Hooks: places where the plan language calls out to whoever wants to know.

In CRAM a hook is a generic function whose applicable methods *all* run, and whose value is the list of their results (cpl.md
section 11). Nothing is called, and nothing is paid for, when nobody has added a method. From Python: ``on_fail.add(function)``;
from Lisp: ``(defmethod on-fail my-name ((datum t)) ...)``, whose qualifier may be any symbol.
"""

from __future__ import annotations

from ..lisp.data import one


class Hook:
    """A hook called ``name`` (a Lisp name). True when it has methods; calling it runs them, the most recent first."""

    def __init__(self, name):
        self.name = name
        self.methods = {}

    def add(self, function, key=None, applicable=None):
        """Run ``function`` whenever the hook is called. A method with the same ``key`` is replaced.

        ``applicable`` is a function of the arguments that says whether the method takes part.
        """
        self.methods[key if key is not None else function] = (function, applicable)
        return function

    def remove(self, key):
        """Forget the method added under ``key`` (or the function itself); unknown ones are ignored."""
        self.methods.pop(key, None)

    def __bool__(self):
        return bool(self.methods)

    def __call__(self, *arguments):
        """The list of the methods' results (a Python list)."""
        return [one(function(*arguments)) for function, applicable in reversed(list(self.methods.values()))
                if applicable is None or applicable(*arguments)]

    def first(self, *arguments):
        """Run all methods; the first result, or ``None``: the id that the matching end hook gets."""
        results = self(*arguments) if self.methods else None
        return results[0] if results else None

    def __repr__(self):
        return f"<hook {self.name}, {len(self.methods)} methods>"


on_make_fluent_hook = Hook("on-make-fluent-hook")
on_top_level_setup_hook = Hook("on-top-level-setup-hook")
on_top_level_cleanup_hook = Hook("on-top-level-cleanup-hook")
on_def_top_level_plan_hook = Hook("on-def-top-level-plan-hook")
on_fail = Hook("on-fail")
on_preparing_named_top_level = Hook("on-preparing-named-top-level")
on_finishing_named_top_level = Hook("on-finishing-named-top-level")
on_begin_execute_tag_task = Hook("on-begin-execute-tag-task")
on_finish_execute_tag_task = Hook("on-finish-execute-tag-task")
on_preparing_task_execution = Hook("on-preparing-task-execution")
on_finishing_task_execution = Hook("on-finishing-task-execution")
on_with_failure_handling_begin = Hook("on-with-failure-handling-begin")
on_with_failure_handling_end = Hook("on-with-failure-handling-end")
on_with_failure_handling_handled = Hook("on-with-failure-handling-handled")
on_with_failure_handling_rethrown = Hook("on-with-failure-handling-rethrown")
on_with_policy_begin = Hook("on-with-policy-begin")
on_with_policy_end = Hook("on-with-policy-end")
