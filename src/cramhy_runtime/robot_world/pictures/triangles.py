"""Where the rays of a picture meet the triangles of a mesh.

A triangle of a mesh fills few pixels, most of them none. So each ray is compared with those triangles only in whose rectangle on the
picture its pixel is, and not with all of them: a spoon of 15,000 triangles costs what its pixels cost.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from cramhy_runtime.kernel.active import checkpoint

if TYPE_CHECKING:
    from collections.abc import Iterator

    from .views import Rays

NEAR = 0.02
"""What is nearer than so many metres is not seen."""
_MOST_AT_ONCE = 1 << 19  # pairs of a ray and a triangle


def meet(corners: np.ndarray, rays: Rays, part: tuple[slice, slice], pixels: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """What the rays through some pixels of a picture meet first. corners: those of the triangles in the frame of the camera, n x 3 x 3.
    part: rows and columns of the picture in which the pixels are; pixels: their numbers.

    Returns two arrays as long as ``pixels``: how far ahead, metres, ``inf`` where nothing is met; and the number of the triangle.
    """
    rows, columns = part
    wide, high = columns.stop - columns.start, rows.stop - rows.start
    row, column = np.divmod(pixels, rays.width)
    wanted = (row - rows.start) * wide + column - columns.start
    depths, chosen, seen = np.full(high * wide, np.inf), np.zeros(high * wide, int), None
    if len(wanted) < high * wide:
        seen = np.zeros(high * wide, bool)
        seen[wanted] = True
    planes = _planes(corners)
    for numbers, places in _pairs(corners, rays, part):
        if seen is not None:
            kept = seen[places]
            numbers, places = numbers[kept], places[kept]
        row, column = np.divmod(places, wide)
        along = _meet_each(planes[:, numbers], rays.across[column + columns.start], rays.down[row + rows.start])
        (met,) = np.nonzero(np.isfinite(along) & (along < depths[places]))
        met = met[np.argsort(along[met], kind="stable")[::-1]]  # the nearest one is written last
        depths[places[met]], chosen[places[met]] = along[met], numbers[met]
        checkpoint()
    return depths[wanted], chosen[wanted]


def _pairs(corners: np.ndarray, rays: Rays, part: tuple[slice, slice]) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Yield numbers of triangles with the pixels, counted within ``part``, in whose rectangles these are."""
    rows, columns = part
    wide, high = columns.stop - columns.start, rows.stop - rows.start
    middle = ((rays.width - 1) / 2, (rays.height - 1) / 2)
    ahead = corners[:, :, 2]
    with np.errstate(divide="ignore", invalid="ignore"):
        places = corners[:, :, :2] / ahead[:, :, None] / rays.pixel + middle - (columns.start, rows.start)
    lowest, highest = np.ceil(places.min(axis=1) - 1e-6), np.floor(places.max(axis=1) + 1e-6)
    beside = (ahead <= NEAR).any(axis=1)  # it ends behind the camera: its rectangle has no end
    lowest[beside], highest[beside] = 0, (wide - 1, high - 1)
    lowest, highest = np.clip(lowest, 0, (wide, high)), np.clip(highest, -1, (wide - 1, high - 1))
    sizes = np.maximum(highest - lowest + 1, 0).astype(int)
    counts = np.where((ahead > NEAR).any(axis=1), sizes[:, 0] * sizes[:, 1], 0)
    (some,) = np.nonzero(counts)
    lowest = lowest.astype(int)
    ends = np.cumsum(counts[some])
    begin = 0
    while begin < len(some):
        done = ends[begin - 1] if begin else 0
        end = max(begin + 1, int(np.searchsorted(ends, done + _MOST_AT_ONCE, side="right")))
        numbers = np.repeat(some[begin:end], counts[some[begin:end]])
        within = np.arange(len(numbers)) - np.repeat(ends[begin:end] - counts[some[begin:end]] - done, counts[some[begin:end]])
        row, column = np.divmod(within, sizes[numbers, 0])
        yield numbers, (row + lowest[numbers, 1]) * wide + column + lowest[numbers, 0]
        begin = end


def _planes(corners: np.ndarray) -> np.ndarray:
    """What Möller and Trumbore's intersection needs of each triangle, for rays from the origin: 10 x n."""
    corner, one, other = corners[:, 0], corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    normal = np.cross(one, other)
    return np.concatenate([normal.T, -np.cross(corner, other).T, np.cross(corner, one).T, np.einsum("nk,nk->n", corner, normal)[None]])


def _meet_each(planes: np.ndarray, across: np.ndarray, down: np.ndarray) -> np.ndarray:
    """How far ahead the ray to (across, down), 1 m ahead, meets the triangle of the same number, by Möller and Trumbore."""
    with np.errstate(divide="ignore", invalid="ignore"):
        inverse = 1.0 / (planes[0] * across + planes[1] * down + planes[2])
        u = (planes[3] * across + planes[4] * down + planes[5]) * inverse
        v = (planes[6] * across + planes[7] * down + planes[8]) * inverse
        along = planes[9] * inverse
        hit = (u >= -1e-9) & (v >= -1e-9) & (u + v <= 1 + 1e-9) & (along > NEAR)
    return np.where(hit, along, np.inf)


def normals(triangles: np.ndarray) -> np.ndarray:
    """The normals of triangles, n x 3; of those that are lines, zero."""
    across = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    return across / np.maximum(np.linalg.norm(across, axis=1, keepdims=True), 1e-300)
