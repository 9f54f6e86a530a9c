"""What a ROS tool asks of the graph, however it reaches it: the ground on which the tools stand.

`Graph` is written down once for both ways: `here` is the graph of this process, for a command typed at the prompt; `there` is the
session of another terminal, or a real ROS, through its rosbridge server. Messages, requests and responses are plain data as in
`ros.message_json`, and times are seconds.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import NamedTuple


OPEN_PAGE = "/cramhy/open_page"
"""The service by which another terminal asks a session for its page."""
reached = []
"""The graphs that were reached through a server, which may be asked for types (`there`)."""


class NoSession(Exception):
    """There is no graph to reach: the text says what to start."""


class SessionEnded(Exception):
    """The other end has gone, in the middle of what was asked."""


class Refused(Exception):
    """A service did not answer a request, or the graph did not take what it was told. ``lost``: the server went away meanwhile."""

    def __init__(self, text, lost=False):
        super().__init__(text)
        self.lost = lost


class NodeFacts(NamedTuple):
    """The names that a node publishes on, subscribes to and serves, each sorted."""

    publishing: list
    subscribing: list
    services: list


class Graph(ABC):
    """A graph of ROS. Names are global."""

    pid = 0

    @abstractmethod
    def nodes(self):
        """The names of all nodes, sorted."""

    @abstractmethod
    def node(self, name):
        """The `NodeFacts` of a node, or ``None``."""

    @abstractmethod
    def uri(self, node):
        """Where a node is reached: ``"127.0.0.1:40001"``."""

    def process(self, node):
        """The number of the process that a node runs in."""
        return self.pid

    @abstractmethod
    def ping(self, node):
        """Ask a node for an answer: the seconds that it took."""

    @abstractmethod
    def kill(self, node):
        """End a node. Raises `Refused` where that cannot be done."""

    @abstractmethod
    def topics(self):
        """The types of all topics by name, sorted by name."""

    @abstractmethod
    def publishers(self, topic):
        """The names of the nodes that publish on ``topic``."""

    @abstractmethod
    def subscribers(self, topic):
        """The names of the nodes that are subscribed to ``topic``."""

    @abstractmethod
    def services(self):
        """The names of all services, sorted."""

    @abstractmethod
    def service(self, name):
        """The node that offers a service, and its type; ``None`` when there is no such service."""

    @abstractmethod
    def call(self, name, ros_type, request):
        """The response of a service, or `Refused`."""

    @abstractmethod
    def listen(self, topic, ros_type):
        """A context manager that gives a `Listener`."""

    @abstractmethod
    def talk(self, topic, ros_type, latch):
        """A context manager that gives a function which publishes a message."""

    @abstractmethod
    def parameter_names(self):
        """The names of all parameters, sorted."""

    @abstractmethod
    def parameter(self, name):
        """The value of a parameter, or `KeyError`."""

    @abstractmethod
    def set_parameter(self, name, value):
        """Give a parameter a value. Raises `Refused`."""

    @abstractmethod
    def delete_parameter(self, name):
        """Remove a parameter, or `KeyError`."""

    @abstractmethod
    def now(self):
        """The time, in seconds since 1970."""

    @abstractmethod
    def sleep(self, seconds):
        """Wait. What arrives meanwhile is kept for its listener."""

    def close(self):  # noqa: B027 - the graph of this process is not let go of
        """Let go of the graph."""


class Listener(ABC):
    """Messages of a topic, one after the other."""

    @abstractmethod
    def take(self, until=None):
        """The next message with the time at which it came; ``None`` when it is ``until``, a time as of `Graph.now`, and none came."""
