"""The functions of the Lisp package ROBOT-WORLD that CL-URDF needs: what a URDF file says beside what moves, and a description as a program
has changed it."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from cramhy_runtime.lisp_core.conditions import error
from cramhy_runtime.lisp_core.data import Cons, FreshString, list_from, lisp_list, python_list
from cramhy_runtime.lisp_core.packages import symbol_name
from cramhy_runtime.robot_world import urdf, urdf_parts
from cramhy_runtime.robot_world.mesh_files import Mesh
from cramhy_runtime.robot_world.descriptions import Description, DescriptionError, Frame, Shape
from cramhy_runtime.robot_world.placements import of_pose

from .shape_calls import told_shape

if TYPE_CHECKING:
    from cramhy_runtime.robot_world.descriptions import Joint, Link

LISP_NAMES = "description-parts changed-description description-file-text make-mesh mesh-points mesh-corners"


def description_parts(text: str, file: str = "") -> Cons:
    """A list (materials visuals mimics) of what the text of a URDF file says.

    A material is (name color texture), a visual (link shape material), a mimic (joint other multiplier offset). What the file does not say
    is nil.
    """
    try:
        parts = urdf_parts.read_text(str(text), str(file))
    except DescriptionError as problem:
        return error("~a", str(problem))
    return lisp_list(
        list_from(map(_told_material, parts.materials)),
        list_from(lisp_list(link, told_shape(shape), material and _told_material(material)) for link, shape, material in parts.visuals),
        list_from(lisp_list(joint, other, float(times), float(plus)) for joint, other, times, plus in parts.mimics),
    )


def _told_material(material: urdf_parts.Material) -> Cons:
    return lisp_list(
        FreshString(material.name),
        list_from(map(float, material.color)) if material.color else None,
        FreshString(material.texture) if material.texture else None,
    )


def changed_description(description: Description, root: str, origins: Cons | None, shapes: Cons | None) -> Description:
    """``description`` from the link ``root`` on, where ``origins``, a list of (joint pose), and ``shapes``, of (link (kind size pose) ...),
    take the place of what the file said."""
    places = {str(joint): _frame(pose) for joint, pose in map(python_list, python_list(origins))}
    bodies = {str(link): tuple(map(_shape, found)) for link, *found in map(python_list, python_list(shapes))}
    links: dict[str, Link] = {}
    joints: dict[str, Joint] = {}
    waiting = [str(root)]
    while waiting:
        name = waiting.pop()
        link = description.links[name]
        links[name] = replace(link, shapes=bodies[name]) if name in bodies else link
        for joint in description.joints_below[name]:
            joints[joint.name] = replace(joint, frame=places[joint.name]) if joint.name in places else joint
            waiting.append(joint.child)
    return Description(description.name, links, joints, description.file)


def _frame(pose: Any) -> Frame:
    place = of_pose(pose)
    return Frame(place.position, place.rotation)


def _shape(told: Cons) -> Shape:
    kind, size, pose, *file = python_list(told)
    mesh = str(file[0]) if file and file[0] is not None else ""
    return Shape(symbol_name(kind).lower(), tuple(float(part) for part in python_list(size)), _frame(pose), mesh)  # type: ignore[arg-type]


def description_file_text(description: Description) -> FreshString:
    """The URDF text of a description."""
    return FreshString(urdf.text_of(description))


# ------------------------------------------------------------------------------------------------------------------ meshes


def make_mesh(points: Cons | None, triangles: Cons | None) -> Mesh:
    """A mesh of lists of three numbers: points, and triangles of numbers of points. Points that are there twice become one."""
    places: dict[tuple[float, ...], int] = {}
    numbers = [places.setdefault(tuple(map(float, python_list(point))), len(places)) for point in python_list(points)]
    if not places:
        return error("A mesh needs points.")
    corners = [[numbers[int(corner)] for corner in python_list(triangle)] for triangle in python_list(triangles)]
    return Mesh(np.array(list(places), float), np.array(corners, int).reshape(-1, 3))


def _point(point: Any) -> Cons:
    return list_from(map(float, point))


def mesh_points(mesh: Mesh) -> Cons | None:
    """The points of a mesh, lists of three numbers."""
    return list_from(map(_point, mesh.points))


def mesh_corners(mesh: Mesh) -> Cons | None:
    """The triangles of a mesh, lists of three points."""
    return list_from(list_from(map(_point, mesh.points[list(triangle)])) for triangle in mesh.triangles)
