"""Where a task of a plan waits, and obeys requests to suspend it.

`pause` is the one way to wait in this room. A task that was asked to suspend obeys there, and at the end of its body: it leaves
``retry-after-suspension``, runs its ``on-suspension`` forms, suspends its children and waits for that, becomes ``:suspended``, and
goes on when it is woken (cpl.md 3.5). Who may ask, and how often, is in ``suspension.py``.
"""

from __future__ import annotations

from cramhy_runtime import kernel

from .current import current_task
from .failures import assert_no_nlx
from .statuses import CREATED, DEAD, RUNNING, SUSPENDED


def pause(why, until=None):
    """Park as ``kernel.park`` does, and obey requests to suspend that arrived meanwhile."""
    woken = kernel.park(why, until)
    task = getattr(kernel.current().local, "plan_task", None)
    if task is not None and task.held:
        obey(task)
    return woken


class Unwind(BaseException):
    """Unwinds to the outermost ``retry-after-suspension`` of ``task``."""

    def __init__(self, task):
        self.task = task


def request(task):
    """Ask ``task`` to suspend itself at its next waiting point."""
    if task.status in DEAD or task.held:
        return
    task.held = True
    if task.kernel_task is not None and task.status is RUNNING and task is not current_task():
        task.kernel_task.interject(lambda: obey(task))


def release(task):
    """Let ``task`` go on."""
    if task.held:
        task.held = False
        if task.status is SUSPENDED:
            task.kernel_task.kernel.unpark(task.kernel_task)


def obey(task):
    """Suspend the current task, which is ``task``, if that is still wanted; returns after the wake-up."""
    me = kernel.current()
    if task.unschedulable or me.cancelled_delivered or not task.held:
        return
    if task.retry_level:
        raise Unwind(task)
    me.local.obeying = True
    try:
        _suspend(task)
    finally:
        me.local.obeying = False
    for block in getattr(me.local, "blocks", ()):
        block.remind()  # what was to end a part of this task waited for the wake-up


def _suspend(task):
    _run_handlers(task)
    children = list(task.children)
    for child in children:
        request(child)
    _await(children, (SUSPENDED, CREATED, *DEAD), "suspension")
    task.change_status(SUSPENDED)
    while task.held:
        kernel.park(lambda: "its wake-up: it is suspended")
    for child in task.children:
        release(child)
    _await(list(task.children), (RUNNING, CREATED, *DEAD), "wake-up")
    task.change_status(RUNNING)


def _run_handlers(task):
    handlers = task.suspension_handlers
    if handlers:
        task.unschedulable += 1
        try:
            for handler in reversed(handlers):
                assert_no_nlx("ON-SUSPENSION", handler)
        finally:
            task.unschedulable -= 1


def _await(children, statuses, what):
    for child in children:
        child.park_until(statuses, lambda child=child: f"the {what} of {child.name}", kernel.park)
