"""Faults: events that happen to a branch at a park point, on purpose.

    fault = faults.at(task="*PAR-CHILD-#1/2", park="sleep", nth=2, action="evaporate")
    outcome = testing.run(plan, faults=[fault])

A fault ends the branch, suspends it and lets it go on, or raises an error where it waits. A plan must survive all of them: its
cleanup forms run once, its other branches end, and nothing is left.
"""

from __future__ import annotations

from collections.abc import Callable
from fnmatch import fnmatchcase
from typing import Literal

from cramhy_runtime.cpl.failures.failure_types import SimplePlanFailure
from cramhy_runtime.cpl.failures.handling import fail
from cramhy_runtime.cpl.tasks.pausing import release, request
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING

if TYPE_CHECKING:
    from cramhy_runtime.cpl.tasks.tasks import AbstractTask
    from cramhy_runtime.kernel import Kernel, Task, Timer
    from .park_points import ParkPoint


Action = Literal["evaporate", "fail", "raise", "suspend-and-resume"] | Callable[[], object]
ACTIONS = ("evaporate", "fail", "raise", "suspend-and-resume")
SUSPENDED_FOR = 0.05  # s


class InjectedFailure(SimplePlanFailure):
    """The plan failure of the action ``fail``."""

    lisp_name = "CRAMHY-TESTING::INJECTED-FAILURE"


class InjectedError(Exception):
    """The error of the action ``raise``."""


class Fault:
    """A fault that happens once, at the park point that `at` describes. ``happened`` is that point, or None."""

    def __init__(self, task: str, park: str | None, nth: int, action: Action, seconds: float, entering: bool):
        self.task, self.park, self.nth, self.action, self.seconds, self.entering = task, park, nth, action, seconds, entering
        self.happened: ParkPoint | None = None
        self.timer: Timer | None = None

    def over(self) -> None:
        """Called when the run is over: resume nothing any more."""
        if self.timer is not None:
            self.timer.cancel()

    def meets(self, point: ParkPoint) -> bool:
        """True if the fault has not happened yet and this is its point."""
        if self.happened is not None or not (self.task == point.task or fnmatchcase(point.task, _pattern(self.task))):
            return False
        return self.nth == point.number if self.park is None else self.park == point.name and self.nth == point.nth

    def happen(self, kernel: Kernel, me: Task[object], point: ParkPoint) -> None:
        """Let the fault happen to the kernel's task ``me``: before it parks (``entering``), or as soon as it has parked."""
        self.happened = point
        task = me.owner
        if self.entering:
            self._act(kernel, me, task)
        else:
            kernel.post(lambda: self._act(kernel, me, task))

    def _act(self, kernel: Kernel, me: Task[object], task: AbstractTask[object]) -> None:
        if task.dead:
            return
        if self.action == "evaporate":
            task.ask_to_end(f"fault at {self.happened}")
        elif self.action == "suspend-and-resume":
            request(task)
            self.timer = kernel.call_at(kernel.now() + self.seconds, lambda: release(task))
        elif not me.shielded:  # who is shielded waits for the death of others, and nothing can go wrong there
            me.interject(self._go_wrong)

    def _go_wrong(self) -> None:
        if self.action == "fail":
            fail(InjectedFailure(f"A fault at {self.happened}."))
        if callable(self.action):
            self.action()
        else:
            raise InjectedError(f"A fault at {self.happened}.")

    def __str__(self) -> str:
        action = getattr(self.action, "__name__", self.action)
        where = f"park point {self.nth}" if self.park is None else f"{self.park} {self.nth}"
        return f"{action} {self.task} at {where}{', entering' if self.entering else ''}"

    __repr__ = __str__


def _pattern(task: str) -> str:
    return task.replace("[", "[[]")


def at(
    task: str = "*",
    park: str | None = None,
    nth: int = 1,
    action: Action = "evaporate",
    *,
    seconds: float = SUSPENDED_FOR,
    entering: bool = False,
) -> Fault:
    """A fault that happens to ``task``, a label or a pattern of labels (``*``, ``?``), at its ``nth`` park point.

    park: count only points of this name, such as ``"sleep"`` or ``"wait-for"`` (see ``park_points.NAMES``). action: ``"evaporate"``;
    ``"fail"`` with a plan failure `InjectedFailure`; ``"raise"`` an error `InjectedError`; ``"suspend-and-resume"`` after ``seconds`` of
    virtual time; or a function, which is called on the task's own stack. entering: let it happen before the task parks, not as soon as it
    has parked. Another action, or an ``nth`` below 1, is a ValueError.
    """
    if not callable(action) and action not in ACTIONS:
        raise ValueError(f'There is no action "{action}". Choose one of {", ".join(ACTIONS)}, or give a function.')
    if nth < 1:
        raise ValueError(f"Park points count from 1, not from {nth}.")
    return Fault(task, park, nth, action, seconds, entering)
