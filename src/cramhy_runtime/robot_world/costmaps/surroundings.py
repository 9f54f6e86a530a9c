"""Cost functions about what is in a world: boxes of things, directions from a thing, and from where a thing is seen.

Source: bullet-world.md 6.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from .arrays import np
from .costs import Cost

if TYPE_CHECKING:
    from cramhy_runtime.robot_world.things import Item, Machine
    from cramhy_runtime.robot_world.world import World

SMALLEST = 0.2
"""The cosine of the widest angle to a direction that still counts."""
_HEIGHTS = 3
_HIDDEN_GROUP = 5


class Boxes(Cost):
    """1 in boxes along the axes, (middle x, middle y, length along x, length along y) each, made ``padding`` metres wider on each side;
    else 0. With ``invert`` the other way round."""

    def __init__(self, boxes: Sequence[Sequence[float]], padding: float = 0.0, invert: bool = False):
        self.boxes, self.padding, self.invert = [tuple(map(float, box)) for box in boxes], float(padding), invert

    def over(self, xs: Any, ys: Any) -> Any:
        """Rows and columns are compared apart."""
        inside = np.zeros((ys.shape[0], xs.shape[1]), bool)
        for x, y, length, width in self.boxes:
            inside |= (abs(xs - x) <= length / 2 + self.padding) & (abs(ys - y) <= width / 2 + self.padding)
        return (~inside if self.invert else inside).astype(float)


class Direction(Cost):
    """The cosine of the angle between the way from (``x`` ``y``) and a direction (``dx`` ``dy``); 0 where it is below `SMALLEST`."""

    def __init__(self, x: float, y: float, dx: float, dy: float):
        length = float(np.hypot(dx, dy))
        if not length:
            raise ValueError("a direction of length 0 points nowhere.")
        self.x, self.y, self.dx, self.dy = float(x), float(y), dx / length, dy / length

    def over(self, xs: Any, ys: Any) -> Any:
        """The place itself is in no direction from itself."""
        x, y = xs - self.x, ys - self.y
        distance = np.hypot(x, y)
        cosine = (x * self.dx + y * self.dy) / np.maximum(distance, 1e-9)
        return np.where(cosine >= SMALLEST, np.minimum(cosine, 1.0), 0.0)


class Slots(Cost):
    """1 up to ``radius`` metres from one of the ``places`` (x y), else 0."""

    def __init__(self, places: Sequence[Sequence[float]], radius: float):
        self.places, self.radius = [tuple(map(float, place)) for place in places], float(radius)

    def over(self, xs: Any, ys: Any) -> Any:
        """The discs together."""
        within = np.zeros((ys.shape[0], xs.shape[1]), bool)
        for x, y in self.places:
            within |= (xs - x) ** 2 + (ys - y) ** 2 <= (self.radius + 1e-9) ** 2
        return within.astype(float)


class Visible(Cost):
    """Which part of the points of a thing is seen by a camera above a place, up to ``distance`` metres away along x and y.

    Rays go from the middle of the box around the thing, and from the middles of its sides, to cameras at heights from ``lowest`` to
    ``highest``; the robot ``viewer`` is in nobody's way.
    """

    def __init__(self, world: World, thing: Item | Machine, distance: float, lowest: float, highest: float, viewer: Machine | None = None):
        self.world, self.thing, self.viewer = world, thing, viewer
        self.distance, self.heights = float(distance), np.linspace(lowest, highest, _HEIGHTS)

    def over(self, xs: Any, ys: Any) -> Any:
        """All rays from one point are asked for at once."""
        scene = self.world.scene
        low, high = self.world.bounds(self.thing.name)
        middle, half = (low + high) / 2, (high - low) / 2
        near = (abs(xs - middle[0]) <= self.distance) & (abs(ys - middle[1]) <= self.distance)
        rows, columns = np.nonzero(near)
        seen = np.zeros(near.shape)
        if not len(rows):
            return seen
        places = np.stack([np.broadcast_to(xs, near.shape)[rows, columns], np.broadcast_to(ys, near.shape)[rows, columns]], axis=1)
        offsets = np.array([(0, 0, 0.9), (0.9, 0, 0), (-0.9, 0, 0), (0, 0.9, 0), (0, -0.9, 0)]) * half
        hidden = [self.thing] + ([self.viewer] if self.viewer is not None else [])
        part = np.zeros(len(rows))
        with scene.without(hidden, _HIDDEN_GROUP) as groups:
            for height in self.heights:
                eyes = np.column_stack([places, np.full(len(rows), height)])
                for offset in offsets:
                    part += scene.free_ways(middle + offset, eyes, groups)
        seen[rows, columns] = part / (len(offsets) * len(self.heights))
        return seen
