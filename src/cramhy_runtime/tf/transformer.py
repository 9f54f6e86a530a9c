"""The buffer for programs: with conditions, with waiting, and filled from ``/tf``.

A `Transformer` is a buffer that a program fills itself; a `TransformListener` subscribes ``/tf`` and ``/tf_static`` and needs a running
node. Who waits for a transform parks until one comes that makes it known, in the time of the plan, and can be ended meanwhile like
every wait. `lookup_transform` and its relatives are generic in the original: other transformers, such as the client of a tf2
server, take part by having the Python method ``lookup``. Source: cl-transforms.md 5.3 and 7.
"""

from __future__ import annotations

from .. import kernel
from cramhy_runtime.lisp_core.condition_types import Error
from cramhy_runtime.lisp_core.conditions import SimpleError, error, handler_case, type_error, warn
from cramhy_runtime.lisp_core.data import LispString, truth
from cramhy_runtime.lisp_core.floats import ZERO
from cramhy_runtime.lisp_core.numbers import is_real
from cramhy_runtime.lisp_core.dispatch.generic_errors import no_applicable_method
from cramhy_runtime.lisp_core.printing import princ_to_string
from ..ros.roslisp import logging, node, parameters, topics
from ..ros.roslisp.clock import ros_time
from ..transforms.coercion import check_type
from ..transforms.poses import transform_point, transform_pose
from cramhy_runtime.utilities.wait_queue import time_limit
from . import errors
from .buffer import FrameBuffer, Unavailable
from .frames import unslash_frame
from .stamped import PointStamped, PoseStamped, TransformStamped, make_point_stamped, transform_to_transform_stamped
from .stamped_messages import from_msg

LOG = ("CL-TF",)
_KINDS = {"lookup": errors.FrameLookupError, "connectivity": errors.ConnectivityError, "extrapolation": errors.ExtrapolationError}
NOW = 0.0


class Transformer:
    """A buffer of transforms with those who wait for one."""

    lisp_name = "CL-TF::TRANSFORMER"

    def __init__(self):
        self.buffer = FrameBuffer()
        self.waiting = kernel.Waiting()

    def store(self, transform, notify=True):
        """Keep a transform-stamped and wake those who wait; false if it came too late and was ignored."""
        check_type(transform, TransformStamped, "TRANSFORM")
        try:
            stored = self.buffer.store(transform)
        except ValueError as problem:
            return errors.transform_error(errors.InvalidArgumentError, str(problem))
        if not stored:
            logging.log_text(
                logging.DEBUG,
                LOG,
                f"Ignoring the transform from {transform.child_frame_id} to {transform.frame_id}: it is older than what is known.",
            )
        elif notify:
            self.changed()
        return stored

    def changed(self):
        """Let those who wait look again."""
        self.waiting.changed()

    def find(self, target, source, time=None):
        """The transform, or the `Unavailable` that tells why not."""
        target, source = unslash_frame(target), unslash_frame(source)
        if target == source:
            return TransformStamped(target, source, ros_time())
        try:
            return self.buffer.lookup(target, source, time)
        except Unavailable as problem:
            return problem
        except ValueError as problem:
            return errors.transform_error(errors.InvalidArgumentError, str(problem))

    def wait(self, target, source, time=None, timeout=None):
        """Wait up to ``timeout`` seconds of plan time (``None``: for ever) until `find` finds it, and return what it gives then."""
        found = self.find(target, source, time)
        until = time_limit(timeout)

        def there():
            nonlocal found
            found = self.find(target, source, time)
            return not isinstance(found, Unavailable)

        if isinstance(found, Unavailable) and (until is None or until > kernel.now()):
            self.waiting.wait(there, lambda: f"a transform from {source} to {target}", until)
        return found

    def lookup(self, target, source, *, time=None, timeout=NOW, target_time=None, fixed_frame=None):
        """The transform after waiting up to ``timeout`` seconds, else a timeout-error."""
        if target_time is not None or fixed_frame is not None:
            warn("~a", "TARGET-TIME and FIXED-FRAME are ignored by CL-TF; a CL-TF2:BUFFER-CLIENT knows them.")
        found = self.wait(target, source, time, timeout)
        if isinstance(found, Unavailable):
            return errors.transform_error(
                errors.TimeoutError_,
                f"No transform was published between frames {princ_to_string(source)} and {princ_to_string(target)}",
                f"{found.text.rstrip('.')}. {found.hint}".replace("\n", " "),
            )
        return found


