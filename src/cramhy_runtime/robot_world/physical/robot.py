"""The motions of a robot in a physical world: each takes its time, and ends where contacts let it end.

They have the names and the errors of `SimulatedRobot`, and more of these: a way may be blocked, a joint may not get where it was sent, and
what was held may slip. A motion waits in the kernel's time. When its task is evaporated, the servos hold what they have reached.
"""

from __future__ import annotations

from itertools import chain, islice, tee
from math import pi
from typing import TYPE_CHECKING

import numpy as np

from ..placements import Placement
from ..reaching import solver_of
from ..simulated_robot import BeyondLimits, MotionError, NothingGripped, OutOfReach, RobotParts, SimulatedRobot
from . import floor_ways
from .arm_ways import APART, Room
from .engine import BASE, yaw_of
from .trajectory import Trajectory
from .world import TICK, PhysicalWorld, touched_by

if TYPE_CHECKING:
    from collections.abc import Hashable, Iterator, Mapping, Sequence

    from ..things import Item, Machine

PACE = 0.5
"""Which part of the speed that a joint can do motions use; the torso does all of it."""
BASE_SPEEDS = (0.5, 0.5, 1.0)
"""Metres and radians in a second, of the PR2's drivers."""
GRIP = 35.0  # newtons, where nothing else is said
_FASTEST = 4.0  # radians in a second, of a joint whose speed nothing limits
_LATE = 75  # ticks that joints may be late
_LATE_FINGERS = 15
_CLOSE = {"prismatic": 0.005}  # how near a joint must come
_CLOSE_BY = 0.03  # radians
_LINE = (0.35, 0.6)  # metres, radians: so far a tool goes along a line
_LINE_STEP = (0.02, 0.1)
_BACK = (0.15, 0.1, 0.06)  # metres: how far a hand is drawn back, the first that can be
_JUMP = 0.35  # radians between two steps of a line
_DIFFERENT = 1e-3  # radians: postures that are nearer to each other are one
_TRIED = 6  # postures to which ways are looked for
_MOST_POSTURES = 80  # that are looked at, whether they touch anything
_TORSO_STEP = 0.05  # metres
_SHUT = 0.01  # radians: fingers that are closed so far hold nothing


class NoWay(MotionError):
    """There is no way for the base, or for an arm, past what stands around. what: ``base``, or the arm's name."""

    def __init__(self, what: Hashable) -> None:
        super().__init__(f"there is no way for the {what} past what stands around")
        self.what = what


class NotReached(MotionError):
    """Joints did not get where they were sent. joints: their names."""

    def __init__(self, joints: Sequence[str]) -> None:
        super().__init__(f"{', '.join(joints)} did not get there")
        self.joints = joints


class Slipped(MotionError):
    """What a hand held is between its fingers no more. item: what it was; arm: the arm's name."""

    def __init__(self, item: Item, arm: Hashable) -> None:
        super().__init__(f"{item.name} slipped out of the {arm} hand")
        self.item, self.arm = item, arm


