"""Topics: advertising, publishing, subscribing, and the tasks that callbacks run in.

A publication knows its connections and hands them each message; there is no queue on this side, so what is published before
somebody listens is lost unless the topic latches. On the other side each topic that the Lisp program subscribes to has one
queue and one task, ``Subscriber thread for topic /x``, which runs the callbacks, the newest first; so callbacks of one topic
never overlap, and an error in one is logged while the others go on (roslisp.md 6).
"""

from __future__ import annotations

from collections import deque

from .. import kernel
from ..lisp import conditions
from ..lisp.condition_types import Condition, Error, SimpleError, SimpleTypeError, formatted, shown
from ..lisp.data import NO_VALUES, LispString, Symbol
from ..lisp.format.format import format_to_string
from ..lisp.objects.generic_errors import no_applicable_method, no_primary_method
from . import wire
from .errors import ros_error
from .messages import RosMessage, topic_class


class Publication:
    """What ``advertise`` returns: one node's side of a topic. ``connections`` are subscriptions."""

    __slots__ = ("node", "name", "type", "latch", "last_message", "connections")
    lisp_name = "ROSLISP::PUBLICATION"

    def __init__(self, node, name, message_type, latch=False):
        self.node, self.name, self.type, self.latch = node, name, message_type, latch
        self.last_message = None
        self.connections = []

    def connect(self, subscription):
        """Write to ``subscription`` from now on; a latched message reaches it at once."""
        if subscription in self.connections or subscription.closed:
            return
        if subscription.type.ros_type != self.type.ros_type:
            subscription.node.graph.log.append(
                (
                    8,
                    subscription.node.name,
                    f"Client [{subscription.node.name}] wants topic {self.name} to have "
                    f"datatype {subscription.type.ros_type}, but our version has {self.type.ros_type}. Dropping connection.",
                )
            )
            return
        self.connections.append(subscription)
        if self.latch and self.last_message is not None:
            subscription.receive(wire.fresh(self.last_message))

    def disconnect(self, subscription):
        if subscription in self.connections:
            self.connections.remove(subscription)

    def publish(self, message):
        """Send ``message``, whatever it holds; the number of connections. Type errors are signalled here."""
        if not self.connections and not self.latch:
            return 0
        received = wire.transmit(message)
        if message.ros_type != self.type.ros_type:
            for subscription in self.connections:
                subscription.spoiled(self, message)
            return len(self.connections)
        return self.send(received)

    def send(self, received):
        """Send a message whose values are such as `wire.transmit` gives; the first receiver gets the object itself."""
        if self.latch:
            self.last_message = wire.fresh(received)
        connections = self.connections
        for index in range(1, len(connections)):
            connections[index].receive(wire.fresh(received))
        if connections:
            connections[0].receive(received)
        return len(connections)


class NativeSubscription:
    """A subscription of a node in Python. The callback runs in the node's spin, or at once when the node does not spin."""

    def __init__(self, node, name, message_type, callback, queue=None):
        self.node, self.name, self.type, self.callback = node, name, message_type, callback
        self.pending = deque(maxlen=queue)
        self.closed = False

    def receive(self, message):
        if not self.node.spins:
            self.callback(message)
            return
        self.pending.append(message)
        self.node.inbox.append(self._handle)

    def _handle(self):
        if self.pending and not self.closed:
            self.callback(self.pending.popleft())

    def spoiled(self, publication, message):
        """A message of another type came over the wire: roscpp cannot read it, says so, and goes on."""
        self.node.graph.log.append(
            (
                8,
                self.node.name,
                f"Exception thrown when deserializing message of type [{message.ros_type}] from "
                f"[{publication.node.name}] on topic [{self.name}], which has type [{self.type.ros_type}]",
            )
        )

    def close(self):
        self.closed = True


