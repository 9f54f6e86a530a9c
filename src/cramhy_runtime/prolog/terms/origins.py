"""The code in Lisp or Hy that made something, the user's or a library's: noted at once, and made a place when a message needs it.

Finding the file, line and column of running code means counting through its instructions, which is too slow for every fact of a large
group. So the code and the number of the instruction are noted, and looked up when a message names the place.
"""

from __future__ import annotations

import sys

from cramhy_runtime.lisp_core.source_places import code_position, is_lisp_text

_FRAMES = 2
"""So many frames are remembered: the innermost may be in code that a macro made, which has no place of its own."""


def origin():
    """The code in Lisp or Hy that runs now, in a form for `position_of_origin`."""
    found, frame = [], sys._getframe(1)
    while frame is not None and len(found) < _FRAMES:
        if is_lisp_text(frame.f_code.co_filename):
            found.append((frame.f_code, frame.f_lasti))
        frame = frame.f_back
    return tuple(found)


def position_of_origin(found):
    """(file, line, column) of an `origin`, or ``None``."""
    positions = [code_position(code, lasti) for code, lasti in found or ()]
    return next((position for position in positions if position[2] != 0), positions[0] if positions else None)
