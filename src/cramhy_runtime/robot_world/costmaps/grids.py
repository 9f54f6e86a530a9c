"""Grids over the floor: which cell a place is in, which cells are occupied, and values by cell.

A cell is addressed by row (y) and column (x). Its place is its corner nearest to the origin, so the place of cell 0 is the origin, and
a grid of 2 by 2 cells of 1 m with the origin (0 0) has its cells at 0 and 1. Lengths are metres. Source: mobile-manipulation.md 9.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from cramhy_runtime.lisp_core.condition_types import TypeError_
from cramhy_runtime.lisp_core.conditions import error
from cramhy_runtime.lisp_core.numbers import is_real

from .arrays import np

PACKAGE = "CRAM-LOCATION-COSTMAP"
MOST_CELLS = 16_000_000
"""Of a grid: a map of 200 m with cells of 5 cm. What asks for more has metres and centimetres exchanged."""
_SLACK = 1e-6
"""Of a cell: a place that arithmetic moved below the edge of its cell by less than this is still in the cell."""


def metres(value: Any, parameter: str) -> float:
    """The real ``value`` given for ``parameter`` as a Python float; anything else is a type error."""
    if is_real(value):
        return float(value)
    condition = TypeError_(value, "REAL")
    condition.context = f"\nwhen binding {PACKAGE}::{parameter}"  # as text: the package of Lisp is not loaded for it
    return error(condition, hint="The sizes of a grid are metres.")


def array_index(coordinate: float, resolution: float, origin: float) -> int:
    """The index of the cell that ``coordinate`` is in: the quotient, truncated."""
    return int((coordinate - origin) / resolution + _SLACK)


def coordinate_of(index: int, resolution: float, origin: float) -> float:
    """The coordinate of the cell ``index``."""
    return index * resolution + origin


class GridMetadata:
    """The geometry of a grid: ``width`` (x) and ``height`` (y), ``origin_x`` and ``origin_y`` of its corner, ``resolution`` of a cell.

    All are metres. ``columns`` and ``rows`` are the numbers of cells. What is not a number, or makes no cell, is an error.
    """

    lisp_name = f"{PACKAGE}::OCCUPANCY-GRID-METADATA"
    initargs = {name: name.lower().replace("-", "_") for name in ("WIDTH", "HEIGHT", "ORIGIN-X", "ORIGIN-Y", "RESOLUTION")}

    def __init__(
        self, *, width: Any = None, height: Any = None, origin_x: Any = 0.0, origin_y: Any = 0.0, resolution: Any = None, **others: Any
    ):
        self.width, self.height = float(metres(width, "WIDTH")), float(metres(height, "HEIGHT"))
        self.origin_x, self.origin_y = float(metres(origin_x, "ORIGIN-X")), float(metres(origin_y, "ORIGIN-Y"))
        self.resolution = float(metres(resolution, "RESOLUTION"))
        if not (self.width > 0 and self.height > 0 and self.resolution > 0):
            error("A grid of ~a by ~a m with cells of ~a m has no cells.", self.width, self.height, self.resolution)
        if not self.width / self.resolution * (self.height / self.resolution) <= MOST_CELLS:
            error(
                f"A grid of ~a by ~a m with cells of ~a m has too many cells: the most is {MOST_CELLS:,}.",
                self.width,
                self.height,
                self.resolution,
            )
        self.columns, self.rows = max(1, round(self.width / self.resolution)), max(1, round(self.height / self.resolution))

    def cell(self, x: float, y: float) -> tuple[int, int] | None:
        """The row and column of the cell at ``x`` and ``y``, or ``None`` outside of the grid."""
        column = (x - self.origin_x) / self.resolution + _SLACK
        row = (y - self.origin_y) / self.resolution + _SLACK
        return (int(row), int(column)) if 0 <= column < self.columns and 0 <= row < self.rows else None

    def xs(self) -> Any:
        """The x of each column, an array of one row."""
        return (np.arange(self.columns) * float(self.resolution) + float(self.origin_x))[None, :]

    def ys(self) -> Any:
        """The y of each row, an array of one column."""
        return (np.arange(self.rows) * float(self.resolution) + float(self.origin_y))[:, None]

    def geometry(self) -> dict[str, float]:
        """The five figures by the names of the parameters, to make another grid."""
        return {name: getattr(self, name) for name in self.initargs.values()}

    def cells_at(self, xs: Any, ys: Any) -> tuple[Any, Any, Any]:
        """For arrays of coordinates: the rows, the columns (0 outside) and which places are inside."""
        columns, rows = (
            (xs - float(self.origin_x)) / float(self.resolution) + _SLACK,
            (ys - float(self.origin_y)) / float(self.resolution) + _SLACK,
        )
        inside = (0 <= columns) & (columns < self.columns) & (0 <= rows) & (rows < self.rows)
        return (
            np.where(0 <= rows, np.minimum(rows, self.rows - 1), 0).astype(int),
            np.where(0 <= columns, np.minimum(columns, self.columns - 1), 0).astype(int),
            inside,
        )


class OccupancyGrid(GridMetadata):
    """A grid whose cells are occupied or free: ``grid`` is an array of 0 and 1."""

    lisp_name = f"{PACKAGE}::OCCUPANCY-GRID"
    initargs = GridMetadata.initargs

    def __init__(
        self, *, width: Any = None, height: Any = None, origin_x: Any = 0.0, origin_y: Any = 0.0, resolution: Any = None, **others: Any
    ):
        super().__init__(width=width, height=height, origin_x=origin_x, origin_y=origin_y, resolution=resolution)
        self.grid = np.zeros((self.rows, self.columns), np.uint8)

    def occupied(self, x: float, y: float) -> bool:
        """Whether the cell at ``x`` and ``y`` is occupied; outside nothing is."""
        cell = self.cell(x, y)
        return cell is not None and bool(self.grid[cell])

    def put(self, x: float, y: float, mask: Any, raw: bool = False) -> None:
        """Occupy the cells of ``mask`` (an array, its middle at ``x`` and ``y``). ``raw``: x and y are a column and a row."""
        if raw:
            column, row = int(x), int(y)
        else:
            column = array_index(x, self.resolution, self.origin_x)
            row = array_index(y, self.resolution, self.origin_y)
        here, there = self._overlap(row, column, mask)
        self.grid[here] |= mask[there].astype(np.uint8)

    def touches(self, x: float, y: float, mask: Any) -> bool:
        """Whether a cell below ``mask``, its middle at ``x`` and ``y``, is occupied."""
        here, there = self._overlap(array_index(y, self.resolution, self.origin_y), array_index(x, self.resolution, self.origin_x), mask)
        return bool((self.grid[here] & mask[there].astype(np.uint8)).any())

    def _overlap(self, row: int, column: int, mask: Any) -> tuple[tuple[slice, slice], tuple[slice, slice]]:
        """The slices of the grid and of the mask that lie on each other."""
        top, left = row - mask.shape[0] // 2, column - mask.shape[1] // 2
        first_row, first_column = max(0, top), max(0, left)
        rows = slice(first_row, max(first_row, min(self.rows, top + mask.shape[0])))
        columns = slice(first_column, max(first_column, min(self.columns, left + mask.shape[1])))
        return (rows, columns), (slice(rows.start - top, rows.stop - top), slice(columns.start - left, columns.stop - left))

    def pad(self, padding: float) -> OccupancyGrid:
        """Occupy all cells within ``padding`` metres of an occupied one. Returns the grid."""
        if padding > 0 and self.grid.any():
            mask = padding_mask(mask_size(padding, self.resolution))
            middle, padded = mask.shape[0] // 2, self.grid.copy()
            for row, column in np.argwhere(mask) - middle:
                target = padded[max(0, row) : self.rows + min(0, row), max(0, column) : self.columns + min(0, column)]
                target |= self.grid[max(0, -row) : self.rows - max(0, row), max(0, -column) : self.columns - max(0, column)]
            self.grid = padded
        return self

    def invert(self) -> OccupancyGrid:
        """Exchange occupied and free cells. Returns the grid."""
        self.grid = 1 - self.grid
        return self

    def places(self) -> Any:
        """The occupied cells' places, an array of rows (x y)."""
        cells = np.argwhere(self.grid)[:, ::-1]
        return cells * float(self.resolution) + (float(self.origin_x), float(self.origin_y))


