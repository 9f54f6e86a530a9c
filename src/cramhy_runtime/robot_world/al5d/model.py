"""The arm, the table, the bricks and the camera: sizes, limits, colours.

The arm is ``lynxmotion_al5d.urdf`` in the definitions of its ROS package. A brick is one of 4 by 2 studs: 31.8 x 15.8 mm, 9.6 mm high
without the studs; its origin is the middle of its bottom. The camera hangs 250 mm above the middle of the workspace; in its picture, x goes
to the right and y up.
"""

from __future__ import annotations

import functools
from math import atan, pi, tan

import numpy as np

from ..descriptions import Description, Frame, Shape
from ..pictures.views import View
from ..placements import Placement, placement
from ..simulated_robot import ArmParts, RobotParts
from ..urdf import read_file
from ...ros.definition_files import OURS

NAME = "al5d"
"""What the world calls the arm."""
JOINTS = ("Joint1", "Joint2", "Joint3", "Joint4", "Joint5", "Gripper")
"""The joints as commands and joint states have them: five angles in rad, and the distance of the fingers in metres."""
FINGERS = ("left_finger_joint", "right_finger_joint")
HOME = (0.0, pi / 2, -pi / 2, 0.0, 0.0, 0.03175)
"""Where the arm is when the simulator starts."""
RESET = (0.0, 1.57, -1.57, 0.0, 0.0, 0.03)
"""Where the service ``reset`` sends it."""
TABLE = (1.0, 0.8, 0.04)
"""Metres; its top is at height 0."""
FLOOR = -0.75
"""How high the floor is: a brick that falls from the table lies there."""
BRICK = (0.0318, 0.0158, 0.0096)
"""Metres, without the studs."""
STUD = (0.0024, 0.0018)
"""Radius and height."""
PITCH = 0.008
"""The distance of the middles of two studs."""
BRICK_MASS = 0.0023
"""Kilograms."""
COLOURS = {"red": (0.79, 0.1, 0.04, 1.0), "green": (0.14, 0.48, 0.24, 1.0), "blue": (0.05, 0.21, 0.75, 1.0)}
WIDTH, HEIGHT = 640, 480
"""Pixels of the camera's picture."""
CAMERA = (0.0, 0.17, 0.25)
"""Where the camera is, in metres."""
WIDE = 1.2
"""Radians: the camera's horizontal opening."""
_WOOD = (0.87, 0.84, 0.78, 1.0)


@functools.cache
def described() -> Description:
    """The description of the arm."""
    return read_file(OURS / "lynxmotion_al5d_description" / "urdf" / "lynxmotion_al5d.urdf")


PARTS = RobotParts(
    torso="",
    pan="",
    tilt="",
    cameras=(),
    arms={
        NAME: ArmParts(
            joints=JOINTS[:5],
            base="base",
            tip="gripper",
            tool=placement((0.0, 0.05, 0.0)),
            fingers=FINGERS,
            hand=("left_finger", "right_finger"),
            open=HOME[5] / 2,
            factor=0.5,
        )
    },
)


def positions(command: tuple[float, ...] | np.ndarray) -> dict[str, float]:
    """The positions of the joints of the description for six numbers of a command: a finger goes half of their distance."""
    return dict(zip(JOINTS[:5], command[:5])) | dict.fromkeys(FINGERS, command[5] / 2)


def brick_shapes() -> tuple[Shape, ...]:
    """What a brick is made of: a box with eight studs on it."""
    long, wide, high = BRICK
    body = Shape("box", (long, wide, high), Frame((0.0, 0.0, high / 2)))
    places = [((column - 1.5) * PITCH, (row - 0.5) * PITCH) for column in range(4) for row in range(2)]
    return (body, *(Shape("cylinder", STUD, Frame((x, y, high + STUD[1] / 2))) for x, y in places))


def table() -> tuple[tuple[Shape, ...], Placement, tuple[float, ...]]:
    """(shapes, place, colour) of the table. Its top is a hair above the floor that pictures draw at height 0."""
    return (Shape("box", TABLE),), placement((0.0, 0.15, 1e-6 - TABLE[2] / 2)), _WOOD


def camera() -> View:
    """The camera that looks down on the workspace."""
    turn = np.array([[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]]).T
    return View(np.array(CAMERA), turn, 2 * atan(tan(WIDE / 2) * HEIGHT / WIDTH))
