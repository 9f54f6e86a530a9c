"""What a joined session tells of its nodes: the other half of `joined_nodes`.

It is told to a session of cramhy only. The rosbridge server of ROS has one node for all its clients, and knows no such operation.
"""

from __future__ import annotations

import os

from ..ros.roslisp import logging
from .joined_nodes import OP, SERVER
from .remote_types import TOPIC


class ToldNodes:
    """The nodes of this process, which ``link``, an `attachment.Link`, tells the other side."""

    def __init__(self, link):
        self.link = link
        self._told = None

    @property
    def wanted(self):
        """Whether the other side is a session of cramhy."""
        return self.link.uplink.server == SERVER

    def own(self):
        """The nodes of this process by name, without the collector of its log, which each process has, and the one that is the mirror."""
        mirror = self.link.node
        return {name: node for name, node in self.link.graph.visible_nodes().items() if node is not mirror and name != "/rosout"}

    def tell(self, again=False):
        """Tell the other side which nodes are here, if that has changed, or ``again``."""
        if not self.wanted:
            return
        types = {name: topic.type.ros_type for name, topic in self.link.graph.topics.items()}
        found = {
            name: {
                "pid": os.getpid(),
                "publications": {topic: types[topic] for topic in node.publications},
                "subscriptions": {topic: types[topic] for topic in node.subscriptions},
            }
            for name, node in self.own().items()
        }
        if again or found != self._told:
            self._told = found
            if again or self.link.announced:
                self.link.uplink.send({"op": OP, "nodes": found})

    def end(self, operation):
        """Somebody there has ended a node of ours, or has taken its name."""
        name = operation.get("node")
        node = self.own().get(name)
        if node is not None:
            text = f"{name} is shut down, as {self.link.shown} asks. Reason: {operation.get('reason', '')}"
            logging.log_text(logging.WARN, TOPIC, text)
            node.shutdown()
