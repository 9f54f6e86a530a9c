"""Postures of arms for poses of their tools, and ways to them that servos can go.

A tool goes along a line to what is near. Where it cannot, other postures are tried, and ways to them past what stands around.
"""

from __future__ import annotations

from itertools import islice
from math import pi
from typing import TYPE_CHECKING

import numpy as np

from ..placements import Placement
from ..reaching import solver_of
from ..simulated_robot import MotionError, OutOfReach, SimulatedRobot
from .arm_ways import APART, Room

if TYPE_CHECKING:
    from collections.abc import Hashable, Iterator, Mapping, Sequence

    from ..inverse_kinematics import Reach

_LINE = (0.35, 0.6)  # metres, radians: so far a tool goes along a line
_LINE_STEP = (0.02, 0.1)
_JUMP = 0.5  # radians between two steps of a line
_BESIDE = 3
_TRIED = 6  # postures to which ways are looked for
_LIMIT = 0.15  # radians
_AROUND = 2  # of these, to which ways around things are looked for
_TORSO_STEP = 0.05  # metres


class NoWay(MotionError):
    """There is no way for the base, or for an arm, past what stands around. what: ``base``, or the arm's name."""

    def __init__(self, what: Hashable) -> None:
        super().__init__(f"there is no way for the {what} past what stands around")
        self.what = what


