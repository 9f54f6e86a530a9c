"""The Lisp package ROBOT-WORLD: the functions of the modules beside this one, and the classes of worlds, items and machines.

It is made when a program first names it, which the libraries ``cl-bullet``, ``cram-bullet-reasoning`` and ``cl-urdf`` do.
"""

from __future__ import annotations

from cramhy_runtime.ground.classes import register_class
from cramhy_runtime.ground.dynamic import global_value
from cramhy_runtime.ground.packages import find_package, on_demand
from cramhy_runtime.robot_world import shown
from cramhy_runtime.robot_world.descriptions import Description, Joint, Link
from cramhy_runtime.robot_world.mesh_files import Mesh
from cramhy_runtime.robot_world.things import Item, Machine, Thing
from cramhy_runtime.robot_world.world import World

from ...packages.face_definition import define_face
from . import costmap_calls, description_calls, link_calls, motion_calls, picture_calls, shape_calls, world_calls

CALLS = (world_calls, shape_calls, description_calls, link_calls, motion_calls, costmap_calls, picture_calls)
CLASSES = {
    "WORLD": World,
    "THING": Thing,
    "ITEM": Item,
    "MACHINE": Machine,
    "DESCRIPTION": Description,
    "LINK": Link,
    "JOINT": Joint,
    "MESH": Mesh,
}


def define_faces() -> None:
    """Make the package."""
    on_demand.pop("ROBOT-WORLD", None)
    package = define_face(
        "ROBOT-WORLD", use=("COMMON-LISP",), functions={calls: calls.LISP_NAMES for calls in CALLS}, export=" ".join(CLASSES)
    )
    for name, cls in CLASSES.items():
        register_class(package.intern(name), cls)
    shown.offer(_current)


def _current() -> World | None:
    """The value of ``btr:*current-bullet-world*`` that all tasks see, not one that a task has bound to look ahead."""
    package = find_package("CRAM-BULLET-REASONING")
    symbol = package and package.lookup("*CURRENT-BULLET-WORLD*")[0]
    value = global_value(symbol) if symbol else None
    return value if isinstance(value, World) else None
