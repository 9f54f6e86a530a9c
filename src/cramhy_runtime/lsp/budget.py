"""A budget of processor time, for texts whose macros never end."""

from __future__ import annotations

import signal
from contextlib import contextmanager

from cramhy_runtime import kernel


class OutOfTime(BaseException):
    """The budget is used up. It is no error, so no handler of a program stops it."""


@contextmanager
def budget(seconds):
    """Raise `OutOfTime` if the block takes more than so many seconds of processor time. Windows has no such timer.

    The kernel that is active then is interrupted, as by Ctrl-C: the block ends at a checkpoint, through the cleanup of what runs, and one
    second later the cleanup is abandoned. Without a kernel nothing is interrupted.
    """
    if not hasattr(signal, "setitimer"):
        yield
        return
    asked = False

    def over(*_):
        nonlocal asked
        if (active := kernel.active()) is not None:
            asked = True
            active.interrupt()

    before = signal.signal(signal.SIGPROF, over)
    signal.setitimer(signal.ITIMER_PROF, seconds, 1.0)
    try:
        yield
    except (kernel.Interrupted, kernel.Abandoned):
        if asked:
            raise OutOfTime from None
        raise
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, before)
