"""Cleanup: work that a task does on its way out, shielded from requests to end.

`with cleanup():` stands around the cleanup form of an ``unwind-protect``, and in Python in a ``finally``. A request to end the
task waits until the block is left (law 2). A wait inside may never end, for example for a fluent that is not set any more; then the
task, its parent and the whole run would wait for ever. So a wait can be ended from outside (`Task.end_wait`): `WaitEnded` unwinds to
the innermost such block and no further, the rest of the block is left out, and the exit that led here goes on to the outer blocks.

`limit_by` installs a function that is called with each block that is entered and its task. It returns ``None``, or a limit that is told
when the block ends.
"""

from __future__ import annotations

from .active import current
from .budget import budget
from .errors import WaitEnded
from .tasks import shield
from .typing_names import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from collections.abc import Callable

    from .tasks import Task


class Limit(Protocol):
    """Limits the time of a block of cleanup."""

    def end(self) -> None:
        """Called when the block is left."""


class cleanup(shield):  # noqa: N801 (reads as a statement)
    """``with cleanup():`` delays requests to end the current task until the block is left.

    ``outer`` is the block around it, or None. ``limit`` is the result of the function of `limit_by`.
    """

    __slots__ = ("outer", "limit")
    _begins: Callable[[cleanup, Task[object]], Limit | None] | None = None

    def __init__(self) -> None:
        self._task = current()

    def __enter__(self) -> None:
        task = self._task
        task.shielded += 1
        self.outer: cleanup | None = task.cleanup
        task.cleanup = self
        begins = cleanup._begins
        self.limit: Limit | None = None if begins is None else begins(self, task)

    def __exit__(self, kind: object = None, *_: object) -> bool | None:
        task = self._task
        task.cleanup = self.outer
        if self.limit is not None:
            self.limit.end()
        task.shielded -= 1
        if task.attention and not task.shielded:
            budget.end()
        return kind is WaitEnded


def limit_by(function: Callable[[cleanup, Task[object]], Limit | None]) -> None:
    """Call ``function(block, task)`` with each block of cleanup that begins from now on. It returns a `Limit` or ``None``."""
    cleanup._begins = staticmethod(function)
