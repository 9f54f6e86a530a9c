"""Which code of the user's made something: cheap to note, and a place in the text when somebody asks.

File, line and column of running code are found by counting through its instructions, which is too slow to do for every fact of a large
group. So the code and how far it had come are noted, and looked up when a message names the place.
"""

from __future__ import annotations

import sys

from cramhy_runtime.ground.source_places import code_position, is_user_file

_FRAMES = 2
"""So many frames of the user's are remembered: the innermost may be in code that a macro made, which has no place of its own."""


def origin():
    """What the user's code that runs now is: `position_of_origin` makes a place of it."""
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
