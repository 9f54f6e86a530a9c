"""Cameras: where they are, where they look, and how much they see.

A camera looks along its z, with x to the right and y down, as ROS's optical frames do (REP 103). So the frame of a camera is a view.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import radians, tan
from typing import TYPE_CHECKING

import numpy as np

from ..mujoco_parts import mujoco
from ..things import Machine
from .solids import solids_of

if TYPE_CHECKING:
    from ..placements import Placement
    from ..things import Thing
    from ..world import World

OPENING = radians(50)
"""How high the picture is, as an angle: that of the robot's camera (``vision.py``)."""
OPTICAL = "optical_frame"
"""How names of links end that are cameras."""
_FROM = np.array([-0.6, -0.5, 0.72]) / np.linalg.norm([-0.6, -0.5, 0.72])  # the side from which a world is seen when nobody says from where
_SHAPE = 4 / 3  # of the picture that all is to have room in
_MARGIN = 1.04


@dataclass(frozen=True, eq=False)
class View:
    """A camera. place: metres in the world. turn: 3 x 3, its columns are where right, down and ahead are in the world. opening: radians."""

    place: np.ndarray
    turn: np.ndarray
    opening: float = OPENING


class Rays:
    """The rays through the middles of the pixels of a picture; each goes 1 m ahead along the axis of the camera.

    across, down: where they are beside the axis then, by columns and by rows. pixel: how large a pixel is there.
    """

    def __init__(self, view: View, width: int, height: int) -> None:
        self.view, self.width, self.height = view, width, height
        half = tan(view.opening / 2)
        self.pixel = 2 * half / height
        self.across = ((np.arange(width) + 0.5) / width * 2 - 1) * half * width / height
        self.down = ((np.arange(height) + 0.5) / height * 2 - 1) * half

    def through(self, pixels: np.ndarray, frame: np.ndarray) -> np.ndarray:
        """The directions through the pixels of these numbers, counted row by row, in a frame whose axes are the columns: 3 x n."""
        right, down, ahead = (frame.T @ self.view.turn).T[:, :, None]
        row, column = np.divmod(pixels, self.width)
        return right * self.across[column] + down * self.down[row] + ahead


def looking_at(place: object, target: object, opening: float = OPENING) -> View:
    """A view from ``place`` to ``target``, upright. Errors: ValueError, when the two are the same place, or are not finite."""
    eye, goal = np.array(place, float), np.array(target, float)
    if not (np.isfinite(eye).all() and np.isfinite(goal).all()):
        raise ValueError(f"a camera stands and looks at places with finite coordinates, but not at {place} and {target}.")
    ahead = goal - eye
    length = np.linalg.norm(ahead)
    if length < 1e-9:
        raise ValueError(f"a camera at {place} cannot look at the place where it is.")
    ahead = ahead / length
    right = np.cross(ahead, (0.0, 0.0, 1.0))
    if np.linalg.norm(right) < 1e-9:  # straight up or down
        right = np.array([1.0, 0.0, 0.0])
    right = right / np.linalg.norm(right)
    return View(eye, np.stack([right, np.cross(ahead, right), ahead], axis=1), opening)


def from_placement(camera: Placement, opening: float = OPENING) -> View:
    """The view of a camera whose optical frame is there."""
    turn = np.zeros(9)
    mujoco.mju_quat2Mat(turn, camera.rotation)
    return View(np.array(camera.position), turn.reshape(3, 3), opening)


def camera_links(thing: Thing) -> list[str]:
    """The links of a robot that are cameras: those with the name of an optical frame."""
    return [link for link in thing.skeleton.links if link.endswith(OPTICAL)] if isinstance(thing, Machine) else []


def robots_view(world: World, link: str | None = None) -> View:
    """What the first robot with a camera sees with it, or with the camera ``link``. Errors: ValueError, when there is none."""
    cameras = [(machine, name) for machine in world.machines() for name in camera_links(machine)]
    for machine, name in cameras:
        if link in (None, name):
            return from_placement(machine.link(name))
    known = ", ".join(name for _, name in cameras)
    raise ValueError(
        f"there is no camera {link}; there are {known}."
        if link and known
        else "no robot of the world has a camera (a link ..._optical_frame)."
    )


def overview(world: World) -> View:
    """A view of everything, obliquely from above."""
    solids = solids_of(world)
    if not solids:
        return looking_at(_FROM * 3, (0.0, 0.0, 0.0))
    corners = np.concatenate([solid.corners() for solid in solids])
    middle = (corners.min(axis=0) + corners.max(axis=0)) / 2
    view = looking_at(middle + _FROM, middle)
    beside, ahead = np.abs((corners - middle) @ view.turn[:, :2]), (corners - middle) @ view.turn[:, 2]
    half = tan(OPENING / 2)
    away = (beside / (half * _SHAPE, half)).max(axis=1) - ahead
    return looking_at(middle + _FROM * max(0.3, float(away.max()) * _MARGIN), middle)
