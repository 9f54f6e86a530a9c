"""What the clients of one server share on the graph: nodes, topics that they listen to, topics that they publish on.

Clients are no nodes, as with rosbridge in ROS: one node, ``/rosbridge_websocket``, subscribes and publishes for all of them. It is on
the graph while some client does either. But a session that has joined has nodes (`joined_nodes`).
A client that says it is an observer (our page, our tools) acts through a hidden node, and so leaves no trace in what a program or a command
line shows.

A `Channel` hands each message of a topic to the server's thread once, however many clients listen. What happens here happens with the
baton; `Hub.hand_out` takes functions to the other side.
"""

from __future__ import annotations

from collections import deque

from ..ros.message_json import MessageJsonError, type_named
from ..ros.names import check_graph_name
from .encoding import Parcel
from .guard import Limits

NODE = "rosbridge_websocket"
OBSERVER = "rosbridge_observer"


class Refused(Exception):
    """An operation that cannot be done; the text is for the client. ``level``: of the status message."""

    def __init__(self, text, level="error"):
        super().__init__(text)
        self.level = level


class Channel:
    """The messages of a topic for all clients that listen. ``feeds`` is replaced, never changed, since two threads look at it."""

    def __init__(self, side, topic, message_type):
        self.side, self.topic, self.type = side, topic, message_type
        self.feeds = ()
        self.backlog = deque()
        self.handed = False
        self.lost = 0
        self._taken_in = self._given_out = 0  # of bytes; each thread changes its own
        self._wanted = {}
        self._keep = 0
        self._subscription = None

    def add(self, feed, keep):
        """Have FEED get what comes from now on, and what a latched topic said last. KEEP: how many messages it wants kept at most."""
        self.feeds = (*self.feeds, feed)
        self.keep(feed, keep)
        if self._subscription is None:
            self._subscription = self.side.node.subscribe(self.topic, self.type, self.receive)
            return
        for publication in self.side.hub.graph.topics[self.topic].publications:
            if publication.latch and publication.last_message is not None and publication.type is self.type:
                parcel = self._parcel(publication.last_message)
                self.side.hub.hand_out(lambda parcel=parcel: feed.offer(parcel))

    def keep(self, feed, number):
        """FEED wants NUMBER messages kept at most; as many are kept as the most demanding feed wants."""
        self._wanted[feed] = number
        self._keep = max(self._wanted.values())

    def remove(self, feed):
        """FEED gets nothing more."""
        self.feeds = tuple(other for other in self.feeds if other is not feed)
        del self._wanted[feed]
        self.side.hub.hand_out(feed.close)
        if self.feeds:
            self._keep = max(self._wanted.values())
        else:
            self.side.node.unsubscribe(self._subscription)
            del self.side.channels[self.topic]
            self.side.tidy()

    def _parcel(self, message):
        return Parcel(self.topic, message, self.side.hub.graph.now())

    def receive(self, message):
        """The callback of the subscription: in the plan's way, so it does next to nothing."""
        backlog, parcel = self.backlog, self._parcel(message)
        self._taken_in += parcel.weight
        backlog.append(parcel)
        heavy = self.side.hub.limits.heavy
        while len(backlog) > self._keep or self._taken_in - self._given_out > heavy and len(backlog) > 1:
            try:
                self._taken_in -= backlog.popleft().weight
                self.lost += 1
            except IndexError:
                break  # the other thread was quicker
        if not self.handed:
            self.handed = True
            self.side.hub.hand_out(self.deliver)

    def deliver(self):
        """In the server's thread: give every feed what has come."""
        self.handed = False
        if self.lost:
            self.lost = 0
            for feed in self.feeds:
                if feed.promised:
                    feed.outbox.overflow(
                        f"Messages of {self.topic} come faster than they can be sent. Subscribe with throttle_rate or queue_length."
                    )
        backlog = self.backlog
        while backlog:
            try:
                parcel = backlog.popleft()
            except IndexError:
                return
            self._given_out += parcel.weight
            for feed in self.feeds:
                feed.offer(parcel)


class Side:
    """One of the hub's two nodes, which is there while clients need it."""

    def __init__(self, hub, name, hidden):
        self.hub, self.name, self.hidden = hub, name, hidden
        self.channels = {}
        self.publishers = {}
        self._node = None

    @property
    def node(self):
        if self._node is None or not self._node.alive:
            self._node = self.hub.graph.node(self.name, hidden=self.hidden)
        return self._node

    def listen(self, topic, message_type, feed, keep):
        """Have FEED get the messages of TOPIC; see `Channel.add`."""
        channel = self.channels.get(topic)
        if channel is None:
            channel = self.channels[topic] = Channel(self, topic, message_type)
        channel.add(feed, keep)
        return channel

    def advertise(self, topic, message_type, session, latch=False):
        """The publication for SESSION, which shares it with other clients."""
        publication, holders = self.publishers.get(topic) or (self.node.advertise(topic, message_type, latch), set())
        holders.add(session)
        self.publishers[topic] = publication, holders
        return publication

    def unadvertise(self, topic, session):
        publication, holders = self.publishers[topic]
        holders.discard(session)
        if not holders:
            del self.publishers[topic]
            self.node.unadvertise(topic)
            self.tidy()

    def tidy(self):
        """Leave the graph when nobody needs the node."""
        if self._node is not None and not (self._node.publications or self._node.subscriptions or self._node.services):
            self._node.shutdown()
            self._node = None


class Hub:
    """graph: where the clients' topics are. hand_out: called with a function that shall run in the server's thread."""

    def __init__(self, graph, hand_out=lambda function: function(), limits=None):
        self.graph, self.hand_out, self.limits = graph, hand_out, limits or Limits()
        self.sides = {False: Side(self, NODE, False), True: Side(self, OBSERVER, True)}
        self.sessions = set()

    def answer_all(self):
        """Every call that a client waits for is answered, since the session ends."""
        for session in list(self.sessions):
            session.answer_all()

    def close(self):
        """Every client goes."""
        for session in list(self.sessions):
            session.close()

    # ------------------------------------------------------------------------------------------------------ names and types

    def name(self, value, what):
        """The global name that a client gave for WHAT, "topic" or "service"."""
        if not isinstance(value, str) or not value:
            raise Refused(f'A {what} is named by a string, such as "/turtle1/pose".')
        if len(value) > self.limits.name:
            raise Refused(f"The name of the {what} has {len(value)} characters; {self.limits.name} are allowed.")
        full = value if value.startswith("/") else "/" + value
        known = self.graph.topics if what == "topic" else self.graph.services
        if full not in known:
            complaint = check_graph_name(full)
            if complaint or full.endswith("/") or "//" in full:
                raise Refused(complaint or f"{full} is not a name of a {what}: a part of it is empty.")
        return full

    def message_type(self, topic, given):
        """The class of the messages on TOPIC, which a client may have named (GIVEN, or ``None``)."""
        established = self.graph.topics.get(topic)
        if given is None or given == "":
            if established is None:
                raise Refused(f"Nobody publishes on {topic} or listens to it yet, so its type is not known. Give the type, too.")
            return established.type
        try:
            found = type_named(given)
        except MessageJsonError as problem:
            raise Refused(str(problem)) from None
        if established is not None and established.type.ros_type != found.ros_type:
            raise Refused(f"The topic {topic} has messages of the type {established.type.ros_type}, not {found.ros_type}.")
        return found
