"""Cleanup: what still has to be done on the way out, shielded from requests to end.

`with cleanup():` stands around the cleanup form of an ``unwind-protect``, and in Python in a ``finally``. A request to end the
task waits until the block is left (law 2). A wait inside may be stuck, on a fluent that nobody sets any more; then the task, its
parent and the whole run would be stuck with it. So a wait can be ended from outside (`Task.end_wait`): `WaitEnded` unwinds to the
innermost such block and no further, the rest of the block is left out, and the exit that led here goes on to the outer blocks.

`begins` is a hook, called with each block that is entered and its task; what it returns, a limit, is told when the block ends.
"""

from .active import current
from .budget import budget
from .errors import WaitEnded
from .tasks import shield


class cleanup(shield):  # noqa: N801 (reads as a statement)
    """A block of cleanup of the current task. ``outer``: the block around it, if one is; ``limit``: what `begins` returned."""

    __slots__ = ("outer", "limit")
    begins = None

    def __init__(self):
        self._task = current()

    def __enter__(self):
        task = self._task
        task.shielded += 1
        self.outer = task.cleanup
        task.cleanup = self
        begins = cleanup.begins
        self.limit = None if begins is None else begins(self, task)

    def __exit__(self, kind, exception, traceback):
        task = self._task
        task.cleanup = self.outer
        if self.limit is not None:
            self.limit.end()
        task.shielded -= 1
        if task.attention and not task.shielded:
            budget.end()
        return kind is WaitEnded
