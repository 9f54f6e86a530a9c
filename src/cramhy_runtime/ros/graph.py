"""The graph: the nodes of this process and what connects them. It does the work of ``roscore`` and of the sockets.

Nodes live in one process and messages are objects, so a connection is a list entry. Two kinds of nodes are told apart by when
they look at what arrives. A *spinning* node, like turtlesim, looks once per tick of its own timer: requests, commands and new
connections wait for `Node.spin_once`. Every other node is served at once: the node of the Lisp program, whose callbacks run
in tasks of its own, and small tools.

There is one active graph per kernel, as there is one roscore per user. Laws: what a tick does is one step for all tasks (law
4); all waiting goes through the kernel (law 5); a node that ends takes its topics, services and waiting callers along (law 1).
"""

from __future__ import annotations

from collections import deque

from .. import kernel
from .names import Naming
from .parameters import ParameterTree

_active = None


class Graph:
    """All nodes, topics, services and parameters of one kernel."""

    def __init__(self, owner):
        self.kernel = owner
        self.nodes = {}
        self.topics = {}
        self.services = {}
        self.parameters = ParameterTree()
        self.log = deque(maxlen=1000)
        self.lisp_node = None
        self.debug_levels = {}
        self.before_first_node = []
        self._ports = 0

    def now(self):
        """Seconds since 1970, by the kernel's clock."""
        clock = self.kernel.clock
        return clock.epoch + clock.now()

    def node(self, name, namespace="/", spins=False):
        """A new node called ``name``, relative to ``namespace``; one of the same name is shut down first, as ROS does."""
        return self.add_node(Naming(name, namespace), spins)

    def add_node(self, naming, spins=False):
        old = self.nodes.get(naming.node_name)
        if old is not None:
            old.shutdown()
        node = self.nodes[naming.node_name] = Node(self, naming, spins)
        return node

    def topic(self, name, message_type):
        """The topic ``name``; made with that type when nobody has used it yet."""
        topic = self.topics.get(name)
        if topic is None:
            topic = self.topics[name] = Topic(name, message_type)
        return topic

    def next_address(self):
        self._ports += 1
        return f"127.0.0.1:{40000 + self._ports}"


class Topic:
    """A name with the publications and subscriptions of all nodes, in order of registration."""

    __slots__ = ("name", "type", "publications", "subscriptions")

    def __init__(self, name, message_type):
        self.name, self.type = name, message_type
        self.publications, self.subscriptions = [], []


class Node:
    """A participant of the graph. ``spins``: it looks at what arrives only in `spin_once`."""

    def __init__(self, graph, naming, spins=False):
        self.graph, self.naming, self.spins = graph, naming, spins
        self.name = naming.node_name
        self.address = graph.next_address()
        self.publications = {}
        self.subscriptions = {}
        self.services = {}
        self.alive = True
        self.inbox = []
        self._accepted = []
        self.on_shutdown = []

    def __repr__(self):
        return f"<node {self.name}>"

    def resolve(self, name):
        return self.naming.resolve(name)

    # --------------------------------------------------------------------------------------------- for nodes in Python

    def advertise(self, name, message_type, latch=False):
        """Publish on ``name`` from now on; returns the `Publication`. Subscribers that are there are connected at once."""
        from .topics import Publication

        name = self.resolve(name)
        publication = self.publications.get(name)
        if publication is None:
            publication = self.publications[name] = Publication(self, name, message_type, latch)
            topic = self.graph.topic(name, message_type)
            topic.publications.append(publication)
            for subscription in topic.subscriptions:
                publication.connect(subscription)
        return publication

    def unadvertise(self, name):
        """Stop publishing on the global name ``name``; true when it was advertised."""
        publication = self.publications.pop(name, None)
        if publication is None:
            return False
        self.graph.topics[name].publications.remove(publication)
        publication.connections.clear()
        self._forget_topic(name)
        return True

    def subscribe(self, name, message_type, callback, queue=None):
        """Have ``callback(message)`` called for every message on ``name``: in `spin_once` of a spinning node, else at once.

        It must not wait. ``queue``: how many messages may wait for the spin; older ones are dropped.
        """
        from .topics import NativeSubscription

        subscription = NativeSubscription(self, self.resolve(name), message_type, callback, queue)
        self.add_subscription(subscription)
        return subscription

    def add_subscription(self, subscription):
        """Register ``subscription`` and connect it; returns the spinning publishers that must accept it first."""
        self.subscriptions[subscription.name] = subscription
        topic = self.graph.topic(subscription.name, subscription.type)
        topic.subscriptions.append(subscription)
        waiting = []
        for publication in topic.publications:
            if publication.node.spins:
                publication.node.inbox.append(lambda publication=publication: publication.connect(subscription))
                waiting.append(publication.node)
            else:
                publication.connect(subscription)
        return waiting

    def unsubscribe(self, name):
        """Drop the subscription to the global name ``name``."""
        subscription = self.subscriptions.pop(name, None)
        if subscription is not None:
            subscription.close()
            topic = self.graph.topics[name]
            topic.subscriptions.remove(subscription)
            for publication in topic.publications:
                publication.disconnect(subscription)
            self._forget_topic(name)

    def serve(self, name, service_type, handler):
        """Offer the service ``name``; ``handler(request)`` returns the response or raises `services.Refusal`."""
        from .services import Service

        service = Service(self, self.resolve(name), service_type, handler)
        self.services[service.name] = self.graph.services[service.name] = service
        return service

    def withdraw(self, name):
        """Stop offering the service with the global name ``name``. Callers that wait are told."""
        service = self.services.pop(name, None)
        if service is not None:
            if self.graph.services.get(name) is service:
                del self.graph.services[name]
            service.close()

    def spin_once(self):
        """Handle everything that arrived since the last time, in order of arrival."""
        inbox = self.inbox
        if inbox:
            self.inbox = []
            for callback in inbox:
                callback()

    def wait_for_spin(self, why):
        """Park the current task until this spinning node has finished its next tick."""
        task = kernel.current()
        entry = [task, False]
        self._accepted.append(entry)
        while self.alive and not entry[1]:
            kernel.park(why)

    def tick_done(self):
        """A spinning node calls this at the end of each tick: who waited for a connection goes on."""
        if self._accepted:
            waiting, self._accepted = self._accepted, []
            for entry in waiting:
                entry[1] = True
                kernel.unpark(entry[0])

    def shutdown(self):
        """Leave the graph: topics, services and subscriptions go, and nobody is left waiting."""
        if not self.alive:
            return
        for name in list(self.services):
            self.withdraw(name)
        for name in list(self.publications):
            self.unadvertise(name)
        for name in list(self.subscriptions):
            self.unsubscribe(name)
        self.alive = False
        self.inbox.clear()
        self.tick_done()
        if self.graph.nodes.get(self.name) is self:
            del self.graph.nodes[self.name]
        if self.graph.lisp_node is self:
            self.graph.lisp_node = None
        for function in self.on_shutdown:
            function()

    def _forget_topic(self, name):
        topic = self.graph.topics[name]
        if not topic.publications and not topic.subscriptions:
            del self.graph.topics[name]


def active():
    """The graph of the active kernel; a fresh one when the kernel is new."""
    global _active
    owner = kernel.active()
    if _active is None or _active.kernel is not owner:
        if owner is None:
            raise kernel.KernelError("There is no ROS graph without a kernel. Call kernel.start() first.")
        _active = Graph(owner)
    return _active
