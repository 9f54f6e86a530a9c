"""Transforms and poses, twists and wrenches.

A transform maps coordinates: translation and rotation. A pose says where something is and how it is turned: origin and
orientation, the same numbers. Source: cl-transforms.md sections 4.1 to 4.3.
"""

from __future__ import annotations

from cramhy_runtime.lisp.conditions import error, warn, wrong_argument_count
from cramhy_runtime.lisp.data import truth
from cramhy_runtime.lisp.packages import keyword

from .coercion import elements, instance, no_method
from .quaternions import Quaternion, inverse, multiply, normalize, normalized, rotated, yaw
from .vectors import Vector3, make_3d_vector, point

_WARN, _NO_WARN = keyword("WARN"), keyword("NO-WARN")


class Transform:
    """A change of coordinates: turn by ``rotation``, then move by ``translation``."""

    lisp_name = "CL-TRANSFORMS::TRANSFORM"
    initargs = {"TRANSLATION": "translation", "ROTATION": "rotation"}

    def __init__(self, translation=None, rotation=None):
        self.translation = Vector3() if translation is None else translation
        self.rotation = Quaternion() if rotation is None else rotation


class Pose:
    """A place and a direction: ``origin`` and ``orientation``, a unit quaternion."""

    lisp_name = "CL-TRANSFORMS::POSE"
    initargs = {"ORIGIN": "origin", "ORIENTATION": "orientation"}

    def __init__(self, origin=None, orientation=None):
        self.origin = Vector3() if origin is None else origin
        self.orientation = Quaternion() if orientation is None else orientation


class Twist:
    """Linear and angular velocity, two vectors."""

    lisp_name = "CL-TRANSFORMS::TWIST"
    initargs = {"TRANSLATION": "translation", "ROTATION": "rotation"}

    def __init__(self, translation=None, rotation=None):
        self.translation = Vector3() if translation is None else translation
        self.rotation = Vector3() if rotation is None else rotation


class Wrench:
    """Force and torque, two vectors."""

    lisp_name = "CL-TRANSFORMS::WRENCH"
    initargs = Twist.initargs
    __init__ = Twist.__init__


def _slot_reader(name, *classes):
    def read(obj):
        return getattr(obj, name) if isinstance(obj, classes) else no_method(name, obj)

    def write(value, obj):
        setattr(instance(obj, classes[0], "OBJECT") if not isinstance(obj, classes) else obj, name, value)
        return value

    read.__name__ = name
    read.__doc__ = f"The {name} of {' or '.join(cls.__name__.lower() for cls in classes)}."
    return read, write


translation, set_translation = _slot_reader("translation", Transform, Twist, Wrench)
rotation, set_rotation = _slot_reader("rotation", Transform, Twist, Wrench)
origin, set_origin = _slot_reader("origin", Pose)
orientation, set_orientation = _slot_reader("orientation", Pose)


# --------------------------------------------------------------------------------------------------------------- transforms


def make_transform(translation, rotation, *, validate_args=_WARN):
    """A transform. A rotation that is not of unit length is normalised with a warning.

    ``validate_args``: ``:warn``, ``:no-warn`` (normalise silently), ``nil`` (keep it), anything else (an error).
    """
    if truth(validate_args) and not normalized(rotation):
        if validate_args not in (_WARN, _NO_WARN):
            return error("Rotation component ~a not normalized", rotation)
        rotation = normalize(rotation)
        if validate_args is _WARN:
            warn("Normalized rotation component to ~a", rotation)
    return Transform(translation, rotation)


def make_identity_transform():
    return Transform()


def copy_transform(transform, *, translation=None, rotation=None):
    instance(transform, Transform, "TRANSFORM")
    return make_transform(transform.translation if translation is None else translation,
                          transform.rotation if rotation is None else rotation)