class PhysicalRobot(SimulatedRobot):
    """The robot ``name`` of a physical world, with its parts."""

    world: PhysicalWorld

    def __init__(self, world: PhysicalWorld, name: Hashable, parts: RobotParts) -> None:
        super().__init__(world, name, parts)
        world.drive_with(name, parts)

    # ----------------------------------------------------------------------------------------------------------------- motions

    def _follow(self, joints: Sequence[str], postures: Sequence[np.ndarray], speeds: Sequence[float], late: int = _LATE) -> list[str]:
        """Go along postures; the joints that are not at the last one afterwards."""
        trajectory = Trajectory(joints, postures, np.array(speeds))
        world = self.world
        world.follow(self.name, trajectory)
        try:
            while not trajectory.done:
                world.pause(max(TICK, trajectory.seconds - trajectory.passed))
            for _ in range(late):
                behind = [joint for joint, goal in zip(joints, trajectory.goal, strict=True) if not self._there(joint, goal)]
                if not behind:
                    break
                world.pause()
            return behind
        finally:
            world.leave(trajectory)

    def _there(self, joint: str, goal: float) -> bool:
        kind = "prismatic" if joint in BASE[:2] else "revolute" if joint in BASE else self.machine.description.joints[joint].kind
        return abs(self.world.engine.joint(self.name, joint) - goal) < _CLOSE.get(kind, _CLOSE_BY)

    def _now(self, joints: Sequence[str]) -> np.ndarray:
        engine = self.world.engine
        return np.array([engine.joint(self.name, joint) for joint in joints])

    def _speeds(self, joints: Sequence[str]) -> list[float]:
        described = self.machine.description.joints
        return [min(described[joint].velocity, _FASTEST) * (1.0 if joint == self.parts.torso else PACE) for joint in joints]

    def _keep_hold(self, arms: Sequence[Hashable]) -> None:
        """Errors: `Slipped`, when one of the arms does not touch what it is to hold; the world knows it then."""
        for arm in arms:
            parts = self.parts.arms[arm]
            lost = [name for name, grips in self.machine.holds.items() if any(grip.link == parts.tip for grip in grips)]
            felt = {thing.name for thing in touched_by(self.world, self.name, set(parts.hand))} if lost else set()
            for name in lost:
                if name not in felt:
                    self.world.detach(self.name, name)
                    raise Slipped(self.world.item(name), arm)

    # ------------------------------------------------------------------------------------------------------------ base and head

    def drive(self, to: Placement) -> None:
        """Drive there. Errors: `Blocked`, when the robot would touch something there; `NoWay`; `NotReached`; `Slipped`."""
        ahead = SimulatedRobot(self.world.copy(), self.name, self.parts)
        ahead.drive(to)  # on the copy, which tells what it would touch
        goal = (float(to.position[0]), float(to.position[1]), yaw_of(to))
        start = self._now(BASE)
        way = floor_ways.way(self.world, self.name, goal)
        if way is None:
            raise NoWay("base")
        turn = start[2] - way[0][2]  # the base may have turned around several times
        postures = [start, *(np.array([x, y, angle + turn]) for x, y, angle in way[1:])]
        behind = self._follow(BASE, postures, BASE_SPEEDS)
        self._keep_hold(list(self.parts.arms))
        if behind:
            raise NotReached(behind)

    def _go(self, joints: Mapping[str, float]) -> None:
        limits = self.machine.description.joints
        near = {name: limits[name].clamped(value) for name, value in joints.items()}
        behind = self._follow(list(near), [self._now(list(near)), np.array(list(near.values()))], self._speeds(list(near)))
        if beyond := [name for name, value in joints.items() if near[name] != value]:
            raise BeyondLimits(beyond)
        if behind:
            raise NotReached(behind)

    # -------------------------------------------------------------------------------------------------------------------- arms

    def move_joints(self, arm: Hashable, positions: Sequence[float]) -> None:
        """Bring the joints of an arm to these positions, past what stands around where there is a way.

        Errors: ValueError, when their number is not that of the joints; `NotReached`; `Slipped`.
        """
        joints = self.parts.arms[arm].joints
        wanted = dict(zip(joints, positions, strict=True))
        now = self._now(joints)
        goal = np.array([self._nearest(joint, wanted[joint], at) for joint, at in zip(joints, now, strict=True)])
        room = Room(self.world, self.name, self.parts, joints)
        way = room.way(goal) or self._way_back(room, arm, goal) or [now, goal]
        behind = self._follow(joints, way, self._speeds(joints))
        self._keep_hold([arm])
        if behind:
            raise NotReached(behind)

    def _way_back(self, room: Room, arm: Hashable, goal: np.ndarray) -> list[np.ndarray] | None:
        """A way that first draws the hand back from what is between its open fingers, or lifts it from there; ``None`` if neither goes."""
        parts = self.parts.arms[arm]
        joints = [self.parts.torso, *parts.joints]
        tool, now = self._tool(arm), self._now(joints)
        ahead = tool.position - (tool @ parts.tool.inverse()).position
        length = float(np.linalg.norm(ahead))
        for direction in ([-ahead / length] if length else []) + [np.array([0.0, 0.0, 1.0])]:
            for metres in _BACK:
                line = self._line({arm: Placement(tool.position + metres * direction, tool.rotation)}, joints, now)
                back = [posture[1:] for posture in line or ()]
                if back and room.clear(back):
                    room.start = back[-1]
                    return [*back, *(room.way(goal) or [back[-1], goal])[1:]]
        return None

    def _nearest(self, joint: str, wanted: float, now: float) -> float:
        """The same position, without the whole turns of a joint that has no limits."""
        described = self.machine.description.joints[joint]
        if described.kind != "continuous":
            return described.clamped(wanted)
        return now + (wanted - now + pi) % (2 * pi) - pi

    def move_tools(self, goals: Mapping[Hashable, Placement], lenient: bool = False) -> None:
        """Bring the tool points of arms to poses in the frame of the base.

        A near goal is reached along a line. Else postures are tried, the nearest first, and ways to them past what stands around; the torso
        moves only where it must. lenient: hands may touch things, and where there is no free way they go all the same. Errors:
        `OutOfReach`, `NoWay`; then nothing has moved. `NotReached`, `Slipped`.
        """
        joints = [self.parts.torso, *(joint for arm in goals for joint in self.parts.arms[arm].joints)]
        room = Room(self.world, self.name, self.parts, joints, lenient)
        way = self._way(room, goals, joints, lenient)
        behind = self._follow(joints, way, self._speeds(joints))
        self._keep_hold(list(goals))
        if behind:
            raise NotReached(behind)

    def _way(self, room: Room, goals: Mapping[Hashable, Placement], joints: Sequence[str], lenient: bool) -> list[np.ndarray]:
        now = self._now(joints)
        line = self._line(goals, joints, now)
        if line is not None and room.clear(line):
            return line
        postures = self._candidates(goals, joints, now)
        first = next(postures, None)
        if first is None:
            heights = self._heights()
            out = (arm for arm, goal in goals.items() if self.reach(arm, goal, heights[-1]) is None)
            raise OutOfReach(next(out, next(iter(goals))), len(self._torso_heights()))
        if line is not None and lenient:
            return line
        some = chain([first], islice(postures, _MOST_POSTURES))
        for room.apart, candidates in zip(APART, tee(some, len(APART)), strict=True):  # each is found once, when it is wanted
            for posture in islice(filter(room.free, candidates), _TRIED):
                way = room.way(posture)
                if way is not None:
                    return way
        if lenient:
            return [now, first]
        raise NoWay(f"{next(iter(goals))} arm")

    def _line(self, goals: Mapping[Hashable, Placement], joints: Sequence[str], now: np.ndarray) -> list[np.ndarray] | None:
        """Postures on a line of all tools to near goals; ``None`` when a goal is far, or an arm does not keep to the line."""
        starts = {arm: self._tool(arm) for arm in goals}
        metres = max(float(np.linalg.norm(goal.position - starts[arm].position)) for arm, goal in goals.items())
        radians = max(_angle(starts[arm].rotation, goal.rotation) for arm, goal in goals.items())
        if metres > _LINE[0] or radians > _LINE[1]:
            return None
        count = max(1, int(np.ceil(max(metres / _LINE_STEP[0], radians / _LINE_STEP[1]))))
        postures = [now]
        for number in range(1, count + 1):
            part = number / count
            poses = {arm: _between(starts[arm], goal, part) for arm, goal in goals.items()}
            posture = self._posture_near(poses, joints, postures[-1])
            if posture is None:
                return None
            postures.append(posture)
        return postures

    def _posture_near(self, poses: Mapping[Hashable, Placement], joints: Sequence[str], near: np.ndarray) -> np.ndarray | None:
        values = dict(zip(joints, near, strict=True))
        for arm, pose in poses.items():
            found = next(self._answers(arm, pose, values[self.parts.torso], [values[joint] for joint in self.parts.arms[arm].joints]), None)
            if found is None:
                return None
            values |= found
        posture = np.array([values[joint] for joint in joints])
        return posture if np.abs(posture - near).max() < _JUMP else None

    def _answers(self, arm: Hashable, pose: Placement, torso: float, near: Sequence[float]) -> Iterator[dict[str, float]]:
        """Positions of an arm's joints with which its tool is at a pose in the frame of the base: first what is found from a posture."""
        parts, machine = self.parts.arms[arm], self.machine
        solver = solver_of(machine.description, parts.base, parts.tip)
        position, rotation = machine.skeleton.pose(machine.skeleton.positions({self.parts.torso: torso}), parts.base)
        wanted = Placement(position, rotation).inverse() @ (pose @ parts.tool.inverse())
        known = dict(zip(parts.joints, near, strict=True))
        first = np.array([known[joint] for joint in solver.joints])
        for answer in solver.solutions(wanted.position, wanted.rotation, first):
            yield {joint: self._nearest(joint, float(value), known[joint]) for joint, value in zip(solver.joints, answer, strict=True)}

    def _candidates(self, goals: Mapping[Hashable, Placement], joints: Sequence[str], now: np.ndarray) -> Iterator[np.ndarray]:
        """Postures in which all tools are at their goals: at each height of the torso, the nearest first, those that are nearest to now."""
        values = dict(zip(joints, now, strict=True))
        for height in self._torso_heights():
            found: list[dict[str, float]] = [{self.parts.torso: height}]
            for arm, goal in goals.items():
                answers = list(self._answers(arm, goal, height, [values[joint] for joint in self.parts.arms[arm].joints]))
                found = [before | answer for before in found for answer in answers]
            postures = [np.array([posture[joint] for joint in joints]) for posture in found]
            last: list[np.ndarray] = []
            for posture in sorted(postures, key=lambda posture: float(np.abs(posture - now).max())):
                if all(np.abs(posture - other).max() > _DIFFERENT for other in last):
                    last.append(posture)
                    yield posture

    def _torso_heights(self) -> list[float]:
        limits = self.machine.description.joints[self.parts.torso]
        now = self.world.engine.joint(self.name, self.parts.torso)
        others = np.arange(limits.lower, limits.upper + 1e-9, _TORSO_STEP)
        return [limits.clamped(now), *sorted(map(float, others), key=lambda height: abs(height - now))]

    def _tool(self, arm: Hashable) -> Placement:
        """Where a tool is in the frame of the base."""
        parts = self.parts.arms[arm]
        return self.machine.placement.inverse() @ self.machine.link(parts.tip) @ parts.tool

    # ----------------------------------------------------------------------------------------------------------------- grippers

    def set_fingers(self, arm: Hashable, position: float) -> None:
        """Bring the fingers of an arm to a position, or as near as what is between them lets them."""
        self._move_fingers(arm, position)

    def _move_fingers(self, arm: Hashable, position: float) -> None:
        fingers = self.parts.arms[arm].fingers[:1]
        if fingers:
            limits = self.machine.description.joints[fingers[0]]
            self._follow(fingers, [self._now(fingers), np.array([limits.clamped(position)])], [limits.velocity], _LATE_FINGERS)

    def grip(self, arm: Hashable, newtons: float | None = None) -> list[Item | Machine]:
        """Close a gripper until something is between the fingers; what that is. newtons: how firmly.

        Errors: `NothingGripped`; the fingers stay closed.
        """
        parts, engine = self.parts.arms[arm], self.world.engine
        if not parts.fingers:
            raise NothingGripped("the gripper has no fingers that move")
        engine.set_force(self.name, parts.fingers[0], newtons or GRIP)
        self._move_fingers(arm, 0.0)
        sides = [set(self.machine.description.below(self.machine.description.joints[finger].child)) for finger in parts.fingers]
        felt = [touched_by(self.world, self.name, side) for side in sides]
        held = [thing for thing in felt[0] if all(any(thing is other for other in side) for side in felt)]
        if not held or float(self._now(parts.fingers[:1])[0]) < _SHUT:
            raise NothingGripped("there was nothing between the fingers")
        return held


def _between(start: Placement, end: Placement, part: float) -> Placement:
    one, other = start.rotation, end.rotation if float(start.rotation @ end.rotation) >= 0 else -end.rotation
    rotation = one + part * (other - one)
    return Placement(start.position + part * (end.position - start.position), rotation / np.linalg.norm(rotation))


def _angle(one: np.ndarray, other: np.ndarray) -> float:
    return 2 * float(np.arccos(min(1.0, abs(float(one @ other)))))
