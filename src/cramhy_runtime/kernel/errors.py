"""The exceptions of the kernel.

Requests to end (`Cancelled`, `Interrupted`, `Terminated`, `Abandoned`) are not errors: they derive from `BaseException`, so that no
`except Exception` and no Lisp handler of `error` swallows them on their way out (law 1: nothing outlives its parent).
Problems of a run as a whole (`Deadlock`, `TimeLimit`) and wrong use of the kernel (`KernelError`) are ordinary exceptions.
"""

from __future__ import annotations

import signal


class Cancelled(BaseException):
    """Raised once in a task that was asked to end. Its cleanup forms run while this unwinds the stack.

    Its argument is that of `Task.cancel`.
    """

    @property
    def reason(self) -> object:
        """The argument, or None."""
        return self.args[0] if self.args else None

    def __str__(self) -> str:
        return "cancelled" if self.reason is None else f"cancelled: {self.reason}"


class WaitEnded(Cancelled):
    """A wait in a task's cleanup was ended (`Task.end_wait`). It unwinds to the end of that cleanup form."""


class Interrupted(KeyboardInterrupt):
    """The user asked the main task to stop (Ctrl-C). A script that does not catch it ends as other Python scripts do at Ctrl-C."""

    def __str__(self) -> str:
        return "interrupted"


class Terminated(SystemExit):
    """The system asked the process to end with the signal ``number``. Raised in the main task. The exit status is 128 + ``number``."""

    def __init__(self, number: int):
        super().__init__(128 + number)
        self.number = number

    def __str__(self) -> str:
        return f"ended by {signal.Signals(self.number).name}"


class Abandoned(BaseException):
    """Cleanup is abandoned: the user asked for the end a second time, while the first request was still unwinding."""

    def __str__(self) -> str:
        return "cleanup abandoned"


class TerminatedAtOnce(Abandoned, Terminated):
    """Cleanup is abandoned: the system asked the process to end a second time, or cleanup took longer than its limit."""

    def __str__(self) -> str:
        return f"{Terminated.__str__(self)}, cleanup abandoned"


class KernelError(RuntimeError):
    """The kernel was used in a way that cannot work. The text says what to do instead."""


class Deadlock(Exception):
    """Every task is parked, and neither a timer nor an outside source can wake one. Raised in the main task."""


class TimeLimit(Exception):
    """Kernel time reached the limit given to `start`. Raised in the main task."""


class WorkLimit(BaseException):
    """A block has used up the slices that `work_limited` gave it. It is no error, so a handler in the block does not swallow it."""


class NoStack(Exception):
    """The system gives no more stacks. The cause says why. Back ends raise it, and the task that needed the stack fails."""
