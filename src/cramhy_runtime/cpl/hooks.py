"""The hooks of the plan language (cpl.md section 11). ``lisp_core/hooks.py`` explains hooks."""

from __future__ import annotations

from cramhy_runtime.lisp_core.hooks import Hook
from . import symbols  # noqa: F401  the packages must exist

on_make_fluent_hook = Hook("CPL-IMPL::ON-MAKE-FLUENT-HOOK", "(fluent allow-tracing max-tracing-freq)")
on_top_level_setup_hook = Hook("CPL-IMPL::ON-TOP-LEVEL-SETUP-HOOK", "(top-level-name task-tree)")
on_top_level_cleanup_hook = Hook("CPL-IMPL::ON-TOP-LEVEL-CLEANUP-HOOK", "(top-level-name)")
on_def_top_level_plan_hook = Hook("CPL-IMPL::ON-DEF-TOP-LEVEL-PLAN-HOOK", "(plan-name)")
on_fail = Hook("CPL-IMPL::ON-FAIL", "(datum)")
on_preparing_named_top_level = Hook("CPL-IMPL::ON-PREPARING-NAMED-TOP-LEVEL", "(name)")
on_finishing_named_top_level = Hook("CPL-IMPL::ON-FINISHING-NAMED-TOP-LEVEL", "(id)")
on_begin_execute_tag_task = Hook("CPL-IMPL::ON-BEGIN-EXECUTE-TAG-TASK", "(task)")
on_finish_execute_tag_task = Hook("CPL-IMPL::ON-FINISH-EXECUTE-TAG-TASK", "(id)")
on_preparing_task_execution = Hook("CPL-IMPL::ON-PREPARING-TASK-EXECUTION", "(name log-parameters log-pattern lambda-list parameters)")
on_finishing_task_execution = Hook("CPL-IMPL::ON-FINISHING-TASK-EXECUTION", "(id)")
on_with_failure_handling_begin = Hook("CPL-IMPL::ON-WITH-FAILURE-HANDLING-BEGIN", "(clauses)")
on_with_failure_handling_end = Hook("CPL-IMPL::ON-WITH-FAILURE-HANDLING-END", "(id)")
on_with_failure_handling_handled = Hook("CPL-IMPL::ON-WITH-FAILURE-HANDLING-HANDLED", "(id)")
on_with_failure_handling_rethrown = Hook("CPL-IMPL::ON-WITH-FAILURE-HANDLING-RETHROWN", "(id)")
on_with_policy_begin = Hook("CPL-IMPL::ON-WITH-POLICY-BEGIN", "(name parameters)")
on_with_policy_end = Hook("CPL-IMPL::ON-WITH-POLICY-END", "(id success)")
