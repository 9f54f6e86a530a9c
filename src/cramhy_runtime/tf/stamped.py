"""Poses, points, vectors and transforms that say in which frame they are meant, and when.

Each is a plain pose, vector or transform too, and can be used wherever those can. A `TransformStamped` is the pose of the frame
``child_frame_id`` as seen in ``frame_id``: it takes coordinates of the child into those of the parent. Stamps are seconds.
Frames come first, then the stamp, then the geometry. Source: cl-transforms.md 5.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.conditions import SimpleError, error, warn
from cramhy_runtime.lisp_core.data import LispString
from cramhy_runtime.lisp_core.numbers import is_real
from cramhy_runtime.lisp_core.dispatch.generic_errors import no_applicable_method
from ..transforms.coercion import check_type, part, real, slot_reader, wrong_type
from ..transforms.poses import Pose, Transform
from ..transforms.vectors import Vector3, point, x, y, z
from . import errors
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable
    from ..transforms.signatures import Rotation


_ORDER = "Frames come first, then the stamp in seconds, then the geometry."


def _checked(value, fits, expected, name):
    """``value`` if it ``fits`` or is NIL, else a type-error: a frame and a stamp that are exchanged would be noticed much later."""
    return value if value is None or fits else wrong_type(value, expected, name, _ORDER, "CL-TRANSFORMS-STAMPED")


def _frame(value: object, name: str = "FRAME-ID") -> Any:
    return _checked(value, isinstance(value, (str, LispString)), "STRING", name)


def _stamp(value: object) -> Any:
    return _checked(value, is_real(value), "REAL", "STAMP")


class Stamped:
    """What has a frame (a string) and a stamp (seconds); NIL stands for one that is not known."""

    lisp_name = "CL-TRANSFORMS-STAMPED::STAMPED"
    initargs = {"FRAME-ID": "frame_id", "STAMP": "stamp"}
    frame_id: str = part("frame_id", "The frame.")
    stamp: float = part("stamp", "The time, in seconds.")

    def __init__(self, frame_id: str | None = None, stamp: float | None = None):
        self._frame_id: str = _frame(frame_id)
        self._stamp: float = _stamp(stamp)


class TransformStamped(Stamped, Transform):
    """The pose of ``child_frame_id`` in ``frame_id``."""

    lisp_name = "CL-TRANSFORMS-STAMPED::TRANSFORM-STAMPED"
    initargs = {"CHILD-FRAME-ID": "child_frame_id"}
    child_frame_id: str = part("child_frame_id", "The frame whose pose it is.")

    def __init__(
        self,
        frame_id: str | None = None,
        child_frame_id: str | None = None,
        stamp: float | None = None,
        translation: Vector3 | None = None,
        rotation: Rotation | None = None,
    ):
        Stamped.__init__(self, frame_id, stamp)
        Transform.__init__(self, translation, rotation)
        self._child_frame_id: str = _frame(child_frame_id, "CHILD-FRAME-ID")


class PoseStamped(Stamped, Pose):
    """A pose in a frame at a time."""

    lisp_name = "CL-TRANSFORMS-STAMPED::POSE-STAMPED"
    initargs: dict[str, str] = {}

    def __init__(
        self, frame_id: str | None = None, stamp: float | None = None, origin: Vector3 | None = None, orientation: Rotation | None = None
    ):
        Stamped.__init__(self, frame_id, stamp)
        Pose.__init__(self, origin, orientation)


class _VectorInFrame(Stamped, Vector3):
    """Components are what Lisp gave, not coerced: ``given`` is a tuple of numbers, or ``None`` if all are doubles."""

    initargs: dict[str, str] = {}
    given: tuple[float, float, float] | None = None

    def __init__(self, frame_id: str | None = None, stamp: float | None = None, x: float = 0.0, y: float = 0.0, z: float = 0.0):
        Stamped.__init__(self, frame_id, stamp)
        self._components = real(x), real(y), real(z)
        if not x.__class__ is y.__class__ is z.__class__ is float:
            self.given = x, y, z

    def component(self, index: int) -> Any:
        return Vector3.component(self, index) if self.given is None else self.given[index]


class PointStamped(_VectorInFrame):
    """A point in a frame at a time."""

    lisp_name = "CL-TRANSFORMS-STAMPED::POINT-STAMPED"


class VectorStamped(_VectorInFrame):
    """A vector in a frame at a time."""

    lisp_name = "CL-TRANSFORMS-STAMPED::VECTOR-STAMPED"


def _reader(name: str, *classes: type) -> Callable[[Any], Any]:
    return slot_reader(name, *classes, package="CL-TRANSFORMS-STAMPED")


frame_id: Callable[[Stamped], str] = _reader("frame-id", Stamped)
stamp: Callable[[Stamped], float] = _reader("stamp", Stamped)
child_frame_id: Callable[[TransformStamped], str] = _reader("child-frame-id", TransformStamped)
error_description = _reader("error-description", errors.TransformStampedError)


# ------------------------------------------------------------------------------------------------------------------- making


def make_pose_stamped(frame_id: str, stamp: float, translation: Vector3, rotation: Rotation) -> PoseStamped:
    """The pose at ``translation`` with the orientation ``rotation``, normalised silently, in ``frame_id`` at ``stamp`` (seconds)."""
    return PoseStamped(frame_id, stamp, translation, rotation)


def make_transform_stamped(frame_id: str, child_frame_id: str, stamp: float, translation: Vector3, rotation: Rotation) -> TransformStamped:
    """The transform from ``child_frame_id`` to its parent ``frame_id`` at ``stamp`` (seconds); the rotation is normalised silently."""
    return TransformStamped(frame_id, child_frame_id, stamp, translation, rotation)


def make_point_stamped(frame_id: str, stamp: float, _3d_vector: Any) -> PointStamped:
    """The point in ``frame_id`` at ``stamp`` (seconds); its components are not coerced."""
    point(_3d_vector)
    return PointStamped(frame_id, stamp, x(_3d_vector), y(_3d_vector), z(_3d_vector))


def make_vector_stamped(frame_id: str, stamp: float, _3d_vector: Any) -> VectorStamped:
    """The vector in ``frame_id`` at ``stamp`` (seconds); its components are not coerced."""
    point(_3d_vector)
    return VectorStamped(frame_id, stamp, x(_3d_vector), y(_3d_vector), z(_3d_vector))


def copy_pose_stamped(
    pose: PoseStamped, *, origin: Vector3 | None = None, orientation: Rotation | None = None, stamp: float | None = None
) -> PoseStamped:
    """A pose in the same frame with parts replaced."""
    check_type(pose, PoseStamped, "POSE")
    return PoseStamped(
        pose.frame_id,
        pose.stamp if stamp is None else stamp,
        pose.origin if origin is None else origin,
        pose.orientation if orientation is None else orientation,
    )


# --------------------------------------------------------------------------------------------------------------- converting


def pose_to_pose_stamped(frame_id: str, stamp: float, pose: Pose) -> PoseStamped:
    """``pose`` as one in ``frame_id`` at ``stamp``."""
    check_type(pose, Pose, "POSE")
    return PoseStamped(frame_id, stamp, pose.origin, pose.orientation)


def pose_stamped_to_pose(pose_stamped: PoseStamped) -> Pose:
    """The pose without its frame."""
    check_type(pose_stamped, PoseStamped, "POSE-STAMPED")
    return Pose(pose_stamped.origin, pose_stamped.orientation)


def point_to_point_stamped(frame_id: str, stamp: float, point: Any) -> PointStamped:
    """``point`` as one in ``frame_id`` at ``stamp``."""
    return make_point_stamped(frame_id, stamp, point)


def vector_to_vector_stamped(frame_id: str, stamp: float, vector: Any) -> VectorStamped:
    """``vector`` as one in ``frame_id`` at ``stamp``."""
    return make_vector_stamped(frame_id, stamp, vector)


def transform_to_transform_stamped(frame_id: str, child_frame_id: str, stamp: float, transform: Transform) -> TransformStamped:
    """``transform`` as that from ``child_frame_id`` to ``frame_id`` at ``stamp``."""
    check_type(transform, Transform, "TRANSFORM")
    return TransformStamped(frame_id, child_frame_id, stamp, transform.translation, transform.rotation)


def transform_stamped_to_pose_stamped(transform: TransformStamped) -> PoseStamped:
    """The identity pose in the child frame, which is where the child is for itself; not the transform's own numbers."""
    check_type(transform, TransformStamped, "TRANSFORM")
    return PoseStamped(transform.child_frame_id, transform.stamp)


