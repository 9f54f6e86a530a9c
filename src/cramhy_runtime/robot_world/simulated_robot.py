"""What a robot does in a world in which nothing takes time: drive, look, see, reach, grip.

These are the motions of CRAM's projection. Each happens at once and whole, or leaves the world as it was and says why not; only the joints
of torso and neck go as far as their limits let them before they complain. A `RobotParts` says which links and joints are meant, so the
same motions serve any robot that has a base, a torso, a neck and arms.

Source: bullet-world.md 5.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import islice
from typing import TYPE_CHECKING

from . import remarks
from .placements import Placement
from .reaching import pan_and_tilt, solver_of
from .things import Item, Machine
from .vision import seen

if TYPE_CHECKING:
    from collections.abc import Hashable, Iterator, Mapping, Sequence

    import numpy as np

    from .world import World

VISIBLE = 0.9
"""Which part of an item's picture must be seen."""
TORSO_STEP = 0.01  # metres
_COARSE = 6  # torso steps: between heights that are tried first
_POSTURES = 32  # how many are tried
_POSTURES_AT_HEIGHT = 6


@dataclass(frozen=True)
class ArmParts:
    """The parts of an arm.

    joints: from the shoulder to the wrist. base: the link that carries the shoulder. tip: the link behind which the gripper is. tool: where
    the tool point is in the frame of the tip. fingers: the joints that open the gripper. hand: the links that touch
    what it grips. open: the position of the fingers when it is open; factor: their position for each metre of opening.
    """

    joints: tuple[str, ...]
    base: str
    tip: str
    tool: Placement
    fingers: tuple[str, ...]
    hand: tuple[str, ...]
    open: float
    factor: float = 1.0


@dataclass(frozen=True)
class RobotParts:
    """The parts of a robot that motions speak of. arms: by their names. cameras: links that look along z, tried in this order."""

    torso: str
    pan: str
    tilt: str
    cameras: tuple[str, ...]
    arms: Mapping[Hashable, ArmParts]


class MotionError(Exception):
    """A motion was not possible."""


class Blocked(MotionError):
    """The base cannot stand there. things: what it would touch."""

    def __init__(self, things: Sequence[Item | Machine]) -> None:
        super().__init__(f"it would touch {', '.join(str(thing.name) for thing in things)}")
        self.things = things


class BeyondLimits(MotionError):
    """Joints went to their limits, and not to where they were to go. joints: their names."""

    def __init__(self, joints: Sequence[str]) -> None:
        super().__init__(f"{', '.join(joints)} reached the limit")
        self.joints = joints


class OutOfReach(MotionError):
    """No posture of the arm brings the tool there. arm: its name. torsos, postures: how many heights and postures were tried."""

    def __init__(self, arm: Hashable, torsos: int) -> None:
        super().__init__(f"no posture of the {arm} arm was found at {torsos} height{'s' if torsos > 1 else ''} of the torso")
        self.arm, self.torsos = arm, torsos


class NothingGripped(MotionError):
    """The fingers closed, and there was nothing between them."""


