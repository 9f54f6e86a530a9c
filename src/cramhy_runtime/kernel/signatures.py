"""What the functions of the kernel take, by name. Only type checkers read this module: nothing imports it when a program runs."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from types import FrameType
from typing import Any, Literal, Protocol, TypeVar

from .clocks import VirtualClock, WallClock
from .scheduler import Kernel
from .tasks import Task

T = TypeVar("T")
Callback = Callable[[], object]
"""A function that somebody calls when its time has come; what it returns is not looked at."""
Why = str | Callable[[], str]
"""What a task waits for, for reports: a text, or a function that makes one when somebody reads it."""
Name = str | Callable[[], str]
"""The name of a task, or a function that makes it when somebody reads it."""
Reason = str | BaseException | Callable[[], BaseException] | None
"""Why a task is asked to end, or what is to be raised in it for that."""
ClockName = Literal["virtual", "wall"]
Clock = VirtualClock | WallClock
BackendName = Literal["threads", "greenlet"]
Seed = int | float | str | Callable[[deque[Task[object]]], int]
"""Who goes next: the seed of a shuffle, or a function of the queue that gives the place of the one that does."""


class Carrier(Protocol):
    """A stack that tasks run on."""

    ident: int


class Backend(Protocol):
    """What makes stacks (carriers), and jumps between them; see `cramhy_runtime.kernel.backends`."""

    calls_back: bool

    def adopt(self, kernel: Kernel) -> Carrier: ...
    def carrier(self, job: Callable[[Carrier], Carrier]) -> Carrier: ...
    def transfer(self, mine: Any, other: Any) -> None: ...
    def run_blocking(self, kernel: Kernel, task: Task[object], call: Callable[[], T]) -> T: ...
    def frame(self, carrier: Any) -> FrameType | None: ...
    def close(self) -> None: ...
    def forsake(self, carrier: Any) -> None: ...


class Dynamic(Protocol):
    """The dynamic state of a task, such as its bindings of special variables, which goes and comes with the baton."""

    def leave(self) -> None: ...
    def enter(self) -> None: ...