class TransformListener(Transformer):
    """A transformer that hears what is published on ``/tf`` and, for good, on ``/tf_static``. Needs a running node."""

    lisp_name = "CL-TF::TRANSFORM-LISTENER"

    def __init__(self):
        super().__init__()
        node.require_node()
        self.prefix = parameters.get_param("~tf_prefix", "")
        self.subscribers = [
            topics.subscribe("/tf", "tf/tfMessage", self.hear),
            topics.subscribe("/tf_static", "tf/tfMessage", lambda message: self.hear(message, ZERO)),
        ]

    def hear(self, message, stamp=None):
        """Store the transforms of a tf message, with ``stamp`` if one is given; one that is broken does not spoil the others."""
        for part in message.transforms:
            handler_case([(Error, self._refuse)], lambda part=part: self._take(from_msg(part), stamp))
        self.changed()

    def _take(self, transform, stamp):
        if stamp is not None:
            transform = transform_to_transform_stamped(transform.frame_id, transform.child_frame_id, stamp, transform)
        self.store(transform, notify=False)

    def _refuse(self, problem):
        logging.log_text(logging.WARN, LOG, f"Ignoring a transform on /tf: {princ_to_string(problem)}")

    def destroy(self):
        """Hear no more. Those who wait go on waiting for what a program stores."""
        while self.subscribers:
            topics.unsubscribe(self.subscribers.pop())


# ------------------------------------------------------------------------------------------------------- CL-TF's functions


def _transformer(tf, function, *arguments):
    return tf if isinstance(tf, Transformer) else no_applicable_method(f"CL-TF:{function}", None, tf, *arguments)


def _frame(name, parameter):
    if isinstance(name, (str, LispString)):
        return str(name)
    return type_error(name, "STRING", f"\nwhen binding CL-TRANSFORMS-STAMPED:{parameter}")


def _seconds(value):
    return value if value is None or is_real(value) else type_error(value, "REAL")


def set_transform(tf, transform, *, suppress_callbacks=None):
    """Store a transform-stamped in the transformer; with ``suppress_callbacks`` nobody is woken who waits for one."""
    _transformer(tf, "SET-TRANSFORM", transform).store(transform, notify=not truth(suppress_callbacks))


def can_transform(tf, *, target_frame=None, source_frame=None, time=None):
    """T if the transform can be looked up now, else NIL. ``time``: seconds; nil or 0: the newest."""
    _transformer(tf, "CAN-TRANSFORM")
    found = tf.find(_frame(target_frame, "TARGET-FRAME"), _frame(source_frame, "SOURCE-FRAME"), _seconds(time))
    return None if isinstance(found, Unavailable) else True


def wait_for_transform(tf, *, target_frame=None, source_frame=None, time=None, timeout=None):
    """Wait until the transform can be looked up: T, or NIL after ``timeout`` seconds of plan time. No timeout is for ever."""
    _transformer(tf, "WAIT-FOR-TRANSFORM")
    found = tf.wait(_frame(target_frame, "TARGET-FRAME"), _frame(source_frame, "SOURCE-FRAME"), _seconds(time), _seconds(timeout))
    return None if isinstance(found, Unavailable) else True


