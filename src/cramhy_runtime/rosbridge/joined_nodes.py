"""The nodes of a process that has joined this session: in ROS each process has nodes of its own at the master, so `rosnode list` has them.

A client of rosbridge is no node, but another session of cramhy that joins tells by the operation "nodes", which is ours, what it has:

    {"op": "nodes", "nodes": {"/talker": {"pid": 4711, "publications": {"/chatter": "std_msgs/String"}, "subscriptions": {}}}}

Each time it tells all of them. The nodes here have the ends of these topics for whoever asks; messages go through the hidden node of the
hub, so that each arrives once, however many nodes the process has. A service belongs to the node that ``advertise_service`` names. The
nodes go with the connection, and so when the process is killed. A node that is ended here, by `rosnode kill` or because another one has
taken its name, is ended there: the process is told by ``{"op": "end_node", "node": NAME, "reason": TEXT}``.
"""

from __future__ import annotations

from ..ros.names import check_graph_name
from ..ros.roslisp import logging
from .hub import Refused
from .operation_fields import integer, shown
from .parsing import json_type
from .remote_types import TOPIC

SERVER = "cramhy"
"""How our server calls itself in the handshake: a session that joins knows by it that its nodes can be told."""
OP, END = "nodes", "end_node"
USER_REQUEST, SAME_NAME = "user request", "new node registered with same name"
"""The reasons that ROS 1's master gives a node that is to end."""


class JoinedNodes:
    """The nodes of the client of ``session``, by name."""

    def __init__(self, session):
        self.session, self.graph = session, session.hub.graph
        self._nodes = {}
        self._ended = set()  # which the client has been told to end, and may still name

    def get(self, name):
        """The node called ``name``, or ``None``."""
        return self._nodes.get(name)

    def declare(self, told):
        """Have the nodes that the client told, the value of "nodes", and no others. Raises `Refused`, and changes nothing then."""
        wanted = self._checked(told)
        self._ended &= wanted.keys()
        for name in self._nodes.keys() - wanted.keys():
            self._leave(name)
        for name, (pid, publications, subscriptions) in wanted.items():
            if name in self._ended:
                continue
            node = self._nodes.get(name) or self._enter(name, pid)
            for topic in node.publications.keys() - publications.keys():
                node.unadvertise(topic)
            for topic in node.subscriptions.keys() - subscriptions.keys():
                node.unsubscribe(topic)
            for topic in publications.keys() - node.publications.keys():
                node.advertise(topic, publications[topic])
            for topic in subscriptions.keys() - node.subscriptions.keys():
                node.subscribe(topic, subscriptions[topic], lambda message: None)

    def close(self):
        """The client has gone."""
        for name in list(self._nodes):
            self._leave(name)

    def _enter(self, name, pid):
        before = self.graph.nodes.get(name)
        if before is not None and before.process is None:
            logging.log_text(
                logging.WARN, TOPIC, f"{name} is shut down, since the process {pid} that has joined has a new node of that name."
            )
        node = self._nodes[name] = self.graph.node(name)
        node.process = pid
        node.on_shutdown.append(lambda: self._is_down(name, node))
        return node

    def _leave(self, name):
        self._nodes.pop(name).shutdown()

    def _is_down(self, name, node):
        """NODE has ended. If it was not the client who ended it, he is told, when it is known whether another one has its name."""
        if self._nodes.get(name) is not node:
            return
        del self._nodes[name]
        self._ended.add(name)

        def tell():
            self.session.send({"op": END, "node": name, "reason": SAME_NAME if name in self.graph.nodes else USER_REQUEST})

        self.graph.kernel.post(tell)

    # -------------------------------------------------------------------------------------------------------------- checking

    def _checked(self, told):
        """``{name: (pid, publications, subscriptions)}``, both with classes of messages by topic."""
        limit = self.session.limits.nodes
        if not isinstance(told, dict):
            raise Refused(f'"nodes" must be an object, with a name of a node for each key, but it is {json_type(told)}.')
        if len(told) > limit:
            raise Refused(f"You have {len(told)} nodes; {limit} are allowed.")
        return {self._name(name): self._facts(name, facts) for name, facts in told.items()}

    def _name(self, name):
        full = name if name.startswith("/") else f"/{name}"
        complaint = check_graph_name(full)
        if complaint or full.endswith("/") or "//" in full or len(full) > self.session.limits.name:
            raise Refused(f"{full[:60]} is not a name of a node: {complaint or 'a part of it is empty, or it is too long.'}")
        there = self.graph.nodes.get(full)
        if there is not None and there.hidden:
            raise Refused(f"The name {full} is taken by the session itself.")
        return full

    def _facts(self, name, facts):
        if not isinstance(facts, dict):
            raise Refused(f'The node {name} must be an object with "pid", "publications" and "subscriptions", but it is {shown(facts)}.')
        limits = self.session.limits
        publications = self._topics(name, facts, "publications", limits.advertisements)
        return integer(facts, "pid") or 0, publications, self._topics(name, facts, "subscriptions", limits.subscriptions)

    def _topics(self, name, facts, key, most):
        told = facts.get(key, {})
        if not isinstance(told, dict):
            raise Refused(f'"{key}" of the node {name} must be an object from topics to types, but it is {json_type(told)}.')
        if len(told) > most:
            raise Refused(f"The node {name} has {len(told)} {key}; {most} are allowed.")
        found = {}
        for topic, ros_type in told.items():
            full = self.session.hub.name(topic, "topic")
            try:
                found[full] = self.session.hub.message_type(full, ros_type)
            except Refused:
                pass  # of another type than here, or of an unknown one: the client is told when it advertises the topic or subscribes to it
        return found
