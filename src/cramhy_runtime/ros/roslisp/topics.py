"""Advertise, publish and subscribe from the Lisp program, and run its callbacks in tasks.

Each topic that the program subscribes to has one queue and one task, ``Subscriber thread for topic /x``, which runs the
callbacks, the newest first. So callbacks of one topic never overlap. An error in a callback is logged, and the others go on.
Source: roslisp.md 6.
"""

from __future__ import annotations

from collections import deque

from ... import kernel
from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.kernel.unstarted import plain_function
from cramhy_runtime.lisp_core.condition_types import Condition, Error, SimpleTypeError, formatted, shown
from cramhy_runtime.lisp_core.data import NO_VALUES, LispString, Symbol
from cramhy_runtime.lisp_core.printing import format_to_string
from cramhy_runtime.lisp_core.dispatch.generic_errors import no_applicable_method, no_primary_method
from ..messages import RosMessage, topic_class
from ..received import lisp_receiver
from ..topics import Publication
from ..type_texts import same_on_the_wire
from . import logging, node
from .errors import close_names, legal, ros_error
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable

    from cramhy_runtime.lisp_core.data import MultipleValues
    from ..graph import Node
    from ..signatures import Callback, MessageType, Text, TypeName


DELIVERY = ("ROSLISP", "DESERIALIZATION-THREAD")
"""The log topic of lines about messages that are not delivered."""


class Subscription:
    """The Lisp program's end of a topic: queue, task, callbacks (`Subscriber`s, the newest first).

    The task lives only while there are messages to deliver. A task that begins where another one has just ended needs no stack
    of its own, so a pose that comes 62 times a second costs no switch of threads. A report of waiting tasks names only tasks
    that really wait. If no task runs, a message goes directly to a new task. Otherwise it waits in the queue, and ``limit`` is
    the number of messages that may wait there.
    """

    lisp_name = "ROSLISP::SUBSCRIPTION"

    def __init__(self, node: Node, name: str, message_type: MessageType, limit: int | None = None):
        self.node, self.name, self.type, self.limit = node, name, message_type, limit
        self.queue: deque[RosMessage] = deque(maxlen=limit)
        self.callbacks: list[Subscriber] = []
        self.closed = False
        self.message: RosMessage | None = None
        self.remaining: list[Subscriber] = []
        self.task: kernel.Task[object] | None = None
        self.task_name = f"Subscriber thread for topic {name}"
        self._handlers = [(Error, self._failed)]

    def receive(self, message: RosMessage) -> None:
        """Deliver ``message`` in a new task, or queue it for the running one. A full queue drops its oldest message."""
        if self.task is not None:
            if len(self.queue) == self.limit:
                logging.log_text(logging.DEBUG, DELIVERY, f"Dropped 1 messages on topic {self.name}")
            self.queue.append(message)
        elif not self.closed:
            owner = self.node.graph.kernel
            self.message, self.remaining = message, list(self.callbacks)
            self.task = owner.spawn(self._run, name=self.task_name, parent=owner.main)

    def spoiled(self, publication: Publication, message: RosMessage) -> None:
        """Drop ``message`` from ``publication``, since it has another type. In roslisp, the connection's thread dies of it."""
        logging.log_text(
            logging.DEBUG,
            DELIVERY,
            f"Dropped a {message.ros_type} that {publication.node.name} sent on {self.name}, whose type is {self.type.ros_type}",
        )

    def close(self) -> None:
        """End the subscription and its task."""
        self.closed = True
        if self.task is not None and self.task is not kernel.current():
            self.task.cancel("the subscription ended")

    def _run(self) -> None:
        try:
            while self.queue or self.remaining:
                try:
                    conditions.handler_case(self._handlers, self._deliver)
                except Condition as condition:  # no error, but nobody handled it: the subscription shall not die of it
                    self._failed(condition)
        finally:
            self.message, self.remaining, self.task = None, [], None

    def _deliver(self) -> None:
        queue, callbacks = self.queue, self.callbacks
        while not self.closed:
            kernel.checkpoint()  # a callback may cause the next message, and that one the next, for ever
            while self.remaining:
                subscriber = self.remaining.pop(0)
                if subscriber in callbacks:  # and did not unsubscribe meanwhile
                    subscriber.callback(self.message)
            if not queue:
                return
            self.message, self.remaining = queue.popleft(), list(callbacks)
        queue.clear()
        self.remaining = []

    def _failed(self, condition: Condition) -> None:
        logging.log_text(
            logging.ERROR,
            ("ROSLISP", "SERVICE", "TCP"),
            format_to_string("Error during subscriber callback: '~a' for topic item: ~%~a ", condition, self.message),
        )


