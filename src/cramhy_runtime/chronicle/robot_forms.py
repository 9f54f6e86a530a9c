"""Things of a robot's world as messages (``cramhy_msgs/WorldThing``, ``WorldStep``, ``WorldMarks``), and what a hand does to them."""

from __future__ import annotations

import numpy as np

from ..robot_world import notes
from ..robot_world.meshes import mesh_of
from ..robot_world.pictures.solids import colour_of
from ..robot_world.pictures.views import OPENING, camera_links
from ..robot_world.placements import Placement
from ..robot_world.things import Item
from ..ros.messages import message_class_exact
from ..ros.wire import ros_text

DIGITS = 5
"""Digits behind the point of lengths and parts of quaternions: hundredths of a millimetre."""
LAID = 3.0
"""Seconds for which something that is let go may fall."""
_NOWHERE = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]

_type = message_class_exact


def _numbers(values):
    return [round(float(value), DIGITS) + 0.0 for value in values]


def _place(placement):
    return _numbers((*placement.position, *placement.rotation))


def movable(thing):
    """Whether a hand can move it: an object with a mass."""
    return isinstance(thing, Item) and thing.mass > 0


def thing(name, thing):
    """A ``cramhy_msgs/WorldThing`` of that name."""
    make = _type("cramhy_msgs/WorldThing")
    if isinstance(thing, Item):
        kind = "object" if movable(thing) else "ground"
        types = [ros_text(str(getattr(each, "name", each)).lower()) for each in thing.types]
        link = _link("", -1, _NOWHERE, -1, None, _shapes(thing, None, thing.shapes))
        return make(name, kind, types, movable(thing) or None, [], OPENING, [link])
    kind = "furniture" if thing.fixed else "robot"
    return make(name, kind, [], None, [ros_text(link) for link in camera_links(thing)], OPENING, _links(thing))


def _links(machine):
    description, joints = machine.description, machine.skeleton.joint_numbers
    numbers, made = description.order, []
    for name in numbers:
        link, joint = description.links[name], description.joint_above.get(name)
        shapes = _shapes(machine, name, link.shapes)
        if joint is None:
            made.append(_link(name, -1, _NOWHERE, -1, None, shapes))
        else:
            frame = _numbers((*joint.frame.position, *joint.frame.rotation))
            made.append(_link(name, numbers[joint.parent], frame, joints.get(joint.name, -1), joint, shapes))
    return made


def _link(name, parent, frame, joint, above, shapes):
    slides = above is not None and above.kind == "prismatic"
    axis = [0.0, 0.0, 0.0]
    if joint >= 0:
        axis = _numbers(np.array(above.axis, float) / np.linalg.norm(above.axis))
    return _type("cramhy_msgs/WorldLink")(ros_text(name), parent, frame, joint, slides or None, axis, shapes)


def _shapes(thing, link, shapes):
    make, colour = _type("cramhy_msgs/WorldShape"), [round(float(part), 4) for part in colour_of(thing, link)]
    made = []
    for shape in shapes:
        points, triangles = [], []
        if shape.kind == "mesh":
            mesh = mesh_of(shape)
            points, triangles = _numbers(mesh.points.ravel()), [int(number) for number in mesh.triangles.ravel()]
        frame = _numbers((*shape.frame.position, *shape.frame.rotation))
        made.append(make(shape.kind, _numbers(shape.size), frame, colour, points, triangles))
    return made


def differs(before, now):
    """Whether a thing of the same name is made of something else than before."""
    if isinstance(before, Item) != isinstance(now, Item):
        return True
    if isinstance(now, Item):
        return before.shapes != now.shapes or before.colour != now.colour or movable(before) != movable(now)
    return before.skeleton is not now.skeleton or before.colour != now.colour


def step(before, now, labels):
    """The ``cramhy_msgs/WorldStep`` from one world to another, with the things that are elsewhere; of all things if ``before`` is None."""
    make, states = _type("cramhy_msgs/WorldState"), []
    grips = _grips(now)
    old = {} if before is None else _grips(before)
    for name, thing in now.things.items():
        last = None if before is None else before.things.get(name)
        if name not in labels or last is not None and grips.get(name) == old.get(name) and not _moved(last, thing):
            continue
        joints = [] if isinstance(thing, Item) else _numbers(thing.joints)
        holder, link, grip = "", "", []
        if name in grips:
            machine, link, _ = grips[name]
            holder, link, grip = labels.get(machine, ""), ros_text(link), _place(_offset(now, name, machine))
        states.append(make(labels[name], _place(thing.placement), joints, holder, link, grip))
    return _type("cramhy_msgs/WorldStep")(0.0 if before is None else round(notes.seconds(before, now), 3), states)


def _grips(world):
    """Name of an item that is held -> (name of the machine, link, where it is in the link, as bytes)."""
    found = {}
    for machine in world.machines():
        for name, grips in machine.holds.items():
            grip = _firm(grips)
            found[name] = machine.name, grip.link, (grip.offset.position.tobytes(), grip.offset.rotation.tobytes())
    return found


def _firm(grips):
    return next((grip for grip in grips if not grip.loose), grips[0])


def _offset(world, item, machine):
    return _firm(world.machine(machine).holds[item]).offset


def _moved(before, now):
    if not notes.same(before.placement, now.placement):
        return True
    return not isinstance(now, Item) and before.joints is not now.joints and not np.array_equal(before.joints, now.joints)


def marks(costmap, grasps, seen):
    """The ``cramhy_msgs/WorldMarks`` of a costmap or ``None``, and of rows (name, placement, good)."""
    make = _type("cramhy_msgs/WorldPose")
    rows = [[make(name, _place(place), True if good else None) for name, place, good in row] for row in (grasps, seen)]
    return _type("cramhy_msgs/WorldMarks")([] if costmap is None else [_cells(costmap)], *rows)


def _cells(costmap):
    values = costmap.values()
    cells = np.round(values * (255 / values.max())).astype(np.uint8)
    return _type("cramhy_msgs/WorldCostmap")(
        float(costmap.origin_x), float(costmap.origin_y), float(costmap.resolution), costmap.columns, costmap.rows, cells.ravel().tolist()
    )


def let_go(world, thing, place):
    """Put an object there, and let it alone fall until it lies, upright as it was; where that is."""
    name = thing.name
    ahead = world.copy()
    ahead.put(name, Placement(np.array(place, float), thing.placement.rotation))
    ahead.simulate(LAID)
    laid = ahead.item(name).placement
    world.put(name, laid)
    return _numbers(laid.position)
