"""The current world of the robot, in Python's words. Names of things are names in Lisp: ``"bottle-1"`` is ``:bottle-1``."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from math import atan2, degrees
from typing import Any

from cramhy_runtime.cpl.failures.python_exceptions import for_python
from cramhy_runtime.lisp_core.data import Symbol, list_from
from cramhy_runtime.lisp_core.packages import find_package_or_error, keyword, sym
from cramhy_runtime.robot_world.placements import Placement, of_pose
from cramhy_runtime.robot_world.pictures import movies, stills, views
from cramhy_runtime.tf.stamped import PoseStamped, copy_pose_stamped

from .libraries import lisp, load
from .poses import Place, at, pose_of

Name = str | Symbol
Point = tuple[float, float, float]
Camera = tuple[Point, Point] | str | None
MODES = ("kinematic", "physical")
"""How a world may be; see `world`."""


class World:
    """The world in which the robot is now; all objects of this class are about the same one, the current."""

    def __repr__(self) -> str:
        return f"<the world of the robot, with {', '.join(self.names()) or 'nothing to take'}>"

    @property
    def core(self) -> Any:
        """The `robot_world.world.World` below, which can be copied to look ahead."""
        return lisp("CRAM-BULLET-REASONING", "current_bullet_world")

    @for_python
    def spawn(
        self,
        type: str,  # noqa: A002
        place: Place,
        name: Name | None = None,
        mass: float = 0.2,
        colour: tuple[float, float, float] | None = None,
    ) -> str:
        """Put an object of a type, such as ``"bottle"``, somewhere. Returns its name: by default the type and a number.

        mass: kilograms; colour: red, green and blue from 0 to 1, by default that of the type.
        Errors: a type of which there is no model, a name that is taken.
        """
        taken = set(self.names())
        number = next(number for number in range(1, len(taken) + 2) if f"{type}-{number}" not in taken)
        symbol = _symbol(name or f"{type}-{number}")
        if text(symbol) in taken:
            raise ValueError(f"There is a thing named {text(symbol)} already; there are {', '.join(sorted(taken))}.")
        lisp("CRAM-BULLET-REASONING-UTILITIES", "spawn_object")(
            symbol,
            keyword(type.upper()),
            sym(":POSE"),
            pose_of(place),
            sym(":MASS"),
            mass,
            sym(":COLOR"),
            None if colour is None else list_from(map(float, colour)),
        )
        return text(symbol)

    @for_python
    def remove(self, name: Name) -> None:
        """Take an object away."""
        self.core.remove(self._thing(name).name)

    @for_python
    def move(self, name: Name, place: Place) -> None:
        """Put a thing somewhere else, as a hand would; the robot does not notice."""
        self.core.put(self._thing(name).name, of_pose(pose_of(place)))

    @for_python
    def settle(self, seconds: float = 10.0) -> None:
        """Let what is free fall, until it lies, so many seconds at most. Of a thing that is stuck inside of another one a warning tells."""
        self.core.simulate(seconds)
        for item, other in self.core.stuck:
            inside = "the floor" if other is None else text(other.name)
            what = f"{text(item.name)} is inside of {inside} and cannot get out of it"
            warnings.warn(f"{what}. It stays where it is: move() puts it elsewhere.", stacklevel=2)

    def names(self) -> list[str]:
        """The names of all objects that are neither robot nor furniture, in the order in which they came."""
        return [text(item.name) for item in self.core.items() if item.types]  # the floor is an item without a type

    @for_python
    def pose(self, name: Name | None = None) -> PoseStamped:
        """Where a thing is; by default the robot."""
        placement: Placement = (self.robot if name is None else self._thing(name)).placement
        x, y, z = map(float, placement.position)
        made = at(x, y, z)
        return copy_pose_stamped(made, orientation=placement.pose().orientation)

    def place(self, name: Name | None = None) -> tuple[float, float, float]:
        """Where a thing is, in whole millimetres; by default the robot."""
        origin = self.pose(name).origin
        return (round(origin.x, 3), round(origin.y, 3), round(origin.z, 3))

    def yaw(self, name: Name | None = None) -> float:
        """How far a thing is turned about the vertical axis, in degrees; by default the robot."""
        turn = self.pose(name).orientation
        return degrees(atan2(2 * (turn.w * turn.z + turn.x * turn.y), 1 - 2 * (turn.y * turn.y + turn.z * turn.z)))

    @for_python
    def save_picture(self, path: str, camera: Camera = None, width: int = stills.WIDTH, height: int = stills.HEIGHT) -> None:
        """Write a picture of the world to a PNG file.

        camera: by default one that shows all of it; ``"robot"``, the robot's; or two places, the eye and where it looks, metres. width,
        height: pixels. Errors: a file-error, when it cannot be written; a simple error for the name of another kind of file.
        """
        stills.save(self.core, path, self._view(camera), width, height)

    @contextmanager
    def movie(
        self, path: str, camera: Camera = None, width: int = movies.WIDTH, height: int = movies.HEIGHT, frames: int = movies.MOST_FRAMES
    ) -> Iterator[None]:
        """Write what happens in the block to a GIF file, each motion for as long as it would take; also when the block fails.

        frames: how many there are at most; a long run is shown faster then. The rest as for `save_picture`.
        """
        movies.check(path)
        movie = movies.Movie(None, self._view(camera), width, height, frames)
        movie.begin()
        try:
            yield
        finally:
            movie.end()
            movie.save(path)

    def _view(self, camera: Camera) -> views.View | None:
        if camera is None:
            return None
        if isinstance(camera, str):
            if camera != "robot":
                raise ValueError(f'The camera is "robot", or two places, the eye and where it looks, not {camera!r}.')
            return views.robots_view(self.core)
        eye, target = camera
        return views.looking_at(eye, target)

    def picture(self) -> dict[str, tuple[float, float, float]]:
        """Where each object is, by its name."""
        return {name: self.place(name) for name in self.names()}

    def held(self) -> dict[str, str]:
        """The arm that holds each object that is held, by the object's name."""
        names = lisp("CRAMHY-ROBOT", "objects_held")() or ()
        return {text(name): text(lisp("CRAMHY-ROBOT", "arm_that_holds")(name)) for name in names}

    @for_python
    def touching(self, name: Name) -> list[str]:
        """The names of the things that touch a thing."""
        return [text(thing.name) for thing in self.core.touching(self._thing(name).name)]

    @property
    def robot(self) -> Any:
        """The robot, a `robot_world.things.Machine`."""
        return lisp("CRAM-BULLET-REASONING", "get_robot_object")()

    def _thing(self, name: Name) -> Any:
        wanted = text(name)
        for thing in self.core.things.values():
            if text(thing.name) == wanted:
                return thing
        raise KeyError(f"There is nothing named {wanted}; there are {', '.join(self.names()) or 'no objects'}.")