class Subscription:
    """The Lisp program's side of a topic: queue, task, callbacks (newest first).

    The task lives as long as there are messages to deliver. A task that begins where another one just ended needs no stack
    of its own, so a pose that comes 62 times a second costs no switch of threads, and a report of waiting tasks names only
    those that really wait.
    """

    lisp_name = "ROSLISP::SUBSCRIPTION"

    def __init__(self, node, name, message_type, limit=None):
        self.node, self.name, self.type = node, name, message_type
        self.queue = deque(maxlen=limit)
        self.callbacks = []
        self.closed = False
        self.message, self.remaining = None, []
        self.task = None
        self.task_name = f"Subscriber thread for topic {name}"
        self._handlers = [(Error, self._failed)]

    def receive(self, message):
        self.queue.append(message)
        if self.task is None:
            owner = self.node.graph.kernel
            self.task = owner.spawn(self._run, name=self.task_name, parent=owner.main)

    def spoiled(self, publication, message):
        from . import logging

        logging.log_text(
            logging.DEBUG,
            ("ROSLISP", "DESERIALIZATION-THREAD"),
            f"Dropped a {message.ros_type} that {publication.node.name} sent on {self.name}, whose type is {self.type.ros_type}",
        )

    def close(self):
        self.closed = True
        if self.task is not None and self.task is not kernel.current():
            self.task.cancel("the subscription ended")

    def _run(self):
        try:
            while self.queue or self.remaining:
                try:
                    conditions.handler_case(self._handlers, self._deliver)
                except Condition as condition:  # no error, but nobody handled it: the subscription shall not die of it
                    self._failed(condition)
        finally:
            self.message, self.remaining, self.task = None, [], None

    def _deliver(self):
        queue = self.queue
        while not self.closed:
            while self.remaining:
                self.remaining.pop(0)(self.message)
            if not queue:
                return
            self.message = queue.popleft()
            if len(self.callbacks) == 1:
                self.callbacks[0](self.message)
            else:
                self.remaining = list(self.callbacks)
        queue.clear()
        self.remaining = []

    def _failed(self, condition):
        from . import logging

        logging.log_text(
            logging.ERROR,
            ("ROSLISP", "SERVICE", "TCP"),
            format_to_string("Error during subscriber callback: '~a' for topic item: ~%~a ", condition, self.message),
        )


class Subscriber:
    """What ``subscribe`` returns: one callback of one subscription, for ``unsubscribe``."""

    __slots__ = ("topic", "subscription", "callback")
    lisp_name = "ROSLISP::SUBSCRIBER"

    def __init__(self, topic, subscription, callback):
        self.topic, self.subscription, self.callback = topic, subscription, callback


# ------------------------------------------------------------------------------------------------------ roslisp's functions


def _topic_name(topic, parameter="TOPIC"):
    if not isinstance(topic, (str, LispString)):
        return conditions.type_error(topic, "STRING", f"\nwhen binding ROSLISP::{parameter}")
    return str(topic)


def advertise(topic, topic_type, *, latch=None):
    """Publish on ``topic`` from now on. Advertised already: the publication that is there, unchanged."""
    from . import node

    topic = _topic_name(topic)
    here = node.require_node()
    cls = topic_class(topic_type)
    return here.advertise(topic, cls, latch is not None and latch is not False)


def unadvertise(topic):
    """Stop publishing on ``topic``; 1. Not advertised: a warning."""
    from . import logging, node

    here = node.require_node()
    name = here.resolve(_topic_name(topic))
    if not here.unadvertise(name):
        logging.log_text(logging.WARN, ("ROSLISP", "TOP"), f"Not publishing on {name}")
        conditions.warn("Not publishing on ~a", name)
    return 1


