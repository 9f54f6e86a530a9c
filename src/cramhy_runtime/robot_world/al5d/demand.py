"""The simulator that starts when it is asked for.

A session begins as if the arm stood on its table already, as ``roslaunch lynxmotion_al5d_description al5d_gazebo_control.launch`` puts it
there in another terminal: the first topic or service below ``/lynxmotion_al5d`` that a program asks for and nobody offers starts it. MuJoCo
is loaded then, not before.
"""

from __future__ import annotations

from ...lisp_core import conditions
from ...lisp_core.condition_types import SimpleError
from ...kernel.active import holds_baton
from ...ros import graph
from .names import NAME


def start_when_asked_for() -> None:
    """Let the simulator start in the active graph when a name below its own is asked for."""
    graph.active().on_demand[NAME] = _start


def _start() -> None:
    try:
        from .node import Simulator
    except ImportError as problem:
        if holds_baton():  # a client of another process gets a topic on which nobody publishes
            conditions.error(SimpleError("~a", f"The arm /{NAME} cannot start. {problem}"))
        return
    Simulator()
