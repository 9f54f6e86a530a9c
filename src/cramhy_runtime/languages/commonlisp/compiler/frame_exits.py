"""Leaving a call from above: a debugger ends a call that runs with a value of the user's, or begins it anew.

Python cannot leave a frame from outside, so only functions take part whose compiled body waits for a `FrameExit`. The compiler
makes such functions where somebody asks for them, as ``(debug 3)`` does in SBCL.
"""

from __future__ import annotations

import sys

from cramhy_runtime.lisp_core.data import Symbol
from cramhy_runtime.lisp_core.dynamic import special

DEBUGGED = special(Symbol("*DEBUGGED*"), False)
"""Whether functions are compiled so that a debugger can leave their calls. It costs a block around the body."""


class FrameExit(BaseException):
    """Unwinds the stack to ``frame``. value: what the call returns; again: the call begins anew instead, with its variables as they are."""

    def __init__(self, frame, value=None, again=False):
        self.frame, self.value, self.again = frame, value, again


def ends_here(leaving):
    """Whether the calling function, which has caught ``leaving``, shall return its value; ``False`` if it shall begin anew.

    An exit that is meant for another frame is raised again.
    """
    if leaving.frame is not sys._getframe(1):
        raise leaving
    return not leaving.again


def can_be_left(frame):
    """Whether the call that runs in ``frame`` waits for a `FrameExit`."""
    return "LFrameExit" in frame.f_code.co_names


__all__ = ["DEBUGGED", "FrameExit", "can_be_left", "ends_here"]
