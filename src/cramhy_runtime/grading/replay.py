"""The turtle's run, drawn again from what the plan sent: in the grader's own process, which the submission cannot reach.

The process of the submission reports what its simulator heard: each command and each call of a service, with its tick. `Replay` gives the
same to turtles of its own, tick by tick, as ``turtlesim/node.py`` does. The paper, the way, the walls and all that checks ask for come from
here. So a submission that writes a report of its own must write the commands that draw the right drawing, and that is the exercise.
"""

from __future__ import annotations

import math

from cramhy_runtime.turtlesim.dimensions import CENTRE, EXTENT
from cramhy_runtime.turtlesim.world import TICK, Turtle

from .troubles import Troubles, put

MOST_TURTLES = 20


class WrongReport(Exception):
    """A report that no simulator has made."""


class _Paper:
    """A canvas that keeps lines: (colour, (x1, y1), (x2, y2), width), in metres on the screen (y down), and pixels."""

    def __init__(self):
        self.lines = []

    def line(self, x, y, old_x, old_y, colour, width):
        if (x + y + old_x + old_y) * 0.0 == 0.0:
            self.lines.append((tuple(colour), (old_x, old_y), (x, y), width))


class Replay:
    """A run of the turtles. Raises `WrongReport`.

    start: (x, y, heading) of turtle1 in metres and radians. heard: a list of [tick, kind, turtle, values...]. ticks: how many there were.
    begin: the tick at which the plan began. troubles, seed: as of `Troubles`.

    ``way``: for each turtle its places (x, y, heading) since the plan began, one for each tick. ``begun``: the place of turtle1 then.
    ``commands``, ``services``: how many reached the turtles since. ``pen_late``: whether a turtle was driven before its pen was set for the
    first time. ``walls``: how often one hit a wall. ``lines``: see `drawing`.
    """

    def __init__(self, start, heard, ticks, begin, troubles=(), seed=1):
        _check(heard, ticks, begin)
        self.ticks = ticks
        self.paper = _Paper()
        self.walls = self.commands = 0
        self.services = {}
        self.pen_late, self._driven = False, set()
        self.turtles = {}
        self._spawn("turtle1", (CENTRE, CENTRE, 0.0))
        put(self.turtles["turtle1"], start)
        self.troubles = Troubles(troubles, seed)
        self.way = {}
        self.begun = start
        self.last = 0
        place = 0
        for tick in range(ticks):
            if tick == begin:
                self.troubles.begin = begin
                self.begun = _place(self.turtles["turtle1"]) if "turtle1" in self.turtles else start
                self.walls = self.commands = 0
                self.services = {}
                self.pen_late, self._driven = False, set()
                self.paper.lines.clear()
            self.troubles.act(tick, self.turtles)
            while place < len(heard) and heard[place][0] == tick:
                self._hear(tick, *heard[place][1:3], heard[place][3:])
                place += 1
            for name, turtle in self.turtles.items():
                if not turtle.at_rest:
                    turtle.update(tick * TICK)
                    turtle.draw()
                if tick >= begin:
                    self.way.setdefault(name, []).append(_place(turtle))

    def _spawn(self, name, start):
        self.turtles[name] = Turtle(name, 0, *start, self.paper, self._wall)
        self.turtles = dict(sorted(self.turtles.items()))

    def _wall(self, text):
        self.walls += 1

    def _hear(self, tick, kind, name, values):
        self.last = tick
        if kind == "command":
            self.commands += 1
            values = self.troubles.command(tick, name, tuple(values))
            if values is not None and any(values):
                self._driven.add(name)
            if name in self.turtles and values is not None:
                self.turtles[name].command(*values, tick * TICK)
            return
        if kind == "set_pen" and kind not in self.services:
            self.pen_late = name in self._driven
        self.services[kind] = self.services.get(kind, 0) + 1
        if kind == "spawn":
            if len(self.turtles) >= MOST_TURTLES:
                raise WrongReport(f"There are more than {MOST_TURTLES} turtles.")
            self._spawn(name, values)
        elif kind == "kill":
            self.turtles.pop(name, None)
        elif kind in ("clear", "reset"):
            self.paper.lines.clear()
            if kind == "reset":
                self.turtles = {}
        elif name in self.turtles:
            getattr(self.turtles[name], kind)(*values)

    def drawing(self):
        """The lines that were drawn since the plan began: [(colour, [(x, y), ...]), ...], in metres of the world (y up)."""
        found, open_line = [], None
        for colour, begin, end, _ in self.paper.lines:
            begin, end = _upright(begin), _upright(end)
            if open_line is not None and open_line[0] == colour and open_line[1][-1] == begin:
                open_line[1].append(end)
            else:
                open_line = (colour, [begin, end])
                found.append(open_line)
        return found

    def widths(self):
        """The widths of the lines that were drawn since the plan began, in pixels, each once."""
        return sorted({width for *_, width in self.paper.lines})

    def place(self, name="turtle1"):
        """Where a turtle is at the end, (x, y, heading), or ``None``. Numbers that are not finite stay so, and are near to nothing."""
        return self.way[name][-1] if name in self.turtles and self.way.get(name) else None

    def distance(self, name="turtle1"):
        """The metres that a turtle went since the plan began."""
        way = self.way.get(name, ())
        return sum(math.dist(one[:2], other[:2]) for one, other in zip(way, way[1:]))

    def turned(self, name="turtle1"):
        """The degrees that a turtle turned to the left since the plan began, all turns together; those to the right count less than 0."""
        way = self.way.get(name, ())
        return math.degrees(sum(math.remainder(other[2] - one[2], math.tau) for one, other in zip(way, way[1:])))

    def moved_since(self, tick, name="turtle1"):
        """(metres, radians) between a turtle's place at a tick, counted from the first one of all, and its place at the end."""
        way = self.way.get(name, ())
        if not way:
            return 0.0, 0.0
        then, last = way[max(min(len(way) - 1 - (self.ticks - 1 - tick), len(way) - 1), 0)], way[-1]
        return math.dist(then[:2], last[:2]), abs(math.remainder(last[2] - then[2], math.tau))


def _upright(point):
    """A point of the world (y up) for one on the screen; one far off the paper becomes one beside it. Not-a-number stays what it is."""
    x, y = point[0], EXTENT - point[1]
    if x != x or y != y:
        return math.nan, math.nan
    return min(max(x, -1.0), EXTENT + 1), min(max(y, -1.0), EXTENT + 1)


def _place(turtle):
    return (*_upright((turtle.x, turtle.y)), turtle.heading)


def _check(heard, ticks, begin):
    """Raise `WrongReport` unless a simulator may have written this. Each entry by itself is good (`schema`)."""
    if begin > ticks:
        raise WrongReport("The plan begins after the end.")
    before = 0
    for tick, *_ in heard:
        if not before <= tick <= ticks:
            raise WrongReport("A command has no place in time.")
        before = tick
