"""When a task of a plan stops in the debugger, and how it goes on from there.

What no handler of a task takes comes to its root. As a rule it ends the task there and then, and its parent hears of it: cpl.md
4.3 suggests this to whoever has no debugger at hand, so ``*debug-on-lisp-errors*`` is nil at first, where the original's is T.
Set to T, an error stops its task with the whole stack still there, in front of the user, while all other tasks wait: the restart
``rethrow`` lets the error go on to the parent, ``teardown`` ends the task with the failure ``Aborted.``. ``*break-on-plan-failures*``
names a type of failures that stop their task before any handler hears of them. Where nobody can be asked, in a script or under
pytest, both go on as if they were nil.

``(abort)`` in a task is its end as well, for every task has a restart of that name around everything else.
"""

from __future__ import annotations

from cramhy_runtime.ground.condition_types import shown
from cramhy_runtime.ground.conditions import (
    Restart,
    enter_debugger,
    find_restart,
    install_root,
    matches,
    offer_everywhere,
    restart_case,
    with_simple_restart,
)
from cramhy_runtime.ground.data import truth
from ..current import current_task
from .failure_types import PlanFailure, SimplePlanFailure
from ..logging import active_tags, log
from ..symbols import sym
from ..task_variables import inherit

BREAK_ON_PLAN_FAILURES = inherit(sym("CPL-IMPL::*BREAK-ON-PLAN-FAILURES*"), None)
DEBUG_ON_LISP_ERRORS = inherit(sym("CPL-IMPL::*DEBUG-ON-LISP-ERRORS*"), None)
RETHROW, TEARDOWN, CONTINUE, ABORT = sym("CPL-IMPL::RETHROW"), sym("CPL-IMPL::TEARDOWN"), sym("CONTINUE"), sym("ABORT")


def end_the_task(condition):
    """The root of a task: ``condition``, an error that nobody took, ends it. Outside of tasks nothing happens."""
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
    """End the current task. No handler of it is asked; its parent gets the plan failure ``Aborted.``"""
    aborted = SimplePlanFailure("Aborted.")
    aborted.signalled = True
    raise aborted


def break_on(failure):
    """Stop in the debugger if ``*break-on-plan-failures*`` names a type of ``failure``."""
    if matches(failure, BREAK_ON_PLAN_FAILURES.value):
        with_simple_restart(CONTINUE, "Continue failure signalling.", lambda: enter_debugger(failure))


install_root(end_the_task)
offer_everywhere(Restart(ABORT, abort_task, lambda: f"Abort {shown(current_task())}.", test=lambda condition: current_task() is not None))