class SimulatedRobot:
    """The robot ``name`` of ``world``, with its parts."""

    def __init__(self, world: World, name: Hashable, parts: RobotParts) -> None:
        self.world, self.name, self.parts = world, name, parts

    @property
    def machine(self) -> Machine:
        return self.world.machine(self.name)

    # ------------------------------------------------------------------------------------------------------------ base and head

    def drive(self, to: Placement) -> None:
        """Put the base there. Errors: `Blocked`, when the robot would touch anything but what it holds; then it stays where it is."""
        before = self.machine.placement
        with self.world.trial():
            self.world.put(self.name, to)
            touched = self.collisions()
            if touched:
                self.world.put(self.name, before)
        if touched:
            raise Blocked(touched)

    def collisions(self, but: Sequence[Hashable] = ()) -> list[Item | Machine]:
        """What the robot touches and does not hold, without the things named in ``but``."""
        held = self.machine.holds
        return [thing for thing in self.world.touching(self.name) if thing.name not in held and thing.name not in but]

    def move_torso(self, height: float) -> None:
        """Raise or lower the torso, as far as it goes. Errors: `BeyondLimits`."""
        self._go({self.parts.torso: height})

    def look_at(self, place: np.ndarray) -> None:
        """Turn the head towards a place in the world, as far as the neck goes. Errors: `BeyondLimits`."""
        self._go(dict(zip((self.parts.pan, self.parts.tilt), self.pan_and_tilt(place), strict=True)))

    def look_forward(self) -> None:
        self._go({self.parts.pan: 0.0, self.parts.tilt: 0.0})

    def pan_and_tilt(self, place: np.ndarray) -> tuple[float, float]:
        """Positions of the two joints of the neck, with which the head looks at a place in the world."""
        joints = self.machine.description.joints
        return pan_and_tilt(self.machine, joints[self.parts.pan], joints[self.parts.tilt], place)

    def _go(self, joints: Mapping[str, float]) -> None:
        limits = self.machine.description.joints
        near = {name: limits[name].clamped(value) for name, value in joints.items()}
        self.world.bend(self.name, near)
        if beyond := [name for name, value in joints.items() if near[name] != value]:
            raise BeyondLimits(beyond)

    # -------------------------------------------------------------------------------------------------------------------- eyes

    def camera(self) -> str | None:
        """The first of the cameras that the robot has."""
        return next((link for link in self.parts.cameras if link in self.machine.skeleton.links), None)

    def sees(self, item: Hashable, least: float = VISIBLE) -> bool:
        """Whether at least the part ``least`` of an item can be seen from one of the cameras."""
        thing, machine = self.world.item(item), self.machine
        cameras = (link for link in self.parts.cameras if link in machine.skeleton.links)
        return any(seen(self.world.scene, machine.link(link), thing)[0] >= least for link in cameras)

    # -------------------------------------------------------------------------------------------------------------------- arms

    def move_joints(self, arm: Hashable, positions: Sequence[float]) -> None:
        """Bring the joints of an arm to these positions, whatever their limits. Errors: ValueError, when their number is not that of the
        joints."""
        self.world.bend(self.name, dict(zip(self.parts.arms[arm].joints, positions, strict=True)))

    def move_tools(self, goals: Mapping[Hashable, Placement], lenient: bool = False) -> None:
        """Bring the tool points of arms to poses in the frame of the base.

        The torso stays where it is if the arms can reach from there, else it goes to the highest place from which they can: every sixth
        step is tried first, then those above the first that will do. Where the arms, but for the hands, would touch something, other
        heights and postures are tried; if none is better, the first is taken. lenient: matters in a physical world, where hands meet what
        they touch. Errors: `OutOfReach`; then nothing has moved.
        """
        first = None
        with self.world.trial():
            for posture in islice(self._postures(goals), _POSTURES):
                first = first or posture
                self.world.bend(self.name, posture)
                if not self._arms_touch():
                    self._remark(goals, True)
                    return
            self._remark(goals, first is not None)
            if first is not None:
                self.world.bend(self.name, first)
                return
        heights = self._heights()
        arms = (arm for arm, goal in goals.items() if self.reach(arm, goal, heights[-1]) is None)
        raise OutOfReach(next(arms, next(iter(goals))), len(heights) // _COARSE + 3)

    def _remark(self, goals: Mapping[Hashable, Placement], reached: bool) -> None:
        if remarks.heard():
            for goal in goals.values():
                remarks.grasp(self.machine, goal, reached)

    def posture_for(self, goals: Mapping[Hashable, Placement]) -> dict[str, float] | None:
        """Positions of the joints of the torso and of the arms that bring the tools there; ``None`` when that is out of reach."""
        return next(self._postures(goals), None)

    def _heights(self) -> list[float]:
        """From the highest place of the torso to the lowest, step by step."""
        limits = self.machine.description.joints[self.parts.torso]
        count = int((limits.upper - limits.lower) / TORSO_STEP + 1e-9)
        return [limits.upper - TORSO_STEP * step for step in range(count + 1)]

    def _postures(self, goals: Mapping[Hashable, Placement]) -> Iterator[dict[str, float]]:
        """Postures in which all arms are at their goals, in the order in which they are tried: at all heights before others at the same."""
        heights = self._heights()
        now, tried = self.machine.joint(self.parts.torso), sorted({*range(0, len(heights), _COARSE), len(heights) - 1})
        first = self._posture(goals, now)
        if first:
            yield first
        for number in tried:
            posture = self._posture(goals, heights[number])
            if posture and not first:
                above = (self._posture(goals, height) for height in heights[max(number - _COARSE + 1, 0) : number])
                first = next(filter(None, above), posture)
                yield first
            if posture:
                yield posture
        if first:
            for other in range(1, _POSTURES_AT_HEIGHT):
                for height in (now, *(heights[number] for number in tried)):
                    if posture := self._posture(goals, height, other):
                        yield posture

    def _posture(self, goals: Mapping[Hashable, Placement], torso: float, number: int = 0) -> dict[str, float] | None:
        """Positions of the joints of the arms, and of the torso at this height; ``None`` when one of the arms does not reach its goal."""
        answers = [self.reach(arm, goal, torso, number) for arm, goal in goals.items()]
        if None in answers:
            return None
        return {self.parts.torso: torso, **{joint: value for answer in answers for joint, value in answer.items()}}

    def _arms_touch(self) -> bool:
        """Whether anything but a hand touches something that is not held."""
        hands = {link for arm in self.parts.arms.values() for link in arm.hand}
        held = self.machine.holds
        touching = (other for own, other in self.world.contacts(self.name) if own.link not in hands)
        return any(other is not None and other.thing.name not in held for other in touching)

    def reach(self, arm: Hashable, goal: Placement, torso: float, number: int = 0) -> dict[str, float] | None:
        """Positions of an arm's joints that bring its tool point to a pose in the frame of the base; ``None`` when there are none.

        number: of several answers, the one of this number, counted from 0.
        """
        parts, machine = self.parts.arms[arm], self.machine
        solver = solver_of(machine.description, parts.base, parts.tip)
        tip = goal @ parts.tool.inverse()
        position, rotation = machine.skeleton.pose(machine.skeleton.positions({self.parts.torso: torso}), parts.base)
        wanted = Placement(position, rotation).inverse() @ tip
        answer = solver.recall(wanted.position, wanted.rotation, number)
        return None if answer is None else dict(zip(solver.joints, map(float, answer), strict=True))

    # ----------------------------------------------------------------------------------------------------------------- grippers

    def open_gripper(self, arm: Hashable) -> None:
        self.set_fingers(arm, self.parts.arms[arm].open)

    def set_gripper(self, arm: Hashable, metres: float) -> None:
        """Open a gripper so far that so much fits in."""
        self.set_fingers(arm, metres * self.parts.arms[arm].factor)

    def close_gripper(self, arm: Hashable) -> None:
        self.set_fingers(arm, 0.0)

    def grip(self, arm: Hashable, newtons: float | None = None) -> list[Item | Machine]:
        """Close a gripper; what its hand touches then. newtons: matters in a physical world.

        Errors: `NothingGripped`; the fingers stay closed.
        """
        self.close_gripper(arm)
        hand = set(self.parts.arms[arm].hand)
        touched = [other.thing for own, other in self.world.contacts(self.name) if own.link in hand and other is not None]
        if not touched:
            raise NothingGripped("there was nothing between the fingers")
        return list({id(thing): thing for thing in touched}.values())

    def set_fingers(self, arm: Hashable, position: float) -> None:
        self.world.bend(self.name, dict.fromkeys(self.parts.arms[arm].fingers, position))
