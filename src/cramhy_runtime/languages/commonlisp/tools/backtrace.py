"""The calls that led to an error, for those who ask: ``--backtrace lisp`` shows Lisp functions, ``--backtrace python`` every frame.

The variable CRAMHY_BACKTRACE says the same where the option is not given. Nothing is shown otherwise (law 7). In the debugger the
stack is still there; of an error that ended the program its traceback is. There, ``backtrace`` shows them at any time (`calls`).
"""

from __future__ import annotations

import os
import sys

from cramhy_runtime.kernel.images import Cell
from cramhy_runtime.lisp_core.source_places import circumstance, describe, frame_position, is_user_file

from .operators_around import TOKEN

KINDS = ("none", "lisp", "python")
_kind = Cell(None)  # what was said by `show`
_MOST = 50
"""So many Lisp calls are shown, the innermost ones."""
_WIDEST = 60
"""So many characters of the text of a call are shown."""


def kind():
    """What is shown, one of `KINDS`. Another word in the variable CRAMHY_BACKTRACE, such as 1, shows everything."""
    word = _kind.value or os.environ.get("CRAMHY_BACKTRACE", "").lower() or "none"
    return word if word in KINDS else "python"


def show(kind):
    """Set what is shown: one of `KINDS`, or ``None``: what CRAMHY_BACKTRACE says."""
    _kind.value = kind


def lines(condition):
    """The lines that follow the explanation of ``condition``: nothing, Lisp calls or Python's frames, the innermost last."""
    wanted = kind()
    if wanted == "none":
        return []
    frames = _frames(condition, sys._getframe(1))
    if wanted == "python":
        import traceback  # takes 2 ms, and a prompt is there without it

        text = "".join(traceback.StackSummary.extract((frame, line) for frame, line, _ in frames).format())
        return ["", "Python frames:", *text.rstrip("\n").splitlines()]
    told = [f"  {name} at {describe(position)}" for name, position in _user_calls(frames)]
    return ["", "calls, the innermost last:", *told[-_MOST:]] if told else []


def calls(condition, frame):
    """The lines that tell of the user's calls that led to ``condition``, with their texts, the innermost last.

    frame: of the debugger, which stands on the stack that has signalled the condition.
    """
    told = [
        f"  {name} at {describe(position)}  {_text_from(position)}".rstrip() for name, position in _user_calls(_frames(condition, frame))
    ]
    left_out = [f"  ({len(told) - _MOST} more)"] if len(told) > _MOST else []
    return ["calls, the innermost last:", *left_out, *told[-_MOST:]] if told else ["No function of yours was running."]


def running_calls(frame):
    """The user's calls that run in ``frame`` and its callers: pairs of a Lisp name and a place, the innermost first."""
    return _user_calls(_stack(frame))[::-1]


def _user_calls(frames):
    return [
        (name_of(frame.f_code), frame_position(frame, lasti))
        for frame, _, lasti in frames
        if is_user_file(frame.f_code.co_filename) and frame.f_code.co_name != "<module>"
    ]


def _text_from(position):
    """The form at ``position``, up to the end of its line."""
    import linecache  # it imports the tokenizer

    line = linecache.getline(position[0], position[1] or 0)[max(0, (position[2] or 1) - 1) :]
    depth, end = 0, len(line)
    for token in TOKEN.finditer(line):
        depth += (token[0] == "(") - (token[0] == ")")
        if depth <= 0:
            end = token.end()
            break
    text = " ".join(line[:end].split())
    return text if len(text) <= _WIDEST else text[: _WIDEST - 3] + "..."


def _frames(condition, frame):
    """(frame, line, instruction) from the outermost to the innermost: of the traceback, or of ``frame`` and its callers."""
    if condition.__traceback__ is not None:
        found, entry = [], condition.__traceback__
        while entry is not None:
            found.append((entry.tb_frame, entry.tb_lineno, entry.tb_lasti))
            entry = entry.tb_next
        return found
    return _stack(frame)


def _stack(frame):
    return [(found, found.f_lineno, lasti) for found, lasti in reversed(circumstance.running(frame))]


def name_of(code):
    """A Lisp name for the function of ``code``."""
    name = code.co_name
    if name == "toplevel":
        return "the form"
    return "(LAMBDA ...)" if name.startswith(("<", "Lfunction")) else name.replace("_", "-").upper()
