"""How near two drawings are: by their lines, and not by pixels.

Both are cut into points that lie close together. A point of the target that is farther from the drawing than the tolerance is missing, and
a point of the drawing that is farther from the target than that is too much. So the order, the direction and the number of strokes do not
count, nor does a line that was drawn twice. They count for `in_order` and `length`.
"""

from __future__ import annotations

import math
from typing import NamedTuple

STEP = 0.05
"""Metres between two points of a line."""


class Difference(NamedTuple):
    """Metres of the target that are ``missing`` and the place (x, y) of the first of them; metres that are too ``much``, and the place."""

    missing: float
    missing_at: tuple[float, float] | None
    much: float
    much_at: tuple[float, float] | None


def difference(target, drawn, tolerance):
    """The `Difference` between two drawings, each a list of (colour or ``None``, [(x, y), ...]) in metres.

    tolerance: in metres. If the target names colours, lines are compared with lines of the same colour.
    """
    coloured = any(colour is not None for colour, _ in target)
    wanted, found = _points(target, coloured), _points(drawn, coloured)
    missing, much = _apart(wanted, found, tolerance), _apart(found, wanted, tolerance)
    return Difference(round(len(missing) * STEP, 2), missing[0] if missing else None, round(len(much) * STEP, 2), much[0] if much else None)


def in_order(target, drawn, tolerance):
    """Whether somebody who follows ``drawn`` from its beginning comes to the points of ``target`` in their order."""
    ahead = iter([point for _, line in drawn for point in _along(line)])
    here = next(ahead, None)
    for x, y in [point for _, line in target for point in _along(line)]:
        while here is not None and not math.dist(here, (x, y)) <= tolerance:
            here = next(ahead, None)
        if here is None:
            return False
    return True


def length(drawing):
    """The metres of all lines of a drawing; what was drawn twice counts twice."""
    return sum(math.dist(one, other) for _, line in drawing for one, other in zip(line, line[1:]))


def _along(line):
    """The points of a line, from its beginning to its end."""
    for (x, y), (to_x, to_y) in zip(line, line[1:]):
        pieces = max(math.ceil(math.hypot(to_x - x, to_y - y) / STEP), 1)
        yield from ((x + (to_x - x) * piece / pieces, y + (to_y - y) * piece / pieces) for piece in range(pieces))
    yield from line[-1:]


def _points(drawing, coloured):
    """For each colour a list of points."""
    found = {}
    for colour, line in drawing:
        points = found.setdefault(colour if coloured else None, [])
        points += _along(line)
    return found


def _apart(these, those, tolerance):
    """The points of ``these`` that are farther than ``tolerance`` from all points of the same colour of ``those``."""
    apart = []
    for colour, points in these.items():
        cells = {}
        for x, y in those.get(colour, ()):
            cells.setdefault((int(x // tolerance), int(y // tolerance)), set()).add((round(x, 2), round(y, 2)))
        seen = set()
        limit = (tolerance + STEP / 2) ** 2
        for x, y in points:
            if (round(x / STEP), round(y / STEP)) in seen:
                continue  # what is drawn twice counts once
            seen.add((round(x / STEP), round(y / STEP)))
            column, row = int(x // tolerance), int(y // tolerance)
            near = (cells.get((column + right, row + up), ()) for right in (-1, 0, 1) for up in (-1, 0, 1))
            if not any((x - a) ** 2 + (y - b) ** 2 <= limit for cell in near for a, b in cell):
                apart.append((x, y))
    return apart
