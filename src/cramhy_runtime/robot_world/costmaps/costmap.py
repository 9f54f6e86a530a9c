"""The location costmap: cost functions by name, their product, and places drawn from it.

The product is computed when somebody first asks, in the order of the functions' scores, the highest first; a cell that is 0 already is
not asked again, so cheap functions that rule out much have high scores. What is registered later does not change a map that was
computed. Source: mobile-manipulation.md section 9.
"""

from __future__ import annotations

import bisect
import copy
import math
from collections.abc import Callable, Iterable
from itertools import groupby
from typing import Any

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.conditions import error
from cramhy_runtime.lisp_core.data import one
from cramhy_runtime.lisp_core.numbers import is_real

from .arrays import np
from .costs import Cost
from .grids import PACKAGE, GridMetadata
from .sieve import LONG, MANY_CELLS, Sieve, turns_of


class NoCostFunctions(Exception):
    """A costmap without cost functions was asked for its values."""


class NothingPossible(Exception):
    """The product of the cost functions is 0 everywhere, so that no place can be drawn.

    ``names``: of the functions that were multiplied; the last one left nothing of what the others allow.
    """

    def __init__(self, names: list[Any]):
        super().__init__(names)
        self.names = names


class CostmapGenerator:
    """Something that gives costs: ``generator_function`` and a name. The subclasses say what the function takes."""

    lisp_name = f"{PACKAGE}::COSTMAP-GENERATOR"
    initargs = {"GENERATOR-FUNCTION": "generator_function", "NAME": "name"}

    def __init__(self, *, generator_function: Any = None, name: Any = None, generator_name: Any = None, **others: Any):
        self.generator_function, self.name = generator_function, name if generator_name is None else generator_name

    def generate(self, matrix: Any, metadata: GridMetadata) -> Any:
        """The array ``matrix`` (rows are y) times the costs."""
        raise NotImplementedError


class FunctionCostmapGenerator(CostmapGenerator):
    """The function takes x and y and gives the cost there. It is not asked about cells that are 0 already."""

    lisp_name = f"{PACKAGE}::FUNCTION-COSTMAP-GENERATOR"

    def generate(self, matrix: Any, metadata: GridMetadata) -> Any:
        """At once where the function is a `Cost`, else cell by cell; other tasks may run after each row."""
        if isinstance(self.generator_function, Cost):
            return matrix * self.generator_function.over(metadata.xs(), metadata.ys())
        function, result = self.generator_function, matrix.copy()
        xs, ys = [[float(value) for value in axis.ravel().tolist()] for axis in (metadata.xs(), metadata.ys())]
        for row, y in enumerate(ys):
            columns = np.flatnonzero(result[row]).tolist()
            if columns:
                result[row, columns] *= [self._checked(function(xs[column], y), xs[column], y) for column in columns]
                kernel.checkpoint()
        return result

    def cost(self, x: float, y: float) -> float:
        """What the function gives there."""
        return self._checked(self.generator_function(x, y), x, y)

    def _checked(self, cost: Any, x: float, y: float) -> float:
        cost = one(cost)
        if not is_real(cost) or not 0 <= cost < math.inf:
            error("The cost function ~s gave ~s at (~a ~a). A number from 0 to 1 is wanted.", self.name, cost, x, y)
        return float(cost)


class MapCostmapGenerator(CostmapGenerator):
    """The function takes the grid's metadata and the matrix so far, and gives the matrix that takes its place."""

    lisp_name = f"{PACKAGE}::MAP-COSTMAP-GENERATOR"

    def generate(self, matrix: Any, metadata: GridMetadata) -> Any:
        """What the function makes of the matrix."""
        return np.asarray(self.generator_function(metadata, matrix.copy()), float)


def own_score(name: Any) -> float:
    """The score of a name that is a number: itself."""
    if not is_real(name):
        raise TypeError(f"The name {name!r} has no score.")
    return name


def _cell_by_cell(generator: CostmapGenerator) -> bool:
    return not isinstance(generator.generator_function, Cost)


