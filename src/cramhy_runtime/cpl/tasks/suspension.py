"""Suspension: stopping a branch with everything below it, and letting it go on.

A request to suspend is obeyed where the task waits (in ``wait-for``, ``sleep``, joins and parallel forms), in loops, and at the end
of its body. The order is that of cpl.md 3.5: leave ``retry-after-suspension``, run the ``on-suspension`` forms, suspend the children
and wait for that, then become ``:suspended``. Waking goes down the tree first as well.

Repaired: both requests are idempotent. Suspending a suspended task and waking a running one do nothing, where the original kills
the task. One wake-up undoes any number of suspensions. Neither request waits for a task that is dead or not started yet; the latter
obeys when it is started. ``with-task-suspended`` on a dead task runs its body at once. On a task that is not started it waits, since
its body may rely on the status, and takes the request back if it is left before.
"""

from __future__ import annotations

from contextlib import contextmanager
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, TypeVar

from cramhy_runtime import kernel

from cramhy_runtime.lisp_core.dispatch.generic_functions import generic
from ..current import current_task, inside_plan
from .pausing import AT_REST, Unwind, obey, request
from .tasks import AbstractTask, check_reason

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ..signatures import Request, Thunk

T = TypeVar("T")
K = TypeVar("K", bound=AbstractTask[object])

suspend: Request = generic(
    "CPL-IMPL::SUSPEND",
    "(task &key reason sync)",
    documentation="""
Suspend ``task`` and all tasks below it. With ``sync`` (the default) wait until it is suspended or dead.""",
)


@suspend.method(AbstractTask)
def _suspend(task, *, reason=None, sync=True):
    check_reason(reason)
    task.suspend(reason, sync)


wake_up: Request = generic(
    "CPL-IMPL::WAKE-UP",
    "(task &key reason sync)",
    documentation="""
Let ``task`` and all tasks below it go on. With ``sync`` (the default) wait until it is running or dead.""",
)


@wake_up.method(AbstractTask)
def _wake_up(task, *, reason=None, sync=True):
    check_reason(reason)
    task.wake_up(reason, sync)


@contextmanager
def handler_for_suspension(handler: Thunk[object]) -> Iterator[None]:
    """While the block runs, the current task calls ``handler()`` before each suspension; the innermost handler comes first."""
    task = current_task()
    if task is None:
        yield
        return
    if task.suspension_handlers is None:
        task.suspension_handlers = []
    handlers = task.suspension_handlers
    handlers.append(handler)
    try:
        yield
    finally:
        handlers.pop()


def on_suspension(handler: Thunk[object], body: Thunk[T]) -> T:
    """``(on-suspension form body...)``: call ``body()`` within `handler_for_suspension`, and return its values."""
    with handler_for_suspension(handler):
        return body()


def retry_after_suspension(body: Thunk[T]) -> T:
    """Call ``body()`` and return its values. A suspension unwinds it, and after the wake-up it starts again. Source: cpl.md 3.11."""
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


@contextmanager
def task_suspended(task: K, reason: str | None = None) -> Iterator[K]:
    """Suspend ``task`` while the block runs, and wake it on every exit. Outside of a plan it is an error."""
    inside_plan("WITH-TASK-SUSPENDED")
    try:
        suspend(task, reason=reason)
        while task.status not in AT_REST:  # not started yet, or somebody else woke it before it came to rest
            request(task)
            task.park_until(AT_REST, lambda: f"the suspension of {task.name}", lambda: not task.held)
        yield task
    finally:
        with kernel.shield():
            wake_up(task, reason=reason)


def with_task_suspended(task: AbstractTask[object], body: Thunk[T], reason: str | None = None) -> T:
    """``(with-task-suspended (task) body...)``: call ``body()`` within `task_suspended`, and return its values. Source: cpl.md 3.12."""
    with task_suspended(task, reason):
        return body()


@contextmanager
def undisturbed() -> Iterator[None]:
    """Delay requests to suspend or evaporate the current task until the block is over."""
    task = current_task()
    if task is None:
        with kernel.shield():
            yield
        return
    task.unschedulable += 1
    try:
        with kernel.shield():
            yield
    finally:
        task.unschedulable -= 1
        if task.held and not task.unschedulable:
            obey(task)
    if task.kernel_task.attention:
        kernel.slice_over()  # which delivers what was held back


def without_scheduling(body: Thunk[T]) -> T:
    """``(without-scheduling body...)``: call ``body()`` `undisturbed`, and return its values. Source: cpl.md 3.6."""
    with undisturbed():
        return body()


def with_scheduling(body: Thunk[T]) -> T:
    """Call ``body()`` `disturbable`, and return its values. Source: cpl.md 3.6."""
    with disturbable():
        return body()


@contextmanager
def disturbable() -> Iterator[None]:
    """Within ``without-scheduling``, requests are obeyed again while the block runs. Elsewhere it changes nothing."""
    task = current_task()
    if task is None or not task.unschedulable:
        yield
        return
    me, levels = task.kernel_task, task.unschedulable
    task.unschedulable = 0
    me.shielded -= levels
    try:
        obey(task)
        if me.attention:
            kernel.slice_over()  # which delivers what was held back
        yield
    finally:
        task.unschedulable = levels
        me.shielded += levels
