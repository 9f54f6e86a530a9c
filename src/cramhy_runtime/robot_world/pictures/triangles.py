"""Where the rays of a picture meet the triangles of a mesh.

A triangle of a mesh fills few pixels, most of them none. So each ray is compared with those triangles only in whose rectangle on the
picture its pixel is, and not with all of them: a spoon of 15,000 triangles costs what its pixels cost.
"""

from __future__ import annotations

from math import tan
from typing import TYPE_CHECKING

import numpy as np

from cramhy_runtime.kernel.active import checkpoint

if TYPE_CHECKING:
    from collections.abc import Iterator

    from .views import View

NEAR = 0.02
"""What is nearer than so many metres is not seen."""
_MOST_AT_ONCE = 1 << 19  # pairs of a ray and a triangle


def meet(corners: np.ndarray, view: View, part: tuple[slice, slice], width: int, height: int) -> tuple[np.ndarray, np.ndarray]:
    """What the rays through a part of a picture meet first. corners: those of the triangles in the frame of the camera, n x 3 x 3.
    part: rows and columns of the picture, which is ``width`` x ``height`` pixels.

    Returns two arrays as large as the part: how far ahead, metres, ``inf`` where nothing is met; and the number of the triangle.
    """
    rows, columns = part
    shape = rows.stop - rows.start, columns.stop - columns.start
    half = tan(view.opening / 2)
    scale = np.array([2 * half / height, 2 * half / height])  # of a pixel, 1 m ahead
    middle = np.array([(width - 1) / 2, (height - 1) / 2])
    depths, chosen = np.full(shape[0] * shape[1], np.inf), np.zeros(shape[0] * shape[1], int)
    for numbers, pixels in _pairs(corners, scale, middle, part):
        row, column = np.divmod(pixels, shape[1])
        flat = (np.stack([column + columns.start, row + rows.start], axis=1) - middle) * scale
        along = _meet_each(corners[numbers], flat)
        met = np.isfinite(along)
        numbers, pixels, along = numbers[met], pixels[met], along[met]
        order = np.lexsort((along, pixels))
        pixels, first = np.unique(pixels[order], return_index=True)
        numbers, along = numbers[order][first], along[order][first]
        nearer = along < depths[pixels]
        depths[pixels[nearer]], chosen[pixels[nearer]] = along[nearer], numbers[nearer]
        checkpoint()
    return depths.reshape(shape), chosen.reshape(shape)


def _pairs(
    corners: np.ndarray, scale: np.ndarray, middle: np.ndarray, part: tuple[slice, slice]
) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Yield numbers of triangles with the pixels, counted within ``part``, in whose rectangles these are."""
    rows, columns = part
    wide, high = columns.stop - columns.start, rows.stop - rows.start
    ahead = corners[:, :, 2]
    with np.errstate(divide="ignore", invalid="ignore"):
        places = corners[:, :, :2] / ahead[:, :, None] / scale + middle - (columns.start, rows.start)
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


def _meet_each(triangles: np.ndarray, flat: np.ndarray) -> np.ndarray:
    """As Möller and Trumbore: the ray to ``flat``, 1 m ahead, with the triangle of the same number, both in the frame of the camera."""
    rays = np.concatenate([flat, np.ones((len(flat), 1))], axis=1)
    corner, one, other = triangles[:, 0], triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    normal = np.cross(one, other)
    across, beyond = np.cross(corner, one), np.cross(corner, other)
    with np.errstate(divide="ignore", invalid="ignore"):
        inverse = 1.0 / (rays * normal).sum(axis=1)
        along = (corner * normal).sum(axis=1) * inverse
        u, v = -(rays * beyond).sum(axis=1) * inverse, (rays * across).sum(axis=1) * inverse
        hit = (u >= -1e-9) & (v >= -1e-9) & (u + v <= 1 + 1e-9) & (along > NEAR)
    return np.where(hit, along, np.inf)


def normals(triangles: np.ndarray) -> np.ndarray:
    """The normals of triangles, n x 3; of those that are lines, zero."""
    across = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    return across / np.maximum(np.linalg.norm(across, axis=1, keepdims=True), 1e-300)