def transform_inv(trans):
    """The transform back."""
    instance(trans, Transform, "TRANS")
    turned_back = inverse(trans.rotation.components)
    moved_back = tuple(-component for component in point(trans.translation))
    return make_transform(Vector3(*rotated(turned_back, moved_back)), Quaternion(*turned_back))


def transform_star(*transforms):
    """``transform*``: the composition; the last one is applied first."""
    if not transforms:
        return wrong_argument_count(0)
    result = transforms[-1]
    for outer in reversed(transforms[:-1]):
        instance(outer, Transform, "TRANSFORM")
        instance(result, Transform, "TRANSFORM")
        turned = rotated(outer.rotation.components, point(result.translation))
        moved = Vector3(*(a + b for a, b in zip(point(outer.translation), turned)))
        result = make_transform(moved, Quaternion(*multiply(outer.rotation.components, result.rotation.components)))
    return result


def transform_diff(transform_to, transform_from):
    """The D with D * from = to."""
    return transform_star(transform_to, transform_inv(transform_from))


def transform_point(trans, p):
    """The coordinates of the point ``p`` after the transform."""
    instance(trans, Transform, "TRANS")
    turned = rotated(trans.rotation.components, point(p, "P"))
    return Vector3(*(a + b for a, b in zip(point(trans.translation), turned)))


def transform(tr, x):
    """The point or pose ``x`` after the transform ``tr``."""
    if isinstance(x, Vector3):
        return transform_point(tr, x)
    if isinstance(x, Pose):
        return transform_pose(tr, x)
    if isinstance(x, list):
        if elements(x, 3) is None:
            return error("The assertion (= 3 (LENGTH CL-TRANSFORMS::P)) failed with (LENGTH CL-TRANSFORMS::P) = ~S.", len(x))
        return transform_point(tr, x)
    return no_method("transform", tr, x)


# -------------------------------------------------------------------------------------------------------------------- poses


def make_pose(origin, orientation):
    """A pose; an orientation that is not of unit length is normalised silently."""
    return Pose(origin, orientation if normalized(orientation) else normalize(orientation))


def make_identity_pose():
    return Pose()


def make_2d_pose(x, y, theta):
    """The pose at (x, y, 0) with heading ``theta``, a float in radians."""
    return Pose(make_3d_vector(x, y, 0), yaw(theta))


def copy_pose(pose, *, origin=None, orientation=None):
    instance(pose, Pose, "POSE")
    return make_pose(pose.origin if origin is None else origin, pose.orientation if orientation is None else orientation)


def reference_transform(pose):
    """The transform with the components of a pose; a transform is its own."""
    if isinstance(pose, Transform):
        return pose
    return Transform(pose.origin, pose.orientation) if isinstance(pose, Pose) else no_method("reference-transform", pose)


def pose_to_transform(pose):
    instance(pose, Pose, "POSE")
    return Transform(pose.origin, pose.orientation)


def transform_to_pose(transform):
    instance(transform, Transform, "TRANSFORM")
    return make_pose(transform.translation, transform.rotation)


def transform_pose(tr, p):
    """The pose ``p`` after the transform ``tr``."""
    instance(tr, Transform, "TR")
    return transform_to_pose(transform_star(tr, pose_to_transform(p)))


# ------------------------------------------------------------------------------------------------------- twists and wrenches


def make_twist(translation, rotation):
    return Twist(translation, rotation)


def make_identity_twist():
    return Twist()


def copy_twist(twist, *, translation=None, rotation=None):
    return _copy(twist, Twist, "TWIST", translation, rotation)


def make_wrench(translation, rotation):
    return Wrench(translation, rotation)


def make_identity_wrench():
    return Wrench()


def copy_wrench(wrench, *, translation=None, rotation=None):
    return _copy(wrench, Wrench, "WRENCH", translation, rotation)


def _copy(obj, cls, parameter, translation, rotation):
    instance(obj, cls, parameter)
    return cls(obj.translation if translation is None else translation, obj.rotation if rotation is None else rotation)
