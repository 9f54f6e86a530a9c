"""Troubles of the turtle's world that an exercise makes on purpose: a push, lost commands, slipping wheels, a pen that somebody changes.

The same object works at two places: in the process of the submission, where it changes what the simulator hears and does, and in the
grader's own, where `Replay` draws the paper again. So a push is there in both, at the same tick. Times count from the beginning of the
plan, in seconds.
"""

from __future__ import annotations

import random

from cramhy_runtime.turtlesim.dimensions import CENTRE
from cramhy_runtime.turtlesim.world import TICK

from .problems import ExerciseError

KINDS = {
    "push": {"at", "x", "y", "turn"},
    "pen": {"at", "off", "r", "g", "b", "width"},
    "lost": {"from", "to", "share"},
    "slip": {"from", "to", "forward", "turn"},
}
"""The kinds of troubles, and what each of them is told."""


def checked(trouble):
    """``trouble``, a table of an exercise, if it can be made. Raises `ExerciseError`."""
    kind = trouble.get("kind")
    if kind not in KINDS:
        raise ExerciseError(f"There is no trouble {kind!r}. There are {', '.join(KINDS)}.")
    unknown = set(trouble) - KINDS[kind] - {"kind", "turtle"}
    if unknown:
        raise ExerciseError(f"The trouble {kind} knows no {', '.join(sorted(unknown))}. It knows {', '.join(sorted(KINDS[kind]))}.")
    return trouble


def put(turtle, start):
    """Put a turtle that has just appeared in the centre to ``start``, (x, y, heading) in metres and radians."""
    x, y, heading = start
    turtle.push(x - CENTRE, y - CENTRE, heading)


class Troubles:
    """The troubles of one run. troubles: a list of tables with numbers. seed: decides which commands are lost.

    ``begin``: the tick at which the plan began, ``None`` before. ``commands``: how many commands were heard since.
    """

    def __init__(self, troubles, seed):
        self.troubles = troubles
        self.chance = random.Random(f"troubles {seed}")
        self.begin = None

    def _seconds(self, tick):
        return (tick - self.begin) * TICK

    def command(self, tick, turtle, velocity):
        """The velocity that counts when ``turtle`` is told ``velocity`` at ``tick``, or ``None`` if it does not hear it."""
        if self.begin is None:
            return velocity
        forward, sideways, turn = velocity
        for trouble in self.troubles:
            if trouble["kind"] not in ("lost", "slip") or turtle != trouble.get("turtle", "turtle1"):
                continue
            if not trouble.get("from", 0.0) <= self._seconds(tick) < trouble.get("to", float("inf")):
                continue
            if trouble["kind"] == "lost":
                if self.chance.random() < trouble.get("share", 1.0):
                    return None
            else:
                forward, turn = forward * trouble.get("forward", 1.0), turn * trouble.get("turn", 1.0)
        return forward, sideways, turn

    def act(self, tick, turtles):
        """Do what happens by itself before the update of ``tick``. turtles: a dictionary from names to `Turtle`."""
        if self.begin is None:
            return
        for trouble in self.troubles:
            if trouble["kind"] not in ("push", "pen") or tick - self.begin != round(trouble.get("at", 0.0) / TICK):
                continue
            turtle = turtles.get(trouble.get("turtle", "turtle1"))
            if turtle is None:
                continue
            if trouble["kind"] == "push":
                turtle.push(trouble.get("x", 0.0), trouble.get("y", 0.0), trouble.get("turn", 0.0))
            else:
                colour = (int(trouble.get(part, 255)) for part in "rgb")
                turtle.set_pen(*colour, int(trouble.get("width", 3)), trouble.get("off", 0))