class Subscriber:
    """One callback of one subscription. ``subscribe`` returns it, for ``unsubscribe``."""

    __slots__ = ("topic", "subscription", "callback")
    lisp_name = "ROSLISP::SUBSCRIBER"

    def __init__(self, topic: str, subscription: Subscription, callback: Callable[[Any], object]):
        self.topic, self.subscription, self.callback = topic, subscription, callback


# ------------------------------------------------------------------------------------------------------ roslisp's functions


def _topic_name(topic: object, parameter: str = "TOPIC") -> str:
    if not isinstance(topic, (str, LispString)):
        return conditions.type_error(topic, "STRING", f"\nwhen binding ROSLISP::{parameter}")
    return legal(str(topic), "topic")


def advertise(topic: Text, topic_type: TypeName, *, latch: bool | None = None) -> Publication | None:
    """Publish messages of ``topic_type`` on ``topic`` from now on; returns the `Publication`.

    If the node advertises the topic already, returns its publication unchanged. ``latch``: whether new subscribers get the last
    message. An unknown type is an error. Source: roslisp.md 6.1.
    """
    topic = _topic_name(topic)
    here = node.require_node()
    cls = topic_class(topic_type)
    if not _agrees_elsewhere(here, here.resolve(topic), cls, "advertise"):
        return None
    publication = here.advertise(topic, cls, latch is not None and latch is not False)
    _warn_of_listeners_to_another_type(publication)
    return publication


def _agrees_elsewhere(here: Node, name: str, cls: MessageType, operator: str) -> bool:
    """Signal an error if the session's robot has another type than ``cls`` on the topic. Returns true if there is no conflict."""
    other = here.graph.type_elsewhere(name, cls) if here.graph.type_elsewhere is not None else None
    if other is None:
        return True
    kind, place = other
    call = f'({operator} "{name}" "{kind}")' if operator == "advertise" else f'({operator} "{name}" "{kind}" callback)'
    ros_error(
        "The topic ~a has messages of the type ~a at ~a, not ~a, so no message would arrive.",
        name,
        kind,
        place,
        cls.ros_type,
        hint=f"Try {call}, or another topic. rostopic list, typed at the prompt, shows those of this session.",
    )
    return False


def _warn_of_listeners_to_another_type(publication: Publication) -> None:
    """Warn the user of ``advertise``; the listening node complains only on its own screen."""
    for subscription in publication.node.graph.topics[publication.name].visible_subscriptions:
        if not same_on_the_wire(subscription.type, publication.type):
            conditions.warn(
                "~a",
                f"{subscription.node.name} listens to {publication.name} for messages of type "
                f"{subscription.type.ros_type}, so it gets no message that is published there as {publication.type.ros_type}.",
            )


def unadvertise(topic: Text) -> int:
    """Stop publishing on ``topic``; returns 1. If the node does not advertise it, warn."""
    here = node.require_node()
    name = here.resolve(_topic_name(topic))
    if not here.unadvertise(name):
        logging.log_text(logging.WARN, ("ROSLISP", "TOP"), f"Not publishing on {name}")
        conditions.warn("Not publishing on ~a", name)
    return 1


def publish(pub: Publication | Text, message: RosMessage) -> int:
    """Send ``message`` on ``pub``, a publication or the name of an advertised topic; returns the number of subscribers reached.

    A topic that is not advertised is an error. Source: roslisp.md 6.
    """
    publication = pub
    if publication.__class__ is not Publication:
        if not isinstance(pub, (str, LispString)):
            advice = (
                "What (advertise topic type) returns is published on, or the name of an advertised topic. Has the function been "
                "called that advertises?"
            )
            return no_primary_method("ROSLISP:PUBLISH", 3, pub, message, advice=advice)
        here = node.require_node()
        name = here.resolve(legal(str(pub), "topic"))
        publication = here.publications.get(name)
        if publication is None:
            return ros_error(
                "Unknown topic ~a",
                name,
                hint=lambda: close_names(
                    name, here.publications, f'One publishes on a topic that was advertised before: (advertise "{name}" type).'
                ),
            )
    elif not publication.node.alive:
        here = node.require_node()
        publication = here.publications.get(publication.name, publication)
    if not isinstance(message, RosMessage):
        return no_applicable_method(
            "ROSLISP-MSG-PROTOCOL:SERIALIZE",
            2,
            message,
            advice=f'What is published is a message: (make-msg "{publication.type.ros_type}" field value ...).',
        )
    return publication.publish(message)


def publication_type(pub: Publication) -> MessageType:
    """The message class of a publication object, for ``publish-msg`` and ``make-publisher-msg``. Else it is a type error."""
    if isinstance(pub, Publication):
        return pub.type
    text = f"Value of #:G418 in\n(THE ROSLISP::PUBLICATION #:G418)\nis\n  {shown(pub)},\nnot a\n  ROSLISP::PUBLICATION."
    return conditions.error(
        SimpleTypeError("~a", text, datum=pub, expected_type="ROSLISP::PUBLICATION"),
        hint="This macro takes what (advertise topic type) returns. With a topic's name one writes (publish name (make-msg ...)).",
    )


