"""The things of a world as MuJoCo sees them: what touches what, what falls where, what a ray meets.

A `Scene` is made for a set of things and thrown away when the set changes, or when an item is gripped or let go; making one takes some
milliseconds. Links of machines and items that are held have no degrees of freedom here: they are where their things say. Items that are
free have six, and fall when the scene is simulated.

Law: a scene computes from where the things are now (`place`), and writes back only what `settle` moved.
"""

from __future__ import annotations

from collections import deque
from contextlib import contextmanager
from copy import copy
from dataclasses import dataclass
from itertools import takewhile
from typing import TYPE_CHECKING

import numpy as np

from cramhy_runtime.kernel.active import checkpoint

from .meshes import mesh_of
from .mujoco_parts import add_shape, mujoco
from .placements import Placement
from .things import Item, Machine

if TYPE_CHECKING:
    from collections.abc import Hashable, Iterable, Iterator, Sequence

    from .descriptions import Shape
    from .meshes import Mesh
    from .things import Colour, Thing

FLOOR = "floor"
TOUCHING = 1e-3
"""How near two shapes are when they touch, metres."""
STEP = 0.004  # seconds
_STANDING, _ITEM = 1, 2  # kinds in MuJoCo's masks of collisions
_AT_REST = 0.02  # metres and radians a second; cylinders that stand tremble below it
_REST_STEPS = 50
_DEEP = 5e-3  # metres
_BELOW_ALL = -1000.0  # metres
_MOST_LIFTS = 200
_WAYS_OUT = sorted(
    [np.array((0.0, 0.0, number * _DEEP)) for number in range(1, _MOST_LIFTS + 1)]
    + [
        np.array((metres * np.cos(turn), metres * np.sin(turn), up))
        for metres in (0.01, 0.02, 0.03, 0.04)
        for turn in np.arange(8) * np.pi / 4
        for up in (0.0, 0.01, 0.02)
    ],
    key=lambda way: np.hypot(way[0], way[1]) + way[2],
)
"""How an item is moved that is inside of something: as far up as it takes, or a little aside; metres, the shortest first."""
_ASIDE = [metres * np.array((np.cos(turn), np.sin(turn))) for metres in np.arange(0.01, 0.41, 0.01) for turn in np.arange(16) * np.pi / 8]
_SAME_HEIGHT = 0.01  # metres
_ROOM_FOR_A_FINGER = 0.03  # metres, between items that are parted
_MANY = 20  # geoms
_TOGETHER = 25  # steps that are computed in one call; what is at rest is at rest after two calls


class Part:
    """A body of the scene: an item, or one link of a machine."""

    __slots__ = ("body", "geoms", "link", "thing")

    def __init__(self, thing: Item | Machine, link: str | None) -> None:
        self.thing, self.link = thing, link
        self.body, self.geoms = 0, range(0)

    def of_copy(self, thing: Item | Machine) -> Part:
        """The same part of a copy of the thing."""
        part = Part(thing, self.link)
        part.body, part.geoms = self.body, self.geoms
        return part


def _add_body(spec: mujoco.MjSpec, shapes: Sequence[Shape], colour: Colour, mass: float = 0.0, free: bool = False) -> None:
    body = spec.worldbody.add_body(mocap=not free)
    if free:
        body.add_freejoint()
    masks = {"contype": _ITEM, "conaffinity": _ITEM | _STANDING} if free else {"contype": _STANDING, "conaffinity": _ITEM}
    for shape in shapes:
        add_shape(body, shape, spec, rgba=colour, mass=mass / len(shapes), friction=[0.9, 0.01, 0.001], **masks)