def lookup_cached_transform(tf, *, target_frame=None, source_frame=None, time=None):
    """The transform as it is known now. Errors: lookup-error, connectivity-error, extrapolation-error, and a plain error when nothing is
    known about the second that was asked for."""
    _transformer(tf, "LOOKUP-CACHED-TRANSFORM")
    found = tf.find(_frame(target_frame, "TARGET-FRAME"), _frame(source_frame, "SOURCE-FRAME"), _seconds(time))
    if not isinstance(found, Unavailable):
        return found
    if found.kind in _KINDS:
        return errors.transform_error(_KINDS[found.kind], found.text, found.hint)
    return error(SimpleError("~a", found.text), hint=found.hint)


def execute_changed_callbacks(tf):
    """Wake those who wait for a transform, after `set_transform` with ``suppress_callbacks``."""
    _transformer(tf, "EXECUTE-CHANGED-CALLBACKS").changed()


def destroy(tf):
    """End the subscriptions of a listener."""
    if not isinstance(tf, TransformListener):
        return no_applicable_method("CL-TF::DESTROY", None, tf)
    return tf.destroy()


# ------------------------------------------------------------------------------------------------- any kind of transformer


def lookup_transform(transformer, target_frame, source_frame, *, time=None, timeout=NOW, target_time=None, fixed_frame=None):
    """The transform-stamped that takes coordinates in ``source_frame`` into those in ``target_frame``.

    time: seconds; nil or 0: the newest. timeout: how many seconds of plan time to wait for it; nil: for ever. Not there by then: a
    timeout-error. target_time, fixed_frame: for a buffer-client, the time of the target, through a frame that does not move.
    """
    if not hasattr(transformer, "lookup"):
        return no_applicable_method("CL-TRANSFORMS-STAMPED:LOOKUP-TRANSFORM", None, transformer, target_frame, source_frame)
    return transformer.lookup(
        _frame(target_frame, "TARGET-FRAME"),
        _frame(source_frame, "SOURCE-FRAME"),
        time=_seconds(time),
        timeout=_seconds(timeout),
        target_time=_seconds(target_time),
        fixed_frame=fixed_frame,
    )


def transform_pose_stamped(transformer, *, target_frame=None, pose=None, timeout=NOW, use_current_ros_time=None):
    """``pose``, a pose-stamped, as seen from ``target_frame`` at its own time, or now if ``use_current_ros_time``."""
    check_type(pose, PoseStamped, "POSE")
    found = lookup_transform(transformer, target_frame, pose.frame_id, time=_time(pose, use_current_ros_time), timeout=timeout)
    return _pose_after(found, pose, unslash_frame(target_frame))


def transform_point_stamped(transformer, *, target_frame=None, point=None, timeout=NOW, use_current_ros_time=None):
    """``point``, a point-stamped, as seen from ``target_frame`` at its own time, or now if ``use_current_ros_time``."""
    check_type(point, PointStamped, "POINT")
    found = lookup_transform(transformer, target_frame, point.frame_id, time=_time(point, use_current_ros_time), timeout=timeout)
    return make_point_stamped(unslash_frame(target_frame), found.stamp, transform_point(found, point))


def _time(thing, current):
    return ros_time() if truth(current) else thing.stamp


def _pose_after(transform, pose, frame_id):
    moved = transform_pose(transform, pose)
    return PoseStamped(frame_id, transform.stamp, moved.origin, moved.orientation)


def old_transform_pose(tf, *, target_frame=None, pose=None):
    """``cl-tf:transform-pose``, the older `transform_pose_stamped`, which does not wait."""
    check_type(pose, PoseStamped, "POSE")
    found = lookup_cached_transform(tf, target_frame=target_frame, source_frame=pose.frame_id, time=pose.stamp)
    return _pose_after(found, pose, found.frame_id)


def old_transform_point(tf, *, target_frame=None, point=None):
    """``cl-tf:transform-point``, the older `transform_point_stamped`, which does not wait."""
    check_type(point, PointStamped, "POINT")
    found = lookup_cached_transform(tf, target_frame=target_frame, source_frame=point.frame_id, time=point.stamp)
    return make_point_stamped(found.frame_id, found.stamp, transform_point(found, point))
