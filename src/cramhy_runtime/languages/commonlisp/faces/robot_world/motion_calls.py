"""The functions of the Lisp package ROBOT-WORLD that move a simulated robot.

A robot is given as a machine of a world and the list of its parts, which `make_parts` makes. What a motion could not do is its value, and
nil when it did what it should, so that Lisp says it with its own failures. In a physical world a motion may be hindered: its value is
then a list of :NO-WAY, :NOT-REACHED or :SLIPPED, and a text.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from cramhy_runtime.lisp_core.data import Cons, boolean, list_from, lisp_list, python_list
from cramhy_runtime.lisp_core.packages import keyword
from cramhy_runtime.robot_world.physical.robot import NotReached, NoWay, PhysicalRobot, Slipped
from cramhy_runtime.robot_world.physical.world import PhysicalWorld
from cramhy_runtime.robot_world.placements import of_pose
from cramhy_runtime.robot_world.simulated_robot import (
    ArmParts,
    BeyondLimits,
    Blocked,
    NothingGripped,
    OutOfReach,
    RobotParts,
    SimulatedRobot,
)

if TYPE_CHECKING:
    from collections.abc import Callable

    from cramhy_runtime.lisp_core.data import Symbol
    from cramhy_runtime.robot_world.things import Item, Machine
    from cramhy_runtime.transforms.poses import Pose
    from cramhy_runtime.transforms.vectors import Vector3

LISP_NAMES = """
make-arm make-parts drive move-torso look-at look-forward sees-p move-arm-joints move-tools posture-for set-fingers grip
collisions
"""


def _texts(names: Any) -> tuple[str, ...]:
    return tuple(map(str, python_list(names)))


def make_arm(*, joints: Cons, base: str, tip: str, tool: Pose, fingers: Cons, hand: Cons, open: Any, factor: Any = 1.0) -> ArmParts:
    """The parts of an arm; see `ArmParts`."""
    return ArmParts(_texts(joints), str(base), str(tip), of_pose(tool), _texts(fingers), _texts(hand), float(open), float(factor))


def make_parts(*, torso: str, pan: str, tilt: str, cameras: Cons, arms: Cons) -> RobotParts:
    """The parts of a robot; ``arms`` is a list of (name . arm)."""
    return RobotParts(str(torso), str(pan), str(tilt), _texts(cameras), {entry.car: entry.cdr for entry in python_list(arms)})


def _robot(machine: Machine, parts: RobotParts) -> SimulatedRobot:
    kind = PhysicalRobot if isinstance(machine.world, PhysicalWorld) else SimulatedRobot
    return kind(machine.world, machine.name, parts)


_HINDERED = {NoWay: "NO-WAY", NotReached: "NOT-REACHED", Slipped: "SLIPPED"}


def _motion(motion: Callable[[], Cons | bool | None]) -> Cons | bool | None:
    """The value of ``motion()``, or what hindered it, as a list of a keyword and a text."""
    try:
        return motion()
    except (NoWay, NotReached, Slipped) as problem:
        return lisp_list(keyword(_HINDERED[type(problem)]), str(problem))


def drive(machine: Machine, parts: RobotParts, pose: Pose) -> Cons | bool | None:
    """Put the base there; the list of the things that it would touch, if there are any: then it stays where it is."""

    def motion() -> Cons | None:
        try:
            return _robot(machine, parts).drive(of_pose(pose))
        except Blocked as problem:
            return list_from(problem.things)

    return _motion(motion)


def collisions(machine: Machine, parts: RobotParts, but: Any = None) -> Cons | None:
    """What the robot touches and does not hold, without the things of the names ``but``."""
    return list_from(_robot(machine, parts).collisions(python_list(but)))


def _limited(motion: Callable[[], None]) -> Cons | bool | None:
    """As `_motion`; the list of the joints that reached their limits."""

    def limited() -> Cons | None:
        try:
            return motion()
        except BeyondLimits as problem:
            return list_from(problem.joints)

    return _motion(limited)


def move_torso(machine: Machine, parts: RobotParts, height: Any) -> Cons | bool | None:
    """Raise or lower the torso; the list of the joints that reached their limits."""
    return _limited(lambda: _robot(machine, parts).move_torso(float(height)))


def look_at(machine: Machine, parts: RobotParts, place: Vector3) -> Cons | bool | None:
    """Look at a place in the world; the list of the joints that reached their limits."""
    return _limited(lambda: _robot(machine, parts).look_at(_coordinates(place)))


def _coordinates(point: Vector3) -> np.ndarray:
    return np.array([float(point.x), float(point.y), float(point.z)])


def look_forward(machine: Machine, parts: RobotParts) -> Cons | bool | None:
    """Look straight ahead."""
    return _motion(lambda: _robot(machine, parts).look_forward())


def sees_p(machine: Machine, parts: RobotParts, item: Item, threshold: Any = 0.9) -> bool | None:
    """Whether the robot sees so much of an item."""
    return boolean(_robot(machine, parts).sees(item.name, float(threshold)))


def move_arm_joints(machine: Machine, parts: RobotParts, arm: Symbol, values: Cons) -> Cons | bool | None:
    """Bring the joints of an arm to these values; nil when their number is not that of the joints."""
    numbers = [float(value) for value in python_list(values)]
    if len(numbers) != len(parts.arms[arm].joints):
        return None
    return _motion(lambda: _robot(machine, parts).move_joints(arm, numbers)) or True


def move_tools(machine: Machine, parts: RobotParts, goals: Cons, *, lenient: Any = None) -> Cons | bool | None:
    """Bring tool points to poses in the frame of the base; ``goals`` is a list of (arm . pose). lenient: in a physical
    world hands may touch things on the way.

    If no posture does that: a list of the arm and of the number of heights of the torso that were tried.
    """

    def motion() -> Cons | None:
        try:
            return _robot(machine, parts).move_tools({entry.car: of_pose(entry.cdr) for entry in python_list(goals)}, lenient is not None)
        except OutOfReach as problem:
            return lisp_list(problem.arm, problem.torsos)

    return _motion(motion)


def posture_for(machine: Machine, parts: RobotParts, arm: Symbol, pose: Pose) -> Cons | None:
    """A list of (joint position) with which the tool of an arm is at a pose in the frame of the base; nil, when it is out of reach."""
    posture = _robot(machine, parts).posture_for({arm: of_pose(pose)})
    return None if posture is None else list_from(lisp_list(joint, float(value)) for joint, value in posture.items())


def set_fingers(machine: Machine, parts: RobotParts, arm: Symbol, position: Any = None) -> None:
    """Bring the fingers of an arm to a position: a number is metres of opening, nil is open."""
    robot = _robot(machine, parts)
    robot.open_gripper(arm) if position is None else robot.set_gripper(arm, float(position))


def grip(machine: Machine, parts: RobotParts, arm: Symbol, newtons: Any = None) -> Cons | None:
    """Close a gripper, in a physical world so firmly; the list of the things that it touches then, nil when there is nothing."""
    try:
        return list_from(_robot(machine, parts).grip(arm, None if newtons is None else float(newtons)))
    except NothingGripped:
        return None
