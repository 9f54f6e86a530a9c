"""Ways of the base between furniture: the shortest on a grid of places and turns at which the robot, as it stands now, touches nothing.

The floor is a grid of five centimetres, a turn a sixteenth of a circle. Robot and furniture count as the boxes around their shapes, in
layers of height. Near the start and the goal, where the robot may stand close to a table, a step beside something is only dear.
"""

from __future__ import annotations

from heapq import heappop, heappush
from math import cos, hypot, pi, sin
from typing import TYPE_CHECKING

import numpy as np

from cramhy_runtime.kernel.active import checkpoint

from ..mujoco_parts import mujoco

if TYPE_CHECKING:
    from collections.abc import Hashable

    from ..world import World

CELL = 0.05  # metres
TURNS = 16
_LAYERS = (0.02, 0.36, 0.62, 0.95, 1.3, 2.0)
_MARGIN = 1.5  # metres around all that stands
_NEAR_END = 0.35  # metres in which the robot may be close to things
_DEAR = 1.0  # metres that a step there costs more
_TURN_COST = 0.1  # metres of a sixteenth
_STEPS = [(x, y) for x in (-1, 0, 1) for y in (-1, 0, 1) if x or y]


def way(world: World, name: Hashable, goal: tuple[float, float, float]) -> list[tuple[float, float, float]] | None:
    """Places (x, y, turn) from where a robot is to a goal, or ``None``. world: it is only looked at."""
    return _Floor(world, name, goal).way()


