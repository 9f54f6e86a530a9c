"""What has come of an action, as the world tells: a plan that ends without a failure has not shown that the thing is where it was to be.

The plans for picking up and placing pass over failures of their last motions, as the original's do. A thing may slip out of the fingers,
fall over when the hand opens, or be pushed by an arm on its way back. So the world is looked at once it has come to rest.
"""

from __future__ import annotations

from math import acos, degrees, dist, hypot, pi, remainder
from typing import Any

from cramhy_runtime.designators import Object
from cramhy_runtime.lisp_core.packages import sym
from cramhy_runtime.prolog import V, findall, names
from cramhy_runtime.tf.stamped import PoseStamped

from .libraries import lisp
from .poses import Place, pose_of
from .worlds import World, text

ROOM = "map"
"""The frame in which the world has its poses."""
BESIDE = 0.05
"""How far beside its target a thing may come to stand, metres."""
BELOW, ABOVE = 0.1, 0.05
"""How far below and above it, metres: a target may be a little above the table."""
TILTED = 0.5
"""How much it may be tilted against its target, radians. How far it is turned about the vertical does not count."""
UNPARKED = 0.1
"""How far a joint of a parked arm may be from its place, radians."""
_PATIENCE = 3  # times ten seconds, until the world is at rest


def in_room(place: Place) -> PoseStamped:
    """``place`` as a pose in the frame of the room, whatever moves afterwards. Errors: as of `pose_of`."""
    pose = pose_of(place)
    return pose if pose.frame_id == ROOM else lisp("CRAM-TF", "ensure_pose_in_frame")(pose, ROOM, sym(":USE-ZERO-TIME"), True)


def name_of(thing: Object) -> str:
    """The name of an object that was detected."""
    return text(lisp("CRAM-DESIGNATORS", "current_desig")(thing)["name"])


def in_hand(thing: Object) -> bool:
    """Whether the robot holds an object."""
    return name_of(thing) in World().held()


def settled() -> World:
    """The world, when nothing falls or rolls any more; after half a minute as it is then."""
    world = World()
    for _ in range(_PATIENCE):
        world.settle()
        if getattr(world.core, "at_rest", True):
            break
    return world


def astray(thing: Object, target: Place) -> str:
    """Where an object is when it does not stand at ``target``, as the end of a sentence; ``""`` when it does. The world is at rest then."""
    wanted, world, name = in_room(target), settled(), name_of(thing)
    if name in world.held():
        return f"is still in the {world.held()[name]} hand"
    pose = world.pose(name)
    there, here = wanted.origin, pose.origin
    beside, above = hypot(here.x - there.x, here.y - there.y), here.z - there.z
    cosine = sum(one * other for one, other in zip(_up(pose), _up(wanted), strict=True))
    tilted = acos(max(-1.0, min(1.0, cosine)))
    if beside <= BESIDE and -BELOW <= above <= ABOVE and tilted <= TILTED:
        return ""
    away = dist((here.x, here.y, here.z), (there.x, there.y, there.z))
    fallen = f", tilted by {degrees(tilted):.0f} degrees" if not tilted <= TILTED else ""
    return f"lies at {told(pose)}, {away:.2f} m from there{fallen}"


def not_parked(arm: Any = None) -> str:
    """Which joint of an arm, by default of any, is not where it is when the arm is parked, as a sentence; ``""`` when all are there."""
    interfaces, machine = names("CRAM-ROBOT-INTERFACES"), World().robot
    for arm_joints in findall((V.arm, V.joints), interfaces.robot(V.robot), interfaces.arm_joints(V.robot, V.arm, V.joints)):
        each, joints = arm_joints
        if arm is not None and each is not arm:
            continue
        values = lisp("CRAM-MOBILE-PICK-PLACE-PLANS", "parking_values")(each, True)
        for joint, value in zip(joints, values, strict=True):
            off = abs(remainder(float(machine.joint(joint)) - float(value), 2 * pi))
            if not off <= UNPARKED:
                return f"The {text(each)} arm is not parked: {joint} is {off:.2f} radians from where it was to be."
    return ""


def _up(pose: Any) -> tuple[float, float, float]:
    """Where the z axis of a pose points."""
    turn = pose.orientation
    x, y, z, w = turn.x, turn.y, turn.z, turn.w
    return (2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y))


def told(spot: Place) -> str:
    """A place as messages show it, in whole millimetres."""
    origin = pose_of(spot).origin
    return f"({origin.x:.5g}, {origin.y:.5g}, {origin.z:.5g})"
