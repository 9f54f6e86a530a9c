"""What comes with cramhy to fill a world: the PR2, the kitchen of Bremen, and the objects of the tutorials.

The figures (sizes, joints, limits) are those of the original's files; the shapes are boxes, cylinders and spheres of our own. An object's
pose is where the origin of the original's mesh is, which is not its middle.
"""

from __future__ import annotations

import functools
import json
from pathlib import Path

from .descriptions import Description, Frame, Shape
from .urdf import read_text

DATA = Path(__file__).parent / "data"
_TUTORIAL = "blue_metal_plate.stl bottle.dae buttermilk.dae cup.dae fork_plastic.dae knife_plastic.dae red_metal_plate.stl"
PACKAGES = {
    "cram_bullet_reasoning": "mug.stl plate.stl mondamin.stl pot.stl bowl.stl fork.stl knife.stl spatula.stl cap.stl glasses.stl glove.stl "
    "shoe.stl gripper.stl axes.stl",
    "cram_bullet_world_tutorial": _TUTORIAL,
    "cram_pick_place_tutorial": f"{_TUTORIAL} cube.stl",
    "cram_pr2_pick_place_demo": "blue_metal_plate.stl bottle.dae bowl.stl breakfast_cereal.stl buttermilk.dae cereal.dae cube.stl cup.dae "
    "fork.dae knife.dae milk.stl red_metal_plate.stl spoon.stl tray-base.stl tray.stl",
}
"""The files of meshes in packages of the original of which the models here are."""


class UnknownObject(KeyError):
    """There is no model of that type of object. type: its name."""

    def __init__(self, type: str) -> None:
        super().__init__(type)
        self.type = type

    def __str__(self) -> str:
        return f"there is no model of the object {self.type}; there are {', '.join(_objects())}."


def urdf_text(name: str) -> str:
    """The URDF text of ``"pr2"`` or ``"kitchen"``. Errors: FileNotFoundError, for another name."""
    return (DATA / f"{name}.urdf").read_text(encoding="utf-8")


@functools.cache
def described(name: str) -> Description:
    """The description of ``"pr2"`` or ``"kitchen"``."""
    return read_text(urdf_text(name), f"{name}.urdf")


@functools.cache
def _objects() -> dict[str, dict]:
    return json.loads((DATA / "objects.json").read_text(encoding="utf-8"))


def object_types() -> list[str]:
    """The types of objects of which there is a model, in lower case with hyphens: ``"bottle"``."""
    return list(_objects())


def object_shapes(type: str) -> tuple[Shape, ...]:
    """The shapes of an object of this type. Errors: `UnknownObject`."""
    model = _objects().get(type)
    if model is None:
        raise UnknownObject(type)
    return (Shape(model["shape"], tuple(model["size"]), Frame(tuple(model["middle"]))),)
