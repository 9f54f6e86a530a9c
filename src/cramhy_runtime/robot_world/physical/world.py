"""A world in which motions take time, and what is let go, or held too loosely, falls.

It is a `World`: things, contacts, what a camera sees, all as before. But nothing teleports unless a program puts it somewhere. A timer of
the kernel steps MuJoCo, twenty-four milliseconds at a time, while a motion goes on or something has not come to rest. So motions and falls
live in the kernel's time, other tasks run in between, and a world at rest costs nothing. A copy is a kinematic world: a plan looks ahead
there, at once.

``holds`` is what the robot believes to hold. It carries nothing: fingers and friction do.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from cramhy_runtime import kernel
from cramhy_runtime.cpl.tasks.waiting import sleep

from .. import shown
from ..things import Machine
from ..world import World
from .engine import Engine, used_joints

if TYPE_CHECKING:
    from collections.abc import Hashable, Mapping

    from ..placements import Placement
    from ..simulated_robot import RobotParts
    from ..things import Item, Thing
    from .trajectory import Trajectory

TICK = 0.024  # seconds: what the timer lets pass at once
_RESTING = 10  # ticks in which nothing moves, until the world is at rest
_LONGEST = 500  # ticks after the last motion: what trembles then lies


class PhysicalWorld(World):
    """Things by their names, with MuJoCo's state of them.

    engine_class: makes the model. tick: how many seconds the timer lets pass at once.
    """

    lisp_name = "ROBOT-WORLD::PHYSICAL-WORLD"
    engine_class: type[Engine] = Engine
    tick = TICK

    def __init__(self) -> None:
        super().__init__()
        self.parts: dict[Hashable, RobotParts] = {}
        self._engine: Engine | None = None
        self._before: Engine | None = None
        self._kernel: kernel.Kernel | None = None
        self._timer: object | None = None
        self._still, self._since = 0, 0

    # ------------------------------------------------------------------------------------------------------------------- model

    @property
    def engine(self) -> Engine:
        """MuJoCo's model of the things, made anew when the set of them has changed."""
        if self._engine is None:
            robots = {name: parts for name, parts in self.parts.items() if name in self.things}
            self._engine, self._before = self.engine_class(self.solids(), robots, self._before), None
        return self._engine

    def drive_with(self, name: Hashable, parts: RobotParts) -> None:
        """Let servos drive these parts of a machine from now on, and its base."""
        if self.parts.get(name) is not parts:
            known = self.parts.get(name)
            self.parts[name] = parts
            if known is None or used_joints(self.machine(name), known) != used_joints(self.machine(name), parts):
                self._rebuild()

    def _rebuild(self) -> None:
        """Forget MuJoCo's model. What falls begins to fall anew; servos and motions go on."""
        if self._engine is not None:
            self._engine, self._before = None, self._engine
        self.wake()

    def _add(self, thing: Thing) -> Thing:
        added = super()._add(thing)
        self._rebuild()
        return added

    def remove(self, name: Hashable) -> None:
        super().remove(name)
        self._rebuild()

    def put(self, name: Hashable, at: Placement) -> None:
        """Put a thing there, as a hand would; a machine takes with it what it holds."""
        _refresh_grips(self, self.thing(name))
        super().put(name, at)
        self._take_over(name)

    def bend(self, name: Hashable, joints: Mapping[str, float]) -> None:
        """Set joints at once, whatever their limits; servos then hold them there."""
        machine = self.machine(name)
        _refresh_grips(self, machine)
        super().bend(name, joints)
        used = used_joints(machine, self.parts[name]) if name in self.parts else None
        if used and not set(joints) <= {*used[0], *used[1]}:
            self._rebuild()  # a joint that is part of the model's shape
        self._take_over(name)

    def _take_over(self, name: Hashable) -> None:
        thing = self.thing(name)
        if isinstance(thing, Machine) and name not in self.parts:
            self._rebuild()  # furniture is part of the model's shape
        elif self._engine is not None:
            self._engine.write(thing)
            if isinstance(thing, Machine):
                for item in thing.holds:
                    self._engine.write(self.item(item))
        self.wake()

    # -------------------------------------------------------------------------------------------------------------------- time

    def wake(self) -> None:
        """Let time pass until all is at rest."""
        self._still = self._since = 0
        active = kernel.active()
        if active is not self._kernel:
            self._kernel, self._timer = active, None
        if active is not None and self._timer is None:
            self._timer = active.call_at(active.now() + self.tick, self._tick)

    def _tick(self) -> None:
        self._timer = None
        if self._kernel is not kernel.active():
            return
        self.advance(self.tick)
        if not self.at_rest:
            self._timer = self._kernel.call_at(self._kernel.now() + self.tick, self._tick)

    def advance(self, seconds: float) -> None:
        """Let so much time pass at once."""
        engine = self.engine
        engine.step(seconds)
        engine.read()
        self._placed = False
        if engine.trajectories:
            self._since = self._still = 0
        else:
            self._since += 1
            self._still = self._still + 1 if engine.at_rest() else 0
        shown.changed(self)

    @property
    def at_rest(self) -> bool:
        """Whether nothing moves, and has not for a while."""
        return self._still >= _RESTING or self._since >= _LONGEST

    def follow(self, name: Hashable, trajectory: Trajectory) -> None:
        """Let the servos of a machine go along a trajectory from now on."""
        self.engine.follow(name, trajectory)
        self.wake()

    def leave(self, trajectory: Trajectory) -> None:
        """Go along it no more: the servos hold what they have reached."""
        self.engine.leave(trajectory)
        self.wake()

    def pause(self, seconds: float = TICK) -> None:
        """Wait in a motion: in the kernel's time, or without a kernel at once."""
        if kernel.active() is not None:
            sleep(seconds)
        else:
            for _ in range(round(seconds / TICK + 0.49)):
                self.advance(TICK)

    def simulate(self, seconds: float, without: Hashable | None = None) -> float:
        """Let time pass until all is at rest, at most so long; the seconds that it took. It is the kernel's time: others run meanwhile.

        Items that are inside of something that stands, or of each other, are freed first, as in a kinematic world; `stuck` tells of those
        that cannot be.

        without: changes nothing here: fingers that have just let go still touch what they held.
        """
        before = {item.name: item.placement for item in self.items()}
        self.stuck = self.scene.free_all()
        self.scene.write_back()
        for item in self.items():
            freed = item.placement
            if np.abs(freed.position - before[item.name].position).max() > 1e-6:
                self.put(item.name, freed)
        self.wake()
        passed = 0.0
        while passed < seconds - 1e-9 and not self.at_rest:
            self.pause(TICK)
            passed += TICK
        return passed

    # ------------------------------------------------------------------------------------------------------------------- holds

    def copy(self, into: World | None = None) -> World:
        """A kinematic world with the same things at the same places, to look ahead; what the robot holds goes with it there."""
        for machine in self.machines():
            _refresh_grips(self, machine)
        return super().copy(into)


def _refresh_grips(world: PhysicalWorld, thing: Thing) -> None:
    if isinstance(thing, Machine):
        for name, grips in thing.holds.items():
            for grip in grips:
                grip.offset = thing.link(grip.link).inverse() @ world.item(name).placement


def touched_by(world: PhysicalWorld, name: Hashable, links: set[str]) -> list[Item | Machine]:
    """What links of a machine touch, by MuJoCo's contacts."""
    found = [other for link, other, _ in world.engine.touching(world.machine(name)) if link in links and other is not None]
    return list({id(thing): thing for thing in found}.values())
