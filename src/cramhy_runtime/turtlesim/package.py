"""The Lisp package TURTLESIM: what one does at the simulator's window, from the REPL.

The original has a window and a terminal for the arrow keys; ``(turtlesim:press :up)`` presses one, ``(turtlesim:save-paper
"turtle.png")`` writes what the window would show.
"""

from __future__ import annotations

from ..lisp import conditions
from ..lisp.faces import define_face
from ..lisp.packages import string_designator
from ..lisp.streams.streams import STANDARD_OUTPUT
from ..ros import graph
from .node import running_simulator, start_turtlesim
from .teleop import KEYS, NAMED_KEYS, Teleop


def _simulator():
    return running_simulator() or conditions.error(
        'No turtlesim is running in this process. It starts with (start-ros-node "name"), or with (turtlesim:start).'
    )


def start():
    """Start the simulator, if none is running."""
    if running_simulator() is None:
        start_turtlesim()


def press(key, turtle="turtle1"):
    """Press an arrow key, ``:up :down :left :right``: one command for the turtle; T."""
    name = string_designator(key).lower()
    if NAMED_KEYS.get(name, name.upper()) not in KEYS:
        return conditions.error("~s is not a key that moves the turtle. Keys: :up :down :left :right.", key)
    nodes = graph.active().nodes
    teleop = getattr(nodes.get("/teleop_turtle"), "teleop", None)
    if teleop is None or teleop.turtle != turtle:
        teleop = Teleop(turtle)
    return True if teleop.press(name if name in NAMED_KEYS else name.upper()) else None


def save_paper(path):
    """Write the window, paper and turtles, as a PNG file; returns the path."""
    _simulator().save_png(str(path))
    return path


def log():
    """Print the simulator's log, which the original prints in its own terminal."""
    STANDARD_OUTPUT.value.write("".join(line + "\n" for line in _simulator().lines))


TURTLESIM = define_face("TURTLESIM", functions={"start": start, "press": press, "save-paper": save_paper, "log": log})