@dataclass
class _KeptSpec:
    """A spec with the floor and the links of machines; ``meshes`` are held, since their names in the spec are their identities."""

    height: float
    links: list[tuple[Sequence[Shape], Colour]]
    meshes: list[Mesh]
    spec: mujoco.MjSpec

    def fits(self, height: float, links: list[tuple[Sequence[Shape], Colour]]) -> bool:
        """Whether it has a floor at that height, and links of the very same shapes, in the same colours."""
        same = self.height == height and len(self.links) == len(links)
        return same and all(shapes is known[0] and colour == known[1] for (shapes, colour), known in zip(links, self.links, strict=True))


_kept_specs: deque[_KeptSpec] = deque(maxlen=4)


def _spec_with(height: float, links: list[tuple[Sequence[Shape], Colour]]) -> mujoco.MjSpec:
    """A new spec with a floor at ``height`` (metres) and a body for each of ``links``, which are the shapes and the colour of a link.

    To add the shapes of a kitchen and a robot takes ten times as long as to copy the spec that has them, and a plan that carries things
    makes a scene each time it grips one or lets it go.
    """
    for kept in _kept_specs:
        if kept.fits(height, links):
            return kept.spec.copy()
    spec = mujoco.MjSpec()
    spec.option.timestep = STEP
    spec.worldbody.add_geom(
        name=FLOOR, type=mujoco.mjtGeom.mjGEOM_PLANE, size=[20, 20, 1], pos=[0, 0, height], contype=_STANDING, conaffinity=_ITEM
    )
    for shapes, colour in links:
        _add_body(spec, shapes, colour)
    meshes = [mesh_of(shape) for shapes, _ in links for shape in shapes if shape.kind == "mesh"]
    _kept_specs.appendleft(_KeptSpec(height, links, meshes, spec))
    return spec.copy()