def ensure_pose_stamped(obj: Pose | TransformStamped, frame_id: str | None = None, stamp: float | None = None) -> PoseStamped:
    """``obj`` as a pose in a frame: one that is one already is returned as it is; a pose needs both arguments; a transform-stamped
    gives a pose with its numbers, in its parent frame and at its time unless the arguments say otherwise."""
    if isinstance(obj, PoseStamped):
        return obj
    if isinstance(obj, TransformStamped):
        return PoseStamped(
            obj.frame_id if frame_id is None else frame_id, obj.stamp if stamp is None else stamp, obj.translation, obj.rotation
        )
    if not isinstance(obj, Pose):
        return no_applicable_method("CL-TRANSFORMS-STAMPED:ENSURE-POSE-STAMPED", None, obj, frame_id, stamp)
    if frame_id is None or stamp is None:
        return error(
            SimpleError("Cannot convert POSE into POSE-STAMPED without `frame-id' and `stamp'."),
            hint='A pose does not know its frame: (ensure-pose-stamped pose "map" 0.0).',
        )
    return PoseStamped(frame_id, stamp, obj.origin, obj.orientation)


# ----------------------------------------------------------------------------------------------------------- deprecated names


def _deprecated(old: str, new: str) -> None:
    warn("~a", f"{old} is deprecated. Use {new} instead.")


def make_stamped_transform(frame_id: str, child_frame_id: str, stamp: float, translation: Vector3, rotation: Rotation) -> TransformStamped:
    """The old name of `make_transform_stamped`."""
    _deprecated("MAKE-STAMPED-TRANSFORM", "MAKE-TRANSFORM-STAMPED")
    return make_transform_stamped(frame_id, child_frame_id, stamp, translation, rotation)


def transform_to_stamped_transform(frame_id: str, child_frame_id: str, stamp: float, transform: Transform) -> TransformStamped:
    """The old name of `transform_to_transform_stamped`."""
    _deprecated("TRANSFORM->STAMPED-TRANSFORM", "TRANSFORM->TRANSFORM-STAMPED")
    return transform_to_transform_stamped(frame_id, child_frame_id, stamp, transform)


def stamped_transform_to_pose_stamped(transform: TransformStamped) -> PoseStamped:
    """The old name of `transform_stamped_to_pose_stamped`."""
    _deprecated("STAMPED-TRANSFORM->POSE-STAMPED", "TRANSFORM-STAMPED->POSE-STAMPED")
    return transform_stamped_to_pose_stamped(transform)
