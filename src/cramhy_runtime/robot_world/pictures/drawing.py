"""The picture that a camera takes of a world: for each pixel the solid that it shows, how far that is, and its colour.

Light comes from above and from the camera, so that no side is black. Outlines are drawn where one solid ends before another. The floor has
tiles of one metre. Law: the same world and view give the same pixels.
"""

from __future__ import annotations

from math import tan
from typing import TYPE_CHECKING

import numpy as np

from cramhy_runtime.kernel.active import checkpoint

from .solids import NEAR, solids_of

if TYPE_CHECKING:
    from ..world import World
    from .solids import Solid
    from .views import View

FLOOR, SKY = -1, -2
"""What pixels show that show no solid."""
_SKY = np.array([0.925, 0.94, 0.955])
_TILES = np.array([[0.84, 0.835, 0.815], [0.79, 0.785, 0.765]])
_LIGHT = np.array([0.35, -0.45, 0.82]) / np.linalg.norm([0.35, -0.45, 0.82])
_AMBIENT, _ABOVE, _AHEAD = 0.42, 0.38, 0.25
_HAZE = 14.0  # metres at which the floor begins to fade into the sky
_OUTLINE = 0.55
_MOST_PIXELS = 4096 * 4096


class Drawing:
    """A picture. solids: those of the world. shown: height x width, the number of the solid of each pixel, or `FLOOR` or `SKY`. depths:
    metres ahead of the camera, ``inf`` for the sky. colours: height x width x 3, 0 to 1."""

    def __init__(self, solids: list[Solid], shown: np.ndarray, depths: np.ndarray, colours: np.ndarray) -> None:
        self.solids, self.shown, self.depths, self.colours = solids, shown, depths, colours


def draw(world: World, view: View, width: int, height: int) -> Drawing:
    """The picture of ``world``, so many pixels wide and high. Other tasks may run meanwhile. Errors: ValueError, for no such size."""
    if not (width > 0 and height > 0 and width * height <= _MOST_PIXELS):
        raise ValueError(f"a picture has from 1 to {_MOST_PIXELS} pixels; {width} x {height} is none.")
    solids = solids_of(world)
    rays = view.rays(width, height)
    shown, depths, colours = _background(view, rays)
    near = [(*part, number) for number, solid in enumerate(solids) if (part := _near(solid, view, width, height)) is not None]
    for count, (nearest, part, number) in enumerate(sorted(near, key=lambda entry: (entry[0], entry[2]))):
        seen = depths[part] >= nearest  # the others show what is before it
        if not seen.any():
            continue
        solid = solids[number]
        found, normals = solid.meet(view, rays, part, seen)
        first = (found < depths[part]) | (found == depths[part]) & (number < shown[part])
        if first.any():
            depths[part][first], shown[part][first] = found[first], number
            colours[part][first] = _lit(np.array(solid.colour[:3]), normals(first), rays[part][first])
        if not count & 31:
            checkpoint()
    _outline(shown, depths, colours)
    return Drawing(solids, shown, depths, colours)


def _background(view: View, rays: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    with np.errstate(divide="ignore", invalid="ignore"):
        depths = -view.place[2] / rays[:, :, 2]
    floor = np.isfinite(depths) & (depths > NEAR) & (depths < 1e4)
    depths = np.where(floor, depths, np.inf)
    shown = np.where(floor, FLOOR, SKY)
    colours = np.empty(rays.shape)
    colours[:] = _SKY
    rows = np.flatnonzero(floor.any(axis=1))
    if len(rows):
        block = slice(rows[0], rows[-1] + 1)
        floor, ahead, rays = floor[block], np.where(floor[block], depths[block], 0.0), rays[block]
        across, along = (np.floor(view.place[axis] + ahead * rays[:, :, axis]).astype(int) for axis in (0, 1))
        tiles = _TILES[(across + along) & 1]
        hazy = ahead > _HAZE
        tiles[hazy] += (_SKY - tiles[hazy]) * np.clip((ahead[hazy] - _HAZE) / (2 * _HAZE), 0, 1)[:, None]
        np.copyto(colours[block], tiles, where=floor[:, :, None])
    return shown, depths, colours


def _near(solid: Solid, view: View, width: int, height: int) -> tuple[float, tuple[slice, slice]] | None:
    """(how far ahead a solid begins, metres; the part of the picture in which it may be seen); ``None`` when it is behind the camera or
    beside the picture."""
    ahead = (solid.place - view.place) @ view.turn[:, 2]
    if ahead + solid.reach <= NEAR:
        return None
    corners = (solid.corners() - view.place) @ view.turn
    if corners[:, 2].min() <= NEAR:  # the camera is beside it, or inside
        corners = _ahead(corners)
        if not len(corners):
            return None
    focal = height / 2 / tan(view.opening / 2)
    flat = corners[:, :2] / corners[:, 2:]
    (left, top), (right, bottom) = flat.min(axis=0), flat.max(axis=0)
    columns = slice(max(0, int(width / 2 + left * focal) - 1), min(width, int(width / 2 + right * focal) + 2))
    rows = slice(max(0, int(height / 2 + top * focal) - 1), min(height, int(height / 2 + bottom * focal) + 2))
    if rows.start >= rows.stop or columns.start >= columns.stop:
        return None
    return float(corners[:, 2].min()) - 1e-6, (rows, columns)


_EDGES = np.array([(one, one | bit) for one in range(8) for bit in (1, 2, 4) if not one & bit])
"""The numbers of the corners of a box that an edge joins; the bits of a number say which of two each of its coordinates is."""


def _ahead(corners: np.ndarray) -> np.ndarray:
    """The corners of that part of a box which is ahead of the camera, in its frame. Some of them are just before it."""
    one, other = corners[_EDGES[:, 0]], corners[_EDGES[:, 1]]
    crossing = (one[:, 2] > NEAR) != (other[:, 2] > NEAR)
    one, other = one[crossing], other[crossing]
    share = (NEAR - one[:, 2]) / (other[:, 2] - one[:, 2])
    return np.concatenate([corners[corners[:, 2] > NEAR], one + share[:, None] * (other - one)])


def _lit(colour: np.ndarray, normals: np.ndarray, rays: np.ndarray) -> np.ndarray:
    above = np.clip(normals @ _LIGHT, 0, 1)
    ahead = np.abs((normals * rays).sum(axis=1)) / np.linalg.norm(rays, axis=1)
    return np.clip(colour * (_AMBIENT + _ABOVE * above + _AHEAD * ahead)[:, None], 0, 1)


def _outline(shown: np.ndarray, depths: np.ndarray, colours: np.ndarray) -> None:
    edge = np.zeros(shown.shape, bool)
    for one, other in (
        ((slice(1, None), slice(None)), (slice(None, -1), slice(None))),
        ((slice(None), slice(1, None)), (slice(None), slice(None, -1))),
    ):
        differs = shown[one] != shown[other]
        edge[one] |= differs & (depths[one] <= depths[other])
        edge[other] |= differs & (depths[other] < depths[one])
    edge &= shown >= 0
    colours[edge] *= _OUTLINE
