"""A budget of processor time, for texts whose macros never end."""

from __future__ import annotations

import signal
from contextlib import contextmanager


class OutOfTime(BaseException):
    """The budget is used up. It is no error, so no handler of a program stops it."""


@contextmanager
def budget(seconds):
    """Raise `OutOfTime` in the main thread if the block takes more than so many seconds of processor time. Windows has no such timer."""
    if not hasattr(signal, "setitimer"):
        yield
        return

    def over(*_):
        raise OutOfTime

    before = signal.signal(signal.SIGPROF, over)
    signal.setitimer(signal.ITIMER_PROF, seconds, 1.0)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, before)
