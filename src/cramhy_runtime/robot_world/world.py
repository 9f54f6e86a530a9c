"""A world of robots, furniture and objects, as CRAM's projection sees it: things stand where they are put, and what is let go falls.

A robot teleports, its arms are where its joints say, and what it holds goes with it. Nothing takes time but `simulate`, in which free
items fall until they lie. A world is copied in well under a millisecond, so a plan can try what it is going to do.

Law: after each function the things are consistent: what is held is where its link holds it. The same calls give the same world, to the bit.
"""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING, TypeVar

import numpy as np

from cramhy_runtime.lisp_core.condition_types import SimpleError
from cramhy_runtime.lisp_core.conditions import error
from cramhy_runtime.lisp_core.data import list_from

from . import shown
from .mesh_files import MeshError
from .meshes import mesh_of
from .placements import Placement, placement
from .scene import FLOOR, Part, Pattern, Scene
from .skeleton import Skeleton, skeleton_of
from .things import GREY, Colour, Grip, Item, Machine, Thing

if TYPE_CHECKING:
    from collections.abc import Hashable, Iterator, Mapping, Sequence

    from .descriptions import Description, Shape


T = TypeVar("T", bound=Thing)


class WorldError(SimpleError):
    """Something was asked of a world that it cannot do: a thing that is not there, a name that is taken, a link that there is not."""

    lisp_name = "ROBOT-WORLD::WORLD-ERROR"


