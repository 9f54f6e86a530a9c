"""Python's own calls that wait, in a session: `time.sleep` and `input` let the other tasks run, and can be interrupted.

They wait in the system, where a signal, a stop button or an editor cannot reach a task. A user who types ``(time.sleep 100)`` at a prompt
or in a cell expects that an interrupt ends it. So in a session the names stand for functions that go outside of the kernel meanwhile, as
`run_blocking` does. In virtual time the clock stands still. In other threads, in callbacks and without a session they are Python's own.
"""

import builtins
import math
import sys
import time

from .active import holds_baton, run_blocking
from .standard_input import StandardInput, read_line

SLICE = 0.05  # s after which a task looks whether it has been asked to end
_sleep, own_input = time.sleep, builtins.input
"""Python's own functions; the prompt itself reads its lines with readline by `own_input`."""


def sleep(seconds: float, /) -> None:
    """``time.sleep``: wait for SECONDS of wall time."""
    if not holds_baton() or not isinstance(seconds, (int, float)) or not 0 < seconds < math.inf:
        return _sleep(seconds)
    end = time.monotonic() + seconds
    while (left := end - time.monotonic()) > 0:
        run_blocking(_sleep, min(left, SLICE))
    return None


def ask(prompt: object = "", /) -> str:
    """``input``: print PROMPT and return a line without its end. EOFError at the end of the input."""
    if type(sys.stdin) is not StandardInput or not holds_baton():
        return own_input(prompt)
    sys.stdout.write(str(prompt))
    sys.stdout.flush()
    line = read_line(sys.stdin)
    if not line:
        raise EOFError("EOF when reading a line")
    return line.removesuffix("\n")


def install() -> None:
    """Let Python's names stand for these functions from now on."""
    time.sleep, builtins.input = sleep, ask
