"""The shapes of a world as solids, and where rays meet them.

All rays of a picture begin at the camera. A solid is asked for those rays near it that nothing before it has met, at once; it answers with
how far along each of them it is met first, ``inf`` where it is not; and then with the normals at such places.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any
from zlib import crc32

import numpy as np

from ..meshes import mesh_of, shape_box
from ..mujoco_parts import mujoco
from ..things import Item, Machine
from . import triangles
from .triangles import NEAR

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from ..descriptions import Shape
    from ..mesh_files import Mesh
    from ..things import Colour, Thing
    from ..world import World
    from .views import Rays

_CORNERS = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)


_PLAIN = Machine.colour
_TONES = ((0.84, 0.82, 0.78, 1.0), (0.73, 0.74, 0.76, 1.0), (0.80, 0.74, 0.66, 1.0), (0.88, 0.87, 0.85, 1.0), (0.66, 0.69, 0.73, 1.0))


def colour_of(thing: Thing, link: str | None) -> Colour:
    """The colour of a thing, or of a link of it: links of machines to which nobody gave a colour have several, to be told apart."""
    return thing.colour if link is None or thing.colour != _PLAIN else _TONES[crc32(link.encode()) % len(_TONES)]


class Solid:
    """A shape where it is in the world. reach: the radius of a ball around its origin in which it is. thing, link: what it is a part of."""

    __slots__ = ("thing", "link", "shape", "form", "place", "turn", "reach", "colour", "_corners")

    def __init__(self, thing: Thing, link: str | None, shape: Shape, place: np.ndarray, turn: np.ndarray, colour: Colour) -> None:
        self.thing, self.link, self.shape, self.place, self.turn, self.colour = thing, link, shape, place, turn, colour
        self.form = shape.size if shape.kind != "mesh" else _triangles(mesh_of(shape))
        lowest, highest = shape_box(shape)
        self._corners = lowest + _CORNERS * (highest - lowest)
        self.reach = float(np.linalg.norm(self._corners, axis=1).max())

    def meet(self, rays: Rays, part: tuple[slice, slice], pixels: np.ndarray) -> tuple[np.ndarray, Callable[[np.ndarray], np.ndarray]]:
        """(how far along the ray through each of some pixels it is met, its normals there). pixels: numbers of pixels in a part of the
        picture. The normals, n x 3 in the world, are a function of which are wanted, a mask."""
        view = rays.view
        if self.shape.kind == "mesh":
            corners = (self.form @ self.turn.T + self.place - view.place) @ view.turn
            found, numbers = triangles.meet(corners, rays, part, pixels)
            return found, lambda wanted: triangles.normals(self.form[numbers[wanted]]) @ self.turn.T
        eye = (view.place - self.place) @ self.turn
        local = rays.through(pixels, self.turn)
        found = _MEET[self.shape.kind](self.form, eye, local)

        def normals(wanted: np.ndarray) -> np.ndarray:
            places = eye + (found[wanted] * local[:, wanted]).T
            return _NORMALS[self.shape.kind](self.form, places) @ self.turn.T

        return found, normals

    def corners(self) -> np.ndarray:
        """The corners of the box around it, 8 x 3, in the world."""
        return self._corners @ self.turn.T + self.place


def solids_of(world: World) -> list[Solid]:
    """All shapes of a world, where they are now. Of a mesh that has only points the box around them is shown; planes are not."""
    return [solid for thing in world.things.values() for solid in _solids(thing)]


def _solids(thing: Thing) -> Iterator[Solid]:
    if isinstance(thing, Item):
        yield from _placed(thing, None, thing.shapes, thing.placement.position, thing.placement.rotation)
        return
    places, turns = thing.links()
    for link in thing.description.links.values():
        if link.shapes:
            number = thing.skeleton.links[link.name]
            yield from _placed(thing, link.name, link.shapes, places[number], turns[number])


def _placed(thing: Thing, link: str | None, shapes: tuple[Shape, ...], place: np.ndarray, turn: np.ndarray) -> Iterator[Solid]:
    for shape in shapes:
        if shape.kind != "mesh" and shape.kind not in _MEET:
            continue
        position, rotation = np.zeros(3), np.zeros(4)
        mujoco.mju_mulPose(position, rotation, place, turn, np.array(shape.frame.position), np.array(shape.frame.rotation))
        matrix = np.zeros(9)
        mujoco.mju_quat2Mat(matrix, rotation)
        yield Solid(thing, link, shape, position, matrix.reshape(3, 3), colour_of(thing, link))


def _meet_box(size: tuple[float, ...], eye: np.ndarray, rays: np.ndarray) -> np.ndarray:
    enter, leave = np.full(rays.shape[1], -np.inf), np.full(rays.shape[1], np.inf)
    with np.errstate(divide="ignore", invalid="ignore"):
        for axis in range(3):
            inverse = 1.0 / rays[axis]
            one, other = (-size[axis] / 2 - eye[axis]) * inverse, (size[axis] / 2 - eye[axis]) * inverse
            enter, leave = np.fmax(enter, np.fmin(one, other)), np.fmin(leave, np.fmax(one, other))
    found = np.where(enter > NEAR, enter, leave)  # the way out, when the camera is inside
    return np.where((leave >= enter) & (leave > NEAR), found, np.inf)


def _box_normals(size: tuple[float, ...], places: np.ndarray) -> np.ndarray:
    axis = np.argmin(np.abs(np.abs(places) - np.array(size) / 2), axis=1)
    rows, normals = np.arange(len(places)), np.zeros_like(places)
    normals[rows, axis] = np.sign(places[rows, axis])
    return normals


def _roots(a: np.ndarray, b: np.ndarray, c: float) -> np.ndarray:
    """The smallest root of a t² + 2 b t + c that lies ahead; inf where there is none."""
    with np.errstate(divide="ignore", invalid="ignore"):
        root = np.sqrt(b * b - a * c)
        near, far = (-b - root) / a, (-b + root) / a
        found = np.where(near > NEAR, near, far)
        return np.where(found > NEAR, found, np.inf)


def _meet_sphere(size: tuple[float, ...], eye: np.ndarray, rays: np.ndarray) -> np.ndarray:
    return _roots((rays * rays).sum(axis=0), eye @ rays, eye @ eye - size[0] ** 2)


def _meet_cylinder(size: tuple[float, ...], eye: np.ndarray, rays: np.ndarray) -> np.ndarray:
    radius, half = size[0], size[1] / 2
    flat, ground = rays[:2], eye[:2]
    side = _roots((flat * flat).sum(axis=0), ground @ flat, ground @ ground - radius**2)
    with np.errstate(divide="ignore", invalid="ignore"):
        side = np.where(np.abs(eye[2] + side * rays[2]) <= half, side, np.inf)
        cap = (-np.sign(rays[2]) * half - eye[2]) / rays[2]  # of the two ends the nearer one
        where = ground[:, None] + cap * flat
        cap = np.where((cap > NEAR) & ((where * where).sum(axis=0) <= radius**2), cap, np.inf)
    return np.fmin(side, cap)


def _cylinder_normals(size: tuple[float, ...], places: np.ndarray) -> np.ndarray:
    radius, half = size[0], size[1] / 2
    on_end = np.abs(np.abs(places[:, 2]) - half) < np.abs(np.hypot(places[:, 0], places[:, 1]) - radius)
    normals = np.where(on_end[:, None], (0.0, 0.0, 1.0), places / radius)
    normals[:, 2] = np.where(on_end, np.sign(places[:, 2]), 0.0)
    return normals


def _triangles(mesh: Mesh) -> np.ndarray:
    """The corners of the triangles of a mesh, n x 3 x 3."""
    if len(mesh.triangles):
        return mesh.points[mesh.triangles]
    (x, y, z), (u, v, w) = mesh.box
    corners = np.array([[x, y, z], [u, y, z], [u, v, z], [x, v, z], [x, y, w], [u, y, w], [u, v, w], [x, v, w]])
    sides = [(0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]
    return corners[[half for one, two, three, four in sides for half in ((one, two, three), (one, three, four))]]


_MEET: dict[str, Callable[[Any, np.ndarray, np.ndarray], np.ndarray]] = {
    "box": _meet_box,
    "sphere": _meet_sphere,
    "cylinder": _meet_cylinder,
}
_NORMALS: dict[str, Callable[[Any, np.ndarray], np.ndarray]] = {
    "box": _box_normals,
    "sphere": lambda size, places: places / size[0],
    "cylinder": _cylinder_normals,
}
