"""The functions of the Lisp package ROBOT-WORLD that add items of all shapes, and tell what models, meshes and descriptions there are."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from cramhy_runtime.lisp_core.condition_types import SimpleError
from cramhy_runtime.lisp_core.conditions import error
from cramhy_runtime.lisp_core.data import Cons, FreshString, list_from, lisp_list, python_list
from cramhy_runtime.lisp_core.packages import is_symbol, keyword, near_names, symbol_name
from cramhy_runtime.robot_world import meshes, models
from cramhy_runtime.robot_world.descriptions import Description, Frame, Shape
from cramhy_runtime.robot_world.mesh_files import Mesh, MeshError
from cramhy_runtime.robot_world.placements import of_pose, placement
from cramhy_runtime.transforms.vectors import make_3d_vector

from .names import colour_of, name_of

if TYPE_CHECKING:
    from cramhy_runtime.lisp_core.data import Symbol
    from cramhy_runtime.robot_world.things import Item
    from cramhy_runtime.robot_world.world import World
    from cramhy_runtime.transforms.poses import Pose

LISP_NAMES = """
add-shape add-mesh add-object-of-type object-types object-size models-of-package mesh-size read-mesh path-of-address
description-name description-links description-joints
"""


def add_shape(
    world: World,
    name: Symbol | str,
    kind: Symbol,
    size: Cons,
    pose: Pose,
    *,
    mass: Any = 0.2,
    color: Any = None,
    types: Any = None,
    drawn: Any = None,
) -> Item:
    """Add an item of one shape: ``kind`` is :BOX, :CYLINDER, :SPHERE, :PLANE or :CONE, ``size`` the list that `Shape` tells of.

    The size of a cone is its radius and its height, that of :POINTS the list of the points, vectors or lists. What is only ``drawn`` is not
    touched, and hides nothing.
    """
    wanted = symbol_name(kind).lower()
    try:
        if wanted == "points":
            shape = meshes.points_shape([_numbers(point) for point in python_list(size)])
        else:
            sizes = tuple(float(part) for part in python_list(size))
            shape = meshes.cone_shape(*sizes) if wanted == "cone" else Shape(wanted, sizes, Frame())
    except MeshError as problem:
        return error("~a", str(problem))
    if any(part <= 0 for part in shape.size):
        return error("The size of ~S is ~S; lengths are above 0.", name_of(name), size)
    return _add(world, name, (shape,), pose, mass, color, types, drawn is not None)


def _numbers(point: Any) -> tuple[float, ...]:
    parts = python_list(point) if isinstance(point, Cons) else (point.x, point.y, point.z)
    return tuple(float(part) for part in parts)


def _add(world: World, name: Any, shapes: tuple[Shape, ...], pose: Pose, mass: Any, color: Any, types: Any, drawn: bool = False) -> Item:
    return world.add_item(
        name_of(name), shapes, of_pose(pose), mass=float(mass or 0), colour=colour_of(color), types=tuple(python_list(types)), drawn=drawn
    )


def add_mesh(
    world: World, name: Symbol | str, mesh: Any, pose: Pose, *, scale: Any = 1.0, mass: Any = 0.2, color: Any = None, types: Any = None
) -> Item:
    """Add an item of a mesh: ``mesh`` is what `read_mesh` gives, or the address of a file."""
    try:
        shape = meshes.mesh_shape(mesh if isinstance(mesh, Mesh) else str(mesh), float(scale))
    except MeshError as problem:
        return error("~a", str(problem))
    return _add(world, name, (shape,), pose, mass, color, types)


def add_object_of_type(
    world: World, name: Symbol | str, type: Symbol, pose: Pose, *, mass: Any = 0.2, color: Any = None, types: Any = None, scale: Any = 1.0
) -> Item:
    """Add an object of which there is a model: ``type`` is a keyword such as :BOTTLE. Scale: how many times as large it is."""
    try:
        shapes = models.object_shapes(symbol_name(type).lower())
    except models.UnknownObject as problem:
        near = near_names(problem.type, models.object_types())
        hint = f"Did you mean {' or '.join(f':{name.upper()}' for name in near)}?" if near else _HOW_TO_ADD
        return error(SimpleError("~a", str(problem)), hint=hint)
    if scale != 1:
        shapes = tuple(_scaled(shape, float(scale)) for shape in shapes)
    return _add(world, name, shapes, pose, mass, color, types or lisp_list(type))


_HOW_TO_ADD = '(btr:add-objects-to-mesh-list "ros_package") makes the meshes in the folder resource of a package known.'


def _scaled(shape: Shape, scale: float) -> Shape:
    place = Frame(tuple(scale * part for part in shape.frame.position), shape.frame.rotation)
    return Shape(shape.kind, tuple(scale * part for part in shape.size), place, shape.mesh, shape.body)


def object_types() -> Cons | None:
    """The types of objects of which there is a model, keywords."""
    return list_from(keyword(name.upper()) for name in models.object_types())


def models_of_package(package: Any) -> Cons | None:
    """A list (type file) for each mesh of a package of the original of which there is a model here; nil for another package."""
    files = sorted(models.PACKAGES.get(str(package), "").split())
    return list_from(lisp_list(keyword(file.partition(".")[0].replace("_", "-").upper()), FreshString(file)) for file in files)


def object_size(type: Symbol) -> Any:
    """The lengths of the box around an object of a type, a vector; nil when there is no model of it."""
    try:
        (shape,) = models.object_shapes(symbol_name(type).lower())
    except models.UnknownObject:
        return None
    lowest, highest = meshes.shape_box(shape)
    return make_3d_vector(*map(float, highest - lowest))


def read_mesh(address: Any) -> Mesh:
    """The mesh of a file, given by its path or ``package://`` address."""
    try:
        return meshes.mesh_at(str(address))
    except MeshError as problem:
        return error("~a", str(problem))