class Scene:
    """Computes contacts, rays and falls of ``things``; ``held``: the names of the items that stay where they are."""

    def __init__(self, things: Iterable[Item | Machine], held: frozenset[Hashable] = frozenset()) -> None:
        self.things, self.held = list(things), held
        # who puts planes into a world says where its floor is
        height = _BELOW_ALL if any(shape.kind == "plane" for thing in self.things for shape in thing.all_shapes()) else 0.0
        first = list(takewhile(lambda thing: isinstance(thing, Machine), self.things))
        self.parts = [Part(machine, link.name) for machine in first for link in machine.description.links.values() if link.shapes]
        spec = _spec_with(height, [(part.thing.description.links[part.link].shapes, part.thing.colour) for part in self.parts])
        self.parts += self._add_parts(spec, self.things[len(first) :])
        self.model = spec.compile()
        self.data = mujoco.MjData(self.model)
        self._find_parts()

    def _add_parts(self, spec: mujoco.MjSpec, things: Iterable[Item | Machine]) -> Iterator[Part]:
        for thing in things:
            if isinstance(thing, Item):
                _add_body(spec, thing.shapes, thing.colour, thing.mass, free=thing.mass > 0 and thing.name not in self.held)
                yield Part(thing, None)
            else:
                for link in thing.description.links.values():
                    if link.shapes:
                        _add_body(spec, link.shapes, thing.colour)
                        yield Part(thing, link.name)

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
        things = np.array([*(numbers[id(part.thing)] for part in self.parts), -1])  # the last one for geoms of no part
        self._thing_of_geom = things[self._part_of_geom]
        self.is_plane = model.geom_type == mujoco.mjtGeom.mjGEOM_PLANE
        self._middle = np.where(self.is_plane[:, None], 0.0, model.geom_aabb[:, :3])
        self._half = np.where(self.is_plane[:, None], 0.0, model.geom_aabb[:, 3:])
        standing = [part.body for part in self.parts if isinstance(part.thing, Machine) and part.thing.fixed]
        self._fixed = np.isin(model.geom_bodyid, standing) | self.is_plane
        machines = [part.body for part in self.parts if isinstance(part.thing, Machine)]
        of_machine = np.isin(model.geom_bodyid, machines)
        self._may_touch = self._thing_of_geom[:, None] != self._thing_of_geom
        self._may_touch &= ~(self._fixed[:, None] & self._fixed)
        self._may_touch &= ~((self.is_plane[:, None] & of_machine) | (of_machine[:, None] & self.is_plane))
        self._machines, self._items = [], []
        parts_of = {id(thing): [] for thing in self.things}
        for part in self.parts:
            parts_of[id(part.thing)].append(part)
        for thing in self.things:
            parts = parts_of[id(thing)]
            mocaps = [int(model.body_mocapid[part.body]) for part in parts]
            if isinstance(thing, Machine):
                self._machines.append((thing, np.array(mocaps, int), np.array([thing.skeleton.links[part.link] for part in parts], int)))
            else:
                joint = model.body_jntadr[parts[0].body]
                self._items.append((thing, mocaps[0], -1 if mocaps[0] >= 0 else int(model.jnt_qposadr[joint])))
        self._free = [part for part in self.parts if model.body_mocapid[part.body] < 0]

    def of_copies(self, copies: Sequence[Item | Machine]) -> Scene:
        """A scene of copies of its things, in the same order, which need no model of their own: that is what takes the time."""
        new = copy(self)
        new.things, new.data = list(copies), mujoco.MjData(self.model)
        of = {id(thing): copied for thing, copied in zip(self.things, copies, strict=True)}
        new.parts = [part.of_copy(of[id(part.thing)]) for part in self.parts]
        new._machines = [(of[id(machine)], *others) for machine, *others in self._machines]
        new._items = [(of[id(item)], *others) for item, *others in self._items]
        free = {part.body for part in self._free}
        new._free = [part for part in new.parts if part.body in free]
        return new

    # ----------------------------------------------------------------------------------------------------------------- places

    def place(self) -> None:
        """Take over where the things are now."""
        model, data = self.model, self.data
        data.qvel[:] = 0
        for machine, mocaps, links in self._machines:
            places, turns = machine.links()
            data.mocap_pos[mocaps], data.mocap_quat[mocaps] = places[links], turns[links]
        for item, mocap, start in self._items:
            if start < 0:
                data.mocap_pos[mocap], data.mocap_quat[mocap] = item.placement
            else:
                data.qpos[start : start + 3], data.qpos[start + 3 : start + 7] = item.placement
        mujoco.mj_kinematics(model, data)

    def boxes(self) -> tuple[np.ndarray, np.ndarray]:
        """(lowest, highest corners) of the boxes along the axes around all geoms, n x 3 each."""
        turned = self.data.geom_xmat.reshape(-1, 3, 3)
        middle = self.data.geom_xpos + np.einsum("gij,gj->gi", turned, self._middle)
        reach = np.einsum("gij,gj->gi", np.abs(turned), self._half)
        return middle - reach, middle + reach

    def around(self, place: np.ndarray) -> np.ndarray:
        """The numbers of the geoms in which a place lies; cylinders and spheres count as the boxes around them."""
        turned = self.data.geom_xmat.reshape(-1, 3, 3)
        local = np.einsum("gji,gj->gi", turned, place - self.data.geom_xpos)
        return np.flatnonzero((np.abs(local - self._middle) <= self._half).all(axis=1))

    def bounds(self, thing: Item | Machine, link: str | None = None) -> tuple[np.ndarray, np.ndarray]:
        """The corners of the box along the axes around a thing, or around one of its links."""
        geoms = self._geoms_in(thing, link)
        if not geoms:
            place = thing.placement.position if link is None else thing.link(link).position
            return place.copy(), place.copy()
        lowest, highest = self.boxes()
        return lowest[geoms].min(axis=0), highest[geoms].max(axis=0)

    def lengths(self, thing: Item | Machine, link: str | None, rotation: np.ndarray) -> np.ndarray:
        """The lengths of the box along the axes that would be around a thing, or around one of its links, if it were turned so.

        rotation: a quaternion (w, x, y, z).
        """
        geoms = self._geoms_in(thing, link)
        if not geoms:
            return np.zeros(3)
        now = thing.placement if link is None else thing.link(link)
        turn = np.zeros(9)
        mujoco.mju_quat2Mat(turn, (Placement(np.zeros(3), rotation) @ now.inverse()).rotation)
        turn = turn.reshape(3, 3)
        turned = turn @ self.data.geom_xmat[geoms].reshape(-1, 3, 3)
        middle = self.data.geom_xpos[geoms] @ turn.T + np.einsum("gij,gj->gi", turned, self._middle[geoms])
        reach = np.einsum("gij,gj->gi", np.abs(turned), self._half[geoms])
        return (middle + reach).max(axis=0) - (middle - reach).min(axis=0)

    def _geoms_in(self, thing: Item | Machine, link: str | None) -> list[int]:
        return [geom for part in self.parts if part.thing is thing and link in (None, part.link) for geom in part.geoms]

    # ------------------------------------------------------------------------------------------------------------------- rays

    @contextmanager
    def without(self, things: Sequence[Item | Machine], group: int) -> Iterator[np.ndarray]:
        """While the block runs, rays pass through these things; the block gets the groups of geoms that rays meet."""
        geoms = np.concatenate([self._geoms_of(thing) for thing in things])
        before = self.model.geom_group[geoms].copy()
        self.model.geom_group[geoms] = group
        groups = np.ones(6, np.uint8)
        groups[group] = 0
        try:
            yield groups
        finally:
            self.model.geom_group[geoms] = before

    def free_ways(self, start: np.ndarray, ends: np.ndarray, groups: np.ndarray) -> np.ndarray:
        """Whether nothing is between a place and each of others, an n x 3 array. groups: as `without` gives them."""
        ways = ends - start
        lengths = np.linalg.norm(ways, axis=1)
        met, distances = np.full(len(ends), -1, np.int32), np.zeros(len(ends))
        directions = (ways / lengths[:, None]).ravel()
        mujoco.mj_multiRay(
            self.model, self.data, start, directions, groups, True, -1, met, distances, None, len(ends), float(lengths.max()) + 0.1
        )
        return (met < 0) | (distances >= lengths)

    # --------------------------------------------------------------------------------------------------------------- contacts

    def contacts(self, of: Item | Machine | None = None) -> list[tuple[Part, Part | None]]:
        """The pairs of parts of different things that touch; ``None`` stands for the floor. of: only those of this thing, which then comes
        first.

        What is fixed, furniture and planes, does not touch each other. Robots do not touch planes either: in CRAM a plane has the collision
        mask of items only.
        """
        lowest, highest = self.boxes()
        mine = np.flatnonzero(self._part_of_geom >= 0) if of is None else self._geoms_of(of)
        near = self._near(lowest, highest, mine, TOUCHING)
        near &= self._may_touch[mine]
        found: dict[tuple[int, int], None] = {}
        for row, other in zip(*map(np.ndarray.tolist, np.nonzero(near)), strict=True):
            geom = mine[row]
            pair = (self._part_of_geom[geom], self._part_of_geom[other])
            if (pair not in found and (of is not None or pair[::-1] not in found)) and self._touch(geom, other):
                found[pair] = None
        return [(self.parts[one], None if other < 0 else self.parts[other]) for one, other in found]

    def _near(self, lowest: np.ndarray, highest: np.ndarray, mine: np.ndarray, distance: float) -> np.ndarray:
        """Which geoms are so near to those of the numbers ``mine``, by the boxes around all: a row of truth values for each of ``mine``."""
        low, high = lowest[mine] - distance, highest[mine] + distance
        near = np.zeros((len(mine), len(lowest)), bool)
        around = slice(None)  # those near the box around all of mine, where it pays to look for them first
        if len(mine) >= _MANY:
            around = np.flatnonzero(((lowest <= high.max(0)) & (highest >= low.min(0))).all(1))
        low_around, high_around = lowest[around], highest[around]
        each = np.ones((len(mine), len(low_around)), bool)
        for axis in range(3):
            each &= (low_around[:, axis] <= high[:, axis, None]) & (high_around[:, axis] >= low[:, axis, None])
        near[:, around] = each
        for plane in np.flatnonzero(self.is_plane):
            normal = self.data.geom_xmat[plane].reshape(3, 3)[:, 2]
            corners = np.where(normal > 0, lowest, highest)
            reaching = (corners - self.data.geom_xpos[plane]) @ normal <= distance
            near[:, plane] = reaching[mine]
            near[mine == plane] = reaching
        return near

    def _geoms_of(self, thing: Item | Machine) -> np.ndarray:
        number = next((number for number, each in enumerate(self.things) if each is thing), -2)  # -1 is no thing's
        return np.flatnonzero(self._thing_of_geom == number)

    def _touch(self, geom: int, other: int) -> bool:
        return mujoco.mj_geomDistance(self.model, self.data, int(geom), int(other), TOUCHING, None) < TOUCHING

    # ------------------------------------------------------------------------------------------------------------------ falls

    def settle(self, seconds: float) -> float:
        """Let the free items fall for so long, or until all are at rest; the seconds that it took. The things have moved then.

        Other tasks may run meanwhile. What they, or a hand from outside, put elsewhere stays there.
        """
        free, model, data = self._free, self.model, self.data
        if not free:
            return 0.0
        steps, done, resting, step = max(1, round(seconds / STEP)), 0, 0, mujoco.mj_step
        velocities, before = data.qvel, [part.thing.placement for part in free]
        while done < steps and resting < _REST_STEPS:
            count = min(_TOGETHER, steps - done)
            step(model, data, count)
            done += count
            resting = resting + count if max(velocities.max(), -velocities.min()) < _AT_REST else 0
            checkpoint()
        self.write_back(part for part, place in zip(free, before, strict=True) if part.thing.placement is place)
        return done * STEP

    def write_back(self, parts: Iterable[Part] | None = None) -> None:
        """Write into the free items where they are in the scene; parts: into these only."""
        for part in self._free if parts is None else parts:
            start = self.model.jnt_qposadr[self.model.body_jntadr[part.body]]
            now = self.data.qpos[start : start + 7].copy()
            part.thing.placement = Placement(now[:3], now[3:])

    def free_all(self) -> list[tuple[Item, Item | Machine | None]]:
        """Lift the free items out of what stands and they are inside of, and part those that are inside of each other.

        Returns the items that cannot be freed, each with what it is in; ``None`` is the floor.
        """
        blockers = [(part, self._lift(part)) for part in self._free]
        freed = [part for part, geom in blockers if geom is None]
        for number, part in enumerate(freed):
            self._part_from(part, [geom for other in freed[:number] for geom in other.geoms])
        stuck = [(part.thing, self._thing_of_geom[geom]) for part, geom in blockers if geom is not None]
        return [(item, None if number < 0 else self.things[number]) for item, number in stuck]

    def _part_from(self, part: Part, others: Sequence[int]) -> None:
        """Put a free item that is inside of one of other geoms aside, to the nearest place with room between at which it stands as high.

        An item for which there is no such place is left to the physics.
        """
        if not self._nearer(part, others, -_DEEP):
            return
        start = self.model.jnt_qposadr[self.model.body_jntadr[part.body]]
        before, height = self.data.qpos[start : start + 2].copy(), self._height_below(part)
        standing = np.flatnonzero((self.model.geom_contype == _STANDING) | self.is_plane)
        for aside in _ASIDE:
            self.data.qpos[start : start + 2] = before + aside
            mujoco.mj_kinematics(self.model, self.data)
            if (
                abs(self._height_below(part) - height) < _SAME_HEIGHT
                and not self._nearer(part, others, _ROOM_FOR_A_FINGER)
                and not self._nearer(part, standing, -_DEEP)
            ):
                return
        self.data.qpos[start : start + 2] = before
        mujoco.mj_kinematics(self.model, self.data)

    def _nearer(self, part: Part, others: Sequence[int] | np.ndarray, distance: float) -> bool:
        """Whether an item is nearer than that to one of other geoms; a negative distance is how deep it is inside."""
        if not len(others):
            return False
        lowest, highest = self.boxes()
        mine = np.array(part.geoms)
        near = self._near(lowest, highest, mine, max(distance, 0.0))[:, others]
        return any(
            mujoco.mj_geomDistance(self.model, self.data, int(mine[row]), int(others[column]), max(distance, 0.0), None) < distance
            for row, column in zip(*np.nonzero(near), strict=True)
        )

    def _height_below(self, part: Part) -> float:
        """How high the thing is that stands below the origin of an item."""
        place = self.data.xpos[part.body].copy()
        with self.without([free.thing for free in self._free], 5) as groups:
            down = mujoco.mj_ray(self.model, self.data, place, np.array([0.0, 0.0, -1.0]), groups, 1, -1, np.zeros(1, np.int32))
        return float(place[2] - down) if down >= 0 else -np.inf

    def _lift(self, part: Part) -> int | None:
        """Bring a free item that is inside of something that stands to where it is no more; a geom that it cannot get out of.

        It goes the shortest of the ways out: up, or aside to where what is below its origin is as high. So a low wall pushes it aside, as
        that of a drawer; raised to the top of the wall, it would topple.
        """
        first = self._blocker(part)
        if first is None:
            return None
        start = self.model.jnt_qposadr[self.model.body_jntadr[part.body]]
        before, level = self.data.qpos[start : start + 3].copy(), self._height_below(part)
        for way in _WAYS_OUT:
            self.data.qpos[start : start + 3] = before + way
            mujoco.mj_kinematics(self.model, self.data)
            if self._blocker(part) is None and (not way[:2].any() or abs(self._height_below(part) - level) < _SAME_HEIGHT):
                return None
        self.data.qpos[start : start + 3] = before
        mujoco.mj_kinematics(self.model, self.data)
        return first

    def _blocker(self, part: Part) -> int | None:
        """A geom that stands and that an item is inside of."""
        for geom in part.geoms:
            depth, other = self._depth(geom)
            if depth > _DEEP:
                return other
        return None

    def _depth(self, geom: int) -> tuple[float, int]:
        """(how deep a geom is inside of what stands, the geom that this is)."""
        lowest, highest = self.boxes()
        near = self._near(lowest, highest, np.array([geom]), 0.0)[0]
        numbers = np.flatnonzero(near & ((self.model.geom_contype == _STANDING) | self.is_plane))
        distances = [mujoco.mj_geomDistance(self.model, self.data, geom, int(other), 0.0, None) for other in numbers]
        if not distances:
            return 0.0, 0
        deepest = int(np.argmin(distances))
        return -distances[deepest], int(numbers[deepest])


@dataclass
class Pattern:
    """A scene, and the things of its world beside their copies, in the same order: a copied world needs no model of its own.

    Whether the copies are still the things of their world is found out only when that world needs a scene; most need none.
    """

    scene: Scene
    things: list[Thing]
    copies: list[Thing]

    def scene_of(self, things: Sequence[Thing], solids: Sequence[Item | Machine], held: frozenset[Hashable]) -> Scene | None:
        """The scene of the copies; ``None`` if these are the ``things`` of their world no more, or others are ``solids`` or ``held``."""
        scene = self.scene
        if scene.held != held or self.copies != things or len(scene.things) != len(solids):
            return None
        copies = dict(zip(map(id, self.things), self.copies, strict=True))
        same = all(copies.get(id(thing)) is solid for thing, solid in zip(scene.things, solids, strict=True))
        return scene.of_copies(solids) if same else None
