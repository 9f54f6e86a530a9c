"""Transforms and poses, twists and wrenches.

A transform maps coordinates: translation and rotation. A pose says where something is and how it is turned: origin and
orientation, the same numbers. Source: cl-transforms.md sections 4.1 to 4.3.
"""

from __future__ import annotations

from cramhy_runtime.lisp.conditions import error, warn, wrong_argument_count
from cramhy_runtime.lisp.data import truth
from cramhy_runtime.lisp.packages import keyword

from .coercion import array_elements, instance, no_method, slot_reader
from .quaternions import TOLERANCE, Quaternion, general, inverse, multiply, normalize, normalized, quaternion, rotated, unit, yaw
from .vectors import Vector3, make_3d_vector, point, vector

_WARN, _NO_WARN = keyword("WARN"), keyword("NO-WARN")


class Transform:
    """A change of coordinates: turn by ``rotation``, then move by ``translation``. A rotation of another length is normalised."""

    lisp_name = "CL-TRANSFORMS::TRANSFORM"
    initargs = {"TRANSLATION": "translation", "ROTATION": "rotation"}

    def __init__(self, translation=None, rotation=None):
        self.translation = Vector3() if translation is None else translation
        self.rotation = Quaternion() if rotation is None else unit(rotation)

    def __repr__(self):
        return f"#<TRANSFORM {self.translation!r} {self.rotation!r}>"


class Pose:
    """A place and a direction: ``origin`` and ``orientation``. An orientation of another length is normalised."""

    lisp_name = "CL-TRANSFORMS::POSE"
    initargs = {"ORIGIN": "origin", "ORIENTATION": "orientation"}

    def __init__(self, origin=None, orientation=None):
        self.origin = Vector3() if origin is None else origin
        self.orientation = Quaternion() if orientation is None else unit(orientation)

    def __repr__(self):
        return f"#<POSE {self.origin!r} {self.orientation!r}>"


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


translation = slot_reader("translation", Transform, Twist, Wrench)
rotation = slot_reader("rotation", Transform, Twist, Wrench)
origin = slot_reader("origin", Pose)
orientation = slot_reader("orientation", Pose)


# --------------------------------------------------------------------------------------------------------------- transforms


def unchecked_transform(translation, rotation):
    """A transform whose rotation is taken as it is."""
    made = Transform.__new__(Transform)
    made.translation, made.rotation = translation, rotation
    return made


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
    return unchecked_transform(translation, rotation)


def make_identity_transform():
    """The transform that changes nothing."""
    return Transform()


def copy_transform(transform, *, translation=None, rotation=None):
    """A transform like ``transform`` with parts replaced."""
    instance(transform, Transform, "TRANSFORM")
    return make_transform(transform.translation if translation is None else translation,
                          transform.rotation if rotation is None else rotation)


def transform_inv(trans):
    """The transform back."""
    instance(trans, Transform, "TRANS")
    turned_back = inverse(general(trans.rotation))
    tx, ty, tz = point(trans.translation)
    return _computed(rotated(turned_back, (-tx, -ty, -tz)), turned_back)


def moved(trans, components):
    """The components of a point, a tuple, after the transform."""
    vx, vy, vz = rotated(general(trans.rotation), components)
    tx, ty, tz = point(trans.translation)
    return tx + vx, ty + vy, tz + vz


def transform_star(*transforms):
    """``transform*``: the composition; the last one is applied first."""
    if not transforms:
        return wrong_argument_count(0)
    result = transforms[-1]
    for outer in transforms[-2::-1]:
        instance(outer, Transform, "TRANSFORM")
        instance(result, Transform, "TRANSFORM")
        result = _computed(moved(outer, point(result.translation)), multiply(general(outer.rotation), general(result.rotation)))
    return result


def _computed(translation, rotation):
    """The transform of component tuples; when many products have made the rotation drift, with the warning of `make_transform`."""
    qx, qy, qz, qw = rotation
    if -TOLERANCE < qx * qx + qy * qy + qz * qz + qw * qw - 1 < TOLERANCE:
        return unchecked_transform(vector(translation), quaternion(rotation))
    return make_transform(vector(translation), quaternion(rotation))


