"""Park points: the places where a task gives the baton away, with names.

Everything that can happen to a task from outside happens at such a point: a sibling fails, a parent ends, another task suspends it. A
point has a stable name, that of the operation that waits: ``wait-for``, ``sleep``, ``branches`` (a parallel form waits for its branches),
``cleanup`` (a form waits for the death of branches that it has ended), ``end`` (of another task), and those in `NAMES`.

This costs nothing outside of tests: only the kernel that tests start finds the name, by looking which function waits.
"""

from __future__ import annotations

import os
from types import CodeType, FrameType

NAMES = {
    "cpl/tasks/waiting.py:wait": "wait-for",
    "cpl/tasks/waiting.py:sleep_star": "sleep",
    "cpl/tasks/parallel_children.py:watch": "with-parallel-childs",
    "cpl/tasks/branches.py:Branches.wait": "branches",
    "cpl/tasks/ending.py:end_tasks": "cleanup",
    "cpl/tasks/tasks.py:AbstractTask.join": "end",
    "cpl/tasks/tasks.py:_evaporate": "evaporation",
    "cpl/tasks/tasks.py:AbstractTask.suspend": "suspension",
    "cpl/tasks/suspension.py:task_suspended": "suspension",
    "cpl/tasks/tasks.py:AbstractTask.wake_up": "wake-up",
    "cpl/tasks/pausing.py:_be_suspended": "suspended",
    "kernel/scheduler.py:Kernel.sleep": "sleep",
    "kernel/tasks.py:Task.join": "end",
    "process_modules/modules.py:ProcessModule._await_request": "request",
    "process_modules/executing.py:_attempt": "pm-execute",
    "process_modules/modules.py:ProcessModule.withdraw": "cleanup",
}
"""The functions that wait, by file and name → the name of their park points."""

ORDER = "cpl/tasks/tasks.py:AbstractTask._await_constraints"  # waits by wait-for, for the steps before in a partial order
OTHER = "park"
_FARTHEST = 8  # frames between a function that waits and the kernel
_RUNTIME = os.path.dirname(os.path.dirname(os.path.abspath(__file__))) + os.sep
_known: dict[CodeType, str] = {}  # what each code object is


def name_of_wait(frame: FrameType | None) -> str:
    """The name for the innermost function of `NAMES` from ``frame`` outwards, or ``park`` if none of them is near."""
    for _ in range(_FARTHEST):
        if frame is None:
            break
        name = NAMES.get(_of(frame.f_code))
        if name is not None:
            return "order" if name == "wait-for" and _called_by(frame, ORDER) else name
        frame = frame.f_back
    return OTHER


def _of(code: CodeType) -> str:
    """A code object's file and name, as in `NAMES`."""
    known = _known.get(code)
    if known is None:
        path = code.co_filename.removeprefix(_RUNTIME).replace(os.sep, "/")
        known = _known[code] = f"{path}:{code.co_qualname}"
    return known


def _called_by(frame: FrameType, name: str) -> bool:
    for _ in range(_FARTHEST):
        frame = frame.f_back
        if frame is None or _of(frame.f_code) == name:
            return frame is not None
    return False


class ParkPoint:
    """One time that a task parked.

    ``task`` is the label of the task, ``name`` the name of the point, and ``time`` is in seconds. ``number`` counts all points of the task,
    and ``nth`` those of this name, both from 1.
    """

    __slots__ = ("task", "name", "number", "nth", "time")

    def __init__(self, task: str, name: str, number: int, nth: int, time: float):
        self.task, self.name, self.number, self.nth, self.time = task, name, number, nth, time

    def __str__(self) -> str:
        return f"{self.task}, point {self.number} ({self.name} {self.nth}), at {self.time:g} s"

    __repr__ = __str__
