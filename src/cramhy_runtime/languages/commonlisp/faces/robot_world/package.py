"""The Lisp package ROBOT-WORLD: the functions of the modules beside this one, and the classes of worlds, items and machines.

It is made when a program first names it, which the libraries ``cl-bullet``, ``cram-bullet-reasoning`` and ``cl-urdf`` do.
"""

from __future__ import annotations

import functools
from typing import Any

from cramhy_runtime.lisp_core.classes import register_class
from cramhy_runtime.lisp_core.conditions import type_error
from cramhy_runtime.lisp_core.dynamic import global_value
from cramhy_runtime.lisp_core.packages import Package, find_package, on_demand
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
    _check_arguments(package)
    shown.offer(_current)


def _check_arguments(package: Package) -> None:
    """Let the functions of ``package`` refuse what is not a world, a thing and so on, as they are annotated, with a type-error of Lisp."""
    names = {cls.__name__: (cls, name) for name, cls in CLASSES.items()}
    for symbol in list(package.external):
        function = package.lookup(symbol)[0].function
        annotations = getattr(getattr(function, "python", function), "__annotations__", {})
        wanted = [(index, *names[kind]) for index, kind in enumerate(annotations.values()) if kind in names]
        if wanted and "return" in annotations:
            package.lookup(symbol)[0].function = _checked(function, [entry for entry in wanted if entry[0] < len(annotations) - 1])


def _checked(function: Any, wanted: list[tuple[int, type, str]]) -> Any:
    @functools.wraps(function)
    def checked(*arguments: Any, **keywords: Any) -> Any:
        for index, cls, name in wanted:
            if index < len(arguments) and not isinstance(arguments[index], cls):
                return type_error(arguments[index], f"ROBOT-WORLD:{name}")
        return function(*arguments, **keywords)

    return checked


def _current() -> World | None:
    """The value of ``btr:*current-bullet-world*`` that all tasks see, not one that a task has bound to look ahead."""
    package = find_package("CRAM-BULLET-REASONING")
    symbol = package and package.lookup("*CURRENT-BULLET-WORLD*")[0]
    value = global_value(symbol) if symbol else None
    return value if isinstance(value, World) else None
