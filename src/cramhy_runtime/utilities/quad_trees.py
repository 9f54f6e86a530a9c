"""Quad trees: points of the plane, found by where they are without looking at all of them.

A region that holds more than `FULL` points is cut into four. The region grows when a point lies outside. Points at the same place are all
kept. Source: cpl.md 13.3, which lists the names.
"""

from __future__ import annotations

from math import hypot

from cramhy_runtime.lisp_core.conditions import error, type_error
from cramhy_runtime.lisp_core.data import list_from
from cramhy_runtime.lisp_core.printing import define_printer, print_unreadable
from cramhy_runtime.lisp_core.printing import prin1_to_string

from .wait_queue import need

FULL = 8  # points of a region that is not cut
SMALLEST = 1e-9  # the side of a region that is not cut any more, as a part of the distance from the origin


class QuadTreePoint:
    """A point of the plane; what else belongs to it is ``data``."""

    lisp_name = "CRAM-UTILITIES::QUAD-TREE-POINT"
    __slots__ = ("x", "y", "data")

    def __init__(self, x=0, y=0, data=None):
        self.x, self.y, self.data = x, y, data


class QuadTree:
    """A square region with the corner ``left``, ``bottom`` and its points, or its four quarters."""

    lisp_name = "CRAM-UTILITIES::QUAD-TREE"

    def __init__(self, left=-1.0, bottom=-1.0, side=2.0):
        self.left, self.bottom, self.side = left, bottom, side
        self.points, self.quarters = [], None
        self.count = 0

    def covers(self, x, y):
        return self.left <= x < self.left + self.side and self.bottom <= y < self.bottom + self.side

    def grow(self, x, y):
        """Double the region towards (x, y)."""
        inner = QuadTree(self.left, self.bottom, self.side)
        inner.points, inner.quarters, inner.count = self.points, self.quarters, self.count
        right, up = x >= self.left, y >= self.bottom  # the side to which it grows
        self.left -= 0 if right else self.side
        self.bottom -= 0 if up else self.side
        self.side *= 2
        self.points = []
        self._cut()
        self.quarters[(0 if right else 1) + (0 if up else 2)] = inner

    def _cut(self):
        half = self.side / 2
        self.quarters = [QuadTree(self.left + column * half, self.bottom + row * half, half) for row in (0, 1) for column in (0, 1)]

    def _quarter(self, x, y):
        half = self.side / 2
        return self.quarters[(1 if x >= self.left + half else 0) + (2 if y >= self.bottom + half else 0)]

    def insert(self, point):
        """Add a point that the region covers."""
        tree = self
        while tree.quarters is not None:
            tree.count += 1
            tree = tree._quarter(point.x, point.y)
        tree.count += 1
        tree.points.append(point)
        if len(tree.points) > FULL and tree.side > SMALLEST * max(1.0, abs(tree.left), abs(tree.bottom)):
            points, tree.points = tree.points, []
            tree._cut()
            tree.count = 0
            for each in points:
                tree.insert(each)

    def distance(self, x, y):
        """From (x, y) to the region; 0 inside."""
        across = max(self.left - x, 0, x - self.left - self.side)
        along = max(self.bottom - y, 0, y - self.bottom - self.side)
        return hypot(across, along)

    def within(self, x, y, radius):
        """(distance, point) for each point that is no farther away than ``radius()``, which may shrink meanwhile."""
        waiting = [self]
        while waiting:
            tree = waiting.pop()
            if not tree.count or tree.distance(x, y) > radius():
                continue
            if tree.quarters is not None:
                waiting += sorted(tree.quarters, key=lambda quarter: -quarter.distance(x, y))
            for point in tree.points:
                distance = hypot(point.x - x, point.y - y)
                if distance <= radius():
                    yield distance, point


def make_quad_tree_point(*, x=0, y=0, data=None):
    """``cut:make-quad-tree-point``."""
    for coordinate in (x, y):
        if isinstance(coordinate, bool) or not hasattr(coordinate, "__float__"):
            type_error(coordinate, "REAL")
    return QuadTreePoint(x, y, data)


def _point(thing):
    return need(thing, QuadTreePoint, "CRAM-UTILITIES::QUAD-TREE-POINT")


def _tree(thing):
    return need(thing, QuadTree, "CRAM-UTILITIES:QUAD-TREE")


def quad_tree_point_x(point):
    return _point(point).x


def quad_tree_point_y(point):
    return _point(point).y


def quad_tree():
    """``(cut:quad-tree)``: an empty tree, as ``(make-instance 'quad-tree)`` gives it."""
    return QuadTree()


def quad_tree_insert(tree, point):
    """``cut:quad-tree-insert``: add ``point``; returns it."""
    tree, point = _tree(tree), _point(point)
    if not abs(point.x) < float("inf") or not abs(point.y) < float("inf"):
        error("A point of a quad tree has finite coordinates, not ~S and ~S.", point.x, point.y)
    while not tree.covers(point.x, point.y):
        tree.grow(point.x, point.y)
    tree.insert(point)
    return point


def quad_tree_closest_point_in_range(tree, point, radius):
    """``cut:quad-tree-closest-point-in-range``: the point nearest to ``point`` that is at most ``radius`` away, or nil."""
    nearest, found = radius, None
    for distance, other in _tree(tree).within(_point(point).x, point.y, lambda: nearest):
        if found is None or distance < nearest:
            nearest, found = distance, other
    return found


def quad_tree_points_in_range(tree, point, radius):
    """The points at most ``radius`` away, nearest first; the original exports it under a name with a slip of the pen, undefined."""
    return list_from([other for _, other in sorted(_tree(tree).within(_point(point).x, point.y, lambda: radius), key=lambda pair: pair[0])])


define_printer(QuadTree, lambda tree, stream: print_unreadable(tree, stream, f"QUAD-TREE of {tree.count} points", identity=True))
define_printer(
    QuadTreePoint,
    lambda point, stream: print_unreadable(point, stream, f"QUAD-TREE-POINT {prin1_to_string(point.x)} {prin1_to_string(point.y)}"),
)
