"""Where the links of the arm and its camera are, as frames of tf, and what the camera's picture measures."""

from __future__ import annotations

from math import tan
from typing import TYPE_CHECKING

from ...ros.messages import message_class_exact
from ..descriptions import Frame
from . import model

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ...ros.messages import RosMessage

CAMERA_FRAME = "camera_link"
"""The frame of the camera's picture: x to the right, y down, z the way it looks."""
_CAMERA = Frame(model.CAMERA, (0.0, 1.0, 0.0, 0.0))


def frames(positions: Sequence[float], stamp: float) -> RosMessage:
    """The message with the frame of each link in that of the link before it. positions: those of `model.JOINTS`, in rad and m."""
    known, robot = model.positions(tuple(positions)), model.described()
    root = next(iter(robot.links))
    placed = [(joint.parent, joint.child, joint.placed(known.get(joint.name, 0.0))) for joint in robot.joints.values()]
    return message_class_exact("tf2_msgs/TFMessage")([_stamped(*each, stamp) for each in (*placed, (root, CAMERA_FRAME, _CAMERA))])


def _stamped(parent: str, child: str, frame: Frame, stamp: float) -> RosMessage:
    header, vector, quaternion, transform, stamped = (
        message_class_exact(f"{package}/{name}")
        for package, name in (
            ("std_msgs", "Header"),
            ("geometry_msgs", "Vector3"),
            ("geometry_msgs", "Quaternion"),
            ("geometry_msgs", "Transform"),
            ("geometry_msgs", "TransformStamped"),
        )
    )
    w, *rest = map(float, frame.rotation)
    place = transform(vector(*map(float, frame.position)), quaternion(*rest, w))
    return stamped(header(seq=0, stamp=stamp, frame_id=parent), child, place)


def camera_info(header: RosMessage) -> RosMessage:
    """The message that tells what the camera's picture measures: a picture without distortion, whose middle is the camera's axis."""
    focal = model.WIDTH / 2 / tan(model.WIDE / 2)
    across, down = model.WIDTH / 2, model.HEIGHT / 2
    matrix = [focal, 0, across, 0, focal, down, 0, 0, 1]
    projection = [focal, 0, across, 0, 0, focal, down, 0, 0, 0, 1, 0]
    numbers = {"D": [0] * 5, "K": matrix, "R": [1, 0, 0, 0, 1, 0, 0, 0, 1], "P": projection}
    return message_class_exact("sensor_msgs/CameraInfo")(
        header=header,
        height=model.HEIGHT,
        width=model.WIDTH,
        distortion_model="plumb_bob",
        **{name: list(map(float, values)) for name, values in numbers.items()},
    )
