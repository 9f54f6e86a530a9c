"""Poses as people say them: where, and which way it points."""

from __future__ import annotations

from math import cos, isfinite, radians, sin

from cramhy_runtime.tf.stamped import PoseStamped, make_pose_stamped
from cramhy_runtime.transforms.quaternions import make_quaternion
from cramhy_runtime.transforms.vectors import Vector3, make_3d_vector

Place = PoseStamped | Vector3 | tuple[float, float, float]
"""A pose, or a point in the room."""


def at(x: float, y: float, z: float = 0.0, yaw: float = 0.0, frame: str = "map") -> PoseStamped:
    """The pose at (x, y, z) metres, turned about the vertical axis by ``yaw`` degrees, in a frame: the room's is ``"map"``."""
    half = radians(yaw) / 2
    numbers = map(float, (x, y, z))
    return make_pose_stamped(frame, 0.0, make_3d_vector(*numbers), make_quaternion(0.0, 0.0, float(sin(half)), float(cos(half))))


def pose_of(place: Place) -> PoseStamped:
    """``place`` as a pose; a point, or three numbers, is not turned. Errors: TypeError, for anything else; ValueError, for numbers that are
    not finite."""
    pose = _pose_of(place)
    origin, turn = pose.origin, pose.orientation
    numbers = [*map(float, (origin.x, origin.y, origin.z, turn.x, turn.y, turn.z, turn.w))]
    if not all(map(isfinite, numbers)):
        raise ValueError(f"A place has finite numbers, not {tuple(numbers[:3])}, turned by the quaternion {tuple(numbers[3:])}.")
    return pose


def _pose_of(place: Place) -> PoseStamped:
    if isinstance(place, PoseStamped):
        return place
    if isinstance(place, Vector3):
        return at(place.x, place.y, place.z)
    try:
        x, y, z = place
        return at(x, y, z)
    except (TypeError, ValueError):
        raise TypeError(f"A place is robot.at(x, y, z, yaw=90) or three numbers, not {place!r}.") from None