def mask_size(padding: float, resolution: float) -> int:
    """How many cells a mask of ``padding`` metres all around a cell has a side: an odd number."""
    return 2 * int(padding / resolution + _SLACK) + 1


def padding_mask(size: int) -> Any:
    """A disc of ones in an array of ``size`` by ``size`` cells."""
    distances = np.arange(size) - size // 2
    return (distances[:, None] ** 2 + distances[None, :] ** 2 <= (size // 2) ** 2).astype(np.uint8)


class ValueMap(GridMetadata):
    """A grid with a value, any object, in each cell; 0 where none was set."""

    lisp_name = f"{PACKAGE}::2D-VALUE-MAP"
    initargs = GridMetadata.initargs

    def __init__(
        self, *, width: Any = None, height: Any = None, origin_x: Any = 0.0, origin_y: Any = 0.0, resolution: Any = None, **others: Any
    ):
        super().__init__(width=width, height=height, origin_x=origin_x, origin_y=origin_y, resolution=resolution)
        self.values: dict[tuple[int, int], Any] = {}

    def lookup(self, x: float, y: float) -> Any:
        """The value of the cell at ``x`` and ``y``; outside of the grid it is an error."""
        return self.values.get(self._cell_or_error(x, y), 0.0)

    def set(self, x: float, y: float, value: Any) -> Any:
        """Set the value of the cell at ``x`` and ``y``; outside of the grid it is an error. Returns ``value``."""
        self.values[self._cell_or_error(x, y)] = value
        return value

    def _cell_or_error(self, x: float, y: float) -> tuple[int, int]:
        cell = self.cell(metres(x, "X"), metres(y, "Y"))
        return cell or error(
            "The place (~a ~a) is outside of the map, which begins at (~a ~a) and is ~a by ~a m.",
            x,
            y,
            self.origin_x,
            self.origin_y,
            self.width,
            self.height,
        )


class LazyValueMap(ValueMap):
    """A map whose values ``generator_function``, a function of x and y, computes when a cell is first looked up."""

    lisp_name = f"{PACKAGE}::LAZY-2D-VALUE-MAP"
    initargs = {**GridMetadata.initargs, "GENERATOR-FUNCTION": "generator_function"}

    def __init__(
        self,
        *,
        width: Any = None,
        height: Any = None,
        origin_x: Any = 0.0,
        origin_y: Any = 0.0,
        resolution: Any = None,
        generator_function: Callable[[float, float], Any] | None = None,
        **others: Any,
    ):
        super().__init__(width=width, height=height, origin_x=origin_x, origin_y=origin_y, resolution=resolution)
        self.generator_function = generator_function

    def lookup(self, x: float, y: float) -> Any:
        """The value of the cell at ``x`` and ``y``, which is computed now if nobody asked before."""
        cell = self._cell_or_error(x, y)
        if cell not in self.values:
            self.values[cell] = self.generator_function(x, y)  # type: ignore[misc]
        return self.values[cell]
