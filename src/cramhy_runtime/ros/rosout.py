"""The common log of all nodes: levels, the topic ``/rosout``, and the node of the same name that collects it.

To log, a node publishes a ``rosgraph_msgs/Log`` on ``/rosout``; the collector sends it on as ``/rosout_agg``. `Graph.log` keeps the
last entries, as tuples (level, node name, text). ``roslisp/logging.py`` prints the lines of roslisp. Source: roslisp.md 4.2, 4.3,
wiki.ros.org/rosout.
"""

from __future__ import annotations

from .loggers import DEBUG, ERROR, FATAL, INFO, LEVEL_CODES, LEVEL_NAMES, WARN, Loggers
from .messages import message_class_exact
from .wire import ros_text
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING

if TYPE_CHECKING:
    from .graph import Node


__all__ = ["DEBUG", "ERROR", "FATAL", "INFO", "LEVEL_CODES", "LEVEL_NAMES", "WARN", "join", "report"]


def report(node: Node, level: int, text: str) -> int:
    """Publish a log entry of ``node`` on ``/rosout``, and keep it in the graph's log; returns the number of subscribers."""
    node.graph.log.append((level, node.name, text))
    publication = node.publications.get("/rosout")
    if publication is None or not publication.connections:
        return 0
    return publication.send(message_class_exact("rosgraph_msgs/Log")(name=node.name, level=level, msg=ros_text(text)))


def join(node: Node, delay: float = 0.0) -> None:
    """Let ``node`` publish its log. After ``delay`` seconds, the node ``/rosout`` begins to collect it for ``/rosout_agg``."""
    graph, log_type = node.graph, message_class_exact("rosgraph_msgs/Log")
    if "/rosout" not in graph.nodes:
        collector = graph.node("rosout")
        aggregate = collector.advertise("/rosout_agg", log_type)
        collector.subscribe("/rosout", log_type, aggregate.send)
        Loggers(collector, "rosout")
    subscription = graph.nodes["/rosout"].subscriptions["/rosout"][0]
    publication = node.advertise("/rosout", log_type)
    if delay:
        publication.disconnect(subscription)
        graph.kernel.call_at(graph.kernel.now() + delay, lambda: publication.connect(subscription) if node.alive else None)
