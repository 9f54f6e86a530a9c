"""Where things are, in numbers that MuJoCo computes with, and the way between these and the poses of plans.

A `Placement` is a position (x, y, z) in metres and a rotation (w, x, y, z), two numpy arrays that nobody changes. ``a @ b`` is where
something is that is at ``b`` in the frame ``a``, as a product of transforms.
"""

from __future__ import annotations

from math import acos
from typing import NamedTuple

import numpy as np

from cramhy_runtime.transforms.poses import Pose, make_pose
from cramhy_runtime.transforms.quaternions import make_quaternion
from cramhy_runtime.transforms.vectors import make_3d_vector

from .mujoco_parts import mujoco


class Placement(NamedTuple):
    """A position and a rotation."""

    position: np.ndarray
    rotation: np.ndarray

    def __matmul__(self, other: Placement) -> Placement:
        position, rotation = np.zeros(3), np.zeros(4)
        mujoco.mju_mulPose(position, rotation, self.position, self.rotation, other.position, other.rotation)
        return Placement(position, rotation)

    def inverse(self) -> Placement:
        position, rotation = np.zeros(3), np.zeros(4)
        mujoco.mju_negPose(position, rotation, self.position, self.rotation)
        return Placement(position, rotation)

    def moved(self, x: float = 0.0, y: float = 0.0, z: float = 0.0) -> Placement:
        """As it is, at a place that lies so far away in the frame around it."""
        return Placement(self.position + (x, y, z), self.rotation)

    def pose(self) -> Pose:
        """The same as a pose of cl-transforms."""
        w, x, y, z = map(float, self.rotation)
        return make_pose(make_3d_vector(*map(float, self.position)), make_quaternion(x, y, z, w))

    def near(self, other: Placement, metres: float, radians: float) -> bool:
        """Whether the two differ by no more than that."""
        turn = min(1.0, abs(float(self.rotation @ other.rotation)))
        return bool(np.linalg.norm(self.position - other.position) <= metres and 2 * acos(turn) <= radians)


def placement(position: object = (0.0, 0.0, 0.0), rotation: object = (1.0, 0.0, 0.0, 0.0)) -> Placement:
    """A placement of three and four numbers; the rotation is made of length 1. Errors: ValueError, for a rotation of length 0."""
    turn = np.array(rotation, float)
    length = float(np.linalg.norm(turn))
    if not length or not np.isfinite(length):
        raise ValueError(f"a rotation needs a quaternion (w, x, y, z) that has a length; {rotation!r} has none.")
    return Placement(np.array(position, float), turn / length)


def of_pose(pose: Pose) -> Placement:
    """The placement of a pose of cl-transforms."""
    origin, turn = pose.origin, pose.orientation
    return placement((origin.x, origin.y, origin.z), (turn.w, turn.x, turn.y, turn.z))
