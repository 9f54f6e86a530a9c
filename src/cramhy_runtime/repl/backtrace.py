"""The calls that led to an error, for those who ask: ``--backtrace lisp`` shows Lisp functions, ``--backtrace python`` every frame.

Nothing is shown otherwise (law 7). In the debugger the stack is still there; of an error that ended the program its traceback is.
"""

from __future__ import annotations

import sys
import traceback

from cramhy_runtime.lisp.evaluation.places_in_source import describe, frame_position, is_user_file

KINDS = ("none", "lisp", "python")
_kind = "none"
_MOST = 50
"""So many Lisp calls are shown, the innermost ones."""


def show(kind):
    """Set what is shown: one of `KINDS`."""
    global _kind
    _kind = kind


def lines(condition):
    """The lines that follow the explanation of ``condition``: nothing, Lisp calls or Python's frames, the innermost last."""
    if _kind == "none":
        return []
    frames = _frames(condition)
    if _kind == "python":
        text = "".join(traceback.StackSummary.extract((frame, line) for frame, line, _ in frames).format())
        return ["", "Python frames:", *text.rstrip("\n").splitlines()]
    calls = [f"  {_name(frame.f_code)} at {describe(frame_position(frame, lasti))}" for frame, _, lasti in frames
             if is_user_file(frame.f_code.co_filename) and frame.f_code.co_name != "<module>"]
    return ["", "calls, the innermost last:", *calls[-_MOST:]] if calls else []


def _frames(condition):
    """(frame, line, instruction) from the outermost to the innermost: of the traceback, or of the stack that signals now."""
    if condition.__traceback__ is not None:
        found, entry = [], condition.__traceback__
        while entry is not None:
            found.append((entry.tb_frame, entry.tb_lineno, entry.tb_lasti))
            entry = entry.tb_next
        return found
    found, frame = [], sys._getframe(1)
    while frame is not None:
        found.append((frame, frame.f_lineno, frame.f_lasti))
        frame = frame.f_back
    return found[::-1]


def _name(code):
    """A Lisp name for the function of ``code``."""
    name = code.co_name
    if name == "toplevel":
        return "the form"
    return "(LAMBDA ...)" if name.startswith(("<", "Lfunction")) else name.replace("_", "-").upper()