class LocationCostmap(GridMetadata):
    """A costmap: a grid with cost functions, height generators and orientation generators.

    Its values are computed when they are first wanted. Two functions are a subclass's to replace: ``score`` gives the score of a name,
    and ``run`` lets a generator multiply a matrix.
    """

    lisp_name = f"{PACKAGE}::LOCATION-COSTMAP"
    initargs = GridMetadata.initargs
    score: Callable[[Any], Any] = staticmethod(own_score)
    run: Callable[[CostmapGenerator, Any, GridMetadata], Any] = staticmethod(
        lambda generator, matrix, metadata: generator.generate(matrix, metadata)
    )

    def __init__(
        self, *, width: Any = None, height: Any = None, origin_x: Any = 0.0, origin_y: Any = 0.0, resolution: Any = None, **others: Any
    ):
        super().__init__(width=width, height=height, origin_x=origin_x, origin_y=origin_y, resolution=resolution)
        self.generators: list[CostmapGenerator] = []  # the newest first
        self.height_generators: list[Any] = []
        self.orientation_generators: list[Any] = []  # the newest first
        self.computed: Any = None
        self._sieve: Sieve | None = None
        self.views: dict[str, Any] = {}  # what others make of the computed map, to keep

    def register(self, function: Any, name: Any) -> None:
        """Enter a cost function, a function of x and y or a `CostmapGenerator`, under ``name``."""
        if isinstance(function, CostmapGenerator):
            function = copy.copy(function)  # the same generator may be registered elsewhere, under another name
            function.name = name
        else:
            function = FunctionCostmapGenerator(generator_function=function, name=name)
        self.generators.insert(0, function)

    def register_height_generator(self, generator: Any) -> None:
        """Enter a function of x and y that returns a list of heights; it comes beside those that are there."""
        self.height_generators.append(generator)

    def register_orientation_generator(self, generator: Any) -> None:
        """Enter a function of x, y and orientations. It is asked before those that are there, and they see what it gave."""
        self.orientation_generators.insert(0, generator)

    def ordered(self) -> list[CostmapGenerator]:
        """The generators as they are multiplied: the highest score first. Of those with one name only the first registered counts.

        Among neighbours that are functions, those that are asked cell by cell come last: they are slow, and are not asked about cells
        that are 0 already. The product is the same.
        """
        kept: dict[Any, CostmapGenerator] = {}
        for generator in self.generators:  # the newest first, so that the oldest remains
            kept[(generator.name.__class__, generator.name)] = generator
        by_score = sorted(kept.values(), key=lambda generator: -self.score(generator.name))
        return [
            generator
            for of_functions, neighbours in groupby(by_score, lambda one: one.__class__ is FunctionCostmapGenerator)
            for generator in (sorted(neighbours, key=_cell_by_cell) if of_functions else neighbours)
        ]

    def values(self) -> Any:
        """The product of all cost functions, an array (rows are y) whose sum is 1; computed once.

        Without functions it raises `NoCostFunctions`, and where all cells are 0 `NothingPossible`.
        """
        if self.computed is None:
            matrix = self._product(self.ordered())
            self.computed, self._sieve = matrix / matrix.sum(), None
        return self.computed

    def _product(self, generators: Iterable[CostmapGenerator], whole: bool = True) -> Any:
        """The product of the generators, an array; unless ``whole``, `_sieve` is set, and None returned, when slow functions come last."""
        if not self.generators:
            raise NoCostFunctions
        matrix, names, rest = np.ones((self.rows, self.columns)), [], list(generators)
        while rest:
            if not whole and self._slow(rest, matrix):
                self._sieve = Sieve(matrix, rest, self)
                return None
            generator = rest.pop(0)
            matrix = self.run(generator, matrix, self)
            names.append(generator.name)
            if not matrix.sum() > 0:
                raise NothingPossible(names)
        return matrix

    def _slow(self, rest: list[CostmapGenerator], matrix: Any) -> bool:
        """Whether only functions are left that are asked cell by cell, the first one is slow, and many cells are left to ask about."""
        first = rest[0]
        if any(one.__class__ is not FunctionCostmapGenerator or not _cell_by_cell(one) for one in rest):
            return False
        cells = np.flatnonzero(matrix)
        if len(cells) <= MANY_CELLS:
            return False
        row, column = divmod(int(cells[len(cells) // 2]), self.columns)
        x, y = float(self.xs().ravel()[column]), float(self.ys().ravel()[row])
        return turns_of(lambda: first.cost(x, y)) >= LONG

    def ready(self) -> None:
        """Find that places can be drawn. Slow functions are asked about a few cells. Errors: as of `values`."""
        if self.computed is None and self._sieve is None:
            matrix = self._product(self.ordered(), whole=False)
            if matrix is not None:
                self.computed = matrix / matrix.sum()
        if self._sieve is not None and not self._sieve.possible():
            self.values()

    def value(self, x: float, y: float) -> float:
        """The value of the cell at ``x`` and ``y``; 0 outside of the grid."""
        values, cell = self.values(), self.cell(x, y)
        return 0.0 if cell is None else float(values[cell])

    def above(self, x: float, y: float, part: float) -> bool:
        """Whether the value at ``x`` and ``y`` is more than that part of the greatest one. Errors: as of `values`."""
        self.ready()
        cell = self.cell(x, y)
        if cell is None or self._sieve is not None and self._sieve.surely_above(*cell, part):
            return cell is not None
        return self.value(x, y) / self.maximum > part

    @property
    def maximum(self) -> float:
        """The greatest value of a cell."""
        return float(self._kept("maximum", lambda: self.values().max()))

    def draw(self, chance: Callable[[], float]) -> tuple[int, int]:
        """The column and row of a cell; greater values are more probable. chance: gives numbers from 0 to below 1."""
        if self.computed is None:
            self.ready()
        if self._sieve is not None and (drawn := self._sieve.draw(chance)):
            return drawn
        cells, sums = self.views.get("sums") or self._kept("sums", self._sums)
        row, column = divmod(cells[min(bisect.bisect_right(sums, chance() * sums[-1]), len(cells) - 1)], self.columns)
        return column, row

    def _sums(self) -> tuple[list[int], list[float]]:
        flat = self.values().ravel()
        cells = np.flatnonzero(flat)
        return cells.tolist(), np.cumsum(flat[cells]).tolist()

    def _kept(self, name: str, compute: Callable[[], Any]) -> Any:
        self.values()
        if name not in self.views:
            self.views[name] = compute()
        return self.views[name]

    def view(self, name: str, compute: Callable[[Any], Any]) -> Any:
        """``compute(values)``, computed once for each ``name``: another form of the computed map."""
        return self._kept(name, lambda: compute(self.values()))


def merged(costmaps: Iterable[LocationCostmap]) -> LocationCostmap:
    """A costmap with the functions and generators of all ``costmaps``, at least one, and the geometry of the first.

    Of functions with one name that of the last costmap counts.
    """
    costmaps = list(costmaps)
    result = costmaps[0].__class__(**costmaps[0].geometry())
    for costmap in costmaps:
        result.generators += costmap.generators
        result.height_generators += costmap.height_generators
        result.orientation_generators += costmap.orientation_generators
    return result
