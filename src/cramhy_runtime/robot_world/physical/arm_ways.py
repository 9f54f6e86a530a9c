"""Ways of arms past furniture and objects: along a line of the tool, straight from posture to posture, or around what is between.

A `Room` is a copy of the world in which postures are tried. Postures are arrays of the positions of some joints. The ways around are found
by two trees of random postures, one from each end, which grow towards each other; the draw is always the same.

Source: J. J. Kuffner and S. M. LaValle, RRT-Connect: an efficient approach to single-query path planning (2000).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from cramhy_runtime.kernel.active import checkpoint

from ..mujoco_parts import mujoco
from ..things import Item
from ..world import carry

if TYPE_CHECKING:
    from collections.abc import Hashable, Sequence

    from ..simulated_robot import RobotParts
    from ..world import World

APART = (0.01, 0.001)
"""How far from everything a way leads, metres: what is tried first, and then. What is nearer at its start may stay as near."""
_FINE = 0.08  # radians between postures that are tried
_BRANCH = 0.4  # radians
_MOST_BRANCHES = 300
_SHORTCUTS = 40


class Room:
    """A kinematic copy of a world, in which a robot's joints ``names`` are tried.

    lenient: the hands may touch things, as when they grasp. apart: how far from everything ways are to lead, metres.
    """

    def __init__(self, world: World, name: Hashable, parts: RobotParts, names: Sequence[str], lenient: bool = False) -> None:
        self.world, self.name, self.names = world.copy(), name, list(names)
        machine = self.machine = self.world.machine(name)
        scene = self.scene = self.world.scene
        hands = {link for arm in parts.arms.values() for link in arm.hand}
        description = machine.description
        moved = {link for joint in names for link in description.below(description.joints[joint].child)}
        held = set(machine.holds)
        mine, others = [], []
        for part in scene.parts:
            if part.thing is machine:
                if part.link in moved and not (lenient and part.link in hands):
                    mine += part.geoms
            elif isinstance(part.thing, Item) and part.thing.name in held:
                if not lenient:
                    mine += part.geoms
            else:
                others += [geom for geom in part.geoms if not scene.is_plane[geom]]
        self.mine, self.others = np.array(mine, int), np.array(others, int)
        lowest, highest = scene.boxes()
        self._low, self._high = lowest[self.others], highest[self.others]
        limits = [description.joints[joint] for joint in names]
        self.lower = np.array([joint.lower for joint in limits])
        self.upper = np.array([joint.upper for joint in limits])
        self.apart = APART[0]
        self.start = np.array([machine.joint(joint) for joint in names])
        self._first = dict(self._near(self.start, APART[0]))

    def _near(self, posture: np.ndarray, distance: float) -> list[tuple[tuple[int, int], float]]:
        """The pairs of geoms that are nearer than that, and how near."""
        scene = self.scene
        self.machine.bend(dict(zip(self.names, map(float, posture), strict=True)))
        carry(self.world, self.machine)  # nobody watches this copy
        scene.place()
        lowest, highest = (corner[self.mine] for corner in scene.boxes())
        near = np.ones((len(self.mine), len(self.others)), bool)
        for axis in range(3):
            near &= self._low[:, axis] <= highest[:, axis, None] + distance
            near &= self._high[:, axis] >= lowest[:, axis, None] - distance
        found = []
        for row, column in zip(*np.nonzero(near), strict=True):
            pair = (int(self.mine[row]), int(self.others[column]))
            apart = mujoco.mj_geomDistance(scene.model, scene.data, *pair, distance, None)
            if apart < distance:
                found.append((pair, apart))
        return found

    def free(self, posture: np.ndarray) -> bool:
        """Whether the robot is far enough from everything there."""
        checkpoint()
        return all(pair in self._first and apart > self._first[pair] - 2e-3 for pair, apart in self._near(posture, self.apart))

    def clear(self, postures: Sequence[np.ndarray]) -> bool:
        """Whether the way along postures is free; the first one is not looked at."""
        for before, after in zip(postures, postures[1:], strict=False):
            count = max(1, int(np.ceil(np.abs(after - before).max() / _FINE)))
            if not all(self.free(before + (after - before) * number / count) for number in range(1, count + 1)):
                return False
        return True

    def way(self, goal: np.ndarray) -> list[np.ndarray] | None:
        """Postures from where the joints are to a goal, or ``None``."""
        if not self.free(goal):
            return None
        if self.clear([self.start, goal]):
            return [self.start, goal]
        found = self._around(goal)
        return None if found is None else self._shortened(found)

    def _around(self, goal: np.ndarray) -> list[np.ndarray] | None:
        draw = np.random.default_rng(20_260_101)
        low = np.where(np.isfinite(self.lower), self.lower, np.minimum(self.start, goal) - 1.0)
        high = np.where(np.isfinite(self.upper), self.upper, np.maximum(self.start, goal) + 1.0)
        trees = [[(self.start, -1)], [(goal, -1)]]
        for number in range(_MOST_BRANCHES):
            this, that = trees[number % 2], trees[1 - number % 2]
            tip = self._grow(this, draw.uniform(low, high), 1)
            if tip is None:
                continue
            meeting = self._grow(that, this[tip][0], 100)
            if meeting is not None and np.array_equal(that[meeting][0], this[tip][0]):
                ways = [_traced(trees[0], tip if this is trees[0] else meeting), _traced(trees[1], tip if this is trees[1] else meeting)]
                return ways[0][::-1] + ways[1][1:]
        return None

    def _grow(self, tree: list[tuple[np.ndarray, int]], towards: np.ndarray, most: int) -> int | None:
        """Grow a branch of the nearest posture of a tree; the number of its last posture, ``None`` when there is no room."""
        nearest = int(np.argmin([np.abs(posture - towards).max() for posture, _ in tree]))
        last = None
        for _ in range(most):
            posture = tree[nearest][0]
            step = towards - posture
            length = float(np.abs(step).max())
            if length == 0:
                return nearest
            after = towards if length <= _BRANCH else posture + step * (_BRANCH / length)
            if not self.clear([posture, after]):
                return last
            tree.append((after, nearest))
            last = nearest = len(tree) - 1
        return last

    def _shortened(self, way: list[np.ndarray]) -> list[np.ndarray]:
        draw = np.random.default_rng(7)
        for _ in range(_SHORTCUTS):
            if len(way) < 3:
                break
            first, last = sorted(map(int, draw.choice(len(way), 2, replace=False)))
            if last - first > 1 and self.clear([way[first], way[last]]):
                del way[first + 1 : last]
        return way


def _traced(tree: list[tuple[np.ndarray, int]], number: int) -> list[np.ndarray]:
    found = []
    while number >= 0:
        posture, number = tree[number]
        found.append(posture)
    return found