def publish(pub, message):
    """Send ``message`` on ``pub``, a publication or the name of an advertised topic; the number of subscribers reached."""
    publication = pub
    if publication.__class__ is not Publication:
        if not isinstance(pub, (str, LispString)):
            advice = ("What (advertise topic type) returns is published on, or the name of an advertised topic. Has the function been "
                      "called that advertises?")
            return no_primary_method("ROSLISP:PUBLISH", 3, pub, message, advice=advice)
        from . import node

        here = node.require_node()
        name = here.resolve(str(pub))
        publication = here.publications.get(name)
        if publication is None:
            return ros_error("Unknown topic ~a", name)
    elif not publication.node.alive:
        from . import node

        here = node.require_node()
        publication = here.publications.get(publication.name, publication)
    if not isinstance(message, RosMessage):
        return no_applicable_method("ROSLISP-MSG-PROTOCOL:SERIALIZE", 2, message)
    return publication.publish(message)


def publication_type(pub):
    """The message class of a publication object (``publish-msg`` and ``make-publisher-msg`` build on it)."""
    if isinstance(pub, Publication):
        return pub.type
    return conditions.error(
        SimpleTypeError(
            "~a",
            f"Value of #:G418 in\n(THE ROSLISP::PUBLICATION #:G418)\nis\n  {shown(pub)},\nnot a\n  ROSLISP::PUBLICATION.",
            datum=pub,
            expected_type="ROSLISP::PUBLICATION",
        )
    )


def num_subscribers(pub):
    """How many subscribers are connected to a publication object."""
    if not isinstance(pub, Publication):
        return conditions.type_error(pub, "ROSLISP::PUBLICATION", "\nwhen binding ROSLISP::PUB")
    return len(pub.connections)


def subscribe(topic, topic_type, callback, *, max_queue_length=None):
    """Have ``callback`` called with every message on ``topic``; returns a subscriber for `unsubscribe`.

    Waits until publishers that are there have accepted the connection. A type that cannot be found is a warning and NIL.
    ``max_queue_length``: of messages that wait, the oldest are dropped beyond it; nil or ``infty``: unlimited.
    """
    from . import node

    topic = _topic_name(topic)
    here = node.require_node()
    if not callable(callback) or isinstance(callback, Symbol):
        return conditions.type_error(callback, "FUNCTION", "\nwhen binding ROSLISP::CALLBACK")
    cls = _type_or_warning(topic, topic_type)
    if cls is None:
        return None
    name = here.resolve(topic)
    subscription = here.subscriptions.get(name)
    waiting = []
    if subscription is None:
        subscription = Subscription(here, name, cls, _limit(max_queue_length))
        subscription.callbacks.insert(0, callback)
        waiting = here.add_subscription(subscription)
    elif subscription.type is not cls:
        return ros_error(
            "Asserted topic type ~a for new subscription to ~a did not match existing type ~a",
            cls.ros_type,
            name,
            subscription.type.ros_type,
        )
    else:
        subscription.callbacks.insert(0, callback)
    for publisher in waiting:
        publisher.wait_for_spin(f"{publisher.name} to accept the subscription to {name}")
    return Subscriber(name, subscription, callback)


def _type_or_warning(topic, topic_type):
    def give_up(condition):
        shown_type = topic_type if isinstance(topic_type, str) else formatted("~a", (topic_type,))
        conditions.warn("~a", f"Couldn't lookup topic type {shown_type} for {topic}, so not subscribing.")

    return conditions.handler_case([(Error, give_up)], lambda: topic_class(topic_type))


def _limit(length):
    if length is None or isinstance(length, Symbol):
        return None
    if length.__class__ is not int or length < 1:
        return conditions.error(
            SimpleError("~a", f"The queue of a subscription must hold at least one message, but :max-queue-length is {length}.")
        )
    return length


def unsubscribe(subscriber):
    """Remove the callback; the last one ends the subscription. Returns no values."""
    subscription = subscriber.subscription
    if subscription.closed or subscriber.callback not in subscription.callbacks:
        return ros_error("Subscription to topic `~a' invalid.", subscriber.topic)
    subscription.callbacks.remove(subscriber.callback)
    if not subscription.callbacks:
        subscription.node.unsubscribe(subscription.name)
    return NO_VALUES
