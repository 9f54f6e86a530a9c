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
    for number, solid in enumerate(solids):
        part = _near(solid, view, width, height)
        if part is None:
            continue
        near = rays[part]
        found = solid.meet(view.place, near.reshape(-1, 3)).reshape(near.shape[:2])
        first = found < depths[part]
        if first.any():
            distances, hit = found[first], near[first]
            depths[part][first], shown[part][first] = distances, number
            colours[part][first] = _lit(np.array(solid.colour[:3]), solid.normals(view.place + distances[:, None] * hit), hit)
        if not number & 31:
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
    where = view.place[:2] + depths[floor][:, None] * rays[floor][:, :2]
    tiles = _TILES[np.floor(where).astype(int).sum(axis=1) & 1]
    share = np.clip((depths[floor] - _HAZE) / (2 * _HAZE), 0, 1)[:, None]
    colours[floor] = tiles + (_SKY - tiles) * share
    return shown, depths, colours


def _near(solid: Solid, view: View, width: int, height: int) -> tuple[slice, slice] | None:
    """The part of the picture in which a solid may be seen; ``None`` when it is behind the camera or beside the picture."""
    ahead = (solid.place - view.place) @ view.turn[:, 2]
    if ahead + solid.reach <= NEAR:
        return None
    corners = (solid.corners() - view.place) @ view.turn
    if corners[:, 2].min() <= NEAR:  # the camera is beside it, or inside
        return slice(0, height), slice(0, width)
    focal = height / 2 / tan(view.opening / 2)
    flat = corners[:, :2] / corners[:, 2:]
    (left, top), (right, bottom) = flat.min(axis=0), flat.max(axis=0)
    columns = slice(max(0, int(width / 2 + left * focal) - 1), min(width, int(width / 2 + right * focal) + 2))
    rows = slice(max(0, int(height / 2 + top * focal) - 1), min(height, int(height / 2 + bottom * focal) + 2))
    return (rows, columns) if rows.start < rows.stop and columns.start < columns.stop else None


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
