"""The things of a world as MuJoCo sees them: what touches what, what falls where, what a ray meets.

A `Scene` is made for a set of things and thrown away when the set changes, or when an item is gripped or let go; making one takes some
milliseconds. Links of machines and items that are held have no degrees of freedom here: they are where their things say. Items that are
free have six, and fall when the scene is simulated.

Law: a scene computes from where the things are now (`place`), and writes back only what `settle` moved.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from cramhy_runtime.kernel.active import checkpoint

from .mujoco_parts import add_shape, mujoco
from .placements import Placement
from .things import Item, Machine

if TYPE_CHECKING:
    from collections.abc import Hashable, Iterable, Iterator

FLOOR = "floor"
TOUCHING = 1e-3
"""How near two shapes are when they touch, metres."""
STEP = 0.004  # seconds
_STANDING, _ITEM = 1, 2  # kinds in MuJoCo's masks of collisions
_AT_REST = 0.02  # metres and radians a second; cylinders that stand tremble below it
_REST_STEPS = 50
_DEEP = 5e-3  # metres


class Part:
    """A body of the scene: an item, or one link of a machine."""

    __slots__ = ("body", "geoms", "link", "thing")

    def __init__(self, thing: Item | Machine, link: str | None) -> None:
        self.thing, self.link = thing, link
        self.body, self.geoms = 0, range(0)


class Scene:
    """Computes contacts, rays and falls of ``things``; ``held``: the names of the items that stay where they are."""

    def __init__(self, things: Iterable[Item | Machine], held: frozenset[Hashable] = frozenset()) -> None:
        self.things, self.held = list(things), held
        spec = mujoco.MjSpec()
        spec.option.timestep = STEP
        spec.worldbody.add_geom(name=FLOOR, type=mujoco.mjtGeom.mjGEOM_PLANE, size=[20, 20, 1], contype=_STANDING, conaffinity=_ITEM)
        self.parts = list(self._add_parts(spec))
        self.model = spec.compile()
        self.data = mujoco.MjData(self.model)
        self._find_parts()

    def _add_parts(self, spec: mujoco.MjSpec) -> Iterator[Part]:
        for thing in self.things:
            if isinstance(thing, Item):
                free = thing.mass > 0 and thing.name not in self.held
                yield self._add(spec, Part(thing, None), thing.shapes, thing.mass, free)
            else:
                for link in thing.description.links.values():
                    if link.shapes:
                        yield self._add(spec, Part(thing, link.name), link.shapes, 0.0, False)

    def _add(self, spec: mujoco.MjSpec, part: Part, shapes: tuple, mass: float, free: bool) -> Part:
        body = spec.worldbody.add_body(mocap=not free)
        if free:
            body.add_freejoint()
        masks = {"contype": _ITEM, "conaffinity": _ITEM | _STANDING} if free else {"contype": _STANDING, "conaffinity": _ITEM}
        for shape in shapes:
            add_shape(body, shape, rgba=part.thing.colour, mass=mass / len(shapes), friction=[0.9, 0.01, 0.001], **masks)
        return part

    def _find_parts(self) -> None:
        model = self.model
        for number, part in enumerate(self.parts, 1):  # bodies are numbered in the order in which they were added, behind the world
            part.body = number
            first = model.body_geomadr[number]
            part.geoms = range(first, first + model.body_geomnum[number])
        self._part_of_geom = np.zeros(model.ngeom, int) - 1
        for number, part in enumerate(self.parts):
            self._part_of_geom[part.geoms.start : part.geoms.stop] = number
        numbers = {id(thing): number for number, thing in enumerate(self.things)}
        self._thing_of_geom = np.array([-1 if part < 0 else numbers[id(self.parts[part].thing)] for part in self._part_of_geom])
        self._half = np.array([_half_size(model.geom_type[geom], model.geom_size[geom]) for geom in range(model.ngeom)])

    # ----------------------------------------------------------------------------------------------------------------- places

    def place(self) -> None:
        """Take over where the things are now."""
        model, data = self.model, self.data
        data.qvel[:] = 0
        for part in self.parts:
            placement = _placement(part)
            mocap = model.body_mocapid[part.body]
            if mocap >= 0:
                data.mocap_pos[mocap], data.mocap_quat[mocap] = placement
            else:
                start = model.jnt_qposadr[model.body_jntadr[part.body]]
                data.qpos[start : start + 3], data.qpos[start + 3 : start + 7] = placement
        mujoco.mj_kinematics(model, data)

    def boxes(self) -> tuple[np.ndarray, np.ndarray]:
        """(lowest, highest corners) of the boxes along the axes around all geoms, n x 3 each."""
        turned = np.abs(self.data.geom_xmat.reshape(-1, 3, 3))
        reach = np.einsum("gij,gj->gi", turned, self._half)
        return self.data.geom_xpos - reach, self.data.geom_xpos + reach

    def around(self, place: np.ndarray) -> np.ndarray:
        """The numbers of the geoms in which a place lies; cylinders and spheres count as the boxes around them."""
        turned = self.data.geom_xmat.reshape(-1, 3, 3)
        local = np.einsum("gji,gj->gi", turned, place - self.data.geom_xpos)
        return np.flatnonzero((np.abs(local) <= self._half).all(axis=1))

    def bounds(self, thing: Item | Machine, link: str | None = None) -> tuple[np.ndarray, np.ndarray]:
        """The corners of the box along the axes around a thing, or around one of its links."""
        geoms = [geom for part in self.parts if part.thing is thing and link in (None, part.link) for geom in part.geoms]
        lowest, highest = self.boxes()
        return lowest[geoms].min(axis=0), highest[geoms].max(axis=0)

    # --------------------------------------------------------------------------------------------------------------- contacts

    def contacts(self, of: Item | Machine | None = None) -> list[tuple[Part, Part | None]]:
        """The pairs of parts of different things that touch; ``None`` stands for the floor. of: only those of this thing, which then comes
        first.

        Two machines that nothing moves, as furniture on its floor, touch where they were built so.
        """
        lowest, highest = self.boxes()
        mine = np.flatnonzero(self._part_of_geom >= 0) if of is None else self._geoms_of(of)
        found: dict[tuple[int, int], None] = {}
        for geom in mine:
            near = ((lowest <= highest[geom] + TOUCHING) & (highest >= lowest[geom] - TOUCHING)).all(axis=1)
            near &= self._thing_of_geom != self._thing_of_geom[geom]
            near[0] = lowest[geom][2] <= TOUCHING  # the floor
            for other in np.flatnonzero(near):
                pair = (self._part_of_geom[geom], self._part_of_geom[other])
                if (pair not in found and (of is not None or pair[::-1] not in found)) and self._touch(geom, other):
                    found[pair] = None
        return [(self.parts[one], None if other < 0 else self.parts[other]) for one, other in found]

    def _geoms_of(self, thing: Item | Machine) -> np.ndarray:
        return np.array([geom for part in self.parts if part.thing is thing for geom in part.geoms], int)

    def _touch(self, geom: int, other: int) -> bool:
        return mujoco.mj_geomDistance(self.model, self.data, int(geom), int(other), TOUCHING, None) < TOUCHING

    # ------------------------------------------------------------------------------------------------------------------ falls

    def settle(self, seconds: float) -> float:
        """Let the free items fall for so long, or until all are at rest; the seconds that it took. The things have moved then.

        An item that is inside of something that stands is lifted out of it first.
        """
        free = [part for part in self.parts if self.model.body_mocapid[part.body] < 0]
        if not free:
            return 0.0
        for part in free:
            self._lift(part)
        steps, resting = max(1, round(seconds / STEP)), 0
        for step in range(1, steps + 1):
            mujoco.mj_step(self.model, self.data)
            resting = resting + 1 if np.abs(self.data.qvel).max() < _AT_REST else 0
            if resting >= _REST_STEPS:
                break
            if not step & 31:
                checkpoint()
        for part in free:
            start = self.model.jnt_qposadr[self.model.body_jntadr[part.body]]
            now = self.data.qpos[start : start + 7].copy()
            part.thing.placement = Placement(now[:3], now[3:])
        return step * STEP

    def _lift(self, part: Part) -> None:
        """Raise a free item that is inside of something that stands, to where it is no more."""
        start = self.model.jnt_qposadr[self.model.body_jntadr[part.body]]
        for _ in range(200):
            if not any(self._depth(geom) > _DEEP for geom in part.geoms):
                return
            self.data.qpos[start + 2] += _DEEP
            mujoco.mj_kinematics(self.model, self.data)

    def _depth(self, geom: int) -> float:
        """How deep a geom is inside of what stands."""
        lowest, highest = self.boxes()
        near = ((lowest <= highest[geom]) & (highest >= lowest[geom])).all(axis=1) & (self.model.geom_contype == _STANDING)
        near[0] = True
        distances = [mujoco.mj_geomDistance(self.model, self.data, int(geom), int(other), 0.0, None) for other in np.flatnonzero(near)]
        return -min(distances, default=0.0)


def _placement(part: Part) -> Placement:
    return part.thing.placement if part.link is None else part.thing.link(part.link)


def _half_size(kind: int, size: np.ndarray) -> np.ndarray:
    """Half the lengths of the box around a geom, in its own frame."""
    if kind == mujoco.mjtGeom.mjGEOM_CYLINDER:
        return np.array([size[0], size[0], size[1]])
    if kind == mujoco.mjtGeom.mjGEOM_SPHERE:
        return np.array([size[0]] * 3)
    return np.zeros(3) if kind == mujoco.mjtGeom.mjGEOM_PLANE else np.array(size)
