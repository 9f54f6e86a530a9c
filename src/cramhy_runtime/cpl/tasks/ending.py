"""How tasks are ended, and how cleanup that does not end is ended.

A task that started others waits here for their death (law 1). It is shielded meanwhile: a request to end it waits too. So a wait that
never ends, in the cleanup form of one task, stops the whole tree. In the original it does so for ever (cpl.md 3.7). Repaired: such a
wait (never a computation) is ended, the rest of its cleanup form is left out, and the outer cleanup forms run,

* when a program says ``(evaporate task)`` a second time; the requests that forms make to their branches do not count;
* when the cleanup has taken longer than ``*cleanup-time-limit*`` seconds of the kernel's clock, with a warning;
* when the kernel finds that nothing can happen any more, or its time limit is reached (`close_plan`), with a warning.

A task that only waits for the death of others is not disturbed: the request goes to those others (`awaiting_death`).
"""

from __future__ import annotations

from numbers import Real

from cramhy_runtime.kernel.images import Cell
from cramhy_runtime import kernel
from cramhy_runtime.kernel.reports import where
from cramhy_runtime.kernel.tasks import PARKED, shield
from cramhy_runtime.kernel.timers import seconds as in_seconds

from cramhy_runtime.lisp_core.condition_types import SimpleWarning
from cramhy_runtime.lisp_core.conditions import warn
from cramhy_runtime.lisp_core.data import list_from
from cramhy_runtime.lisp_core.dynamic import binding
from ..logging import active_tags, log
from ..statuses import DEAD
from ..task_variables import define_task_state, inherit
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from cramhy_runtime.kernel import Task, cleanup
    from .tasks import AbstractTask

LATER = 0.01  # s after which a limit looks again, if the cleanup computed when it was over
PATIENCE = 100  # waits that are ended when a plan is closed, before its cleanup is given up


class awaiting_death(shield):  # noqa: N801 (reads as a statement)
    """``with awaiting_death(tasks):`` around a wait for the death of ``tasks``, a list or a function that returns one."""

    __slots__ = ("tasks", "plan_task", "outer")

    def __init__(self, tasks):
        super().__init__(kernel.current())
        self.tasks = tasks
        self.plan_task = self._task.owner

    def __enter__(self):
        self._task.shielded += 1
        task = self.plan_task
        if task is not None:
            self.outer, task.awaited = task.awaited, self.tasks

    def __exit__(self, *exception):
        task, block = self.plan_task, self._task.cleanup
        if task is not None:
            task.awaited = self.outer
            if task.cleanup_limit is not None:
                task.cleanup_limit.go_on()
        while block is not None:
            if block.limit is not None:
                block.limit.go_on()
            block = block.outer
        return super().__exit__(*exception)


def end_tasks(tasks: list[Any], reason: str | None = None) -> None:
    """Evaporate ``tasks`` and wait until they are dead. A request to end the current task waits for that too."""
    if active_tags and tasks:
        log("TEARDOWN", "~@[~a ~]~{~a~^, ~:_~}", reason, list_from([task.name for task in tasks]))
    for task in tasks:
        task.ask_to_end(reason)
    with awaiting_death(tasks):
        for task in tasks:
            if task.status not in DEAD:
                task.park_until(DEAD, lambda task=task: f"the cleanup of {task.name}")


def end_waits(task: AbstractTask[object], because: str | None = None) -> bool:
    """End the wait in the cleanup of ``task``, or of the tasks whose death it awaits. Returns whether there was one.

    With ``because``, a clause such as "Nothing can bring that about", the task that waits signals a warning.
    """
    if task.awaited is not None:
        others = task.awaited() if callable(task.awaited) else task.awaited
        return any([end_waits(other, because) for other in others if other.alive])
    me = task.kernel_task
    if me is None or me.state is not PARKED or not (me.cancelled_delivered or me.cleanup is not None):
        return False
    if because is None:
        return me.end_wait(kernel.WaitEnded("its cleanup waited, and it was asked to end once more"))
    why, place = me.describe_why(), where(me.kernel.frame_of(me))

    def told():
        warn(
            SimpleWarning(
                "The cleanup of ~a waited for ~a~@[, at ~a~]. ~a: the rest of this cleanup form is left out, and outer ones run.",
                task.name,
                why,
                place or None,
                because,
            )
        )
        return kernel.WaitEnded(because)

    return me.end_wait(told)


