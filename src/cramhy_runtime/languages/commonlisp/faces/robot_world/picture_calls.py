"""The functions of the Lisp package ROBOT-WORLD that make pictures and movies of a world."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from cramhy_runtime.lisp_core.condition_types import SimpleError
from cramhy_runtime.lisp_core.conditions import error
from cramhy_runtime.lisp_core.data import Cons, python_list
from cramhy_runtime.lisp_core.numbers import is_real
from cramhy_runtime.lisp_core.packages import is_symbol, symbol_name
from cramhy_runtime.robot_world.pictures import movies, stills, views
from cramhy_runtime.robot_world.placements import of_pose
from cramhy_runtime.transforms.poses import Pose
from cramhy_runtime.transforms.vectors import Vector3

from ...files.files import path_of
from ...pathnames.pathnames import namestring

if TYPE_CHECKING:
    from cramhy_runtime.robot_world.pictures.views import View
    from cramhy_runtime.robot_world.world import World

LISP_NAMES = "save-picture begin-movie end-movie check-movie"


def _view(world: World, camera: Any) -> View | None:
    """A camera as users name it: nil is ours, :ROBOT the robot's, a string one of its camera links, a pose an optical frame, and a list of
    two places the eye and where it looks."""
    try:
        if camera is None:
            return None
        if isinstance(camera, str):
            return views.robots_view(world, str(camera))
        if is_symbol(camera) and symbol_name(camera) == "ROBOT":
            return views.robots_view(world)
        if isinstance(camera, Pose):
            return views.from_placement(of_pose(camera))
        if isinstance(camera, Cons):
            eye, target = map(_place, python_list(camera))
            return views.looking_at(eye, target)
    except ValueError as problem:
        return error(SimpleError("~a", f"There is no picture from there: {problem}"))
    return error(
        SimpleError(
            "~S is no camera. A camera is :ROBOT, the name of a camera link, a pose whose z axis looks ahead, or a list of two places: the "
            "eye, and where it looks.",
            camera,
        )
    )


def _place(place: Any) -> tuple[float, ...]:
    if isinstance(place, Vector3):
        return (float(place.x), float(place.y), float(place.z))
    numbers = python_list(place) if isinstance(place, Cons) else []
    if len(numbers) != 3 or not all(map(is_real, numbers)):
        raise ValueError("a place is a list of three numbers, x y z, or a 3d-vector.")
    return tuple(map(float, numbers))


def _pixels(number: Any) -> int:
    if not isinstance(number, int) or isinstance(number, bool):
        return error(SimpleError("A picture is so many pixels wide and high, an integer, but not ~S.", number))
    return number


def _frames(number: Any) -> int:
    if not isinstance(number, int) or isinstance(number, bool) or number < 1:
        return error(SimpleError("A movie has so many frames at most, a positive integer, but not ~S.", number))
    return number


def save_picture(world: World, path: Any, *, camera: Any = None, width: Any = stills.WIDTH, height: Any = stills.HEIGHT) -> Any:
    """Write a picture of a world to a PNG file; returns the path."""
    stills.save(world, path_of(path), _view(world, camera), _pixels(width), _pixels(height), called=namestring(path))
    return path


def check_movie(path: Any) -> None:
    """An error for the name of a file that is no movie's."""
    movies.check(path_of(path), namestring(path))


def begin_movie(
    world: World | None, *, camera: Any = None, width: Any = movies.WIDTH, height: Any = movies.HEIGHT, frames: Any = movies.MOST_FRAMES
) -> movies.Movie:
    """Record what happens from now on in the world that is shown; ``world`` is the one that ``camera`` is in."""
    movie = movies.Movie(None, None if camera is None else _view(world, camera), _pixels(width), _pixels(height), _frames(frames))
    movie.begin()
    return movie


def end_movie(movie: movies.Movie, path: Any) -> Any:
    """Record no more, and write the movie to a GIF file; returns the path."""
    movie.end()
    movie.save(path_of(path), namestring(path))
    return path
