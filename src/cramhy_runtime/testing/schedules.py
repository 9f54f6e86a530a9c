"""Schedules: decisions which task goes next, which can be recorded and repeated.

A run of a plan is a function of its inputs and of the decisions which of the runnable tasks gets the baton. If only one task can go on,
there is nothing to decide. Otherwise the candidates are in the order in which they became runnable, and a decision is the number of the
one that goes, 0 for the first. A schedule is the list of these numbers. After its end, tasks run first come, first served. So ``[]`` is
the ordinary run, and in ``[0, 1]`` only the second decision is different.
"""

from __future__ import annotations

from ..kernel.scheduler import lots
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING
from .labels import label

if TYPE_CHECKING:
    from collections import deque
    from collections.abc import Iterable, Sequence

    from ..kernel import Kernel, Task


class Decision:
    """One decision: the ``time`` in seconds, the ``candidates`` (a label and an activity of each), and the ``choice``, a number."""

    __slots__ = ("time", "candidates", "choice")

    def __init__(self, time: float, candidates: list[str], choice: int):
        self.time, self.candidates, self.choice = time, candidates, choice


class Schedule:
    """Decides for one run: first by ``prefix``, then by lot if there is a ``seed``, or else first come, first served.

    Afterwards ``choices`` are the decisions made. With ``noting``, ``decisions`` has them with their candidates as well.
    """

    def __init__(self, prefix: Iterable[int] = (), seed: int | None = None, noting: bool = False):
        self.prefix = list(prefix)
        self.lots = None if seed is None else lots(seed)
        self.noting = noting
        self.choices: list[int] = []
        self.decisions: list[Decision] = []
        self.misfit: int | None = None  # the number of a decision that the prefix does not fit
        self.kernel: Kernel  # from `watch` on

    def watch(self, kernel: Kernel) -> None:
        """Decide for ``kernel``."""
        self.kernel = kernel

    def __call__(self, queue: deque[Task[object]]) -> int:
        drawn = None if self.lots is None else self.lots(queue)
        if len(queue) == 1:
            return 0
        eligible: list[int] = []
        newborn = None
        for index, task in enumerate(queue):
            if task.carrier is not None:
                eligible.append(index)
            elif newborn is None:  # branches begin in the order in which they stand
                newborn = index
                eligible.append(index)
        if len(eligible) == 1:
            return eligible[0]
        number = len(self.choices)
        if number < len(self.prefix):
            choice = self.prefix[number]
            if not 0 <= choice < len(eligible):
                self.misfit = number if self.misfit is None else self.misfit
                choice = 0
        elif drawn is not None:
            choice = eligible.index(drawn if queue[drawn].carrier is not None else newborn)
        else:
            choice = 0
        self.choices.append(choice)
        if self.noting:
            self.decisions.append(Decision(self.kernel.now(), [_activity(queue[index]) for index in eligible], choice))
        return eligible[choice]


def _activity(task: Task[object]) -> str:
    """The label of ``task``, and what it goes on with."""
    if task.carrier is None:
        doing = "begins"
    elif task.preempted:
        doing = "goes on computing"
    else:
        why = task.describe_why()
        doing = f"goes on after waiting for {why}" if why else "goes on"
    return f"{label(task)} ({doing})"


def without_defaults(choices: Sequence[int]) -> list[int]:
    """The schedule without the zeros at its end, which change nothing."""
    end = len(choices)
    while end and not choices[end - 1]:
        end -= 1
    return list(choices[:end])
