"""The two ends of a topic: publications, and the subscriptions of nodes in Python.

A publication knows its connections and hands them each message; there is no queue on this side, so what is published before
somebody listens is lost unless the topic latches. A connection is any object with ``node``, ``type``, ``closed``,
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
    """What ``advertise`` returns: one node's side of a topic. ``connections`` are subscriptions."""

    __slots__ = ("node", "name", "type", "latch", "last_message", "connections", "hidden")
    lisp_name = "ROSLISP::PUBLICATION"

    def __init__(self, node: Node, name: str, message_type: MessageType, latch: bool = False):
        self.node, self.name, self.type, self.latch = node, name, message_type, latch
        self.last_message: RosMessage | None = None
        self.connections: list[Connection] = []
        self.hidden = 0

    @property
    def subscribers(self) -> int:
        """How many connections there are, not counting those to hidden nodes."""
        return len(self.connections) - self.hidden

    def connect(self, subscription: Connection) -> None:
        """Write to ``subscription`` from now on; a latched message reaches it at once."""
        if subscription in self.connections or subscription.closed:
            return
        if not same_on_the_wire(subscription.type, self.type):
            self.node.complain(self.mismatch(subscription.node, subscription.type))
            return
        self.connections.append(subscription)
        self.hidden += subscription.node.hidden
        if self.latch and self.last_message is not None:
            subscription.receive(wire.fresh(self.last_message))

    def mismatch(self, client: Node, message_type: MessageType) -> str:
        """What this node says to ``client``, a node that wants messages of another type."""
        return (
            f"Client [{client.name}] wants topic {self.name} to have datatype [{message_type.ros_type}], "
            f"but our version has [{self.type.ros_type}]. Dropping connection."
        )

    def disconnect(self, subscription: Connection) -> None:
        """Write to ``subscription`` no more."""
        if subscription in self.connections:
            self.connections.remove(subscription)
            self.hidden -= subscription.node.hidden

    def publish(self, message: RosMessage) -> int:
        """Send ``message``, whatever it holds; the number of connections. Type errors are signalled here."""
        if not self.connections and not self.latch:
            return 0
        received = wire.transmit(message)
        if message.ros_type != self.type.ros_type:
            for subscription in list(self.connections):
                subscription.spoiled(self, message)
            return self.subscribers
        return self.send(received)

    def send(self, received: RosMessage) -> int:
        """Send a message whose values are such as `wire.transmit` gives; the first receiver gets the object itself.

        The value counts the connections that one may know of: not those to hidden nodes.
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
    """A subscription of a node in Python. The callback runs in the node's spin, or at once when the node does not spin."""

    def __init__(self, node: Node, name: str, message_type: MessageType, callback: Callable[[Any], object], queue: int | None = None):
        self.node, self.name, self.type, self.callback = node, name, message_type, callback
        self.pending: deque[RosMessage] = deque(maxlen=queue)
        self.closed = False

    def receive(self, message: RosMessage) -> None:
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
        """A message of another type came over the wire: roscpp cannot read it, says so, and goes on."""
        self.node.complain(
            f"Exception thrown when deserializing message of type [{message.ros_type}] from "
            f"[{publication.node.name}] on topic [{self.name}], which has type [{self.type.ros_type}]"
        )

    def close(self) -> None:
        self.closed = True
