"""The two ends of a topic: publications, and the subscriptions of nodes in Python.

A publication knows its connections and gives them each message. There is no queue on this side, so a message without a
subscriber is lost unless the topic latches. A connection is any object with ``node``, ``type``, ``closed``,
``receive(message)`` and ``spoiled(publication, message)``: `NativeSubscription` here, and the queue and task of the Lisp
program's subscriptions in ``roslisp/topics.py``. Source: roslisp.md 6, wiki.ros.org/Topics.
"""

from __future__ import annotations

from collections import deque

from .. import kernel
from . import wire
from .type_texts import same_on_the_wire
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable
    from .graph import Node
    from .messages import RosMessage
    from .signatures import Connection, MessageType


class Publication:
    """One node's publishing end of a topic (from ``advertise``). ``connections``: the connected subscriptions.

    ``hidden``: how many of them belong to hidden nodes. ``on_listeners``: called when a subscriber has come or gone, or ``None``; a node
    whose messages take long to make learns there whether somebody listens.
    """

    __slots__ = ("node", "name", "type", "latch", "last_message", "connections", "hidden", "on_listeners")
    lisp_name = "ROSLISP::PUBLICATION"

    def __init__(self, node: Node, name: str, message_type: MessageType, latch: bool = False):
        self.node, self.name, self.type, self.latch = node, name, message_type, latch
        self.last_message: RosMessage | None = None
        self.connections: list[Connection] = []
        self.hidden = 0
        self.on_listeners: Callable[[], object] | None = None

    @property
    def subscribers(self) -> int:
        """The number of connections, without those to hidden nodes."""
        return len(self.connections) - self.hidden

    def connect(self, subscription: Connection) -> None:
        """Send to ``subscription`` from now on, and a latched message at once. If its type differs, log an error instead."""
        if subscription in self.connections or subscription.closed:
            return
        if not same_on_the_wire(subscription.type, self.type):
            self.node.complain(self.mismatch(subscription.node, subscription.type))
            return
        self.connections.append(subscription)
        self.hidden += subscription.node.hidden
        if self.latch and self.last_message is not None:
            subscription.receive(wire.fresh(self.last_message))
        if self.on_listeners is not None:
            self.on_listeners()

    def mismatch(self, client: Node, message_type: MessageType) -> str:
        """The text of the error about ``client``, a node that wants messages of ``message_type``, another type."""
        return (
            f"Client [{client.name}] wants topic {self.name} to have datatype [{message_type.ros_type}], "
            f"but our version has [{self.type.ros_type}]. Dropping connection."
        )

    def disconnect(self, subscription: Connection) -> None:
        """Stop sending to ``subscription``."""
        if subscription in self.connections:
            self.connections.remove(subscription)
            self.hidden -= subscription.node.hidden
            if self.on_listeners is not None:
                self.on_listeners()

    def publish(self, message: RosMessage) -> int:
        """Check and send ``message``; returns the number of subscribers. A wrong value in a field is an error of serialisation."""
        if not self.connections and not self.latch:
            return 0
        received = wire.transmit(message)
        if message.ros_type != self.type.ros_type:
            for subscription in list(self.connections):
                subscription.spoiled(self, message)
            return self.subscribers
        return self.send(received)

    def send(self, received: RosMessage) -> int:
        """Send ``received``, a message as from `wire.transmit`. The first receiver gets the object itself, the others get copies.

        Returns the number of subscribers, without those of hidden nodes.
        """
        if self.latch:
            self.last_message = wire.fresh(received)
        connections = self.connections
        count = len(connections)
        if count == 1:
            connections[0].receive(received)
        elif count:
            first, *others = connections  # a list of our own, since a callback may connect or disconnect somebody
            for subscription in others:
                subscription.receive(wire.fresh(received))
            first.receive(received)
        return count - self.hidden


class NativeSubscription:
    """A subscription of a node in Python. The callback runs in the node's spin, or at once if the node does not spin."""

    def __init__(self, node: Node, name: str, message_type: MessageType, callback: Callable[[Any], object], queue: int | None = None):
        self.node, self.name, self.type, self.callback = node, name, message_type, callback
        self.pending: deque[RosMessage] = deque(maxlen=queue)
        self.closed = False

    def receive(self, message: RosMessage) -> None:
        """Call the callback with ``message`` at once, or queue it for the node's spin."""
        if self.node.spins:
            self.pending.append(message)
            self.node.inbox.append(self._handle)
        elif not self.closed:
            self._call(message)

    def _handle(self) -> None:
        if self.pending and not self.closed:
            self._call(self.pending.popleft())

    def _call(self, message: RosMessage) -> None:
        try:
            self.callback(message)
        except Exception as problem:  # neither the publisher nor the other subscribers have to do with it
            kernel.unhandled(kernel.current(), problem)

    def spoiled(self, publication: Publication, message: RosMessage) -> None:
        """Log that ``message`` from ``publication`` has another type, and drop it, as roscpp does."""
        self.node.complain(
            f"Exception thrown when deserializing message of type [{message.ros_type}] from "
            f"[{publication.node.name}] on topic [{self.name}], which has type [{self.type.ros_type}]"
        )

    def close(self) -> None:
        """End the subscription: waiting messages are not delivered."""
        self.closed = True
