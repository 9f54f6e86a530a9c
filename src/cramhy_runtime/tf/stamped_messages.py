"""Geometry as messages of geometry_msgs, and back. Source: cl-transforms.md 5.1.

A ``3d-vector`` becomes a Vector3 message, never a Point, and a ``vector-stamped``, too, which loses its header; a ``point-stamped``
keeps it. A quaternion message that nobody filled in converts, but makes no pose: it is no rotation.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import Cons
from cramhy_runtime.lisp_core.dispatch.generic_errors import no_applicable_method
from ..ros.messages import RosMessage, message_class_exact
from ..ros.wire import transmit
from ..transforms.coercion import check_type, instance
from ..transforms.poses import Pose, Transform, unchecked_transform
from ..transforms.quaternions import Quaternion, make_quaternion
from ..transforms.vectors import Vector3, make_3d_vector, x, y, z
from .stamped import PointStamped, PoseStamped, TransformStamped


def _message(name, **fields):
    return message_class_exact(name)(**fields)


def make_header_msg(stamp, frame_id):
    """A ``std_msgs/Header`` with the stamp (seconds) and the frame."""
    return _message("std_msgs/Header", stamp=stamp, frame_id=frame_id)


def make_point_msg(_3d_vector):
    """The ``geometry_msgs/Point`` of a 3d-vector; anything else is a type-error."""
    instance(_3d_vector, Vector3, "DATA")
    return _message("geometry_msgs/Point", x=x(_3d_vector), y=y(_3d_vector), z=z(_3d_vector))


def make_pose_stamped_msg(pose, frame_id, stamp):
    """The ``geometry_msgs/PoseStamped`` of a pose in ``frame_id`` at ``stamp`` (seconds)."""
    instance(pose, Pose, "POSE")
    return _message("geometry_msgs/PoseStamped", header=make_header_msg(stamp, frame_id), pose=_pose_msg(pose))


def pose_stamped_to_point_stamped_msg(pose):
    """The ``geometry_msgs/PointStamped`` of the place of a pose-stamped."""
    check_type(pose, PoseStamped, "POSE")
    return _message("geometry_msgs/PointStamped", header=make_header_msg(pose.stamp, pose.frame_id), point=make_point_msg(pose.origin))


def restamp_msg(msg, stamp):
    """Give the ``geometry_msgs/TransformStamped`` the time ``stamp`` (seconds). It is changed, and returned."""
    if getattr(msg, "ros_type", None) != "geometry_msgs/TransformStamped":
        return no_applicable_method("CL-TRANSFORMS-STAMPED:RESTAMP-MSG", None, msg, stamp)
    msg.header = make_header_msg(stamp, msg.header.frame_id)
    return msg


# ------------------------------------------------------------------------------------------------------------------- to-msg


def _vector_msg(vector):
    return _message("geometry_msgs/Vector3", x=x(vector), y=y(vector), z=z(vector))


def _quaternion_msg(q):
    return _message("geometry_msgs/Quaternion", **{letter: q.component(index) for index, letter in enumerate("xyzw")})


def _pose_msg(pose):
    return _message("geometry_msgs/Pose", position=make_point_msg(pose.origin), orientation=_quaternion_msg(pose.orientation))


def _transform_msg(transform):
    return _message("geometry_msgs/Transform", translation=_vector_msg(transform.translation), rotation=_quaternion_msg(transform.rotation))


_TO = (
    (PoseStamped, lambda pose: make_pose_stamped_msg(pose, pose.frame_id, pose.stamp)),
    (
        TransformStamped,
        lambda transform: _message(
            "geometry_msgs/TransformStamped",
            header=make_header_msg(transform.stamp, transform.frame_id),
            child_frame_id=transform.child_frame_id,
            transform=_transform_msg(transform),
        ),
    ),
    (
        PointStamped,
        lambda point: _message(
            "geometry_msgs/PointStamped", header=make_header_msg(point.stamp, point.frame_id), point=make_point_msg(point)
        ),
    ),
    (Vector3, _vector_msg),
    (Quaternion, _quaternion_msg),
    (Pose, _pose_msg),
    (Transform, _transform_msg),
    (Cons, lambda items: [to_msg(item) for item in items]),
    (type(None), lambda _: []),
)
"""Class → the function that makes the message, the special ones first."""


def to_msg(obj):
    """The message of geometry_msgs for ``obj``; for a list, the vector of those of its elements."""
    for cls, make in _TO:
        if isinstance(obj, cls):
            return make(obj)
    return no_applicable_method("CL-TRANSFORMS-STAMPED:TO-MSG", None, obj)


# ----------------------------------------------------------------------------------------------------------------- from-msg


def _vector(msg):
    return make_3d_vector(msg.x, msg.y, msg.z)


def _quaternion(msg):
    return make_quaternion(msg.x, msg.y, msg.z, msg.w)


_FROM = {
    "geometry_msgs/Vector3": _vector,
    "geometry_msgs/Point": _vector,
    "geometry_msgs/Quaternion": _quaternion,
    "geometry_msgs/Pose": lambda msg: Pose(_vector(msg.position), _quaternion(msg.orientation)),
    "geometry_msgs/Transform": lambda msg: unchecked_transform(_vector(msg.translation), _quaternion(msg.rotation)),
    "geometry_msgs/PoseStamped": lambda msg: PoseStamped(
        msg.header.frame_id, msg.header.stamp, _vector(msg.pose.position), _quaternion(msg.pose.orientation)
    ),
    "geometry_msgs/PointStamped": lambda msg: PointStamped(msg.header.frame_id, msg.header.stamp, *_vector_numbers(msg.point)),
    "geometry_msgs/TransformStamped": lambda msg: TransformStamped(
        msg.header.frame_id, msg.child_frame_id, msg.header.stamp, _vector(msg.transform.translation), _quaternion(msg.transform.rotation)
    ),
}


def _vector_numbers(msg):
    vector = _vector(msg)
    return [vector.component(index) for index in range(3)]


def from_msg(msg):
    """What a message of geometry_msgs stands for. The rotation of a Transform is not validated."""
    convert = _FROM.get(msg.ros_type) if isinstance(msg, RosMessage) else None
    if convert is None:
        return no_applicable_method("CL-TRANSFORMS-STAMPED:FROM-MSG", None, msg)
    try:
        return convert(msg)
    except AttributeError:  # a part of it is no message: sending it would say which
        transmit(msg)
        raise
