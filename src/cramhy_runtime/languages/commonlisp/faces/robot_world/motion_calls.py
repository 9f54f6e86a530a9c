"""The functions of the Lisp package ROBOT-WORLD that move a simulated robot.

A robot is given as a machine of a world and the list of its parts, which `make_parts` makes. What a motion could not do is its value, and
nil when it did what it should, so that Lisp says it with its own failures.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from cramhy_runtime.ground.data import Cons, DoubleFloat, boolean, list_from, lisp_list, python_list
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
    from cramhy_runtime.ground.data import Symbol
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
    return SimulatedRobot(machine.world, machine.name, parts)


def drive(machine: Machine, parts: RobotParts, pose: Pose) -> Cons | None:
    """Put the base there; the list of the things that it would touch, if there are any: then it stays where it is."""
    try:
        _robot(machine, parts).drive(of_pose(pose))
    except Blocked as problem:
        return list_from(problem.things)
    return None


def collisions(machine: Machine, parts: RobotParts, but: Any = None) -> Cons | None:
    """What the robot touches and does not hold, without the things of the names ``but``."""
    return list_from(_robot(machine, parts).collisions(python_list(but)))


def move_torso(machine: Machine, parts: RobotParts, height: Any) -> Cons | None:
    """Raise or lower the torso; the list of the joints that reached their limits."""
    try:
        _robot(machine, parts).move_torso(float(height))
    except BeyondLimits as problem:
        return list_from(problem.joints)
    return None


def look_at(machine: Machine, parts: RobotParts, place: Vector3) -> Cons | None:
    """Look at a place in the world; the list of the joints that reached their limits."""
    try:
        _robot(machine, parts).look_at(_coordinates(place))
    except BeyondLimits as problem:
        return list_from(problem.joints)
    return None


def _coordinates(point: Vector3) -> np.ndarray:
    return np.array([float(point.x), float(point.y), float(point.z)])


def look_forward(machine: Machine, parts: RobotParts) -> None:
    """Look straight ahead."""
    _robot(machine, parts).look_forward()


def sees_p(machine: Machine, parts: RobotParts, item: Item, threshold: Any = 0.9) -> bool | None:
    """Whether the robot sees so much of an item."""
    return boolean(_robot(machine, parts).sees(item.name, float(threshold)))


def move_arm_joints(machine: Machine, parts: RobotParts, arm: Symbol, values: Cons) -> bool | None:
    """Bring the joints of an arm to these values; nil when their number is not that of the joints."""
    numbers = [float(value) for value in python_list(values)]
    if len(numbers) != len(parts.arms[arm].joints):
        return None
    _robot(machine, parts).move_joints(arm, numbers)
    return True


def move_tools(machine: Machine, parts: RobotParts, goals: Cons) -> Cons | None:
    """Bring tool points to poses in the frame of the base; ``goals`` is a list of (arm . pose).

    If no posture does that: a list of the arm and of the number of heights of the torso that were tried.
    """
    try:
        _robot(machine, parts).move_tools({entry.car: of_pose(entry.cdr) for entry in python_list(goals)})
    except OutOfReach as problem:
        return lisp_list(problem.arm, problem.torsos)
    return None


def posture_for(machine: Machine, parts: RobotParts, arm: Symbol, pose: Pose) -> Cons | None:
    """A list of (joint position) with which the tool of an arm is at a pose in the frame of the base; nil, when it is out of reach."""
    posture = _robot(machine, parts).posture_for({arm: of_pose(pose)})
    return None if posture is None else list_from(lisp_list(joint, DoubleFloat(value)) for joint, value in posture.items())


def set_fingers(machine: Machine, parts: RobotParts, arm: Symbol, position: Any = None) -> None:
    """Bring the fingers of an arm to a position: a number is metres of opening, nil is open."""
    robot = _robot(machine, parts)
    robot.open_gripper(arm) if position is None else robot.set_gripper(arm, float(position))


def grip(machine: Machine, parts: RobotParts, arm: Symbol) -> Cons | None:
    """Close a gripper; the list of the things that it touches then, nil when there is nothing."""
    try:
        return list_from(_robot(machine, parts).grip(arm))
    except NothingGripped:
        return None