@for_python
def world(description: str | None = None, mode: str = "kinematic") -> World:
    """Begin with a new world: the kitchen, and the robot with its arms parked at the origin.

    description: the system that describes the robot, such as ``"cram_porter_description"``; by default that of the PR2. mode:
    ``"kinematic"``, in which motions happen at once and what is let go falls, or ``"physical"``, in which controllers move the joints in
    the kernel's time, fingers hold by friction, and what slips falls. Errors: ImportError without the extra ``robot``; ValueError, when
    this image has another robot, and for another mode.
    """
    if mode not in MODES:
        raise ValueError(f"The mode of a world is {' or '.join(map(repr, MODES))}, not {mode!r}.")
    load(description)
    # not by `sym`, which remembers the symbol of the first image: each image loads the library for itself
    find_package_or_error("CRAM-BULLET-REASONING-BELIEF-STATE").intern("*WORLD-MODE*").value = keyword(mode.upper())
    lisp("CRAM-OCCASIONS-EVENTS", "clear_belief")()
    return World()


def _symbol(name: Name) -> Symbol:
    return name if isinstance(name, Symbol) else keyword(name.upper())


def text(name: Any) -> str:
    """A name of Lisp as Python writes it: in small letters, without package."""
    return (name.name if isinstance(name, Symbol) else str(name)).lower()