class _Floor:
    def __init__(self, world: World, name: Hashable, goal: tuple[float, float, float]) -> None:
        from .engine import yaw_of

        machine, scene = world.machine(name), world.scene
        here = machine.placement
        self.start = (float(here.position[0]), float(here.position[1]), yaw_of(here))
        self.goal = goal
        lowest, highest = scene.boxes()
        robot, others = [], []
        for part in scene.parts:
            geoms = [geom for geom in part.geoms if scene.model.geom_type[geom] != mujoco.mjtGeom.mjGEOM_PLANE]
            if part.thing is machine or part.thing.name in machine.holds:
                robot += geoms
            else:
                others += geoms
        self._low, self._high = lowest[others], highest[others]
        self._rectangles = self._robot_rectangles(scene, robot, lowest, highest)
        ends = np.array([self.start[:2], goal[:2]])
        wide = np.abs(self._low).max(axis=1) < 15 if len(others) else np.zeros(0, bool)
        corners = np.vstack([ends, self._low[wide][:, :2], self._high[wide][:, :2]])
        self._origin = corners.min(axis=0) - _MARGIN
        self._size = tuple(np.ceil((corners.max(axis=0) + _MARGIN - self._origin) / CELL).astype(int))

    def _robot_rectangles(self, scene, geoms: list[int], lowest: np.ndarray, highest: np.ndarray) -> list[tuple[np.ndarray, float, float]]:
        """(corners in the frame of the base, lowest, highest z) of the robot's shapes."""
        x, y, turn = self.start
        back = np.array([[cos(turn), sin(turn)], [-sin(turn), cos(turn)]])
        found = []
        for geom in geoms:
            matrix, half = scene.data.geom_xmat[geom].reshape(3, 3), scene.model.geom_aabb[geom, 3:]
            middle = scene.data.geom_xpos[geom] + matrix @ scene.model.geom_aabb[geom, :3]
            local = back @ (middle[:2] - (x, y))
            reach = np.abs(back @ matrix[:2]) @ half
            corners = np.array([local + reach * sign for sign in ((-1, -1), (1, -1), (1, 1), (-1, 1))])
            found.append((corners, float(lowest[geom, 2]), float(highest[geom, 2])))
        return found

    def _taken(self) -> np.ndarray:
        """Turns x cells: where the robot would touch something."""
        taken = np.zeros((TURNS, *self._size))
        shape = self._size
        for low, high in zip(_LAYERS, _LAYERS[1:], strict=False):
            grid = np.zeros(shape)
            inside = (self._low[:, 2] < high) & (self._high[:, 2] > low)
            first = np.clip(((self._low[inside, :2] - self._origin) / CELL).astype(int), 0, None)
            last = np.ceil((self._high[inside, :2] - self._origin) / CELL).astype(int)
            for (x0, y0), (x1, y1) in zip(first, last, strict=True):
                grid[x0:x1, y0:y1] = 1
            rectangles = [corners for corners, bottom, top in self._rectangles if bottom < high and top > low]
            if not rectangles or not grid.any():
                continue
            spectrum = np.fft.rfft2(grid)
            for turn in range(TURNS):
                taken[turn] += np.fft.irfft2(spectrum * np.conj(np.fft.rfft2(self._print(rectangles, turn, shape))), shape)
        return taken > 0.5

    def _print(self, rectangles: list[np.ndarray], turn: int, shape: tuple[int, int]) -> np.ndarray:
        """The cells that the robot covers when it stands at cell (0, 0); negative ones are at the far ends."""
        angle = 2 * pi * turn / TURNS
        across = np.array([[cos(angle), -sin(angle)], [sin(angle), cos(angle)]])
        grid = np.zeros(shape)
        for corners in rectangles:
            edges = (corners[1] - corners[0], corners[3] - corners[0])
            counts = [max(2, int(np.ceil(np.linalg.norm(edge) / (CELL * 0.7))) + 1) for edge in edges]
            s, t = (np.linspace(0, 1, count) for count in counts)
            points = corners[0] + s[:, None, None] * edges[0] + t[None, :, None] * edges[1]
            cells = np.floor(points.reshape(-1, 2) @ across.T / CELL + 0.5).astype(int)
            grid[cells[:, 0] % shape[0], cells[:, 1] % shape[1]] = 1
        return grid

    def _cell(self, place: tuple[float, float, float]) -> tuple[int, int, int]:
        x, y = ((np.array(place[:2]) - self._origin) / CELL).astype(int)
        return int(x), int(y), round(place[2] / (2 * pi) * TURNS) % TURNS

    def _place(self, cell: tuple[int, int, int]) -> tuple[float, float, float]:
        x, y = self._origin + (np.array(cell[:2]) + 0.5) * CELL
        return float(x), float(y), 2 * pi * cell[2] / TURNS

    def way(self) -> list[tuple[float, float, float]] | None:
        taken = self._taken()
        first, last = self._cell(self.start), self._cell(self.goal)
        cells = self._search(taken, first, last)
        if cells is None:
            return None
        middle = [self._place(cell) for cell in _thinned(cells)][1:-1]
        return _unwound([self.start, *middle, self.goal])

    def _search(self, taken: np.ndarray, first: tuple[int, int, int], last: tuple[int, int, int]) -> list[tuple[int, int, int]] | None:
        def ahead(x: int, y: int, turn: int) -> float:
            around = abs(turn - last[2])
            return hypot(x - last[0], y - last[1]) * CELL + min(around, TURNS - around) * _TURN_COST

        def near(x: int, y: int) -> bool:
            return min(hypot(x - first[0], y - first[1]), hypot(x - last[0], y - last[1])) * CELL < _NEAR_END

        best, before = {first: 0.0}, {first: first}
        waiting = [(ahead(*first), first)]
        done = set()
        wide, high = self._size
        while waiting:
            _, cell = heappop(waiting)
            if cell == last:
                found = [cell]
                while before[found[-1]] != found[-1]:
                    found.append(before[found[-1]])
                return found[::-1]
            if cell in done:
                continue
            done.add(cell)
            checkpoint()
            x, y, turn = cell
            steps = [((x + dx, y + dy, turn), CELL * hypot(dx, dy)) for dx, dy in _STEPS]
            steps += [((x, y, (turn + way) % TURNS), _TURN_COST) for way in (-1, 1)]
            for after, cost in steps:
                if not (0 <= after[0] < wide and 0 <= after[1] < high) or after in done:
                    continue
                if taken[after[2], after[0], after[1]]:
                    if not near(after[0], after[1]):
                        continue
                    cost += _DEAR
                total = best[cell] + cost
                if total < best.get(after, np.inf):
                    best[after], before[after] = total, cell
                    heappush(waiting, (total + ahead(*after), after))
        return None


def _thinned(cells: list[tuple[int, int, int]]) -> list[tuple[int, int, int]]:
    """The cells at which the direction changes, and the ends."""

    def step(one: tuple[int, int, int], other: tuple[int, int, int]) -> tuple[int, ...]:
        return tuple(b - a for a, b in zip(one, other, strict=True))

    inner = [cell for before, cell, after in zip(cells, cells[1:], cells[2:], strict=False) if step(before, cell) != step(cell, after)]
    return [cells[0], *inner, cells[-1]] if len(cells) > 1 else [*cells, *cells]


def _unwound(places: list[tuple[float, float, float]]) -> list[tuple[float, float, float]]:
    """The same places, each turned by at most half a circle from the one before."""
    found = [places[0]]
    for x, y, turn in places[1:]:
        before = found[-1][2]
        found.append((x, y, before + (turn - before + pi) % (2 * pi) - pi))
    return found
