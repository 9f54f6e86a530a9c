"""The functions of the Lisp package ROBOT-WORLD: worlds in terms of Lisp's names, poses and lists.

Poses are those of CL-TRANSFORMS, names of things symbols or strings (equal strings are the same name), names of links and joints strings.
What a world cannot do is a simple-error with the reason.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from cramhy_runtime.ground.conditions import error
from cramhy_runtime.ground.data import Cons, DoubleFloat, FreshString, MultipleValues, boolean, lisp_list, list_from, python_list
from cramhy_runtime.ground.packages import is_symbol, keyword, symbol_name
from cramhy_runtime.robot_world import models, urdf
from cramhy_runtime.robot_world.descriptions import Description, DescriptionError, Frame, Shape
from cramhy_runtime.robot_world.placements import of_pose
from cramhy_runtime.robot_world.things import Item, Machine, Thing
from cramhy_runtime.robot_world.vision import seen
from cramhy_runtime.robot_world.world import World
from cramhy_runtime.transforms.vectors import make_3d_vector

if TYPE_CHECKING:
    from cramhy_runtime.ground.data import Symbol
    from cramhy_runtime.transforms.poses import Pose

LISP_NAMES = """
make-world copy-world add-object-of-type add-shape add-description remove-thing find-thing things thing-name thing-world thing-pose
set-thing-pose thing-types thing-mass thing-bounds part-bounds machine-joints machine-joint set-machine-joint machine-links machine-link
machine-description attach detach attachments contacts settle stable visibility object-types object-size read-description description-text
"""


def _name(designator: Symbol | str) -> Symbol | str:
    return designator if is_symbol(designator) else str(designator)


def make_world() -> World:
    """A world with nothing in it."""
    return World()


def copy_world(world: World) -> World:
    """A world with copies of the things of ``world``."""
    return world.copy()


def _colour(colour: Any) -> tuple[float, float, float, float]:
    parts = [float(part) for part in python_list(colour)] if colour is not None else [0.5, 0.5, 0.5]
    return (*parts, 1.0) if len(parts) == 3 else tuple(parts)


def add_shape(
    world: World, name: Symbol | str, kind: Symbol, size: Cons, pose: Pose, *, mass: Any = 0.2, color: Any = None, types: Any = None
) -> Item:
    """Add an item of one shape: ``kind`` is :BOX, :CYLINDER or :SPHERE, ``size`` the list that `Shape` tells of."""
    shape = Shape(symbol_name(kind).lower(), tuple(float(part) for part in python_list(size)), Frame())
    return world.add_item(_name(name), (shape,), of_pose(pose), mass=float(mass), colour=_colour(color), types=tuple(python_list(types)))


def add_object_of_type(
    world: World, name: Symbol | str, type: Symbol, pose: Pose, *, mass: Any = 0.2, color: Any = None, types: Any = None
) -> Item:
    """Add an object of which there is a model: ``type`` is a keyword such as :BOTTLE."""
    try:
        shapes = models.object_shapes(symbol_name(type).lower())
    except models.UnknownObject as problem:
        return error("~a", str(problem))
    return world.add_item(
        _name(name), shapes, of_pose(pose), mass=float(mass), colour=_colour(color), types=tuple(python_list(types)) or (type,)
    )


def add_description(world: World, name: Symbol | str, description: Description, pose: Pose, *, color: Any = None) -> Machine:
    """Add a robot, or furniture."""
    machine = world.add_machine(_name(name), description, of_pose(pose))
    if color is not None:
        machine.colour = _colour(color)
    return machine


def remove_thing(world: World, name: Symbol | str) -> None:
    """Take a thing away."""
    world.remove(_name(name))


def find_thing(world: World, name: Symbol | str) -> Thing | None:
    """The thing of that name, or nil."""
    return world.things.get(_name(name))


def things(world: World) -> Cons | None:
    """The list of all things, in the order in which they were added."""
    return list_from(world.things.values())


def thing_name(thing: Thing) -> Symbol | str:
    """What a thing is called."""
    return thing.name


def thing_world(thing: Thing) -> World | None:
    """The world that a thing is in; nil for one that was removed."""
    return thing.world


def thing_pose(thing: Thing) -> Pose:
    """Where a thing is."""
    return thing.placement.pose()


def set_thing_pose(thing: Thing, pose: Pose) -> Pose:
    """Put a thing there, and what it holds with it."""
    if thing.world is None:
        return error("~S is in no world: it was removed.", thing)
    thing.world.put(thing.name, of_pose(pose))
    return pose


def thing_types(item: Item) -> Cons | None:
    """The list of the types of an item."""
    return list_from(item.types)


def thing_mass(item: Item) -> float:
    """The mass of an item in kilograms."""
    return DoubleFloat(item.mass)


def _box(lowest: Any, highest: Any) -> Cons:
    middle, size = (lowest + highest) / 2, highest - lowest
    return lisp_list(*(make_3d_vector(*map(DoubleFloat, vector)) for vector in (middle, size)))


def thing_bounds(thing: Thing) -> Cons:
    """The box along the axes around a thing: a list of its middle and its lengths, two vectors."""
    return _box(*thing.world.bounds(thing.name))


def part_bounds(machine: Machine, link: str) -> Cons:
    """As `thing_bounds`, of one link."""
    return _box(*machine.world.bounds(machine.name, str(link)))


def machine_joints(machine: Machine) -> Cons | None:
    """The names of the joints that move."""
    return list_from(machine.skeleton.joints)


def machine_joint(machine: Machine, joint: str) -> float | None:
    """The position of a joint; nil for one that there is not."""
    value = machine.joint(str(joint))
    return None if value is None else DoubleFloat(value)


def set_machine_joint(machine: Machine, joint: str, value: Any) -> bool | None:
    """Set a joint, whatever its limits; whether there is one of that name."""
    if str(joint) not in machine.skeleton.joint_numbers:
        return None
    machine.world.bend(machine.name, {str(joint): float(value)})
    return True


def machine_links(machine: Machine) -> Cons | None:
    """The names of all links."""
    return list_from(machine.description.links)


def machine_link(machine: Machine, link: str) -> Pose | None:
    """Where a link is in the world; nil for one that there is not."""
    return machine.link(str(link)).pose() if str(link) in machine.skeleton.links else None


def machine_description(machine: Machine) -> Description:
    """The description of a robot, or of furniture."""
    return machine.description


def attach(machine: Machine, item: Item, link: str, *, loose: Any = None) -> None:
    """Let a link hold an item."""
    machine.world.attach(machine.name, item.name, str(link), loose is not None)


def detach(machine: Machine, item: Item, link: Any = None) -> None:
    """Let an item go."""
    machine.world.detach(machine.name, item.name, None if link is None else str(link))


def attachments(machine: Machine) -> Cons | None:
    """A list of (name . links) for each item that a machine holds."""
    return list_from(Cons(name, list_from(grip.link for grip in grips)) for name, grips in machine.holds.items())


def contacts(world: World, thing: Thing | None = None) -> Cons | None:
    """A list of (thing link other-thing other-link) for what touches; links of items are nil, and so are both of the floor."""
    pairs = world.contacts(None if thing is None else thing.name)
    return list_from(lisp_list(one.thing, one.link, other and other.thing, other and other.link) for one, other in pairs)


def settle(world: World, seconds: Any) -> float:
    """Let free items fall for so long, or until they lie; the seconds that it took."""
    return DoubleFloat(world.simulate(float(seconds)))


def stable(item: Item) -> bool | None:
    """Whether an item would still be where it is after five seconds."""
    return boolean(item.world.stable(item.name))


def visibility(world: World, camera: Pose, thing: Thing) -> MultipleValues:
    """Two values: which part of a thing is seen from a camera, 0 to 1, and the list of the things that hide the rest."""
    part, hiding = seen(world.scene, of_pose(camera), thing)
    return MultipleValues((DoubleFloat(part), list_from(hiding)))


def object_types() -> Cons | None:
    """The types of objects of which there is a model, keywords."""
    return list_from(keyword(name.upper()) for name in models.object_types())


def object_size(type: Symbol) -> Any:
    """The lengths of the box around an object of a type, a vector; nil when there is no model of it."""
    try:
        (shape,) = models.object_shapes(symbol_name(type).lower())
    except models.UnknownObject:
        return None
    x, y, z = shape.size if shape.kind == "box" else (2 * shape.size[0], 2 * shape.size[0], shape.size[1])
    return make_3d_vector(*map(DoubleFloat, (x, y, z)))


def read_description(text: str, file: str = "") -> Description:
    """The description in the text of a URDF file."""
    try:
        return urdf.read_text(str(text), str(file))
    except DescriptionError as problem:
        return error("~a", str(problem))


def description_text(name: Symbol | str) -> str:
    """The URDF text that comes with cramhy, of :PR2 or :KITCHEN, or a file's, by its path; one in no folder may be a file of ours."""
    if is_symbol(name):
        return FreshString(models.urdf_text(symbol_name(name).lower()))
    path = Path(str(name))
    try:
        return FreshString((path if path.is_file() else models.DATA / path).read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError) as problem:
        return error("the description ~a cannot be read: ~a", str(name), str(problem))