# ------------------------------------------------------------------------------------------------------- the limit of cleanup


class CleanupLimit:
    """Ends the waits of a cleanup when ``seconds`` are over, and again after as many more.

    ``block`` is the `kernel.cleanup` block that it limits. ``None`` stands for everything that a task does outside of such blocks after
    it was asked to end, as in ``finally`` in a plan in Python.
    """

    __slots__ = ("task", "seconds", "block", "timer")

    def __init__(self, task, seconds, block):
        self.task, self.seconds, self.block = task, seconds, block
        self._look_after(seconds)

    def _look_after(self, seconds):
        self.timer = kernel.call_at(kernel.now() + seconds, self._over)

    def _over(self):
        task = self.task
        if task.dead or task.awaited is not None or (self.block is None and task.kernel_task.cleanup is not None):
            return  # those that it waits for, and the blocks, have limits of their own; a timer for nothing would hide a deadlock
        ended = end_waits(task, f"The time of *CLEANUP-TIME-LIMIT*, {self.seconds:g} s, is over")
        self._look_after(self.seconds if ended else LATER)

    def go_on(self):
        """Look again after ``seconds``, if the timer ran out while the task waited for others to die. That wait is over."""
        if not self.timer.active:
            self._look_after(self.seconds)

    def end(self):
        """End nothing any more."""
        self.timer.cancel()


def limit_cleanup(task: AbstractTask[object], block: cleanup | None = None) -> CleanupLimit | None:
    """A `CleanupLimit` for the cleanup that ``task``, the current task, begins; ``None`` if no limit is set."""
    seconds = LIMIT.value
    if seconds is None or not isinstance(seconds, Real) or not 0 <= seconds < float("inf"):
        return None
    return CleanupLimit(task, float(seconds), block)


def _limit_of_block(block: cleanup, kernel_task: Task[object]) -> CleanupLimit | None:
    task = kernel_task.owner
    return None if task is None else limit_cleanup(task, block)


LIMIT: Cell[float | None] = Cell(None)


def _set_limit(seconds: float | None) -> None:
    LIMIT.value = seconds
    if seconds is not None:  # until somebody sets a limit, blocks do not even ask for it
        kernel.limit_by(_limit_of_block)


CLEANUP_TIME_LIMIT = inherit(define_task_state("CPL-IMPL", "*CLEANUP-TIME-LIMIT*", lambda: LIMIT.value, _set_limit), None)


def cleanup_time_limit(seconds: float | None) -> binding:
    """``with cleanup_time_limit(5.0):`` limits the cleanup of plans that start in the block, in seconds of the kernel's clock.

    It binds ``*cleanup-time-limit*``. ``None`` means that there is no limit. When the time is over, waits in the cleanup are ended, with
    a warning. A NaN is a ValueError, and what is not a number a TypeError.
    """
    return binding(CLEANUP_TIME_LIMIT, None if seconds is None else in_seconds(seconds, "cpl.cleanup_time_limit({})"))


# ------------------------------------------------------------------------------------------------------------ the whole plan


def close_plan(task: AbstractTask[object], reason: str | None) -> None:
    """Evaporate the root ``task`` and return when it is dead, whatever its cleanup waits for. Its starter calls this, outside of it."""
    for _ in range(PATIENCE):
        try:
            return end_tasks([task], reason)
        except kernel.Abandoned:  # the user does not want to wait: all cleanup is given up already, but let it come down
            kernel.settle()
            raise
        except (kernel.Deadlock, kernel.TimeLimit) as problem:
            hopeless = isinstance(problem, kernel.Deadlock)
            if not end_waits(task, "Nothing can bring that about any more" if hopeless else "The time limit of the run was reached"):
                break
    for below in _with_descendants(task):
        below.kernel_task.abandon()
    return end_tasks([task], reason)


def _with_descendants(task):
    found = [task]
    for one in found:
        found += [child for child in one.children if child.kernel_task is not None]
    return found
