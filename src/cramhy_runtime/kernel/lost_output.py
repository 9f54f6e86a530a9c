"""Output that nobody reads any more: the terminal was closed, or the program at the other end of the pipe has ended.

An error in the middle of a plan would be the wrong answer, and one in a cleanup form the worst: it would leave out the stop command that
stands after a PRINT. So what is written from then on goes nowhere, and the process is asked to end, as the system's own signal asks it.
"""

import errno
import os
import signal

from .active import active

REASONS = {errno.EPIPE: "SIGPIPE", errno.EIO: "SIGHUP", errno.ENXIO: "SIGHUP"}
"""The signal that stands for each reason; where there is no such signal SIGTERM does."""


def lost(file, problem):
    """Whether PROBLEM, the OSError of a write to FILE, says that nobody reads it any more. If so, FILE leads to nowhere from now on, and
    the process ends through the cleanup of its plans."""
    if problem.errno not in REASONS:
        return False
    nowhere = os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(nowhere, file.fileno())
    except (AttributeError, OSError, ValueError):  # it is not one of the system's files
        return False
    finally:
        os.close(nowhere)
    kernel = active()
    if kernel is None:
        return False
    if kernel.ended_by is None:
        kernel.terminate(getattr(signal, REASONS[problem.errno], signal.SIGTERM))
    return True
