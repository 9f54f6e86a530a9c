"""Write pictures of the simulator. The ending of the file says the kind: the present window, or a replay of the history.

=================  ==========================================================================
``x.png``          the window as it is, 500 by 500 pixels
``x.svg``          the same as vectors
``x.gif``          a replay in pixels
``x.replay.svg``   a replay as vectors, for browsers
=================  ==========================================================================

A replay needs a history from the beginning of the run. `keep_history` costs five microseconds per tick of driving, a quarter of
the allowed time of a tick, so it is off by default.
"""

from __future__ import annotations

import importlib.util
import math

from .. import storage
from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.lisp_core.condition_types import SimpleError, SimpleFileError, shown
from cramhy_runtime.lisp_core.numbers import is_real
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
_VECTORS = {".png": ".svg", ".gif": ".replay.svg"}
"""The endings of pictures in pixels, which Pillow writes, and those of the same in vectors, which need nothing."""


def is_picture(path: str | Path) -> bool:
    """Whether the ending of the file's name is that of a picture."""
    return str(path).lower().endswith((*_REPLAYS, *_STILLS))


def check(path: str | Path) -> None:
    """Signal a simple error if the ending of the file's name is not that of a picture, or if Pillow is missing and the picture needs it.

    Call it before the run to be shown.
    """
    if not is_picture(path):
        conditions.error(
            SimpleError(
                "~a",
                f"What kind of picture is {path} to be? A name ends in .png or .svg (the window as it is), in .gif or .replay.svg (a "
                "replay).",
            )
        )
    text = str(path)
    vectors = _VECTORS.get(text[-4:].lower())
    if vectors is not None and importlib.util.find_spec("PIL") is None:
        conditions.error(
            SimpleError(
                "~a",
                f"The picture {text} has pixels, which the Python package Pillow writes, and Pillow is not installed (for a browser's tab "
                f"there is none). Save it as {text[:-4]}{vectors}, which needs nothing else.",
            )
        )


def is_replay(path: str | Path) -> bool:
    """Whether the ending of the file's name is that of a replay, which needs `keep_history` before the plan runs."""
    return str(path).lower().endswith(tuple(_REPLAYS))


def keep_history() -> None:
    """Keep a history from now on in every simulator of the active graph, running already or started later."""
    each_simulator(lambda simulator: simulator.keep_history())


def save(path: str | Path, simulator: Turtlesim | None = None, speed: float | None = None, called: str | None = None) -> None:
    """Write a picture to ``path``. Its ending says the kind of picture; see the module.

    ``simulator``: a `Turtlesim`, by default the running one. ``speed``: of a replay, in seconds of plan time per second. By default 1,
    or faster, so that the replay ends within 30 seconds. ``called``: the user's spelling of the file name, for errors.

    If the file cannot be written, it is a file-error, and an old file stays as it was. Simple errors: an unknown ending; no
    simulator; no history; a speed for a still picture; a speed that is not a number above zero, or so low that the replay would take
    more than ten minutes.
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
    """``speed`` as a float. If the replay of ``history`` would take too long with it, it is a simple error."""
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
