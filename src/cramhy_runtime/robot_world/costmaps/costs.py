"""Cost functions: how good each cell is, a number from 0 to 1.

A cost function is called with x and y. Those that come along can also tell all values of a grid at once (`Cost.over`), which takes a
hundredth of the time. Source: mobile-manipulation.md section 9.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any


from .arrays import np
from .grids import GridMetadata, OccupancyGrid


class Cost:
    """A cost function: call it with x and y, or ask for its values `over` a grid."""

    def over(self, xs: Any, ys: Any) -> Any:
        """The values at ``xs`` (an array of one row) and ``ys`` (of one column): an array that broadcasts to the grid's shape."""
        raise NotImplementedError

    def __call__(self, x: float, y: float) -> float:
        values = self.over(np.array([[float(x)]]), np.array([[float(y)]]))
        return float(values.flat[0])


class Gauss(Cost):
    """The density of the normal distribution around ``mean`` (x y) with the 2 by 2 matrix ``covariance``, which must be regular."""

    def __init__(self, mean: Any, covariance: Any):
        self.mean, covariance = np.asarray(mean, float)[:2], np.asarray(covariance, float)[:2, :2]
        determinant = float(np.linalg.det(covariance))
        if not determinant > 0:
            raise ValueError(f"The matrix of covariances {covariance.tolist()} is not positive definite.")
        self.inverse = np.linalg.inv(covariance)
        self.factor = 1 / (2 * np.pi * determinant**0.5)

    def over(self, xs: Any, ys: Any) -> Any:
        """Row and column are computed apart where the axes are independent, since the exponential is what takes the time."""
        dx, dy = xs - self.mean[0], ys - self.mean[1]
        (a, b), (c, d) = self.inverse
        if b + c == 0:
            return self.factor * np.exp(-0.5 * a * dx * dx) * np.exp(-0.5 * d * dy * dy)
        return self.factor * np.exp(-0.5 * (a * dx * dx + (b + c) * dx * dy + d * dy * dy))


class Range(Cost):
    """1 up to ``distance`` metres from (``x`` ``y``), 0 beyond; with ``invert`` the other way round."""

    def __init__(self, x: float, y: float, distance: float, invert: bool = False):
        self.x, self.y, self.distance, self.invert = float(x), float(y), float(distance), invert

    def over(self, xs: Any, ys: Any) -> Any:
        """A place is as far as arithmetic can tell: a hair beyond the distance is within."""
        within = (xs - self.x) ** 2 + (ys - self.y) ** 2 <= (self.distance + 1e-9) ** 2
        return (~within if self.invert else within).astype(float)


class AxisBoundary(Cost):
    """1 where ``predicate(coordinate, boundary)`` holds for the coordinate on ``axis``, "x" or "y"; else 0."""

    def __init__(self, axis: str, boundary: Any, predicate: Callable[[Any, Any], bool]):
        self.axis, self.boundary, self.predicate = axis, boundary, predicate

    def over(self, xs: Any, ys: Any) -> Any:
        """The predicate is asked once for each row or column."""
        coordinates = xs if self.axis == "x" else ys
        holds = [float(bool(self.predicate(float(value), self.boundary))) for value in coordinates.ravel().tolist()]
        return np.array(holds).reshape(coordinates.shape)


class Occupancy(Cost):
    """1 in the occupied cells of ``grid``, 0 elsewhere; with ``invert`` the other way round."""

    def __init__(self, grid: OccupancyGrid, invert: bool = False):
        self.grid, self.invert = grid, invert

    def over(self, xs: Any, ys: Any) -> Any:
        """What lies outside of the grid is not occupied."""
        rows, columns, inside = self.grid.cells_at(xs, ys)
        occupied = self.grid.grid[rows, columns].astype(float) * inside
        return 1 - occupied if self.invert else occupied


class Matrix(Cost):
    """The values of ``matrix`` (an array, rows are y) on a grid of its own; 0 outside."""

    def __init__(self, origin_x: float, origin_y: float, resolution: float, matrix: Any):
        self.matrix = np.asarray(matrix, float)
        rows, columns = self.matrix.shape
        self.grid = GridMetadata(
            width=columns * resolution, height=rows * resolution, origin_x=origin_x, origin_y=origin_y, resolution=resolution
        )

    def over(self, xs: Any, ys: Any) -> Any:
        """Each place has the value of the cell that it is in."""
        rows, columns, inside = self.grid.cells_at(xs, ys)
        return self.matrix[rows, columns] * inside
