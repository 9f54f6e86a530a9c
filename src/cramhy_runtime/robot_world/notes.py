"""What the things of a world do, motion by motion, for whoever shows it: a movie, a page.

The motions of projection take no time, and what a plan does in one instant shall be seen one after the other. So `Notes` keeps copies of
the world, one after each motion; changes of different joints that follow each other are one motion. `moved` tells what differs between
two of them, and `seconds` how long the way from one to the other would take. Nobody's run is changed by it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .things import Item

if TYPE_CHECKING:
    from collections.abc import Iterator

    from .placements import Placement
    from .world import World

_BASE, _TURN, _JOINT = 1.0, 1.5, 1.2  # m/s, rad/s: how fast things seem to go
_LEAST, _LONGEST = 0.2, 2.0  # seconds of a motion


class Notes:
    """Copies of a world, the first as it was at the beginning. most: of them; when there are more, every second one is dropped."""

    def __init__(self, world: World, most: int) -> None:
        self.most = most
        self.begin(world)

    def begin(self, world: World) -> None:
        """Forget all notes, and begin with the world as it is now."""
        self.worlds: list[World] = [world.copy()]
        self._touched: set = set()

    def add(self, world: World) -> bool:
        """Note the world, if anything in it has moved; whether that is so."""
        now = world.copy()
        touched = set(moved(self.worlds[-1], now))
        if not touched:
            return False
        if self._touched and self._together(touched):
            self.worlds[-1] = now
            self._touched |= touched
        else:
            self.worlds.append(now)
            self._touched = touched
        if len(self.worlds) > self.most:
            del self.worlds[1:-1:2]
        return True

    def _together(self, touched: set) -> bool:
        """Whether what was ``touched`` can be shown as one motion with what the last note shows."""
        return not touched & self._touched and {kind for kind, *_ in touched | self._touched} == {"joint"}

    def take(self) -> list[World]:
        """The notes since the last call, behind the one before them; that one is the first."""
        taken, self.worlds, self._touched = self.worlds, self.worlds[-1:], set()
        return taken


def moved(one: World, other: World) -> Iterator[tuple]:
    """What differs: ("item", name), ("root", name), ("joint", name, number), ("things",)."""
    if one.things.keys() != other.things.keys():
        yield ("things",)
    held = {item for machine in other.machines() for item in machine.holds}
    for name, now in other.things.items():
        before = one.things.get(name)
        if before is None:
            continue
        if isinstance(now, Item):
            if name not in held and not same(before.placement, now.placement):
                yield ("item", name)
            continue
        if not same(before.placement, now.placement):
            yield ("root", name)
        if before.joints is not now.joints and len(before.joints) == len(now.joints):
            yield from (("joint", name, int(number)) for number in np.flatnonzero(before.joints != now.joints))


def same(one: Placement, other: Placement) -> bool:
    """Whether two placements are the same to the bit."""
    return one is other or (np.array_equal(one.position, other.position) and np.array_equal(one.rotation, other.rotation))


def seconds(one: World, other: World) -> float:
    """How long the motion from one world to the other seems to take."""
    longest = _LEAST
    for name, now in other.things.items():
        before = one.things.get(name)
        if before is None:
            continue
        turn = 2 * float(np.arccos(np.clip(abs(before.placement.rotation @ now.placement.rotation), 0, 1)))
        longest = max(longest, float(np.linalg.norm(now.placement.position - before.placement.position)) / _BASE, turn / _TURN)
        if not isinstance(now, Item) and len(before.joints) == len(now.joints):
            longest = max(longest, float(np.abs(now.joints - before.joints).max(initial=0.0)) / _JOINT)
    return min(longest, _LONGEST)