def transform_diff(transform_to, transform_from):
    """The D with D * from = to."""
    return transform_star(transform_to, transform_inv(transform_from))


def transform_point(trans, p):
    """The coordinates of the point ``p`` after the transform."""
    instance(trans, Transform, "TRANS")
    return vector(moved(trans, point(p, "P")))


def transform(tr, x):
    """The point or pose ``x`` after the transform ``tr``."""
    if isinstance(x, Vector3):
        return transform_point(tr, x)
    if isinstance(x, Pose):
        return transform_pose(tr, x)
    items = array_elements(x)
    if items is None:
        return no_method("transform", tr, x)
    if len(items) != 3:
        return error("The assertion (= 3 (LENGTH CL-TRANSFORMS::P)) failed with (LENGTH CL-TRANSFORMS::P) = ~S.", len(items))
    return transform_point(tr, items)


# -------------------------------------------------------------------------------------------------------------------- poses


def unchecked_pose(origin, orientation):
    """A pose whose orientation is of unit length already."""
    made = Pose.__new__(Pose)
    made.origin, made.orientation = origin, orientation
    return made


def make_pose(origin, orientation):
    """A pose at a point, in metres; an orientation that is not of unit length is normalised silently."""
    return unchecked_pose(origin, unit(orientation))


def make_identity_pose():
    """The pose at the origin that looks along x."""
    return Pose()


def make_2d_pose(x, y, theta):
    """The pose at (x, y, 0), in metres, with heading ``theta``, a float in radians."""
    return unchecked_pose(make_3d_vector(x, y, 0), yaw(theta))


def copy_pose(pose, *, origin=None, orientation=None):
    """A pose like ``pose`` with parts replaced."""
    instance(pose, Pose, "POSE")
    return make_pose(pose.origin if origin is None else origin, pose.orientation if orientation is None else orientation)


def reference_transform(pose):
    """The transform with the components of a pose; a transform is its own."""
    if isinstance(pose, Transform):
        return pose
    return pose_to_transform(pose) if isinstance(pose, Pose) else no_method("reference-transform", pose)


def pose_to_transform(pose):
    """The transform from the coordinates of ``pose`` to those that it is given in."""
    instance(pose, Pose, "POSE")
    return unchecked_transform(pose.origin, pose.orientation)


def transform_to_pose(transform):
    """The pose with the components of a transform."""
    instance(transform, Transform, "TRANSFORM")
    return make_pose(transform.translation, transform.rotation)


def transform_pose(tr, p):
    """The pose ``p`` after the transform ``tr``."""
    instance(tr, Transform, "TR")
    moved = transform_star(tr, pose_to_transform(p))
    return unchecked_pose(moved.translation, moved.rotation)


# ------------------------------------------------------------------------------------------------------- twists and wrenches


def make_twist(translation, rotation):
    """A twist: linear velocity in m/s and angular velocity in rad/s, two vectors."""
    return Twist(translation, rotation)


def make_identity_twist():
    """The twist of what stands still."""
    return Twist()


def copy_twist(twist, *, translation=None, rotation=None):
    """A twist like ``twist`` with parts replaced."""
    return _copy(twist, Twist, "TWIST", translation, rotation)


def make_wrench(translation, rotation):
    """A wrench: force in N and torque in N m, two vectors."""
    return Wrench(translation, rotation)


def make_identity_wrench():
    """The wrench of what nothing pulls or turns."""
    return Wrench()


def copy_wrench(wrench, *, translation=None, rotation=None):
    """A wrench like ``wrench`` with parts replaced."""
    return _copy(wrench, Wrench, "WRENCH", translation, rotation)


def _copy(obj, cls, parameter, translation, rotation):
    instance(obj, cls, parameter)
    return cls(obj.translation if translation is None else translation, obj.rotation if rotation is None else rotation)
