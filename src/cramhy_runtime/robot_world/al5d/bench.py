"""The table with the arm and the bricks, as a physical world.

Bricks are light, so steps are shorter and contacts stiffer than in the kitchen: MuJoCo lets a light body be pressed into a hard one by the
square of the contact's time constant. The fingers are pressed together by a spring with a limit of force, as a servo presses them; friction
does the rest. The arm stands on a plate that is too heavy to be moved.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..descriptions import Shape
from ..physical.engine import Engine
from ..physical.world import PhysicalWorld
from ..placements import placement
from . import model
from .servos import Servos

if TYPE_CHECKING:
    from collections.abc import Hashable, Sequence

    import mujoco


STEP = 0.002
"""Seconds of one step."""
_CONTACT = {"solref": [0.005, 1.0], "solimp": [0.98, 0.995, 0.0005, 0.5, 2]}
"""The time constant of contacts in seconds, how they are damped, critically, and how hard they are: at once, and when pressed by 0.5 mm."""
_PRESS, _DAMP = 400.0, 8.0  # N/m and N s/m of the servo that presses the fingers
_FORCE = 5.0  # N at most
_SOFT, _SOFT_FINGERS = 20.0, 0.5  # rad/s^2 and m/s^2: how fast servos get faster
_SLOW = 0.002  # rad/s and m/s: below it a joint is at rest
DRIVEN = (*model.JOINTS[:5], model.FINGERS[0])
"""The joints that servos drive; the other finger goes with the first."""


class BenchEngine(Engine):
    """MuJoCo's model of the table, for light things."""

    timestep = STEP

    def _add_geom(self, *arguments, **options) -> None:
        super()._add_geom(*arguments, **(options | _CONTACT))

    def _spec(self) -> mujoco.MjSpec:
        spec = super()._spec()
        for together in spec.equalities:  # the fingers; they are one gear, however hard one of them is pressed
            together.solref, together.solimp = _CONTACT["solref"], [0.995, 0.999, 0.0005, 0.5, 2]
        return spec

    def _tune(self) -> None:
        super()._tune()
        for servos in self.servos.values():
            servo = servos[model.FINGERS[0]]
            self.model.actuator_gainprm[servo, 0] = _PRESS
            self.model.actuator_biasprm[servo, :3] = 0.0, -_PRESS, -_DAMP
            self.model.actuator_forcerange[servo] = -_FORCE, _FORCE

    def at_rest(self) -> bool:
        """Whether neither a brick moves nor a joint."""
        return super().at_rest() and float(np.abs(self.data.qvel[self._turning]).max()) < _SLOW

    def _find(self) -> None:
        super()._find()
        moved = [self.model.joint(int(joint)) for joint in self.model.actuator_trnid[:, 0]]
        self._turning = np.array([int(joint.dofadr[0]) for joint in moved], int)

    def force(self, name: Hashable, joint: str) -> float:
        """What the servo of a joint does now, in Nm or N."""
        return float(self.data.actuator_force[self.servos[name][joint]])


class Bench(PhysicalWorld):
    """The table with the arm at home. servos: where the arm is on its way to. moment: another object after each change."""

    lisp_name = "LYNXMOTION-AL5D::BENCH"
    engine_class = BenchEngine
    tick = 0.02
    engine: BenchEngine

    def __init__(self) -> None:
        self.moment = object()
        super().__init__()
        shapes, place, colour = model.table()
        self.add_item("table", shapes, place, mass=0.0, colour=colour)
        self.add_item("ground", [Shape("plane", ())], placement((0.0, 0.0, model.FLOOR)), mass=0.0)
        self.arm = self.add_machine(model.NAME, model.described(), joints=model.positions(model.HOME))
        self.drive_with(model.NAME, model.PARTS)
        limits = [self.arm.description.joints[name] for name in DRIVEN]
        self.lowest, self.highest = np.array([each.lower for each in limits]), np.array([each.upper for each in limits])
        start = [self.arm.joint(name) for name in DRIVEN]
        self.servos = Servos(DRIVEN, np.array(start), np.array([each.velocity for each in limits]), np.array([_SOFT] * 5 + [_SOFT_FINGERS]))

    def send(self, command: Sequence[float]) -> list[str]:
        """Send the servos to six positions, as near as their limits allow; the joints whose limits kept them far away."""
        wanted = np.array(command, float)
        wanted[5] /= 2
        goal = np.clip(wanted, self.lowest, self.highest)
        self.servos.goal = goal
        if not self.servos.done and not any(entry[1] is self.servos for entry in self.engine.trajectories):
            self.follow(model.NAME, self.servos)
        return [name for name, far in zip(model.JOINTS, np.abs(goal - wanted) > (0.05,) * 5 + (0.001,), strict=True) if far]

    def _tell(self) -> None:
        self.moment = object()
        super()._tell()

    def advance(self, seconds: float) -> None:
        self.moment = object()
        super().advance(seconds)
        if self.servos.done and self.engine.trajectories:
            self.engine.leave(self.servos)


def states(bench: Bench) -> tuple[list[float], list[float], list[float]]:
    """(positions, velocities, efforts) of `model.JOINTS`."""
    engine, name, (left, right) = bench.engine, model.NAME, model.FINGERS
    places = [engine.joint(name, joint) for joint in DRIVEN[:5]] + [engine.joint(name, left) + engine.joint(name, right)]
    moving = not bench.at_rest
    speeds = [engine.speed(name, joint) if moving else 0.0 for joint in DRIVEN]
    speeds[5] *= 2
    return places, speeds, [engine.force(name, joint) for joint in DRIVEN]