class ReachingRobot(SimulatedRobot):
    """A robot that finds ways for its tools."""

    def _joints(self, goals: Mapping[Hashable, Placement]) -> list[str]:
        return [self.parts.torso, *(joint for arm in goals for joint in self.parts.arms[arm].joints)]

    def _now(self, joints: Sequence[str]) -> np.ndarray:
        return np.array([self.machine.joint(joint) for joint in joints])

    def _nearest(self, joint: str, wanted: float, now: float) -> float:
        """The same position, without the whole turns of a joint that has no limits."""
        described = self.machine.description.joints[joint]
        if described.kind != "continuous":
            return described.clamped(wanted)
        return now + (wanted - now + pi) % (2 * pi) - pi

    def _way(self, goals: Mapping[Hashable, Placement], joints: Sequence[str], lenient: bool) -> list[np.ndarray]:
        now = self._now(joints)
        line = next(filter(None, (self._line(goals, joints, now, height) for height in self._heights_for(goals))), None)
        room = Room(self.world, self.name, joints, 0.0 if lenient else APART)  # elsewhere than on a line hands must not push things about
        if line is not None and (lenient or room.clear(line)):
            return line
        postures = list(islice(self._candidates(goals, joints, now), _TRIED))
        if not postures:
            heights = self._heights()
            out = (arm for arm, goal in goals.items() if self.reach(arm, goal, heights[-1]) is None)
            raise OutOfReach(next(out, next(iter(goals))), len(self._torso_heights()))
        for posture in postures:
            if room.clear([now, posture]):
                return [now, posture]
        for posture in postures[: 1 if lenient else _AROUND]:
            way = room.way(posture)
            if way is not None:
                return way
        if lenient:
            return [now, postures[0]]
        raise NoWay(f"{next(iter(goals))} arm")

    def _line(self, goals: Mapping[Hashable, Placement], joints: Sequence[str], now: np.ndarray, height: float) -> list[np.ndarray] | None:
        """Postures on a line of all tools to near goals, while the torso goes to a height; ``None`` when a goal is far, or an arm does not
        keep to the line."""
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
            posture = self._posture_near(poses, joints, postures[-1], now[0] + part * (height - now[0]))
            if posture is None:
                return None
            postures.append(posture)
        return postures

    def _posture_near(
        self, poses: Mapping[Hashable, Placement], joints: Sequence[str], near: np.ndarray, torso: float
    ) -> np.ndarray | None:
        """The posture with the tools there that the one before leads to; ``joints`` begin with the torso."""
        values = dict(zip(joints, near, strict=True)) | {self.parts.torso: torso}
        for arm, pose in poses.items():
            solver, wanted = self._wanted(arm, pose, torso)
            found = self._solved_near(solver, wanted, np.array([values[joint] for joint in solver.joints]))
            if found is None:
                return None
            values |= {joint: self._nearest(joint, float(value), values[joint]) for joint, value in zip(solver.joints, found, strict=True)}
        posture = np.array([values[joint] for joint in joints])
        return posture if np.abs(posture - near).max() < _JUMP else None

    def _solved_near(self, solver: Reach, wanted: Placement, start: np.ndarray) -> np.ndarray | None:
        """What a posture leads to; where it leads nowhere, as at a limit, what postures beside it lead to."""
        draw = np.random.default_rng(3)
        for number in range(_BESIDE):
            found = solver.near(*wanted, start if number == 0 else start + draw.uniform(-_JUMP, _JUMP, len(start)))
            if found is not None and np.abs(found - start).max() < _JUMP:
                return found
        return None

    def _wanted(self, arm: Hashable, pose: Placement, torso: float) -> tuple[Reach, Placement]:
        """(the solver of an arm, where its tip has to be for it) when its tool is at a pose in the frame of the base."""
        parts, machine = self.parts.arms[arm], self.machine
        position, rotation = machine.skeleton.pose(machine.skeleton.positions({self.parts.torso: torso}), parts.base)
        wanted = Placement(position, rotation).inverse() @ (pose @ parts.tool.inverse())
        return solver_of(machine.description, parts.base, parts.tip), wanted

    def _answers(self, arm: Hashable, pose: Placement, torso: float, near: Sequence[float]) -> Iterator[dict[str, float]]:
        """Positions of an arm's joints with which its tool is at a pose in the frame of the base: first what is found from a posture."""
        solver, wanted = self._wanted(arm, pose, torso)
        known = dict(zip(self.parts.arms[arm].joints, near, strict=True))
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
            yield from sorted(postures, key=lambda posture: float(np.abs(posture - now).max()) + self._near_limits(joints, posture))

    def _near_limits(self, joints: Sequence[str], posture: np.ndarray) -> float:
        """The more, the nearer to their limits joints are: from there a tool cannot go on along every line."""
        limits = [self.machine.description.joints[joint] for joint in joints[1:]]
        room = (min(value - limit.lower, limit.upper - value) for limit, value in zip(limits, posture[1:], strict=True))
        return sum(1.0 for left in room if left < _LIMIT)

    def _heights_for(self, goals: Mapping[Hashable, Placement]) -> list[float]:
        """Heights of the torso to try with a line: first as it is, then raised as much as the tools, so that arms stay as they are."""
        now, *others = self._torso_heights()
        rise = float(np.mean([goal.position[2] - self._tool(arm).position[2] for arm, goal in goals.items()]))
        return [now, self.machine.description.joints[self.parts.torso].clamped(now + rise), *others]

    def _torso_heights(self) -> list[float]:
        limits = self.machine.description.joints[self.parts.torso]
        now = self.machine.joint(self.parts.torso)
        others = np.arange(limits.lower, limits.upper + 1e-9, _TORSO_STEP)
        return [limits.clamped(now), *sorted(map(float, others), key=lambda height: abs(height - now))]

    def _tool(self, arm: Hashable) -> Placement:
        """Where a tool is in the frame of the base."""
        parts = self.parts.arms[arm]
        return self.machine.placement.inverse() @ self.machine.link(parts.tip) @ parts.tool


def _between(start: Placement, end: Placement, part: float) -> Placement:
    one, other = start.rotation, end.rotation if float(start.rotation @ end.rotation) >= 0 else -end.rotation
    rotation = one + part * (other - one)
    return Placement(start.position + part * (end.position - start.position), rotation / np.linalg.norm(rotation))


def _angle(one: np.ndarray, other: np.ndarray) -> float:
    return 2 * float(np.arccos(min(1.0, abs(float(one @ other)))))
