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
from .views import Rays

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
_JUMP = 0.03
"""How much the colours of pixels beside each other may differ that are not smoothed."""
_NEIGHBOURS = (
    ((slice(1, None), slice(None)), (slice(None, -1), slice(None))),
    ((slice(None), slice(1, None)), (slice(None), slice(None, -1))),
)


class Drawing:
    """A picture. solids: those of the world. shown: height x width, the number of the solid of each pixel, or `FLOOR` or `SKY`. depths:
    metres ahead of the camera, ``inf`` for the sky. colours: height x width x 3, 0 to 1."""

    def __init__(self, solids: list[Solid], shown: np.ndarray, depths: np.ndarray, colours: np.ndarray) -> None:
        self.solids, self.shown, self.depths, self.colours = solids, shown, depths, colours


def draw(world: World, view: View, width: int, height: int, smooth: int = 1) -> Drawing:
    """The picture of ``world``, so many pixels wide and high. Other tasks may run meanwhile.

    smooth: a pixel at an edge, or where colours differ else, is the mean of so many pixels in each direction; depths and what is shown are
    those of the middles of pixels. Errors: ValueError, for no such size.
    """
    if not (width > 0 and height > 0 and width * height * smooth**2 <= _MOST_PIXELS):
        raise ValueError(f"a picture has from 1 to {_MOST_PIXELS} pixels; {width * smooth} x {height * smooth} is none.")
    solids = solids_of(world)
    canvas = _Canvas(view, width, height)
    canvas.paint(solids, np.arange(width * height))
    shown, depths = canvas.shown.reshape(height, width), canvas.depths.reshape(height, width)
    if smooth > 1:
        colours = _smoothed(canvas, solids, smooth)
    else:
        canvas.outline()
        colours = canvas.colours.reshape(height, width, 3)
    return Drawing(solids, shown, depths, colours)


def _smoothed(canvas: _Canvas, solids: list[Solid], smooth: int) -> np.ndarray:
    """The colours of a picture, outlined, in which the pixels at edges are painted anew in pieces."""
    height, width = canvas.height, canvas.width
    edges = np.repeat(np.repeat(canvas.edges(), smooth, axis=0), smooth, axis=1)
    fine = _Canvas(canvas.view, width * smooth, height * smooth)
    for name, shape in (("shown", (height, width)), ("depths", (height, width)), ("colours", (height, width, 3))):
        values = getattr(canvas, name).reshape(shape)
        getattr(fine, name)[:] = np.repeat(np.repeat(values, smooth, axis=0), smooth, axis=1).reshape(getattr(fine, name).shape)
    fine.paint(solids, np.flatnonzero(edges))
    fine.outline()
    return fine.colours.reshape(height, smooth, width, smooth, 3).mean(axis=(1, 3))


class _Canvas:
    """The pixels of a picture, numbered row by row: what each shows, how far ahead that is, and its colour."""

    def __init__(self, view: View, width: int, height: int) -> None:
        self.view, self.width, self.height, self.rays = view, width, height, Rays(view, width, height)
        self.shown, self.depths = np.full(width * height, SKY), np.full(width * height, np.inf)
        self.colours = np.empty((width * height, 3))

    def paint(self, solids: list[Solid], pixels: np.ndarray) -> None:
        """Paint these pixels: the floor and the sky, and before them the solids, the nearest ones first."""
        self._paint_background(pixels)
        wanted = None
        if len(pixels) < len(self.shown):
            wanted = np.zeros((self.height, self.width), bool)
            wanted.ravel()[pixels] = True
        near = [(*part, number) for number, solid in enumerate(solids) if (part := _near(solid, self.view, self.width, self.height))]
        for count, (nearest, part, number) in enumerate(sorted(near, key=lambda entry: (entry[0], entry[2]))):
            within = self._within(part, wanted)
            within = within[self.depths[within] >= nearest]  # the others show what is before it
            if len(within):
                found, normals = solids[number].meet(self.rays, part, within)
                before = self.depths[within]
                first = (found < before) | (found == before) & (number < self.shown[within]) & (found < np.inf)
                within = within[first]
                self.depths[within], self.shown[within] = found[first], number
                rays = self.rays.through(within, np.eye(3))
                self.colours[within] = _lit(np.array(solids[number].colour[:3]), normals(first), rays)
            if not count & 31:
                checkpoint()

    def _within(self, part: tuple[slice, slice], wanted: np.ndarray | None) -> np.ndarray:
        """The numbers of the pixels in a part of the picture, or of those of them that are wanted."""
        rows, columns = part
        if wanted is None:
            return (np.arange(rows.start, rows.stop)[:, None] * self.width + np.arange(columns.start, columns.stop)).ravel()
        row, column = np.nonzero(wanted[part])
        return (row + rows.start) * self.width + column + columns.start

    def _paint_background(self, pixels: np.ndarray) -> None:
        rays = self.rays.through(pixels, np.eye(3))
        with np.errstate(divide="ignore", invalid="ignore"):
            depths = -self.view.place[2] / rays[2]
        floor = np.isfinite(depths) & (depths > NEAR) & (depths < 1e4)
        self.depths[pixels] = np.where(floor, depths, np.inf)
        self.shown[pixels] = np.where(floor, FLOOR, SKY)
        self.colours[pixels[~floor]] = _SKY
        ahead = depths[floor]
        across, along = (np.floor(self.view.place[axis] + ahead * rays[axis][floor]).astype(int) for axis in (0, 1))
        tiles = _TILES[(across + along) & 1]
        hazy = ahead > _HAZE
        tiles[hazy] += (_SKY - tiles[hazy]) * np.clip((ahead[hazy] - _HAZE) / (2 * _HAZE), 0, 1)[:, None]
        self.colours[pixels[floor]] = tiles

    def edges(self) -> np.ndarray:
        """Whether a pixel shows another thing than one beside it, or another colour: height x width."""
        shown, colours = self.shown.reshape(self.height, self.width), self.colours.reshape(self.height, self.width, 3)
        edges = np.zeros(shown.shape, bool)
        for one, other in _NEIGHBOURS:
            differs = (shown[one] != shown[other]) | (np.abs(colours[one] - colours[other]) > _JUMP).any(axis=2)
            edges[one] |= differs
            edges[other] |= differs
        return edges

    def outline(self) -> None:
        """Darken the borders of solids, on the side of the nearer one."""
        shown, depths = self.shown.reshape(self.height, self.width), self.depths.reshape(self.height, self.width)
        edges = np.zeros(shown.shape, bool)
        for one, other in _NEIGHBOURS:
            differs = shown[one] != shown[other]
            edges[one] |= differs & (depths[one] <= depths[other])
            edges[other] |= differs & (depths[other] < depths[one])
        self.colours[(edges & (shown >= 0)).ravel()] *= _OUTLINE


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
    """The colour of places with these normals, n x 3, which rays, 3 x n, meet."""
    above = np.clip(normals @ _LIGHT, 0, 1)
    ahead = np.abs(np.einsum("nk,kn->n", normals, rays)) / np.sqrt(np.einsum("kn,kn->n", rays, rays))
    return np.clip(colour * (_AMBIENT + _ABOVE * above + _AHEAD * ahead)[:, None], 0, 1)