class World:
    """Things by their names, in the order in which they were added."""

    lisp_name = "ROBOT-WORLD::WORLD"

    def __init__(self) -> None:
        self.things: dict[Hashable, Thing] = {}
        self.ignored: list[tuple[Hashable, Hashable]] = []  # pairs of names whose contacts do not count
        self.stuck: list[tuple[Item, Thing | None]] = []  # items that the last `simulate` could not free, and what they are in
        self.let_go: list[tuple[Hashable, Hashable]] = []  # names of robots, and of items that they may still have between their fingers
        self._scene: Scene | None = None
        self._pattern: Pattern | None = None  # for the first scene of a world that is a copy
        self._placed = False
        self._trials = 0

    @contextmanager
    def trial(self) -> Iterator[None]:
        """During the block nobody is told of changes: what is only tried, and taken back, is not seen."""
        self._trials += 1
        try:
            yield
        finally:
            self._trials -= 1
            self._tell()

    def _tell(self) -> None:
        if not self._trials:
            shown.changed(self)

    # ----------------------------------------------------------------------------------------------------------------- things

    def add_item(
        self,
        name: Hashable,
        shapes: Sequence[Shape],
        at: Placement | None = None,
        *,
        mass: float = 0.2,
        colour: Colour = GREY,
        types: Sequence[Hashable] = (),
        drawn: bool = False,
    ) -> Item:
        """Add a rigid object. See `Item` for the arguments. Errors: `WorldError`, when the name is taken."""
        return self._add(Item(name, tuple(shapes), at or placement(), mass, colour, tuple(types), drawn))

    def add_machine(
        self,
        name: Hashable,
        description: Description | Skeleton,
        at: Placement | None = None,
        joints: Mapping[str, float] | None = None,
        *,
        fixed: bool = False,
    ) -> Machine:
        """Add a robot, or furniture, with the given positions of its joints, the others 0. See `Machine` for ``fixed``.

        Errors: `WorldError`, when the name is taken.
        """
        skeleton = description if isinstance(description, Skeleton) else skeleton_of(description)
        return self._add(Machine(name, skeleton, at or placement(), skeleton.positions(joints or {}), fixed=fixed))

    def _add(self, thing: T) -> T:
        if thing.name in self.things or isinstance(thing.name, str) and thing.name == FLOOR:
            error(WorldError("there is a thing named ~S already.", thing.name))
        for shape in thing.all_shapes():
            if shape.kind == "mesh":
                try:
                    mesh_of(shape)
                except MeshError as problem:
                    error(WorldError("the mesh of ~S cannot be read: ~A", thing.name, str(problem)))
        self.things[thing.name] = thing
        thing.world = self
        self._scene = None
        self._tell()
        return thing

    def let_stay(self, name: Hashable, stays: bool) -> None:
        """From now on the item ``name`` does not fall, or does so again."""
        thing = self.thing(name)
        if isinstance(thing, Item) and thing.stays != stays:
            thing.stays, self._scene = stays, None

    def remove(self, name: Hashable) -> None:
        """Take a thing away; who holds it holds it no more. Errors: `WorldError`, when it is not there."""
        thing = self.thing(name)
        del self.things[name]
        thing.world = None
        for machine in self.machines():
            machine.holds.pop(name, None)
        self._scene = None
        self._tell()

    def thing(self, name: Hashable) -> Thing:
        """The thing of that name. Errors: `WorldError`, when there is none."""
        found = self.things.get(name)
        if found is None:
            return error(WorldError("there is no thing named ~S; there are ~:[none~;~:*~{~S~^, ~}~].", name, list_from(self.things)))
        return found

    def item(self, name: Hashable) -> Item:
        """The item of that name. Errors: `WorldError`."""
        found = self.thing(name)
        if not isinstance(found, Item):
            error(WorldError("~S has joints; an item was expected.", name))
        return found

    def machine(self, name: Hashable) -> Machine:
        """The robot, or furniture, of that name. Errors: `WorldError`."""
        found = self.thing(name)
        if not isinstance(found, Machine):
            error(WorldError("~S has no joints; a robot or furniture was expected.", name))
        return found

    def items(self) -> list[Item]:
        return [thing for thing in self.things.values() if isinstance(thing, Item)]

    def machines(self) -> list[Machine]:
        return [thing for thing in self.things.values() if isinstance(thing, Machine)]

    # ----------------------------------------------------------------------------------------------------------------- places

    def put(self, name: Hashable, at: Placement) -> None:
        """Put a thing there; a machine takes with it what it holds. Errors: `WorldError`."""
        thing = self.thing(name)
        if isinstance(thing, Item):
            thing.placement = at
        else:
            thing.stand(at)
            carry(self, thing)
        self._placed = False
        self._tell()

    def bend(self, name: Hashable, joints: Mapping[str, float]) -> None:
        """Set joints of a machine, whatever their limits. Errors: `WorldError`, for joints that it has not."""
        machine = self.machine(name)
        for joint in joints:
            if joint not in machine.skeleton.joint_numbers:
                error(WorldError("~S has no joint ~A that moves.", name, joint))
        machine.bend(joints)
        carry(self, machine)
        self._placed = False
        self._tell()

    def link(self, name: Hashable, link: str) -> Placement:
        """Where a link of a machine is. Errors: `WorldError`, for a link that it has not."""
        machine = self.machine(name)
        if link not in machine.skeleton.links:
            error(WorldError("~S has no link ~A.", name, link))
        return machine.link(link)

    # ------------------------------------------------------------------------------------------------------------------ grips

    def attach(self, name: Hashable, item: Hashable, link: str, loose: bool = False, grasp: Hashable = None) -> None:
        """Let a link of a machine hold an item from now on, as it is now. loose, grasp: see `Grip`."""
        machine, held = self.machine(name), self.item(item)
        machine.holds.setdefault(item, []).append(Grip(link, self.link(name, link).inverse() @ held.placement, loose, grasp))
        self.let_go = [pair for pair in self.let_go if pair != (name, item)]
        self._scene = None
        self._tell()

    def detach(self, name: Hashable, item: Hashable, link: str | None = None) -> None:
        """Let an item go, by default all links. It stays where it is until the world is simulated."""
        machine = self.machine(name)
        grips = [grip for grip in machine.holds.pop(item, ()) if link is not None and grip.link != link]
        if grips:
            machine.holds[item] = grips
        elif not machine.fixed and (name, item) not in self.let_go:
            self.let_go.append((name, item))
        self._scene = None
        self._tell()

    def holders(self, item: Hashable) -> list[tuple[Machine, str]]:
        """The machines and links that hold an item."""
        return [(machine, grip.link) for machine in self.machines() for grip in machine.holds.get(item, ())]

    # ---------------------------------------------------------------------------------------------- what happens between things

    def solids(self) -> list[Thing]:
        """The things that can be touched: all but drawings."""
        return [thing for thing in self.things.values() if not (isinstance(thing, Item) and thing.drawn)]

    @property
    def scene(self) -> Scene:
        """The things as MuJoCo sees them, where they are now."""
        if self._scene is None:
            solids, held, pattern = self.solids(), held_in(self), self._pattern
            copied = pattern and pattern.scene_of(list(self.things.values()), solids, held)
            self._scene, self._placed, self._pattern = copied or Scene(solids, held), False, None
        if not self._placed:
            self._scene.place()
            self._placed = True
        return self._scene

    def contacts(self, name: Hashable | None = None) -> list[tuple[Part, Part | None]]:
        """What touches what, or touches the thing ``name``: see `Scene.contacts`."""
        return self.scene.contacts(None if name is None else self.thing(name))

    def touching(self, name: Hashable) -> list[Thing]:
        """The things that touch the thing ``name``, in the order of the world; the floor is not among them."""
        others = {id(other.thing) for _, other in self.contacts(name) if other is not None}
        return [thing for thing in self.things.values() if id(thing) in others]

    def bounds(self, name: Hashable, link: str | None = None) -> tuple[np.ndarray, np.ndarray]:
        """The lowest and the highest corner of the box along the axes around a thing, or around one of its links."""
        thing = self.thing(name)
        return _scene_with(self, thing).bounds(thing, link)

    def lengths(self, name: Hashable, link: str | None, rotation: np.ndarray) -> np.ndarray:
        """The lengths of the box along the axes that would be around a thing, or one of its links, if it were turned so: (w, x, y, z)."""
        thing = self.thing(name)
        return _scene_with(self, thing).lengths(thing, link, rotation)

    def simulate(self, seconds: float, without: Hashable | None = None) -> float:
        """Let free items fall for so long, or until all are at rest; the seconds that it took.

        An item that is inside of something that stands is lifted out of it first, and of two that are inside of each other the later one is
        put aside. One that cannot be lifted, as in a wall, stays where it is; `stuck` tells of it.

        A robot touches nothing meanwhile while it touches an item that it let go: its fingers would throw the item away.

        without: the name of a machine that touches nothing meanwhile, wherever its hands are.
        """
        held = held_in(self)
        absent = {without, *_still_around(self)}
        things = [thing for thing in self.solids() if thing.name not in absent]
        scene = self.scene
        if len(things) < len(scene.things):
            scene = Scene(things, held)
            scene.place()
        self.stuck = scene.free_all()
        if self.stuck:
            scene = Scene(things, held | {item.name for item, _ in self.stuck})
            scene.place()
            scene.free_all()
        took = scene.settle(seconds)
        self._placed = False
        self._tell()
        return took

    def stable(self, name: Hashable, metres: float = 0.005, radians: float = 0.15) -> bool:
        """Whether an item would still be where it is after five seconds."""
        ahead = self.copy()
        ahead.simulate(5.0)
        return self.item(name).placement.near(ahead.item(name).placement, metres, radians)

    def copy(self, into: World | None = None) -> World:
        """A world with the same things at the same places, which goes its own way. ``into``: a kinematic world that becomes it."""
        new = World() if into is None else into
        new.things, new.ignored, new.stuck, new._scene, new._placed = {}, list(self.ignored), [], None, False
        new.let_go, new._pattern = list(self.let_go), None
        for name, thing in self.things.items():
            new.things[name] = copied = thing.copy()
            copied.world = new
        things, pattern = list(self.things.values()), self._pattern
        if self._scene is not None:
            new._pattern = Pattern(self._scene, things, list(new.things.values()))
        elif pattern is not None and pattern.copies == things:
            new._pattern = Pattern(pattern.scene, pattern.things, list(new.things.values()))
        if into is not None:
            into._tell()
        return new


def carry(world: World, machine: Machine) -> None:
    """Put what a machine holds to where the links are that hold it."""
    for name, grips in machine.holds.items():
        grip = next((grip for grip in grips if not grip.loose), grips[0])
        world.item(name).placement = machine.link(grip.link) @ grip.offset


def held_in(world: World) -> frozenset[Hashable]:
    """The names of the items that do not fall: a machine holds them, or they stay."""
    held = frozenset(item for machine in world.machines() for item in machine.holds)
    return held | {thing.name for thing in world.things.values() if isinstance(thing, Item) and thing.stays}


def _scene_with(world: World, thing: Thing) -> Scene:
    """The scene; for a drawing, which is not in it, one of its own."""
    scene = world.scene
    if thing not in scene.things:
        scene = Scene([thing])
        scene.place()
    return scene


def _still_around(world: World) -> set[Hashable]:
    """The names of the robots that touch an item that they let go. Items that they touch no more are forgotten."""
    world.let_go = [
        (name, item)
        for name, item in world.let_go
        if name in world.things and item in world.things and any(thing.name == name for thing in world.touching(item))
    ]
    return {name for name, _ in world.let_go}
