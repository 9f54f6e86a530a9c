"""Where a task of a plan waits, and obeys requests to suspend it.

`pause` is the only way to wait in this room. A task that was asked to suspend itself obeys there, and at the end of its body: it leaves
``retry-after-suspension``, runs its ``on-suspension`` forms, suspends its children and waits for that, becomes ``:suspended``, and
goes on when it is woken (cpl.md 3.5). The requests are in ``suspension.py``.
"""

from __future__ import annotations

from cramhy_runtime import kernel

from ..failures.handling import assert_no_nlx
from ..logging import EVENT, active_tags, log
from ..statuses import CREATED, DEAD, RUNNING, SUSPENDED


pause = kernel.park
"""``pause(why, until=None)`` waits. The kernel calls `obey` there after a `request`."""


class Unwind(BaseException):
    """Unwinds to the outermost ``retry-after-suspension`` of ``task``."""

    def __init__(self, task):
        self.task = task


def request(task):
    """Ask ``task`` to suspend itself at its next waiting point, or at its first if it is not started yet."""
    if task.status in DEAD or task.held:
        return
    task.held = True
    if task.kernel_task is not None:
        task.kernel_task.interject(lambda: obey(task))
    if task.status is SUSPENDED:
        task.tell_observers()  # it was woken and has not begun to run: who waits for that would wait for ever


def release(task):
    """Wake ``task``, or take back a request to suspend it."""
    if task.held:
        task.held = False
        if task.status is SUSPENDED:
            task.kernel_task.kernel.unpark(task.kernel_task)
        else:
            task.tell_observers()


def obey(task):
    """Suspend the current task, which is ``task``, if that is still wanted. Returns after the wake-up."""
    if task.unschedulable or task.comes_down:
        return
    while task.held:
        if task.retry_level:
            raise Unwind(task)
        task.unschedulable += 1  # a request that comes meanwhile is seen when this one is over
        local = task.kernel_task.local
        local.obeying = True
        try:
            _be_suspended(task)
        finally:
            task.unschedulable -= 1
            local.obeying = False
        for block in getattr(local, "blocks", ()):
            block.remind()  # what was to end a part of this task waited for the wake-up


def _pass_on(kind, child):
    if active_tags:
        log("PROPAGATE-EVENT", EVENT + " to ~a", kind, None, child.name)


def _be_suspended(task):
    try:
        if active_tags:
            log("RECEIVE-EVENT", EVENT, "SUSPEND", None)
            if task.suspension_handlers:
                log("ON-SUSPENSION", "~d handler~:p", len(task.suspension_handlers))
        for handler in reversed(task.suspension_handlers or ()):
            assert_no_nlx("ON-SUSPENSION", handler)
        children = list(task.children)
        for child in children:
            _pass_on("SUSPEND", child)
            request(child)
        for child in children:
            child.park_until(AT_REST, lambda child=child: f"the suspension of {child.name}", lambda child=child: not child.held)
        task.change_status(SUSPENDED)
        if active_tags:
            log("EVENT-LOOP", "waiting for the wake-up")
        while task.held:
            kernel.park(lambda: "its wake-up: it is suspended")
        children = list(task.children)
        if active_tags:
            log("RECEIVE-EVENT", EVENT, "WAKEUP", None)
        for child in children:
            _pass_on("WAKEUP", child)
            release(child)
        for child in children:
            child.park_until(AWAKE, lambda child=child: f"the wake-up of {child.name}", lambda child=child: child.held or child.comes_down)
    except BaseException:  # it fails here, and may recover, or be suspended again in its cleanup
        for child in task.children:
            release(child)
        if task.comes_down:
            task.tell_observers()  # it goes on, with its cleanup, but keeps its status: who waits for its wake-up has waited enough
        elif task.status is SUSPENDED:
            task.change_status(RUNNING)
        raise
    task.change_status(RUNNING)


AT_REST = frozenset((SUSPENDED, *DEAD))
AWAKE = frozenset((CREATED, RUNNING, *DEAD))
