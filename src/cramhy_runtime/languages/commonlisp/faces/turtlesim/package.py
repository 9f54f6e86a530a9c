"""The Lisp package TURTLESIM: what one does at the simulator's window, from the REPL.

The original has a window and a terminal for the arrow keys. ``(turtlesim:view)`` shows the turtles in a browser, and ``(turtlesim:press
:up)`` presses a key. ``(turtlesim:save-picture "turtle.png")`` writes what the window would show, and after ``(turtlesim:record)`` the same
for ``"turtle.gif"`` shows how it came about. What only some sessions need is imported when it is called for: a session begins in a third of
a second.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.lisp_core.condition_types import SimpleError, shown
from cramhy_runtime.lisp_core.data import Symbol
from ...packages.face_definition import define_face
from cramhy_runtime.lisp_core.packages import string_designator
from ...streams.streams import STANDARD_OUTPUT
from cramhy_runtime.ros import graph
from cramhy_runtime.ros.names import check_graph_name
from cramhy_runtime.turtlesim.node import Turtlesim, needed_simulator, running_simulator
from cramhy_runtime.turtlesim.teleop import KEYS, NAMED_KEYS, Teleop


def _name(designator):
    """What a string or a symbol names: names in ROS have small letters and underscores. One that ROS does not allow is a simple error."""
    name = string_designator(designator)
    name = name.lower().replace("-", "_") if isinstance(designator, Symbol) else name
    complaint = check_graph_name(name)
    if complaint:
        conditions.error(SimpleError("~a", f"{shown(designator)} is not the name of a turtle or of a node. {complaint}"))
    return name


def start(*arguments):
    """Start a simulator with the words of a command line, strings; without any: ``/turtlesim``, if no simulator is running. T."""
    if arguments or running_simulator() is None:
        Turtlesim(arguments=list(map(str, arguments)))
    return True


def press(key, turtle="turtle1"):
    """Press an arrow key, ``:up :down :left :right``: one command for the turtle; T."""
    name = string_designator(key).lower()
    if NAMED_KEYS.get(name, name.upper()) not in KEYS:
        return conditions.error("~s is not a key that moves the turtle. Keys: :up :down :left :right.", key)
    turtle = _name(turtle)
    teleop = getattr(graph.active().nodes.get("/teleop_turtle"), "program", None)
    if not isinstance(teleop, Teleop) or teleop.turtle != turtle:
        teleop = Teleop(turtle)
    return True if teleop.press(name if name in NAMED_KEYS else name.upper()) else None


def draw_square(*arguments):
    """Start ``draw_square``, which resets the world and drives squares until the node ``/draw_square`` ends; T.

    The arguments are the words of its command line, strings.
    """
    from cramhy_runtime.turtlesim.draw_square import DrawSquare

    DrawSquare(arguments=list(map(str, arguments)))
    return True


def mimic(leader="turtle1", follower="turtle2", *arguments):
    """Start ``mimic``: the turtle ``follower`` does what ``leader`` does, both names (``"turtlesim1/turtle1"``); T."""
    from cramhy_runtime.turtlesim.mimic import Mimic

    Mimic(_name(leader), _name(follower), arguments=list(map(str, arguments)))
    return True


def stop(name):
    """End the program whose node has that name, ``"draw_square"`` or ``"turtle_mimic"``; T, or NIL when it does not run."""
    name = _name(name)
    program = getattr(graph.active().nodes.get(name if name.startswith("/") else f"/{name}"), "program", None)
    if program is None:
        return None
    program.shutdown()
    return True


def save_picture(path, *, speed=None):
    """Write a picture; returns the path. ``.png`` and ``.svg`` show the window as it is, ``.gif`` and ``.replay.svg`` what has happened
    since ``(turtlesim:record)``, ``speed`` times as fast as it was. The file is the one that ``open`` would open."""
    from ...files.files import path_of
    from ...pathnames.pathnames import namestring
    from cramhy_runtime.turtlesim import pictures

    pictures.save(path_of(path), speed=speed, called=namestring(path))
    return path


def record():
    """Remember from now on what happens, for ``(turtlesim:save-picture "x.gif")``; T."""
    from cramhy_runtime.turtlesim import pictures

    pictures.keep_history()
    return True


def log():
    """Print the simulator's log, which the original prints in its own terminal."""
    STANDARD_OUTPUT.value.write("".join(line + "\n" for line in needed_simulator().lines))


def view():
    """Show the turtles' world and the plan in a page; returns its address. On a desktop the page opens in a browser.

    It opens at any time, and stays until the session ends.
    """
    from cramhy_runtime.turtlesim import window

    try:
        return window.view()
    except window.NoPage as problem:
        return conditions.error(SimpleError("~a", str(problem)))


def define():
    """Let Common Lisp see it; called once, when the image is made."""
    define_face(
        "TURTLESIM",
        use=["COMMON-LISP"],
        shadow="log",
        functions={
            "start": start,
            "press": press,
            "draw-square": draw_square,
            "mimic": mimic,
            "stop": stop,
            "log": log,
            "record": record,
            "save-picture": save_picture,
            "save-paper": save_picture,
            "view": view,
        },
    )
