"""The shapes of things for contacts in a physical world.

The kinematic world closes hollow objects, as the original does, which takes the convex hull of each mesh. A gripper takes a bowl by its
rim, so in a physical world a bowl has a wall: slabs around a bottom. It takes a spoon by its handle, so there cutlery has one.
"""

from __future__ import annotations

from dataclasses import replace
from math import cos, pi, sin, tan
from typing import TYPE_CHECKING

from ..descriptions import Frame, turned

if TYPE_CHECKING:
    from ..descriptions import Shape
    from ..things import Item

HOLLOW = ("bowl", "cup", "mug", "pot")
WALL = 0.006
"""How thick the walls of hollow objects are, metres."""
_SLABS = 16
CUTLERY = ("cutlery", "spoon", "fork", "knife")
HANDLE = 0.012
"""How wide the handles of cutlery are, metres."""
_HEAD = 0.3  # the share of the length that the wide end has


def contact_shapes(item: Item) -> tuple[Shape, ...]:
    """What an item is made of in a physical world: its own shapes, with a wall and a bottom for each cylinder of a hollow object, and a
    handle for each box of cutlery."""
    kinds = {str(getattr(kind, "name", kind)).lower() for kind in item.types}
    if kinds.intersection(CUTLERY):
        return tuple(part for shape in item.shapes for part in (_with_handle(shape) if shape.kind == "box" else (shape,)))
    if not kinds.intersection(HOLLOW):
        return item.shapes
    return tuple(part for shape in item.shapes for part in (_hollow(shape) if shape.kind == "cylinder" else (shape,)))


def _hollow(shape: Shape) -> list[Shape]:
    radius, length = shape.size
    x, y, z = shape.frame.position
    middle, width = radius - WALL / 2, 2 * radius * tan(pi / _SLABS)
    bottom = replace(shape, size=(radius, WALL), frame=Frame((x, y, z - length / 2 + WALL / 2)))
    walls = [
        replace(  # only the bottom stands on the table
            shape,
            kind="box",
            size=(WALL, width, length - WALL),
            frame=Frame((x + middle * cos(a), y + middle * sin(a), z + WALL / 2), turned(0, 0, a)),
        )
        for a in (2 * pi * number / _SLABS for number in range(_SLABS))
    ]
    return [bottom, *walls]


def _with_handle(shape: Shape) -> list[Shape]:
    """A box along x as a handle and a wide end; a box that is no wider than a handle as it is."""
    length, width, height = shape.size
    if width <= HANDLE:
        return [shape]
    x, y, z = shape.frame.position
    ends = ((HANDLE, 1 - _HEAD, -_HEAD / 2), (width, _HEAD, (1 - _HEAD) / 2))
    return [
        replace(shape, size=(length * share, wide, height), frame=replace(shape.frame, position=(x + length * at, y, z)))
        for wide, share, at in ends
    ]
