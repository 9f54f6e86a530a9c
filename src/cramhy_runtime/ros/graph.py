"""The graph: the nodes of this process and their connections. It does the work of ``roscore`` and of the sockets.

All nodes live in one process and messages are objects, so a connection is a list entry. There are two kinds of nodes. A
*spinning* node, like turtlesim, looks at its input once per tick of its own timer: requests, commands and new connections
wait for `Node.spin_once`. Every other node receives its input at once: the node of the Lisp program, whose callbacks run in
tasks of their own, and small tools.

A *hidden* node (``Graph.node("cramhy_view", hidden=True)``) is an observer of ours: a page, a recorder. It must not change
what a program or a command line shows. So it does not count as a subscriber, and it makes no log lines that others see. All
lists shown to users come from `Graph.visible_nodes`, `visible_topics` and `visible_services`, which leave out hidden nodes
and the topics and services of hidden nodes alone.

Observers of changes append a function to `Graph.on_change`. The task that makes the change calls it as ``function(kind, name,
there)`` with the kind ``"node"``, ``"topic"`` or ``"service"``, for visible ones only. The function must not wait.

A session that is joined to a robot (room ``rosbridge``) sets two more attributes. `Graph.type_elsewhere` is a function of a
topic's name and a message class. If the topic has another type on the robot, it returns that type and where it is; it waits for
the answer. `Graph.cut_off` is a text that says why the robot cannot be reached at the moment, or ``None``.

`Graph.on_demand` has functions by the first part of names: ``"arm"`` for ``/arm/state``. The first who asks for such a topic or service,
when there is none and no node ``/arm``, starts it: a simulator that need not run while nobody wants it.

There is one active graph per kernel, as there is one roscore per user. Laws: a tick is one step for all tasks (law 4); all
waiting goes through the kernel (law 5); a node that ends takes its topics, services and waiting callers along (law 1).
"""

from __future__ import annotations

from collections import deque

from cramhy_runtime.kernel.images import Cell
from .. import kernel
from . import rosout
from .names import Naming
from .parameter_tree import ParameterTree
from .services import Service
from .topics import NativeSubscription, Publication
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any, TypeVar

if TYPE_CHECKING:
    from collections.abc import Callable
    from .messages import RosMessage, ServiceType
    from .signatures import Connection, Handler, MessageType, Observer

M = TypeVar("M", bound="RosMessage")
_active: Cell[Graph | None] = Cell(None, fresh=True)


class Graph:
    """All nodes, topics, services and parameters of one kernel."""

    def __init__(self, owner: kernel.Kernel):
        self.kernel = owner
        self.nodes: dict[str, Node] = {}
        self.topics: dict[str, Topic] = {}
        self.services: dict[str, Service] = {}
        self.parameters = ParameterTree(owner.clock.epoch)
        self.log: deque[tuple[int, str | None, str]] = deque(maxlen=1000)  # level, node, text
        self.on_change: list[Observer] = []
        self.lisp_node: Node | None = None
        self.debug_levels: dict[tuple[str, ...], int] = {}
        self.before_first_node: list[Callable[[], object]] = []
        self.on_demand: dict[str, Callable[[], object]] = {}
        self.type_elsewhere: Callable[[str, MessageType], tuple[str, str] | None] | None = None
        self.cut_off: str | None = None
        self.joined: object = None  # the `rosbridge.attachment.Link` to another graph
        self._ports = 0

    def now(self) -> float:
        """The time of the kernel's clock, in seconds since 1970."""
        clock = self.kernel.clock
        return clock.epoch + clock.now()

    def node(self, name: str, namespace: str = "/", spins: bool = False, hidden: bool = False) -> Node:
        """Make a node called ``name``, relative to ``namespace``. As in ROS, a node of the same name is shut down first.

        ``spins``: whether the node handles its input only in `Node.spin_once`. ``hidden``: whether users do not see it.
        """
        return self.add_node(Naming(name, namespace), spins, hidden)

    def add_node(self, naming: Naming, spins: bool = False, hidden: bool = False) -> Node:
        """Make a node as `node` does, with ``naming``, a `Naming`."""
        old = self.nodes.get(naming.node_name)
        if old is not None:
            old.shutdown()
        node = self.nodes[naming.node_name] = Node(self, naming, spins, hidden)
        if not hidden:
            self.changed("node", node.name, True)
        return node

    def topic(self, name: str, message_type: MessageType) -> Topic:
        """The topic with the global name ``name``; if there is none, it is made with the type ``message_type``."""
        if name not in self.topics:
            self._start_on_demand(name)
        topic = self.topics.get(name)
        if topic is None:
            topic = self.topics[name] = Topic(name, message_type)
        return topic

    def service(self, name: str) -> Service | None:
        """The service with the global name ``name``, or ``None``."""
        if name not in self.services:
            self._start_on_demand(name)
        return self.services.get(name)

    def _start_on_demand(self, name: str) -> None:
        if self.on_demand:
            first = name.lstrip("/").partition("/")[0]
            start = self.on_demand.get(first)
            if start is not None and f"/{first}" not in self.nodes:
                start()

    def next_address(self) -> str:
        """A new address for a node, as ``"127.0.0.1:40001"``; there is no socket behind it."""
        self._ports += 1
        return f"127.0.0.1:{40000 + self._ports}"

    # ------------------------------------------------------------------------------------------- what users are shown

    def visible_nodes(self) -> dict[str, Node]:
        """The nodes that are not hidden, by name, sorted."""
        return {name: node for name, node in sorted(self.nodes.items()) if not node.hidden}

    def visible_topics(self) -> dict[str, Topic]:
        """The topics that a visible node publishes on or listens to, by name, sorted."""
        return {name: topic for name, topic in sorted(self.topics.items()) if topic.visible}

    def visible_services(self) -> dict[str, Service]:
        """The services of visible nodes, by name, sorted."""
        return {name: service for name, service in sorted(self.services.items()) if not service.node.hidden}

    def changed(self, kind: str, name: str, there: bool) -> None:
        """Tell the observers that a visible ``kind`` of thing called ``name`` has come (``there`` is true) or gone."""
        for function in list(self.on_change):
            try:
                function(kind, name, there)
            except Exception as problem:  # the node that comes or goes has nothing to do with it
                kernel.unhandled(kernel.current(), problem)


