"""Places drawn from a costmap of which some cost functions are too slow to be asked about each cell.

A cost function of CRAM's branch devel goes over the 124 boxes of a kitchen in each call. Asked about ten thousand cells it takes a quarter
of a minute of processor, for one place that is wanted. So the quick factors of the product are computed for all cells. The slow ones are
asked about the cells that these give: a cell then counts with the probability that the slow factors say. That is the same distribution.
A count of loops' turns, never the clock, says how slow a function is (law 5).
"""

from __future__ import annotations

import bisect
from operator import length_hint
from typing import TYPE_CHECKING, Any

from cramhy_runtime.kernel.budget import budget

from .arrays import np

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from .costmap import FunctionCostmapGenerator
    from .grids import GridMetadata

MANY_CELLS = 2000
"""A map with fewer cells left is computed whole."""
LONG = 40
"""Turns of loops in one call, from which on a cost function is slow."""
_TRIES = 300
_STEPS = 64
_GOLDEN = 0.6180339887498949  # multiples of it, without their whole parts, lie evenly between 0 and 1


def turns_of(call: Callable[[], Any]) -> int:
    """How many turns of loops a call takes; `LONG` for one that uses up a whole slice."""
    for _ in range(2):
        before = budget.left + length_hint(budget.ticks)
        call()
        turns = before - budget.left - length_hint(budget.ticks)
        if turns >= 0:  # else a new slice has begun
            return turns
    return LONG


class Sieve:
    """The product ``weights`` of the quick factors, an array whose rows are y, and the generators of the others."""

    def __init__(self, weights: Any, generators: Sequence[FunctionCostmapGenerator], metadata: GridMetadata) -> None:
        self.generators = list(generators)
        self._metadata, self._weights = metadata, weights.ravel()
        self._cells = np.flatnonzero(self._weights)
        self._highest = float(self._weights.max())
        self._sums = np.cumsum(self._weights[self._cells]).tolist()
        self._xs, self._ys = (axis.ravel().tolist() for axis in (metadata.xs(), metadata.ys()))
        self._known: dict[int, float] = {}

    def passes(self, cell: int) -> float:
        """The product of the slow factors at a cell, by its number; each cell is asked about once."""
        if cell not in self._known:
            row, column = divmod(cell, len(self._xs))
            product = 1.0
            for generator in self.generators:
                if not product:
                    break
                product *= generator.cost(self._xs[column], self._ys[row])
            self._known[cell] = product
        return self._known[cell]

    def _cell(self, chance: float) -> int:
        return int(self._cells[min(bisect.bisect_right(self._sums, chance * self._sums[-1]), len(self._cells) - 1)])

    def surely_above(self, row: int, column: int, part: float) -> bool:
        """Whether the value of a cell is more than that part of what the greatest may be."""
        cell = row * len(self._xs) + column
        weight = float(self._weights[cell])
        return weight > 0 and 1 >= self.passes(cell) > part * self._highest / weight

    def possible(self) -> bool:
        """Whether a cell was found that is not 0. Cells all over the map are tried, not all cells."""
        return any(self._known.values()) or any(self.passes(self._cell(step * _GOLDEN % 1.0)) for step in range(_STEPS))

    def draw(self, chance: Callable[[], float]) -> tuple[int, int] | None:
        """The column and row of a cell; ``None``, when nothing was drawn in many tries, or a factor is above 1.

        chance: gives numbers from 0 to below 1.
        """
        for _ in range(_TRIES):
            cell = self._cell(chance())
            passes = self.passes(cell)
            if passes > 1:
                return None
            if passes and (passes == 1 or chance() < passes):
                row, column = divmod(cell, len(self._xs))
                return column, row
        return None
