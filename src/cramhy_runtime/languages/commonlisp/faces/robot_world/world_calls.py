"""The functions of the Lisp package ROBOT-WORLD: worlds in terms of Lisp's names, poses and lists.

Poses are those of CL-TRANSFORMS, names of things symbols or strings (equal strings are the same name), names of links and joints strings.
What a world cannot do is a simple-error with the reason.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from cramhy_runtime.lisp_core.conditions import error
from cramhy_runtime.lisp_core.data import Cons, FreshString, MultipleValues, boolean, lisp_list, list_from, truth
from cramhy_runtime.lisp_core.packages import is_symbol, keyword, symbol_name
from cramhy_runtime.robot_world import description_files, models, remarks, xacro_files
from cramhy_runtime.robot_world.descriptions import Description, DescriptionError
from cramhy_runtime.robot_world.physical.world import PhysicalWorld
from cramhy_runtime.robot_world.placements import of_pose, placement
from cramhy_runtime.robot_world.things import Item, Machine, Thing
from cramhy_runtime.robot_world.vision import seen
from cramhy_runtime.robot_world.world import World
from cramhy_runtime.transforms.vectors import make_3d_vector

from .names import colour_of, name_of

if TYPE_CHECKING:
    from cramhy_runtime.lisp_core.data import Symbol
    from cramhy_runtime.transforms.poses import Pose
    from cramhy_runtime.transforms.quaternions import Quaternion
    from cramhy_runtime.transforms.vectors import Vector3

LISP_NAMES = """
make-world physical-p copy-world thing-color stuck-things ignored-contacts ignore-contact add-description remove-thing find-thing things
thing-name thing-world thing-pose set-thing-pose thing-types thing-mass thing-stays set-thing-stays
thing-bounds part-bounds thing-lengths machine-joints machine-joint
set-machine-joint machine-links machine-link machine-description attach detach attachments grips contacts settle stable visibility
read-description description-text looked-on-p remark-seen remark-grasp
"""


def make_world(mode: Any = None) -> World:
    """A world with nothing in it: :KINEMATIC, or :PHYSICAL, in which motions take time and fingers hold by friction."""
    word = "KINEMATIC" if mode is None else symbol_name(mode) if is_symbol(mode) else str(mode)
    kind = {"KINEMATIC": World, "PHYSICAL": PhysicalWorld}.get(word)
    return error("The mode of a world is :KINEMATIC or :PHYSICAL, not ~s.", mode) if kind is None else kind()


def physical_p(world: World) -> bool | None:
    """Whether motions in a world take time."""
    return boolean(isinstance(world, PhysicalWorld))


def copy_world(world: World, into: World | None = None) -> World:
    """A world with copies of the things of ``world``; ``into``, a kinematic world, has them then instead of its own."""
    if isinstance(into, PhysicalWorld):
        return error("A world can be copied into a kinematic one only: ~s is a physical world.", into)
    return into if into is world else world.copy(into)


def add_description(
    world: World, name: Symbol | str, description: Description, pose: Pose, *, color: Any = None, fixed: Any = None
) -> Machine:
    """Add a robot, or furniture; ``fixed``: it touches neither the floor nor other furniture."""
    machine = world.add_machine(name_of(name), description, of_pose(pose), fixed=fixed is not None)
    if color is not None:
        machine.colour = colour_of(color)
    return machine


def remove_thing(world: World, name: Symbol | str) -> None:
    """Take a thing away."""
    world.remove(name_of(name))


def find_thing(world: World, name: Symbol | str) -> Thing | None:
    """The thing of that name, or nil. A string may also be the name in small letters that Python and Hy give to a keyword."""
    found = world.things.get(name_of(name))
    return world.things.get(keyword(str(name).upper())) if found is None and not is_symbol(name) else found


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
    return float(item.mass)


def thing_stays(item: Item) -> bool | None:
    """Whether an item does not fall: nobody let it fall, or it has no mass."""
    return boolean(item.stays or not item.mass)


def set_thing_stays(item: Item, stays: Any) -> Any:
    """Keep an item from falling, or let it fall again; returns ``stays``."""
    if item.world is not None:
        item.world.let_stay(item.name, truth(stays))
    return stays


def _box(lowest: Any, highest: Any) -> Cons:
    middle, size = (lowest + highest) / 2, highest - lowest
    return lisp_list(*(make_3d_vector(*map(float, vector)) for vector in (middle, size)))


def thing_color(thing: Thing) -> Cons:
    """Red, green, blue and opacity of a thing, each from 0 to 1."""
    return list_from(map(float, thing.colour))


def thing_bounds(thing: Thing) -> Cons:
    """The box along the axes around a thing: a list of its middle and its lengths, two vectors."""
    return _box(*thing.world.bounds(thing.name))


def part_bounds(machine: Machine, link: str) -> Cons:
    """As `thing_bounds`, of one link."""
    return _box(*machine.world.bounds(machine.name, str(link)))


def thing_lengths(thing: Thing, rotation: Quaternion, link: str | None = None) -> Vector3:
    """The lengths of the box along the axes that would be around a thing, or around one of its links, if it were turned so."""
    turn = placement(rotation=(rotation.w, rotation.x, rotation.y, rotation.z)).rotation
    return make_3d_vector(*map(float, thing.world.lengths(thing.name, None if link is None else str(link), turn)))


def machine_joints(machine: Machine) -> Cons | None:
    """The names of the joints that move."""
    return list_from(machine.skeleton.joints)


def machine_joint(machine: Machine, joint: str) -> float | None:
    """The position of a joint; nil for one that there is not."""
    value = machine.joint(str(joint))
    return None if value is None else float(value)


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


def attach(machine: Machine, item: Item, link: str, *, loose: Any = None, grasp: Any = None) -> None:
    """Let a link hold an item."""
    machine.world.attach(machine.name, item.name, str(link), loose is not None, grasp)


def detach(machine: Machine, item: Item, link: Any = None) -> None:
    """Let an item go."""
    machine.world.detach(machine.name, item.name, None if link is None else str(link))


def attachments(machine: Machine) -> Cons | None:
    """A list of (name . links) for each item that a machine holds."""
    return list_from(Cons(name, list_from(grip.link for grip in grips)) for name, grips in machine.holds.items())


def grips(machine: Machine, item: Item) -> Cons | None:
    """A list (link loose grasp) for each link that holds an item."""
    return list_from(lisp_list(grip.link, boolean(grip.loose), grip.grasp) for grip in machine.holds.get(item.name, ()))


def contacts(world: World, thing: Thing | None = None) -> Cons | None:
    """A list of (thing link other-thing other-link) for what touches; links of items are nil, and so are both of the floor."""
    pairs = world.contacts(None if thing is None else thing.name)
    return list_from(lisp_list(one.thing, one.link, other and other.thing, other and other.link) for one, other in pairs)


def settle(world: World, seconds: Any, without: Machine | None = None) -> float:
    """Let free items fall for so long, or until they lie, past the machine ``without``; the seconds that it took."""
    return float(world.simulate(float(seconds), None if without is None else without.name))


def stuck_things(world: World) -> Cons | None:
    """A list (item other) for each item that the last `settle` could not free from the other thing."""
    return list_from(lisp_list(item, other) for item, other in world.stuck)


def ignored_contacts(world: World) -> Cons | None:
    """The pairs of names (name . other) whose contacts do not count."""
    return list_from(Cons(one, other) for one, other in world.ignored)


def ignore_contact(world: World, name: Symbol | str, other: Symbol | str) -> None:
    """Let contacts of these two things not count from now on, for those who ask `ignored_contacts`."""
    pair = (name_of(name), name_of(other))
    if pair not in world.ignored:
        world.ignored.append(pair)


def stable(item: Item) -> bool | None:
    """Whether an item would still be where it is after five seconds."""
    return boolean(item.world.stable(item.name))


def visibility(world: World, camera: Pose, thing: Thing) -> MultipleValues:
    """Two values: which part of a thing is seen from a camera, 0 to 1, and the list of the things that hide the rest."""
    part, hiding = seen(world.scene, of_pose(camera), thing)
    return MultipleValues((float(part), list_from(hiding)))


def read_description(text: str, file: str = "") -> Description:
    """The description in the text of a URDF or MJCF file."""
    try:
        return description_files.read_text(str(text), str(file))
    except DescriptionError as problem:
        return error("~a", str(problem))


def description_text(name: Symbol | str) -> str:
    """The URDF text that comes with cramhy, of :PR2 or :KITCHEN, or a file's, by its path; one in no folder may be a file of ours.

    A file whose name ends in ``.xacro`` is expanded.
    """
    if is_symbol(name):
        return FreshString(models.urdf_text(symbol_name(name).lower()))
    path = Path(str(name))
    try:
        if xacro_files.is_xacro(path):
            return FreshString(xacro_files.expanded(path))
        return FreshString((path if path.is_file() else models.DATA / path).read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, DescriptionError) as problem:
        return error("the description ~a cannot be read: ~a", str(name), str(problem))


def looked_on_p() -> bool | None:
    """Whether anybody looks on at what a plan considers (``remarks``)."""
    return boolean(remarks.heard())


def remark_seen(name: Symbol | str, pose: Pose | None) -> None:
    """Tell who looks on that the thing of a name is believed to be at a pose in the room; nil: in the hand that holds it."""
    remarks.seen(name_of(name), None if pose is None else of_pose(pose))


def remark_grasp(machine: Machine, pose: Pose, reached: Any) -> None:
    """Tell who looks on that a tool of a machine might go to a pose in the frame of its base, and whether it gets there."""
    remarks.grasp(machine, of_pose(pose), reached is not None)
