"""Which kind of picture a file gets, by its ending: a still one of the window as it is, or a replay of what has happened.

=================  ==========================================================================
``x.png``          the window as it is, 500 by 500 pixels
``x.svg``          the same as vectors
``x.gif``          a replay in pixels
``x.replay.svg``   a replay as vectors, for browsers
=================  ==========================================================================

A replay needs a history that was kept from the beginning: `keep_history`, which costs five microseconds per tick of driving, a quarter of
what a tick may cost, and is therefore done only when asked for.
"""

from __future__ import annotations

import math

from .. import storage
from cramhy_runtime.ground import conditions
from cramhy_runtime.ground.condition_types import SimpleError, SimpleFileError, shown
from cramhy_runtime.ground.numbers import is_real
from . import replay, stills
from .node import each_simulator, needed_simulator
from .world import TICK
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, NoReturn

if TYPE_CHECKING:
    from pathlib import Path

    from .history import History
    from .node import Turtlesim


_REPLAYS = {".gif": replay.write_gif, ".replay.svg": replay.write_svg}
_STILLS = {".png": stills.still_png, ".svg": stills.still_svg}


def is_picture(path: str | Path) -> bool:
    """Whether the file's name says which kind of picture it is to be."""
    return str(path).lower().endswith((*_REPLAYS, *_STILLS))


def check(path: str | Path) -> None:
    """Complain of a file name that says no kind of picture: a simple error. To be called before what the picture shall show."""
    if not is_picture(path):
        conditions.error(
            SimpleError(
                "~a",
                f"What kind of picture is {path} to be? A name ends in .png or .svg (the window as it is), in .gif or .replay.svg (a "
                "replay).",
            )
        )


def is_replay(path: str | Path) -> bool:
    """Whether the file's name asks for a replay, and so for `keep_history` before the plan runs."""
    return str(path).lower().endswith(tuple(_REPLAYS))


def keep_history() -> None:
    """Remember from now on what happens, in every simulator that runs or starts in the active graph."""
    each_simulator(lambda simulator: simulator.keep_history())


def save(path: str | Path, simulator: Turtlesim | None = None, speed: float | None = None, called: str | None = None) -> None:
    """Write a picture to ``path``; its ending says which kind (see the module).

    simulator: a `Turtlesim`; the running one when it is left out. speed: of a replay, seconds of plan time per second; ``None``: 1, or as
    fast as it takes to be over in 30 seconds. called: how the user writes the name. Errors: a file-error when the file cannot be
    written, which is then as it was; simple errors: an ending that says nothing, no simulator, no history, a speed that is no number above
    zero, or with which the replay would take longer than ten minutes, or of a still picture.
    """
    path = str(path)
    called = called or path
    check(called)
    if speed is not None:
        _check_speed(speed, called)
    simulator = simulator or needed_simulator()
    try:
        for ending, write in _REPLAYS.items():
            if path.lower().endswith(ending):
                history = simulator.history or _no_history(called)
                return write(history, path, speed and _bearable(speed, history, called))
        for ending, write in _STILLS.items():
            if path.lower().endswith(ending):
                return write(simulator, path)
    except OSError as problem:
        conditions.error(SimpleFileError(called, "~a", f"The picture {called} cannot be written: {storage.why(problem)}"))


def _check_speed(speed: float, path: str) -> None:
    if not (is_real(speed) and 0 < speed < math.inf):
        conditions.error(
            SimpleError("~a", f"The speed of a replay is a number above zero, such as 2 for twice as fast, but not {shown(speed)}.")
        )
    if not is_replay(path):
        conditions.error(
            SimpleError(
                "~a",
                f"The picture {path} shows the window as it is and has no speed. A name that ends in .gif or .replay.svg gets a replay.",
            )
        )


def _bearable(speed: float, history: History, path: str) -> float:
    """``speed`` as a float, when a replay of ``history`` ends in a reasonable time with it."""
    least = history.ticks * TICK / replay.UTMOST
    if speed < least:
        conditions.error(
            SimpleError(
                "~a",
                f"At the speed {shown(speed)} the replay {path} would take longer than {replay.UTMOST / 60:g} minutes. Give a speed of "
                f"{math.ceil(least * 1000) / 1000:g} or more, or none.",
            )
        )
    return float(min(speed, 1e9))  # an integer may be too large for a float


def _no_history(path: str) -> NoReturn:
    conditions.error(
        SimpleError(
            "~a",
            f"There is no history for the replay {path}, since nobody asked to keep one. Type (turtlesim:record), let the turtle do it "
            "again, and save the replay then.",
        )
    )
