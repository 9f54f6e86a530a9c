"""Types of the arguments of the kernel. Only type checkers read this module: no code imports it when a program runs."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from types import FrameType
from typing import Any, Literal, Protocol, TypeVar

from .clocks import Bell, VirtualClock, WallClock
from .scheduler import Kernel
from .tasks import Task

T = TypeVar("T")
Callback = Callable[[], object]
"""A function that is called later. Its result is ignored."""
Why = str | Callable[[], str]
"""A text for reports that says what a task waits for, or a function that makes it when it is read."""
Name = str | Callable[[], str]
"""The name of a task, or a function that makes it when it is read."""
Reason = str | BaseException | Callable[[], BaseException] | None
"""Why a task is asked to end, or the exception to raise in it for that."""
ClockName = Literal["virtual", "wall"]
Clock = VirtualClock | WallClock
BackendName = Literal["auto", "threads", "greenlet", "jspi"]
Seed = int | float | str | Callable[[deque[Task[object]]], int]
"""The order of tasks: the seed of a shuffle, or a function of the queue that returns the place of the task that goes next."""


class Carrier(Protocol):
    """A stack on which tasks run."""

    ident: int

    @property
    def direct(self) -> bool: ...

    def switch(self) -> object: ...


class Backend(Protocol):
    """Makes stacks (carriers), and jumps between them; see `cramhy_runtime.kernel.backends`."""

    calls_back: bool

    @property
    def breathe(self) -> Callback | None: ...
    def adopt(self, kernel: Kernel) -> Carrier: ...
    def carrier(self, job: Callable[[Carrier], Carrier]) -> Carrier: ...
    def transfer(self, mine: Any, other: Any) -> None: ...
    def run_blocking(self, kernel: Kernel, task: Task[object], call: Callable[[], T]) -> T: ...
    def frame(self, carrier: Any) -> FrameType | None: ...
    def bell(self) -> Bell: ...
    def close(self) -> None: ...
    def forsake(self, carrier: Any) -> None: ...


class Dynamic(Protocol):
    """The dynamic state of a task, such as its bindings of special variables. It is put away while the task does not have the baton."""

    def leave(self) -> None: ...
    def enter(self) -> None: ...
