"""Ways of the base between furniture: the shortest on a grid of places and turns at which the robot, as it stands now, touches nothing.

The floor is a grid of five centimetres, a turn a sixteenth of a circle. Robot and furniture count as the boxes around their shapes, in
layers of height. Near the start and the goal, where the robot may stand close to a table, a step beside something is only dear.
"""

from __future__ import annotations

from heapq import heappop, heappush
from math import cos, hypot, inf, pi, sin
from typing import TYPE_CHECKING

import numpy as np

from cramhy_runtime.kernel.active import checkpoint

from .engine import yaw_of

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
_GREED = 1.3
_MOST_CELLS = 100_000
_STEPS = [(x, y) for x in (-1, 0, 1) for y in (-1, 0, 1) if x or y]


def way(world: World, name: Hashable, goal: tuple[float, float, float]) -> list[tuple[float, float, float]] | None:
    """Places (x, y, turn) from where a robot is to a goal, or ``None``. world: it is only looked at."""
    return _Floor(world, name, goal).way()


class _Floor:
    def __init__(self, world: World, name: Hashable, goal: tuple[float, float, float]) -> None:
        machine, scene = world.machine(name), world.scene
        here = machine.placement
        self.start = (float(here.position[0]), float(here.position[1]), yaw_of(here))
        self.goal = goal
        lowest, highest = scene.boxes()
        robot, others = [], []
        for part in scene.parts:
            geoms = [geom for geom in part.geoms if not scene.is_plane[geom]]
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
        self._padded = tuple(_next_smooth(int(cells)) for cells in self._size)

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
        """Turns x cells: where the robot would touch something, which is the correlation of what it covers with what stands there."""
        shape = self._padded
        spectra = np.zeros((TURNS, shape[0], shape[1] // 2 + 1), complex)
        for low, high in zip(_LAYERS, _LAYERS[1:], strict=False):
            grid = np.zeros(shape)
            inside = (self._low[:, 2] < high) & (self._high[:, 2] > low)
            first = np.clip(((self._low[inside, :2] - self._origin) / CELL).astype(int), 0, None)
            last = np.ceil((self._high[inside, :2] - self._origin) / CELL).astype(int)
            for (x0, y0), (x1, y1) in zip(first, last, strict=True):
                grid[x0:x1, y0:y1] = 1
            points = [_filled(corners) for corners, bottom, top in self._rectangles if bottom < high and top > low]
            if points and grid.any():
                spectrum, points = np.fft.rfft2(grid), np.concatenate(points)
                for turn in range(TURNS):
                    spectra[turn] += spectrum * np.conj(np.fft.rfft2(self._print(points, turn)))
        return np.fft.irfft2(spectra, shape)[:, : self._size[0], : self._size[1]] > 0.5

    def _print(self, points: np.ndarray, turn: int) -> np.ndarray:
        """The cells that the robot covers when it stands at cell (0, 0); negative ones are at the far ends."""
        angle = 2 * pi * turn / TURNS
        across = np.array([[cos(angle), -sin(angle)], [sin(angle), cos(angle)]])
        cells = np.floor(points @ across.T / CELL + 0.5).astype(int)
        grid = np.zeros(self._padded)
        grid[cells[:, 0] % self._padded[0], cells[:, 1] % self._padded[1]] = 1
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
        """A*, on cells that are numbers: (turn * width + x) * height + y. Its guess is a little too high, which finds a way sooner."""
        dear = self._dear(taken, first, last)
        guess = self._guesses(dear, last)
        if guess[first[2], first[0], first[1]] == inf:
            return None
        dear, guess = dear.ravel().tolist(), guess.ravel().tolist()
        wide, high = self._size
        layer = wide * high
        begin, end = ((turn * wide + x) * high + y for x, y, turn in (first, last))
        steps = [(dx * high + dy, CELL * hypot(dx, dy)) for dx, dy in _STEPS]
        best, before, done = {begin: 0.0}, {begin: begin}, set()
        waiting = [(0.0, begin)]
        while waiting and len(done) < _MOST_CELLS:
            _, cell = heappop(waiting)
            if cell == end:
                return [((one // high) % wide, one % high, one // layer) for one in _back(before, cell)]
            if cell in done:
                continue
            done.add(cell)
            checkpoint()
            so_far, turn = best[cell], cell // layer
            turns = [(((turn + way) % TURNS - turn) * layer, _TURN_COST) for way in (-1, 1)]
            for step, cost in (*steps, *turns):
                after = cell + step
                price = dear[after]
                if price < 0 or after in done:
                    continue
                total = so_far + cost + price
                if total < best.get(after, inf):
                    best[after], before[after] = total, cell
                    heappush(waiting, (total + guess[after], after))
        return None

    def _dear(self, taken: np.ndarray, first: tuple[int, int, int], last: tuple[int, int, int]) -> np.ndarray:
        """What a step to each cell costs beside its length; -1, where the robot cannot be."""
        x, y = np.indices(self._size) * CELL
        near = np.zeros(self._size, bool)
        for cell in (first, last):
            near |= np.hypot(x - cell[0] * CELL, y - cell[1] * CELL) < _NEAR_END
        dear = np.where(taken, np.where(near, _DEAR, -1.0), 0.0)
        dear[:, [0, -1], :] = dear[:, :, [0, -1]] = -1.0  # the border, so that no step leads out
        return dear

    def _guesses(self, dear: np.ndarray, last: tuple[int, int, int]) -> np.ndarray:
        """How far it is to the goal from each cell, as waves run around what stands there; infinite where none comes."""
        open_, far = (dear >= 0).any(axis=0), np.full(self._size, inf)
        wave = np.zeros(self._size, bool)
        wave[last[0], last[1]] = True
        count = 0
        while wave.any():
            far[wave] = count
            grown = wave.copy()
            grown[1:] |= wave[:-1]
            grown[:-1] |= wave[1:]
            across = wave if count % 2 else grown.copy()  # waves are octagons: every other step goes across, too
            grown[:, 1:] |= across[:, :-1]
            grown[:, :-1] |= across[:, 1:]
            wave = grown & open_ & (far == inf)
            count += 1
        around = np.abs(np.arange(TURNS) - last[2])
        turned = np.minimum(around, TURNS - around) * _TURN_COST
        return (far * CELL + turned[:, None, None]) * _GREED


def _next_smooth(number: int) -> int:
    """The least integer from ``number`` on that has no prime factor above 11: grids of such a size are transformed fast."""
    while True:
        rest = number
        for prime in (2, 3, 5, 7, 11):
            while rest % prime == 0:
                rest //= prime
        if rest == 1:
            return number
        number += 1


def _back(before: dict[int, int], cell: int) -> list[int]:
    found = [cell]
    while before[found[-1]] != found[-1]:
        found.append(before[found[-1]])
    return found[::-1]


def _filled(corners: np.ndarray) -> np.ndarray:
    """Places in a rectangle, less than a cell apart, n x 2."""
    edges = (corners[1] - corners[0], corners[3] - corners[0])
    s, t = (np.linspace(0, 1, max(2, int(np.ceil(np.linalg.norm(edge) / (CELL * 0.7))) + 1)) for edge in edges)
    return (corners[0] + s[:, None, None] * edges[0] + t[None, :, None] * edges[1]).reshape(-1, 2)


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
