"""The ink on the paper as lines, for other painters: the live page, and pictures without pixels.

A driving turtle draws a line per tick, 62 a second. `Ink` keeps them in arrays, 20 bytes each, and thins them out on demand or piece
by piece. Connected lines become one polyline, and it leaves out points within `TOLERANCE`, a fifth of a pixel, of the line without
them. If lines of different turtles cross within a few seconds, their order may change.
"""

from __future__ import annotations

import math
from array import array

from .dimensions import EXTENT
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, TypeVar

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from .signatures import Colour, Point, Polyline, Stroke

P = TypeVar("P")
TOLERANCE = 0.0045
"""The allowed error of a polyline, in metres: a fifth of a pixel."""
MOST_LINES = 50_000
"""Number of lines to keep, a megabyte. Thinned out piece by piece, that is some hours of driving without a clear; every pixel has
been painted ten times by then. Beyond it, all lines are thinned out, and if that is not enough, the oldest quarter is forgotten."""
PIECE = 1000
"""Number of lines to thin out together, which takes some milliseconds."""
_TOGETHER = 512  # lines among which one may continue another
_WINDOW = 48  # points that one straight piece of a polyline may leave out


class Ink:
    """Lines since the last clear, in the order of drawing."""

    def __init__(self) -> None:
        self._ends = array("f")  # x1 y1 x2 y2 in metres on the screen, per line
        self._pens = array("I")  # place in `_table`, per line
        self._table: dict[tuple[Colour, int], int] = {}

    def __len__(self) -> int:
        return len(self._pens)

    def copy(self) -> Ink:
        """Another `Ink` with the same lines."""
        return self.first(len(self))

    def take(self, lines: Iterable[Stroke]) -> None:
        """Add lines ``(x2, y2, x1, y1, colour, width)`` from `Canvas`, in metres on the screen, drawn from 1 to 2."""
        ends, pens, table = self._ends, self._pens, self._table
        for x2, y2, x1, y1, colour, width in lines:
            if (x1 + y1 + x2 + y2) * 0.0 == 0.0:  # all are finite
                ends.extend((x1, y1, x2, y2))
                pens.append(table.setdefault((colour, width), len(table)))
        if len(pens) > MOST_LINES:
            self._shorten()

    def take_thinned(self, lines: Sequence[Stroke]) -> None:
        """Add lines as `take` does, thinned out in pieces. Over hours, a tenth of them remains."""
        for begin in range(0, len(lines), PIECE):
            piece = Ink()
            piece.take(lines[begin : begin + PIECE])
            for colour, width, points in piece.polylines():
                self.take([(*end, *start, colour, width) for start, end in zip(points, points[1:])])

    def first(self, count: int) -> Ink:
        """Another `Ink` with the first ``count`` lines."""
        other = Ink()
        other._ends, other._pens, other._table = self._ends[: 4 * count], self._pens[:count], dict(self._table)
        return other

    def room_for(self, count: int) -> bool:
        """Whether `Ink` can add ``count`` lines without changing the lines before."""
        return len(self) + count <= MOST_LINES

    def _shorten(self) -> None:
        polylines = self.polylines()
        self.__init__()
        for colour, width, points in polylines:
            self.take([(*end, *start, colour, width) for start, end in zip(points, points[1:])])
        surplus = len(self) - MOST_LINES * 3 // 4
        if surplus > 0:
            del self._ends[: 4 * surplus], self._pens[:surplus]

    def polylines(self) -> list[Polyline]:
        """[(colour, width, [(x, y), ...]), ...], in metres on the screen (y down), thinned out."""
        pens, found = list(self._table), []
        ending: dict[tuple[float, float, int], list[Point]] = {}
        ends = self._ends
        for index, pen in enumerate(self._pens):
            if index % _TOGETHER == 0:
                ending.clear()
            x1, y1, x2, y2 = ends[4 * index : 4 * index + 4]
            points = ending.pop((x1, y1, pen), None)
            if points is None:
                points = [(x1, y1)]
                found.append((*pens[pen], points))
            points.append((x2, y2))
            ending[x2, y2, pen] = points
        return [(colour, width, thinned(points)) for colour, width, points in found]

    def strokes(self) -> list[Stroke]:
        """[(x1, y1, x2, y2, colour, width), ...] in metres of the world (y up), thinned out."""
        return [
            (x1, EXTENT - y1, x2, EXTENT - y2, colour, width)
            for colour, width, points in self.polylines()
            for (x1, y1), (x2, y2) in zip(points, points[1:])
        ]


def thinned(points: Sequence[Point], tolerance: float = TOLERANCE) -> list[Point]:
    """The points of a polyline, without those within ``tolerance`` metres of the straight line between two others.

    ``points``: tuples that begin with x and y, in metres. The result has the same tuples, always with the first and the last.
    """
    return thinned_by(lambda begin, end: _straight(points, begin, end, tolerance), points)


def thinned_by(fits: Callable[[int, int], bool], points: Sequence[P], window: int = _WINDOW) -> list[P]:
    """The points, of any kind, without the unnecessary ones.

    ``fits(begin, end)`` says whether all points between these two indices are unnecessary. ``window``: how many may be at most.
    """
    if len(points) < 3:
        return list(points)
    kept, begin = [points[0]], 0
    for index in range(2, len(points)):
        if index - begin > window or not fits(begin, index):
            begin = index - 1
            kept.append(points[begin])
    kept.append(points[-1])
    return kept


def _straight(points: Sequence[Point], begin: int, end: int, tolerance: float) -> bool:
    """Whether all points between the two indices are within ``tolerance`` of the straight line between the two points."""
    x, y = points[begin][:2]
    along_x, along_y = points[end][0] - x, points[end][1] - y
    length = math.hypot(along_x, along_y)
    if not length:
        return all(math.hypot(points[index][0] - x, points[index][1] - y) <= tolerance for index in range(begin + 1, end))
    along_x, along_y = along_x / length, along_y / length
    for index in range(begin + 1, end):
        off_x, off_y = points[index][0] - x, points[index][1] - y
        ahead = off_x * along_x + off_y * along_y
        if not (-tolerance <= ahead <= length + tolerance and abs(off_y * along_x - off_x * along_y) <= tolerance):
            return False
    return True
