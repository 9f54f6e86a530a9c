"""When a task of a plan stops in the debugger, and how it goes on from there.

A condition that no handler of a task takes reaches the root of the task. As a rule it ends the task at once, and the parent gets the
failure. cpl.md 4.3 suggests this for users without a debugger. So ``*debug-on-lisp-errors*`` is nil at first, where the original's is
T. If it is T, an error stops its task in front of the user, with the whole stack still there, and all other tasks wait. The restart
``rethrow`` lets the error go on to the parent, ``teardown`` ends the task with the failure ``Aborted.``. ``*break-on-plan-failures*``
names a type of failures that stop their task before any handler sees them. In a script or under pytest there is no user to ask, and
both variables count as nil.

``(abort)`` in a task ends the task, too: every task has a restart of that name around everything else.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.condition_types import shown
from cramhy_runtime.lisp_core.conditions import (
    Restart,
    enter_debugger,
    find_restart,
    install_root,
    matches,
    offer_everywhere,
    restart_case,
    with_simple_restart,
)
from cramhy_runtime.lisp_core.data import truth
from ..current import current_task
from .failure_types import PlanFailure, SimplePlanFailure
from ..logging import active_tags, log
from ..symbols import sym
from ..task_variables import inherit

BREAK_ON_PLAN_FAILURES = inherit(sym("CPL-IMPL::*BREAK-ON-PLAN-FAILURES*"), None)
DEBUG_ON_LISP_ERRORS = inherit(sym("CPL-IMPL::*DEBUG-ON-LISP-ERRORS*"), None)
RETHROW, TEARDOWN, CONTINUE, ABORT = sym("CPL-IMPL::RETHROW"), sym("CPL-IMPL::TEARDOWN"), sym("CONTINUE"), sym("ABORT")


def end_the_task(condition):
    """End the current task with ``condition``, an error that no handler took, or stop it in the debugger. Outside of tasks do nothing."""
    task = current_task()
    if task is None:
        return
    if find_restart(TEARDOWN) is not None:  # an error of a form that was typed into this task's debugger
        enter_debugger(condition)
    elif truth(DEBUG_ON_LISP_ERRORS.value) and not isinstance(condition, PlanFailure):
        if active_tags:
            log("DEBUGGER", "~s: ~_~a", condition, condition)
        restart_case(
            [
                (RETHROW, lambda: None, lambda: f"Rethrow condition `{shown(condition)}'"),
                (TEARDOWN, abort_task, lambda: f"Tear down {shown(task)}"),
            ],
            lambda: enter_debugger(condition),
        )
    raise condition


def abort_task():
    """End the current task without asking its handlers. Its parent gets the plan failure ``Aborted.``"""
    aborted = SimplePlanFailure("Aborted.")
    aborted.signalled = True
    raise aborted


def break_on(failure):
    """Stop in the debugger if ``*break-on-plan-failures*`` names a type of ``failure``."""
    if matches(failure, BREAK_ON_PLAN_FAILURES.value):
        with_simple_restart(CONTINUE, "Continue failure signalling.", lambda: enter_debugger(failure))


install_root(end_the_task)
offer_everywhere(Restart(ABORT, abort_task, lambda: f"Abort {shown(current_task())}.", test=lambda condition: current_task() is not None))