def mesh_size(mesh: Any) -> Any:
    """The lengths of the box around a mesh, which is given as for `add_mesh`, a vector."""
    lowest, highest = (mesh if isinstance(mesh, Mesh) else read_mesh(mesh)).box
    return make_3d_vector(*map(float, highest - lowest))


def path_of_address(address: Any) -> str | None:
    """The path that a path or a ``package://`` address means; nil when the package is not found. Wildcards stay as they are."""
    path = meshes.path_of(symbol_name(address) if is_symbol(address) else str(address))
    return None if path is None else FreshString(path)


# ---------------------------------------------------------------------------------------------------------- descriptions


def description_name(description: Description) -> str:
    """What the file calls the robot."""
    return FreshString(description.name)


def description_links(description: Description) -> Cons | None:
    """A list (name mass shapes) for each link; a shape is (kind size pose file)."""
    return list_from(
        lisp_list(link.name, float(link.mass), list_from(told_shape(shape) for shape in link.shapes)) for link in description.links.values()
    )


def told_shape(shape: Shape) -> Cons:
    return lisp_list(keyword(shape.kind.upper()), list_from(map(float, shape.size)), _pose(shape.frame), shape.mesh or None)


def _pose(frame: Frame) -> Pose:
    return placement(frame.position, frame.rotation).pose()


def description_joints(description: Description) -> Cons | None:
    """A list (name type parent child pose axis lower upper velocity effort mimic) for each joint; what is not limited is nil."""
    return list_from(
        lisp_list(
            joint.name,
            keyword(joint.kind.upper()),
            joint.parent,
            joint.child,
            _pose(joint.frame),
            make_3d_vector(*map(float, joint.axis)),
            *(float(limit) if abs(limit) < float("inf") else None for limit in (joint.lower, joint.upper)),
            *(float(limit) if limit < float("inf") else None for limit in (joint.velocity, joint.effort)),
            joint.mimic or None,
        )
        for joint in description.joints.values()
    )
