"""A budget of processor time, for texts whose macros never end."""

from __future__ import annotations

import signal
from contextlib import contextmanager
from pathlib import Path

from cramhy_runtime import kernel
from cramhy_runtime.ground import dynamic

_WHOLE = (str(Path(kernel.__file__).parent), dynamic.__file__)
"""Where a task changes hands or bindings are swapped: nothing is broken off in the middle of that."""
_LATER = 0.001  # seconds until it is tried again


class OutOfTime(BaseException):
    """The budget is used up. It is no error, so no handler of a program stops it."""


@contextmanager
def budget(seconds):
    """Raise `OutOfTime` in the main thread if the block takes more than so many seconds of processor time. Windows has no such timer."""
    if not hasattr(signal, "setitimer"):
        yield
        return

    def over(_, frame):
        if frame.f_code.co_filename.startswith(_WHOLE):
            signal.setitimer(signal.ITIMER_PROF, _LATER, 1.0)
            return
        raise OutOfTime

    before = signal.signal(signal.SIGPROF, over)
    signal.setitimer(signal.ITIMER_PROF, seconds, 1.0)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, before)
