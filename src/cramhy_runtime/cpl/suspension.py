"""Suspension: stopping a branch with everything below it, and letting it go on.

A request to suspend is obeyed where the task waits (in ``wait-for``, ``sleep``, joins and parallel forms) and at the end of its
body. The order is that of cpl.md 3.5: leave ``retry-after-suspension``, run the ``on-suspension`` forms, suspend the children and
wait for that, then become ``:suspended``. Waking goes down the tree first as well.

Repaired: both requests are idempotent. Suspending a suspended task and waking a running one do nothing, where the original kills
the task; one wake-up undoes any number of suspensions. ``with-task-suspended`` on a dead task runs its body at once.
"""

from __future__ import annotations

from cramhy_runtime import kernel

from ..lisp.data import truth
from .current import current_task, inside_plan
from .pausing import Unwind, obey, release, request
from .statuses import CREATED, DEAD, RUNNING, SUSPENDED
from .tasks import check_reason


def suspend(task, *, reason=None, sync=True):
    """Suspend ``task`` and all below it; with ``sync`` wait until it is suspended or dead."""
    check_reason(reason)
    request(task)
    if task is current_task():
        if truth(sync):
            obey(task)
    elif truth(sync):
        task.park_until((SUSPENDED, CREATED, *DEAD), lambda: f"the suspension of {task.name}")


def wake_up(task, *, reason=None, sync=True):
    """Let ``task`` and all below it go on; with ``sync`` wait until it is running or dead."""
    check_reason(reason)
    release(task)
    if truth(sync) and task is not current_task():
        task.park_until((RUNNING, CREATED, *DEAD), lambda: f"the wake-up of {task.name}")


def on_suspension(handler, body):
    """Values of ``body()``; whenever the task is suspended meanwhile, ``handler()`` runs in it first. Innermost first."""
    task = current_task()
    if task is None:
        return body()
    if task.suspension_handlers is None:
        task.suspension_handlers = []
    handlers = task.suspension_handlers
    handlers.append(handler)
    try:
        return body()
    finally:
        handlers.pop()


def retry_after_suspension(body):
    """Values of ``body()``. A suspension unwinds it, the task is suspended outside of it, and after wake-up it starts again."""
    task = current_task()
    if task is None or task.retry_level:
        return body()
    while True:
        task.retry_level += 1
        try:
            return body()
        except Unwind as unwind:
            if unwind.task is not task:
                raise
        finally:
            task.retry_level -= 1
        obey(task)


def with_task_suspended(task, body, reason=None):
    """Values of ``body()``, run while ``task`` is suspended; it is woken again on every exit."""
    inside_plan("WITH-TASK-SUSPENDED")
    suspend(task, reason=reason)
    try:
        return body()
    finally:
        with kernel.shield():
            wake_up(task, reason=reason)


def without_scheduling(body):
    """Values of ``body()``; requests to suspend or evaporate the task wait until it is over."""
    task = current_task()
    if task is None:
        with kernel.shield():
            return body()
    task.unschedulable += 1
    try:
        with kernel.shield():
            return body()
    finally:
        task.unschedulable -= 1
        if task.held and not task.unschedulable:
            obey(task)


def with_scheduling(body):
    """Values of ``body()``. Kept for programs that name it: requests are obeyed wherever ``without-scheduling`` is not."""
    return body()


