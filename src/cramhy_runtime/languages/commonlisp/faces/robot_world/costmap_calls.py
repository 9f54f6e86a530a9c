"""The functions of the Lisp package ROBOT-WORLD that make cost functions about what is in a world."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from cramhy_runtime.lisp_core.data import Cons, python_list
from cramhy_runtime.robot_world.costmaps.surroundings import Boxes, Direction, Slots, Visible

if TYPE_CHECKING:
    from cramhy_runtime.robot_world.things import Machine, Thing

LISP_NAMES = """
make-boxes-cost make-direction-cost make-slots-cost make-visible-cost
"""


def make_boxes_cost(boxes: Cons, padding: Any = 0.0, *, invert: Any = None) -> Boxes:
    """1 in the boxes, lists (middle-x middle-y length-x length-y), made wider by a padding; with :INVERT 1 outside of them."""
    return Boxes([python_list(box) for box in python_list(boxes)], float(padding), invert is not None)


def make_direction_cost(x: Any, y: Any, dx: Any, dy: Any) -> Direction:
    """The cosine of the angle between the way from (x y) and the direction (dx dy)."""
    return Direction(float(x), float(y), float(dx), float(dy))


def make_slots_cost(places: Cons, radius: Any) -> Slots:
    """1 up to so many metres from one of the places, lists (x y)."""
    return Slots([python_list(place) for place in python_list(places)], float(radius))


def make_visible_cost(thing: Thing, distance: Any, lowest: Any, highest: Any, viewer: Machine | None = None) -> Visible:
    """Which part of a thing cameras see, by the place above which they are, at heights between these two."""
    return Visible(thing.world, thing, float(distance), float(lowest), float(highest), viewer)
