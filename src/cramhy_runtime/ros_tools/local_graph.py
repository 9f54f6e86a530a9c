"""The graph of this process, for a ROS command that is typed at the prompt: it waits in the kernel's time, like a plan.

What listens and publishes is a node of its own for as long as the command runs. Commands that would go on for ever end with Ctrl-C in
wall time; in virtual time, where they would fill the screen at once, after some seconds of the kernel's clock.
"""

from __future__ import annotations

import os
from collections import deque
from contextlib import contextmanager

from cramhy_runtime import kernel
from cramhy_runtime.ros import graph, message_json, services
from cramhy_runtime.ros.messages import message_class_exact
from cramhy_runtime.rosbridge.remote_types import as_ros1
from .graph_access import Graph, Listener, NodeFacts, Refused


class HereGraph(Graph):
    """The graph that is active in this process. patience: seconds after which a command that does not end by itself ends."""

    pid = os.getpid()

    def __init__(self, patience=None):
        self.graph = graph.active()
        self.end = None if patience is None else kernel.now() + patience

    def nodes(self):
        return list(self.graph.visible_nodes())

    def node(self, name):
        node = self.graph.nodes.get(name)
        return node and NodeFacts(sorted(node.publications), sorted(node.subscriptions), sorted(node.services))

    def uri(self, node):
        return self.graph.nodes[node].address

    def process(self, node):
        return self.graph.nodes[node].process or self.pid

    def ping(self, node):
        before = self.now()
        kernel.yield_()
        return self.now() - before

    def kill(self, node):
        self.graph.nodes[node].shutdown()

    def topics(self):
        return {name: topic.type.ros_type for name, topic in self.graph.visible_topics().items()}

    def publishers(self, topic):
        return [entry.node.name for entry in self.graph.topics[topic].visible_publications]

    def subscribers(self, topic):
        return [entry.node.name for entry in self.graph.topics[topic].visible_subscriptions]

    def services(self):
        return list(self.graph.visible_services())

    def service(self, name):
        service = self.graph.service(name)
        return service and (service.node.name, service.type.name)

    def call(self, name, ros_type, request):
        service = self.graph.services[name]
        answer = services.exchange(service, message_json.from_json(service.type.request, request, self.now()))
        if answer.lost:
            raise Refused("", lost=True)
        if answer.failure is not None:
            raise Refused(str(answer.failure))
        return message_json.to_json(answer.response)

    @contextmanager
    def listen(self, topic, ros_type):
        with self._node() as node:
            yield HereListener(self, node, topic, message_class_exact(ros_type))

    @contextmanager
    def talk(self, topic, ros_type, latch):
        cls = message_class_exact(ros_type)
        with self._node() as node:
            publication = node.advertise(topic, cls, latch=latch)
            yield lambda data: publication.send(message_json.from_json(cls, data, self.now()))

    @contextmanager
    def _node(self):
        node = self.graph.node(f"rostopic_{self.pid}")
        try:
            yield node
        finally:
            node.shutdown()

    def parameter_names(self):
        return self.graph.parameters.names()

    def parameter(self, name):
        return self.graph.parameters.get(name)

    def set_parameter(self, name, value):
        try:
            self.graph.parameters.set(name, value)
        except TypeError as problem:
            raise Refused(str(problem)) from None

    def delete_parameter(self, name):
        self.graph.parameters.delete(name)

    def now(self):
        return self.graph.now()

    def sleep(self, seconds):
        end = kernel.now() + seconds
        if self.end is not None and end > self.end:
            if self.end > kernel.now():
                kernel.sleep(self.end - kernel.now())
            raise OutOfTime
        kernel.sleep(seconds)


class JoinedGraph(HereGraph):
    """The graph of a process that has joined another session, or a real ROS: what is there, and the nodes of this process."""

    def __init__(self, patience=None):
        super().__init__(patience)
        self.link = self.graph.joined

    def _ask(self, service, /, **values):
        return self.link.ask(f"/rosapi/{service}", **values)

    def _ends(self, topic, there, here):
        mirror = self.link.node.name
        own = [] if topic not in self.graph.topics else [name for name in here(topic) if name != mirror]
        return sorted({*there, *own})

    def nodes(self):
        return sorted({*self._ask("nodes")["nodes"], *self.link.told_nodes.own()})

    def node(self, name):
        if name in self.link.told_nodes.own():
            return super().node(name)
        if name not in self.nodes():
            return None
        found = self._ask("node_details", node=name)
        return NodeFacts(*(sorted(found[key]) for key in ("publishing", "subscribing", "services")))

    def uri(self, node):
        return super().uri(node) if node in self.link.told_nodes.own() else self.link.shown.split("/")[2]

    def process(self, node):
        if node in self.link.told_nodes.own():
            return super().process(node)
        if self.graph.service("/cramhy/node_process") is None:
            return 0  # not told there
        return self.link.ask("/cramhy/node_process", node=node)["pid"]

    def ping(self, node):
        if node in self.link.told_nodes.own():
            return super().ping(node)
        before = self.now()
        self._ask("node_details", node=node)
        return self.now() - before

    def kill(self, node):
        if node in self.link.told_nodes.own():
            return super().kill(node)
        if not self.link.told_nodes.wanted:
            raise Refused(f"it runs at {self.link.shown}. Type there: rosnode kill {node}")
        self.link.ask("/cramhy/end_node", node=node)

    def topics(self):
        found = self._ask("topics")
        there = dict(zip(found["topics"], map(as_ros1, found["types"])))
        return dict(sorted({**super().topics(), **there}.items()))

    def publishers(self, topic):
        return self._ends(topic, self._ask("publishers", topic=topic)["publishers"], super().publishers)

    def subscribers(self, topic):
        return self._ends(topic, self._ask("subscribers", topic=topic)["subscribers"], super().subscribers)

    def services(self):
        return sorted({*self._ask("services")["services"], *super().services()})

    def service(self, name):
        found = super().service(name)
        if found is not None and found[0] == self.link.node.name:
            return self._ask("service_node", service=name)["node"], found[1]
        return found


def reached(patience=None):
    """The graph that a command typed at the prompt is about; see `HereGraph`."""
    return (JoinedGraph if graph.active().joined is not None else HereGraph)(patience)


class OutOfTime(Exception):
    """A command that would go on for ever has had its time."""


class HereListener(Listener):
    """A subscription of a node that lives as long as the command."""

    def __init__(self, reached, node, topic, cls):
        self.reached, self.topic = reached, topic
        self.waiting = deque()
        self.task = kernel.current()
        node.subscribe(topic, cls, self._arrived)

    def _arrived(self, message):
        self.waiting.append((self.reached.now(), message))
        if len(self.waiting) == 1:
            kernel.unpark(self.task)

    def take(self, until=None):
        clock = self.reached.graph.kernel.clock
        moment = None if until is None else until - clock.epoch
        end = self.reached.end
        while not self.waiting:
            if end is not None and kernel.now() >= end:
                raise OutOfTime
            if moment is not None and kernel.now() >= moment:
                return None
            kernel.park(f"messages on {self.topic}", min((time for time in (moment, end) if time is not None), default=None))
        stamp, message = self.waiting.popleft()
        return stamp, message_json.to_json(message)
