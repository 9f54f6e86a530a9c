"""The user's code that made something: cheap to note, and converted to a place in the text when a message needs it.

Finding the file, line and column of running code means counting through its instructions, which is too slow for every fact of a large
group. So the code and the number of the instruction are noted, and looked up when a message names the place.
"""

from __future__ import annotations

import sys

from cramhy_runtime.ground.source_places import code_position, is_user_file

_FRAMES = 2
"""So many frames of the user are remembered: the innermost may be in code that a macro made, which has no place of its own."""


def origin():
    """The user's code that runs now, in a form for `position_of_origin`."""
    found, frame = [], sys._getframe(1)
    while frame is not None and len(found) < _FRAMES:
        if is_user_file(frame.f_code.co_filename):
            found.append((frame.f_code, frame.f_lasti))
        frame = frame.f_back
    return tuple(found)


def position_of_origin(found):
    """(file, line, column) of an `origin`, or ``None``."""
    positions = [code_position(code, lasti) for code, lasti in found or ()]
    return next((position for position in positions if position[2] != 0), positions[0] if positions else None)
