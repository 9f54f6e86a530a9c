"""Transforms and poses, twists and wrenches.

A transform maps coordinates: translation and rotation. A pose says where something is and how it is turned: origin and
orientation, the same numbers. Source: cl-transforms.md sections 4.1 to 4.3.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.conditions import error, warn, wrong_argument_count
from cramhy_runtime.lisp_core.data import truth
from cramhy_runtime.lisp_core.packages import keyword

from .coercion import ByValue, array_elements, instance, no_method, part, slot_reader
from .quaternions import TOLERANCE, Quaternion, general, inverse, multiply, normalize, normalized, quaternion, rotated, unit, yaw
from .vectors import Vector3, make_3d_vector, point, vector
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any, TypeVar, overload

if TYPE_CHECKING:
    from collections.abc import Callable

    from .signatures import Four, Place, PoseOrTransform, Rotation, Three

T = TypeVar("T", bound="Twist | Wrench")
_WARN, _NO_WARN = keyword("WARN"), keyword("NO-WARN")


class Transform(ByValue):
    """A change of coordinates: turn by ``rotation``, then move by ``translation``. A rotation of another length is normalised."""

    lisp_name = "CL-TRANSFORMS::TRANSFORM"
    initargs = {"TRANSLATION": "translation", "ROTATION": "rotation"}
    translation: Vector3 = part("translation", "The move, a vector.")
    rotation: Quaternion = part("rotation", "The turn, of unit length.")

    def __init__(self, translation: Vector3 | None = None, rotation: Rotation | None = None):
        self._translation = Vector3() if translation is None else translation
        self._rotation = Quaternion() if rotation is None else unit(rotation)

    def __repr__(self) -> str:
        return f"#<TRANSFORM {self.translation!r} {self.rotation!r}>"


class Pose(ByValue):
    """A place and a direction: ``origin`` and ``orientation``. An orientation of another length is normalised."""

    lisp_name = "CL-TRANSFORMS::POSE"
    initargs = {"ORIGIN": "origin", "ORIENTATION": "orientation"}
    origin: Vector3 = part("origin", "The place.")
    orientation: Quaternion = part("orientation", "The direction, of unit length.")

    def __init__(self, origin: Vector3 | None = None, orientation: Rotation | None = None):
        self._origin = Vector3() if origin is None else origin
        self._orientation = Quaternion() if orientation is None else unit(orientation)

    def __repr__(self) -> str:
        return f"#<POSE {self.origin!r} {self.orientation!r}>"


class Twist(ByValue):
    """Linear and angular velocity, two vectors."""

    lisp_name = "CL-TRANSFORMS::TWIST"
    initargs = {"TRANSLATION": "translation", "ROTATION": "rotation"}
    translation: Vector3 = part("translation", "The linear part, a vector.")
    rotation: Vector3 = part("rotation", "The angular part, a vector.")

    def __init__(self, translation: Vector3 | None = None, rotation: Vector3 | None = None):
        self._translation = Vector3() if translation is None else translation
        self._rotation = Vector3() if rotation is None else rotation


class Wrench(ByValue):
    """Force and torque, two vectors."""

    lisp_name = "CL-TRANSFORMS::WRENCH"
    initargs = Twist.initargs
    translation, rotation = Twist.translation, Twist.rotation
    _translation: Vector3
    _rotation: Vector3
    __init__ = Twist.__init__


translation: Callable[[Transform | Twist | Wrench], Vector3] = slot_reader("translation", Transform, Twist, Wrench)
rotation: Callable[[Any], Any] = slot_reader("rotation", Transform, Twist, Wrench)
origin: Callable[[Pose], Vector3] = slot_reader("origin", Pose)
orientation: Callable[[Pose], Quaternion] = slot_reader("orientation", Pose)


# --------------------------------------------------------------------------------------------------------------- transforms


def unchecked_transform(translation: Vector3, rotation: Quaternion) -> Transform:
    """A transform whose rotation is taken as it is."""
    made = Transform.__new__(Transform)
    made._translation, made._rotation = translation, rotation
    return made


def make_transform(translation: Any, rotation: Any, *, validate_args: object = _WARN) -> Transform:
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


def make_identity_transform() -> Transform:
    """The transform that changes nothing."""
    return Transform()


def copy_transform(transform: Transform, *, translation: Vector3 | None = None, rotation: Quaternion | None = None) -> Transform:
    """A transform like ``transform`` with parts replaced."""
    instance(transform, Transform, "TRANSFORM")
    return make_transform(
        transform._translation if translation is None else translation, transform._rotation if rotation is None else rotation
    )


def transform_inv(trans: Transform) -> Transform:
    """The transform back."""
    instance(trans, Transform, "TRANS")
    turned_back = inverse(general(trans._rotation))
    tx, ty, tz = point(trans._translation)
    return _computed(rotated(turned_back, (-tx, -ty, -tz)), turned_back)


def moved(trans: Transform, components: Three) -> Three:
    """The components of a point, a tuple, after the transform."""
    vx, vy, vz = rotated(general(trans._rotation), components)
    tx, ty, tz = point(trans._translation)
    return tx + vx, ty + vy, tz + vz


def transform_star(*transforms: Transform) -> Transform:
    """``transform*``: the composition; the last one is applied first."""
    if not transforms:
        return wrong_argument_count(0)
    result = transforms[-1]
    for outer in transforms[-2::-1]:
        instance(outer, Transform, "TRANSFORM")
        instance(result, Transform, "TRANSFORM")
        result = _computed(moved(outer, point(result._translation)), multiply(general(outer._rotation), general(result._rotation)))
    return result


def _computed(translation: Three, rotation: Four) -> Transform:
    """The transform of component tuples; when many products have made the rotation drift, with the warning of `make_transform`."""
    qx, qy, qz, qw = rotation
    if -TOLERANCE < qx * qx + qy * qy + qz * qz + qw * qw - 1 < TOLERANCE:
        return unchecked_transform(vector(translation), quaternion(rotation))
    return make_transform(vector(translation), quaternion(rotation))


def transform_diff(transform_to: Transform, transform_from: Transform) -> Transform:
    """The D with D * from = to."""
    return transform_star(transform_to, transform_inv(transform_from))


def transform_point(trans: Transform, p: Place) -> Vector3:
    """The coordinates of the point ``p`` after the transform."""
    instance(trans, Transform, "TRANS")
    return vector(moved(trans, point(p, "P")))


@overload
def transform(tr: Transform, x: Pose) -> Pose: ...
@overload
def transform(tr: Transform, x: Place) -> Vector3: ...
def transform(tr: Transform, x: Any) -> Any:
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


def unchecked_pose(origin: Vector3, orientation: Quaternion) -> Pose:
    """A pose whose orientation is of unit length already."""
    made = Pose.__new__(Pose)
    made._origin, made._orientation = origin, orientation
    return made


def make_pose(origin: Vector3, orientation: Rotation) -> Pose:
    """A pose at a point, in metres; an orientation that is not of unit length is normalised silently."""
    return unchecked_pose(origin, unit(orientation))


def make_identity_pose() -> Pose:
    """The pose at the origin that looks along x."""
    return Pose()


def make_2d_pose(x: float, y: float, theta: float) -> Pose:
    """The pose at (x, y, 0), in metres, with heading ``theta``, a float in radians."""
    return unchecked_pose(make_3d_vector(x, y, 0), yaw(theta))


def copy_pose(pose: Pose, *, origin: Vector3 | None = None, orientation: Rotation | None = None) -> Pose:
    """A pose like ``pose`` with parts replaced."""
    instance(pose, Pose, "POSE")
    return make_pose(pose._origin if origin is None else origin, pose._orientation if orientation is None else orientation)


def reference_transform(pose: PoseOrTransform) -> Transform:
    """The transform with the components of a pose; a transform is its own."""
    if isinstance(pose, Transform):
        return pose
    return pose_to_transform(pose) if isinstance(pose, Pose) else no_method("reference-transform", pose)


def pose_to_transform(pose: Pose) -> Transform:
    """The transform from the coordinates of ``pose`` to those that it is given in."""
    instance(pose, Pose, "POSE")
    return unchecked_transform(pose._origin, pose._orientation)


def transform_to_pose(transform: Transform) -> Pose:
    """The pose with the components of a transform."""
    instance(transform, Transform, "TRANSFORM")
    return make_pose(transform._translation, transform._rotation)


def transform_pose(tr: Transform, p: Pose) -> Pose:
    """The pose ``p`` after the transform ``tr``."""
    instance(tr, Transform, "TR")
    moved = transform_star(tr, pose_to_transform(p))
    return unchecked_pose(moved._translation, moved._rotation)


# ------------------------------------------------------------------------------------------------------- twists and wrenches


def make_twist(translation: Vector3, rotation: Vector3) -> Twist:
    """A twist: linear velocity in m/s and angular velocity in rad/s, two vectors."""
    return Twist(translation, rotation)


def make_identity_twist() -> Twist:
    """The twist of what stands still."""
    return Twist()


def copy_twist(twist: Twist, *, translation: Vector3 | None = None, rotation: Vector3 | None = None) -> Twist:
    """A twist like ``twist`` with parts replaced."""
    return _copy(twist, Twist, "TWIST", translation, rotation)


def make_wrench(translation: Vector3, rotation: Vector3) -> Wrench:
    """A wrench: force in N and torque in N m, two vectors."""
    return Wrench(translation, rotation)


def make_identity_wrench() -> Wrench:
    """The wrench of what nothing pulls or turns."""
    return Wrench()


def copy_wrench(wrench: Wrench, *, translation: Vector3 | None = None, rotation: Vector3 | None = None) -> Wrench:
    """A wrench like ``wrench`` with parts replaced."""
    return _copy(wrench, Wrench, "WRENCH", translation, rotation)


def _copy(obj: T, cls: type[T], parameter: str, translation: Vector3 | None, rotation: Vector3 | None) -> T:
    instance(obj, cls, parameter)
    return cls(obj._translation if translation is None else translation, obj._rotation if rotation is None else rotation)
