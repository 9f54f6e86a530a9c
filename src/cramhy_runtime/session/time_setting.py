"""Which time a session lives in, virtual or the wall's: the one place that decides it.

A prompt lives in wall time, and so do the simulator and the page where no session runs. What runs to its end (``cramhy run``, ``hy FILE``,
``cramhy test``, ``cramhy eval``, pytest, an import) lives in virtual time, which passes as fast as the machine computes. Three things say
otherwise. The first of them that is there counts:

1. the option ``--time wall`` of a command, ``--cramhy-time wall`` of pytest,
2. the variable CRAMHY_TIME,
3. a form in the file: ``(cramhy.time "wall")`` in Hy, ``(cramhy:time "wall")`` in Common Lisp, ``cramhy.time("wall")`` in Python.

A session that joins a real robot (``--ros``) lives in wall time, unless 1 or 2 say otherwise.
"""

from __future__ import annotations

import os

from cramhy_runtime import kernel
from cramhy_runtime.kernel.clocks import KINDS
from cramhy_runtime.kernel.images import Cell

VARIABLE = "CRAMHY_TIME"
RUNS_TO_ITS_END, PROMPT = "virtual", "wall"

_fixed = Cell(False)  # whether an option has decided it, so that a form in a file does not count


def _checked(word, said_by):
    """``word``, a string or a Lisp keyword, as one of the two words. ValueError if it is neither."""
    text = str(getattr(word, "name", word)).lower()
    if text not in KINDS:
        raise ValueError(f'{said_by} says "{text}". Time is "virtual" or "wall".')
    return text


def _from_environment():
    word = os.environ.get(VARIABLE)
    return _checked(word, f"The variable {VARIABLE}") if word else None


def decide(option=None, default=RUNS_TO_ITS_END, robot=False):
    """The time of a session that begins, "virtual" or "wall", for `kernel.start`.

    option: what ``--time`` says, or ``None``. default: `RUNS_TO_ITS_END` or `PROMPT`. robot: whether it joins a real robot.
    ValueError if CRAMHY_TIME names neither.
    """
    said = option or _from_environment()
    _fixed.value = said is not None
    return said or ("wall" if robot else default)


def time(kind):
    """Live in the time ``kind`` from now on, "virtual" or "wall"; unless ``--time`` or CRAMHY_TIME have decided it. Returns the time.

    A file says this first, before its plans. Plans that wait go on with the moments that they wait for. ValueError
    for another word.
    """
    kind = _checked(kind, "(cramhy:time ...)")
    if not _fixed.value:
        kernel.set_clock(kind)
    return "virtual" if kernel.active().clock.virtual else "wall"


__all__ = ["PROMPT", "RUNS_TO_ITS_END", "decide", "time"]
