"""Telling others where frames are: publications of transforms. Source: cl-transforms.md 6 and 8.

CL-TF sends ``tf/tfMessage`` on a publication of roslisp, CL-TF2 ``tf2_msgs/TFMessage`` on an object of its own; both messages have
the same one field, and who listens to one hears the other. What is republished runs in a task that ends with the node.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from .. import kernel
from cramhy_runtime.lisp_core.conditions import type_error
from cramhy_runtime.lisp_core.data import Cons, list_from, truth
from cramhy_runtime.lisp_core.numbers import is_real
from cramhy_runtime.lisp_core.dispatch.generic_errors import no_applicable_method
from ..ros import graph
from ..ros.messages import message_class_exact
from ..ros.roslisp import topics
from ..ros.roslisp.clock import ros_time
from ..ros.roslisp.time import running_beside
from ..ros.topics import Publication
from ..transforms.coercion import check_type
from .stamped import TransformStamped
from .stamped_messages import from_msg, restamp_msg, to_msg

AHEAD = 0.5
"""Seconds by which the stamps of transforms that are sent again and again are ahead of the time."""
INTERVAL = 0.1
"""Seconds between two messages of `while_broadcasting`."""


def make_transform_broadcaster(*, topic="/tf"):
    """``cl-tf``: the publication that transforms are sent on."""
    return topics.advertise(topic, "tf/tfMessage")


def transform_to_tf_msg(transform):
    """The ``tf/tfMessage`` with one transform-stamped."""
    return _message(message_class_exact("tf/tfMessage"), [transform])


def transforms_to_tf_msg(transforms):
    """The ``tf/tfMessage`` with a list or vector of transform-stampeds."""
    if not (transforms is None or isinstance(transforms, (Cons, list))):
        return type_error(transforms, "SEQUENCE")
    return _message(message_class_exact("tf/tfMessage"), transforms or ())


def tf_msg_to_transforms(msg):
    """The list of the transform-stampeds of a tf message."""
    return list_from([from_msg(part) for part in _tf_message(msg, "TF-MSG->TRANSFORMS").transforms])


def restamp_tf_msg(msg, stamp):
    """Give all transforms of a tf message the time ``stamp`` (seconds). It is changed, and returned."""
    for part in _tf_message(msg, "RESTAMP-TF-MSG").transforms:
        restamp_msg(part, stamp)
    return msg


def _tf_message(msg, function):
    return msg if hasattr(msg, "transforms") else no_applicable_method(f"CL-TF:{function}", None, msg)


def _message(cls, transforms):
    return cls(transforms=[to_msg(check_type(transform, TransformStamped, "TRANSFORM")) for transform in transforms])


def _publication(broadcaster: object, function: str) -> Publication:
    if isinstance(broadcaster, Publication):
        return broadcaster
    return no_applicable_method(f"CL-TF:{function}", None, broadcaster)


def _checked(broadcaster, function, interval, transforms):
    """The publication; what is wrong with the arguments is told to the caller, and not by a task in the background."""
    publication = _publication(broadcaster, function)
    _message(publication.type, transforms)
    if not is_real(interval) or not interval > 0:
        type_error(interval, "(REAL (0))")
    return publication


def send_transform(broadcaster, tr):
    """``cl-tf``: publish one transform-stamped; the number of subscribers reached."""
    return send_transforms(broadcaster, tr)


def send_transforms(broadcaster, *transforms):
    """``cl-tf``: publish transform-stampeds in one message; the number of subscribers reached."""
    publication = _publication(broadcaster, "SEND-TRANSFORMS")
    return topics.publish(publication, _message(publication.type, transforms))


def send_static_transforms_blocking(broadcaster, interval, *transforms):
    """Publish the transforms every ``interval`` seconds while the node runs, with stamps 0.5 s ahead."""
    publication = _checked(broadcaster, "SEND-STATIC-TRANSFORMS-BLOCKING", interval, transforms)
    while publication.node.alive:
        ahead = ros_time() + AHEAD
        send_transforms(
            publication,
            *(
                TransformStamped(transform.frame_id, transform.child_frame_id, ahead, transform.translation, transform.rotation)
                for transform in transforms
            ),
        )
        kernel.sleep(float(interval))


def send_static_transforms(broadcaster, interval, new_thread, *transforms):
    """The same; with ``new_thread`` (true) in the background, until the node ends."""
    if not truth(new_thread):
        return send_static_transforms_blocking(broadcaster, interval, *transforms)
    _checked(broadcaster, "SEND-STATIC-TRANSFORMS", interval, transforms)
    owner = graph.active().kernel
    owner.spawn(lambda: send_static_transforms_blocking(broadcaster, interval, *transforms), name="static transforms", parent=owner.main)
    return None


def repeat_beside(publication: Publication, interval: float, function: Callable[[], object]) -> Callable[[], None]:
    """Call ``function``, which publishes, every ``interval`` seconds in the background, until the node of ``publication`` ends or the
    function that is returned is called."""
    _checked(publication, "START-PUBLISHING-TRANSFORMS", interval, ())
    owner, wanted = graph.active().kernel, [True]

    def repeat() -> None:
        while wanted and publication.node.alive:
            function()
            kernel.sleep(float(interval))

    owner.spawn(repeat, name="tf broadcaster", parent=owner.main)
    return wanted.clear


def while_broadcasting(broadcaster, transforms, body):
    """``with-tf-broadcasting``: publish ``transforms``, a list, every 0.1 s while ``body`` runs; its values."""
    with broadcasting(broadcaster, *(transforms or ())):
        return body()


@contextmanager
def broadcasting(broadcaster: Publication, *transforms: TransformStamped) -> Iterator[None]:
    """``with broadcasting(broadcaster, TransformStamped("map", "cup", 0.0, place)):`` they are sent every 0.1 s while the block runs."""
    _checked(broadcaster, "WITH-TF-BROADCASTING", INTERVAL, transforms)
    with running_beside(lambda: send_static_transforms_blocking(broadcaster, INTERVAL, *transforms), "tf broadcaster"):
        yield


def topic(broadcaster: object) -> str:
    """The name of the topic that a broadcaster publishes on, of CL-TF or of CL-TF2."""
    if isinstance(broadcaster, TransformBroadcaster):
        broadcaster = broadcaster.publication
    return _publication(broadcaster, "TOPIC").name


# -------------------------------------------------------------------------------------------------------------------- CL-TF2


class TransformBroadcaster:
    """What ``cl-tf2:make-transform-broadcaster`` returns."""

    lisp_name = "CL-TF2::TRANSFORM-BROADCASTER"

    def __init__(self, topic="/tf", static=None):
        self.publication = topics.advertise(topic, "tf2_msgs/TFMessage", latch=True if truth(static) else None)

    def send(self, *transforms):
        """Publish transform-stampeds in one message; the number of subscribers reached."""
        return topics.publish(self.publication, _message(self.publication.type, transforms))


def make_transform_broadcaster_2(*, topic="/tf", static=None):
    """``cl-tf2``: what transforms are sent with; ``static``: the last message is kept for who comes later."""
    return TransformBroadcaster(topic, static)


def send_transform_2(broadcaster, *transforms):
    """``cl-tf2``: publish transform-stampeds in one message; the number of subscribers reached."""
    if not isinstance(broadcaster, TransformBroadcaster):
        return no_applicable_method("CL-TF2:SEND-TRANSFORM", None, broadcaster, *transforms)
    return broadcaster.send(*transforms)
