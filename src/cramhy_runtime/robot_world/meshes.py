"""The meshes that shapes are made of: from files, found by their addresses, and computed ones.

An address is a path, or ``package://PACKAGE/PATH`` for a file in a ROS package. A shape counts in collisions as the convex hull of its
mesh, as in the original.
"""

from __future__ import annotations

import functools
from math import cos, pi, sin
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from cramhy_runtime.ros import definition_files
from cramhy_runtime.ros.search_folders import crawl

from .descriptions import Frame, Shape
from .mesh_files import Mesh, MeshError, read_mesh, solid_mesh

if TYPE_CHECKING:
    from collections.abc import Sequence

PACKAGE = "package://"
_SIDES = 24
"""Of the polygon that stands for the circle of a cone."""


def package_folder(name: str) -> Path | None:
    """The folder of the ROS package ``name``: its manifest says so, or it is called so and has a system in it; else ``None``."""
    for folder in crawl():
        if folder.manifest is not None and definition_files.package_name(folder) == name:
            return Path(folder.path)
        if Path(folder.path).name == name and any(folder.files(".asd")):
            return Path(folder.path)
    return None


def path_of(address: str) -> Path | None:
    """The path that an address means; ``None`` when its package is not found. A path may have wildcards."""
    if not address.startswith(PACKAGE):
        return Path(address.removeprefix("file://"))
    package, _, inside = address.removeprefix(PACKAGE).partition("/")
    folder = package_folder(package)
    return None if folder is None else folder / inside


def mesh_at(address: str) -> Mesh:
    """The mesh at an address. Errors: `MeshError`."""
    path = path_of(address)
    if path is None:
        package = address.removeprefix(PACKAGE).partition("/")[0]
        raise MeshError(address, f"the ROS package {package} is not found; ROS_PACKAGE_PATH names the folders in which packages are.")
    return read_mesh(path)


@functools.lru_cache(maxsize=512)
def mesh_of(shape: Shape) -> Mesh:
    """The mesh of a shape of the kind ``"mesh"``, as large as the shape says. Errors: `MeshError`."""
    mesh = shape.body if shape.body is not None else mesh_at(shape.mesh)
    return mesh if shape.size == (1.0, 1.0, 1.0) else mesh.scaled(shape.size)


def mesh_shape(mesh: Mesh | str, scale: float = 1.0, frame: Frame = Frame()) -> Shape:
    """A shape of a mesh, or of the mesh at an address. Errors: `MeshError`."""
    body, address = (mesh_at(mesh), mesh) if isinstance(mesh, str) else (mesh, "")
    return Shape("mesh", (float(scale),) * 3, frame, address, body)


def cone_shape(radius: float, height: float) -> Shape:
    """A cone, whose middle is at half its height, with its tip up. Errors: `MeshError`."""
    circle = [(radius * cos(2 * pi * each / _SIDES), radius * sin(2 * pi * each / _SIDES), -height / 2) for each in range(_SIDES)]
    sides = [(each, (each + 1) % _SIDES, _SIDES) for each in range(_SIDES)]
    floor = [(0, each + 1, each) for each in range(1, _SIDES - 1)]
    return mesh_shape(solid_mesh(np.array([*circle, (0.0, 0.0, height / 2)]), np.array([*sides, *floor]), "a cone"))


def points_shape(points: Sequence[Sequence[float]]) -> Shape:
    """The convex hull of points. Errors: `MeshError`."""
    return mesh_shape(solid_mesh(np.array(points, float), np.zeros((0, 3), int), "a point cloud"))


def shape_box(shape: Shape) -> tuple[np.ndarray, np.ndarray]:
    """The corners of the box around a shape, in the frame of the shape. Errors: `MeshError`."""
    if shape.kind == "mesh":
        return mesh_of(shape).box
    if shape.kind == "plane":
        return np.zeros(3), np.zeros(3)
    if shape.kind == "box":
        half = np.array(shape.size) / 2
    elif shape.kind == "cylinder":
        half = np.array([shape.size[0], shape.size[0], shape.size[1] / 2])
    else:
        half = np.array([shape.size[0]] * 3)
    return -half, half