class Topic:
    """A name with the publications and subscriptions of all nodes, in order of registration."""

    __slots__ = ("name", "type", "publications", "subscriptions")

    def __init__(self, name: str, message_type: MessageType):
        self.name, self.type = name, message_type
        self.publications: list[Publication] = []
        self.subscriptions: list[Connection] = []

    @property
    def visible(self) -> bool:
        """Whether a visible node publishes on the topic or listens to it."""
        return bool(self.visible_publications or self.visible_subscriptions)

    @property
    def visible_publications(self) -> list[Publication]:
        """The publications of visible nodes."""
        return [publication for publication in self.publications if not publication.node.hidden]

    @property
    def visible_subscriptions(self) -> list[Connection]:
        """The subscriptions of visible nodes."""
        return [subscription for subscription in self.subscriptions if not subscription.node.hidden]


class Node:
    """A participant of the graph. ``spins``: it handles its input only in `spin_once`. ``hidden``: users do not see it.

    ``publications`` and ``services`` are dictionaries by global name. ``subscriptions`` has a list for each global name, since
    a node may listen to a topic with several callbacks.
    """

    def __init__(self, graph: Graph, naming: Naming, spins: bool = False, hidden: bool = False):
        self.graph, self.naming, self.spins, self.hidden = graph, naming, spins, hidden
        self.name = naming.node_name
        self.address = graph.next_address()
        self.publications: dict[str, Publication] = {}
        self.subscriptions: dict[str, list[Connection]] = {}
        self.services: dict[str, Service] = {}
        self.alive = True
        self.inbox: deque[Callable[[], object]] = deque()
        self._accepted: list[list[Any]] = []
        self.on_shutdown: list[Callable[[], object]] = []
        self.program: object = None  # the `roscpp.Program` whose node it is
        self.process: int | None = None  # the number of the process whose node it is, if it is not this one

    def __repr__(self) -> str:
        return f"<node {self.name}>"

    def resolve(self, name: str) -> str:
        """The global name that ``name`` means to this node."""
        return self.naming.resolve(name)

    def complain(self, text: str) -> None:
        """Log ``text``, an error between this node and another one."""
        rosout.report(self, rosout.ERROR, text)

    # ---------------------------------------------------------------------------------------------------- topics

    def advertise(self, name: str, message_type: MessageType, latch: bool = False) -> Publication:
        """Publish messages of ``message_type`` on ``name`` from now on; returns the `Publication`.

        Present subscribers are connected at once. ``latch``: whether new subscribers get the last message.
        """
        name = self.resolve(name)
        publication = self.publications.get(name)
        if publication is None:
            topic = self.graph.topic(name, message_type)
            publication = self.publications[name] = Publication(self, name, message_type, latch)
            self._join(topic, topic.publications, publication)
            for subscription in list(topic.subscriptions):
                publication.connect(subscription)
        return publication

    def unadvertise(self, name: str) -> bool:
        """Stop publishing on the global name ``name``; returns whether the node published on it."""
        publication = self.publications.pop(name, None)
        if publication is None:
            return False
        for subscription in list(publication.connections):
            publication.disconnect(subscription)
        topic = self.graph.topics[name]
        self._leave(topic, topic.publications, publication)
        return True

    def subscribe(self, name: str, message_type: type[M], callback: Callable[[M], object], queue: int | None = None) -> NativeSubscription:
        """Call ``callback(message)`` for every message on ``name``: in `spin_once` of a spinning node, else at once.

        ``callback`` must not wait. ``queue``: how many messages may wait for the spin; older ones are dropped. Returns the
        subscription.
        """
        subscription = NativeSubscription(self, self.resolve(name), message_type, callback, queue)
        self.add_subscription(subscription)
        return subscription

    def add_subscription(self, subscription: Connection) -> list[Node]:
        """Register ``subscription`` and connect it; returns the spinning publishers that must accept it first."""
        self.subscriptions.setdefault(subscription.name, []).append(subscription)
        topic = self.graph.topic(subscription.name, subscription.type)
        self._join(topic, topic.subscriptions, subscription)
        waiting = []
        for publication in list(topic.publications):
            if publication.node.spins:
                publication.node.inbox.append(lambda publication=publication: publication.connect(subscription))
                waiting.append(publication.node)
            else:
                publication.connect(subscription)
        return waiting

    def unsubscribe(self, name: str | Connection) -> None:
        """End all subscriptions to the global name ``name``, or a single one if ``name`` is a subscription."""
        if isinstance(name, str):
            gone = self.subscriptions.pop(name, ())
        else:
            subscription, name = name, name.name
            rest = [other for other in self.subscriptions.get(name, ()) if other is not subscription]
            gone = () if len(rest) == len(self.subscriptions.get(name, ())) else (subscription,)
            if rest:
                self.subscriptions[name] = rest
            else:
                self.subscriptions.pop(name, None)
        for subscription in gone:
            subscription.close()
            topic = self.graph.topics[name]
            for publication in topic.publications:
                publication.disconnect(subscription)
            self._leave(topic, topic.subscriptions, subscription)

    def _join(self, topic: Topic, ends: list[Any], end: object) -> None:
        news = not (self.hidden or topic.visible)
        ends.append(end)
        if news:
            self.graph.changed("topic", topic.name, True)

    def _leave(self, topic: Topic, ends: list[Any], end: object) -> None:
        ends.remove(end)
        if not topic.publications and not topic.subscriptions:
            del self.graph.topics[topic.name]
        if not (self.hidden or topic.visible):
            self.graph.changed("topic", topic.name, False)

    # -------------------------------------------------------------------------------------------------- services

    def serve(self, name: str, service_type: ServiceType, handler: Handler) -> Service:
        """Offer the service ``name`` of type ``service_type``; returns the `Service`.

        ``handler(request)`` returns the response or raises `services.Refusal`.
        """
        return self.add_service(Service(self, self.resolve(name), service_type, handler))

    def add_service(self, service: Service) -> Service:
        """Offer ``service`` and return it. It replaces a service of the same name."""
        self.withdraw(service.name)
        self.services[service.name] = self.graph.services[service.name] = service
        if not self.hidden:
            self.graph.changed("service", service.name, True)
        return service

    def withdraw(self, name: str) -> None:
        """Stop offering the service with the global name ``name``. Waiting callers are told."""
        service = self.services.pop(name, None)
        if service is not None:
            if self.graph.services.get(name) is service:
                del self.graph.services[name]
                if not self.hidden:
                    self.graph.changed("service", name, False)
            service.close()

    # -------------------------------------------------------------------------------------------- spinning, ending

    def spin_once(self) -> None:
        """Handle all input since the last call, in order of arrival. Input that arrives meanwhile waits for the next call."""
        inbox = self.inbox
        for _ in range(len(inbox)):
            if not inbox:  # the node was shut down
                return
            inbox.popleft()()

    def wait_for_spin(self, why: str) -> None:
        """Park the current task until this spinning node has finished its next tick. ``why``: the reason that reports show."""
        task = kernel.current()
        entry = [task, False]
        self._accepted.append(entry)
        while self.alive and not entry[1]:
            kernel.park(why)

    def tick_done(self) -> None:
        """Resume the tasks in `wait_for_spin`. A spinning node calls this at the end of each tick."""
        if self._accepted:
            waiting, self._accepted = self._accepted, []
            for entry in waiting:
                entry[1] = True
                kernel.unpark(entry[0])

    def shutdown(self) -> None:
        """Leave the graph: end all topics, services and subscriptions, and release all waiting callers."""
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
            if not self.hidden:
                self.graph.changed("node", self.name, False)
        if self.graph.lisp_node is self:
            self.graph.lisp_node = None
        for function in self.on_shutdown:
            function()


def active() -> Graph:
    """The graph of the active kernel; the first call makes it. Without a kernel: a `kernel.KernelError`."""
    owner = kernel.active()
    if _active.value is None or _active.value.kernel is not owner:
        if owner is None:
            raise kernel.KernelError("There is no ROS graph without a kernel. Call kernel.start() first.")
        _active.value = Graph(owner)
    return _active.value