def num_subscribers(pub: Publication) -> int:
    """The number of subscribers connected to a publication object."""
    if not isinstance(pub, Publication):
        return conditions.type_error(pub, "ROSLISP::PUBLICATION", "\nwhen binding ROSLISP::PUB")
    return pub.subscribers


def subscribe(
    topic: Text, topic_type: TypeName, callback: Callable[[Any], object], *, max_queue_length: int | Symbol | None = None
) -> Subscriber | None:
    """Call ``callback`` with every message on ``topic``; returns a `Subscriber` for `unsubscribe`.

    First, wait until the present publishers have accepted the connection. For an unknown type, warn and return NIL.
    ``max_queue_length``: how many messages may wait; older ones are dropped. Nil or ``infty``: unlimited.
    Source: roslisp.md 6.4.
    """
    return subscribed(topic, topic_type, callback, max_queue_length, lisp_receiver)


def subscribed(
    topic: Text, topic_type: TypeName, callback: Callback, max_queue_length: object, receiver: Callable[[MessageType, Callback], Callback]
) -> Subscriber | None:
    """`subscribe` for any language: ``receiver(class, callback)`` is the function that is called with the graph's messages."""
    topic = _topic_name(topic)
    here = node.require_node()
    if not callable(callback) or isinstance(callback, Symbol):
        return conditions.type_error(callback, "FUNCTION", "\nwhen binding ROSLISP::CALLBACK")
    plain_function(callback, f"the callback for {topic}")
    cls = _type_or_warning(topic, topic_type)
    if cls is None:
        return None
    name, limit = here.resolve(topic), _limit(max_queue_length)
    subscription, waiting = _subscription(here, name), []
    if subscription is not None and subscription.type is not cls:
        return ros_error(
            "Asserted topic type ~a for new subscription to ~a did not match existing type ~a",
            cls.ros_type,
            name,
            subscription.type.ros_type,
        )
    if subscription is None and not _agrees_elsewhere(here, name, cls, "subscribe"):
        return None
    problem = _publishers_of_another_type(here, name, cls)
    if problem is not None:
        conditions.warn(
            "~a", f"Received error {problem} when attempting to setup subscription to {name} of type {cls.ros_type}, so not subscribing."
        )
        return None
    first = subscription is None
    if first:
        subscription = Subscription(here, name, cls, limit)
    subscriber = Subscriber(name, subscription, receiver(cls, callback))
    subscription.callbacks.insert(0, subscriber)
    if first:
        waiting = here.add_subscription(subscription)
    for publisher in waiting:
        publisher.wait_for_spin(f"{publisher.name} to accept the subscription to {name}")
    return subscriber


def _publishers_of_another_type(here: Node, name: str, cls: MessageType) -> str | None:
    """The publishers' complaint if none of them has messages of class ``cls``, else ``None``."""
    topic = here.graph.topics.get(name)
    publications = topic.visible_publications if topic is not None else []
    if not publications or any(same_on_the_wire(publication.type, cls) for publication in publications):
        return None
    return publications[0].mismatch(here, cls)


def _subscription(here: Node, name: str) -> Subscription | None:
    return next((entry for entry in here.subscriptions.get(name, ()) if isinstance(entry, Subscription)), None)


def _type_or_warning(topic: str, topic_type: TypeName) -> MessageType | None:
    def give_up(condition):
        shown_type = topic_type if isinstance(topic_type, str) else formatted("~a", (topic_type,))
        conditions.warn("~a", f"Couldn't lookup topic type {shown_type} for {topic}, so not subscribing.")

    return conditions.handler_case([(Error, give_up)], lambda: topic_class(topic_type))


def _limit(length: object) -> int | None:
    if length is None or isinstance(length, Symbol) and length.name == "INFTY":
        return None
    if length.__class__ is not int or length < 1:
        return conditions.error("The queue of a subscription must hold at least one message, but :max-queue-length is ~s.", length)
    return length


def unsubscribe(subscriber: Subscriber) -> MultipleValues:
    """Remove the callback of ``subscriber``; removing the last one ends the subscription. Returns no values.

    If the callback is gone already, it is an error.
    """
    if not isinstance(subscriber, Subscriber):
        return conditions.type_error(subscriber, "ROSLISP::SUBSCRIBER", "\nwhen binding ROSLISP::SUBSCRIBER")
    subscription = subscriber.subscription
    if subscription.closed or subscriber not in subscription.callbacks:
        return ros_error("Subscription to topic `~a' invalid.", subscriber.topic)
    subscription.callbacks.remove(subscriber)
    if not subscription.callbacks:
        subscription.node.unsubscribe(subscription)
    return NO_VALUES
