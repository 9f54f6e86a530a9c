"""A node around a block, services with keyword arguments, and lines of the log. Source: roslisp.md 2, 4, 7."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager

from cramhy_runtime import kernel
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any

from ..messages import RosMessage, service_type
from ..received import for_python, python_receiver
from ..roslisp import logging, node, services, topics
from ..strict import check, check_type
from ..topics import Publication

if TYPE_CHECKING:
    from collections.abc import Callable

    from ..signatures import Answers, ServiceName, TypeName

Topic = str | tuple[str, ...]
"""What a line of the log is about: ``"arm"``, or a path such as ``("robot", "arm")``."""


@contextmanager
def ros_node(name: str, *, anonymous: bool = False, arguments: Sequence[str] = ()) -> Iterator[None]:
    """``with ros_node("driver"):`` the node runs while the block does, and is shut down on every way out.

    anonymous: append the time to the name. arguments: remappings and private parameters, as behind ``rosrun``: ``["_speed:=2"]``.
    """
    try:
        node.start_ros_node(name, anonymous=anonymous, cmd_line_args=list(arguments))
        yield
    finally:
        with kernel.shield():
            node.shutdown_ros_node()


def publish(topic: str | Publication, message: RosMessage) -> int:
    """Send a message on a topic that was advertised; returns the number of subscribers it reached.

    topic: its name, or what `advertise` returned. Errors: a topic that is not advertised; a TypeError for a message of another type than
    the topic's, and for a value of a wrong type; a ValueError for an integer that is out of range.
    """
    found = node.require_node().publications.get(node.fully_qualified_name(topic)) if isinstance(topic, str) else topic
    if isinstance(found, Publication):
        check_type(message, found.type, found.name)
    return topics.publish(topic, message)


def subscribe(
    topic: str, topic_type: TypeName, callback: Callable[[Any], object], *, max_queue_length: int | None = None
) -> topics.Subscriber | None:
    """Call ``callback`` with every message on ``topic``; returns what `unsubscribe` wants.

    topic_type: a text, ``"sensor_msgs/LaserScan"``, or the class of its messages. max_queue_length: how many messages may wait; older ones
    are dropped. Of an unknown type it warns, and returns None. A ``uint8[]`` arrives as a `bytearray` that is equal to lists, too:
    ``numpy.asarray(image.data)`` sees it without a copy. Other arrays are lists.
    """
    return topics.subscribed(topic, topic_type, callback, max_queue_length, python_receiver)


def call_service(service: str | services.ServiceClient, kind: ServiceName | None = None, /, **fields: object) -> RosMessage | None:
    """Call a service with the fields of its request, ``call_service("/spawn", "turtlesim/Spawn", x=2, y=3)``; its response.

    service: a name, or a client, which has the type. Errors: a failure if nobody offers the service, or if its callback failed; TypeError
    for a field that the request does not have.
    """
    if isinstance(service, services.ServiceClient):
        return _received(services.response_of(service, _checked(service.type.request(**fields))))
    if kind is None:
        raise TypeError(f'call_service needs the type of the service, too: call_service("{service}", "std_srvs/Empty").')
    found = service_type(kind)
    return _received(services.response_of(service, found.name, _checked(found.request(**fields))))


def _received(response: RosMessage | None) -> RosMessage | None:
    return None if response is None else for_python(response)


def register_service(name: str, kind: ServiceName, callback: Answers) -> None:
    """Offer a service: ``callback(request)`` returns the response, or a dict of its fields. It ends with the node.

    Errors: a failure if the node offers a service of that name already.
    """
    found = service_type(kind)

    def answer(request: RosMessage) -> RosMessage:
        response = callback(request)
        return _checked(found.response(**response) if isinstance(response, dict) else response)

    services.offered(name, answer, kind, python_receiver)


def _checked(message: RosMessage) -> RosMessage:
    if isinstance(message, RosMessage):
        check(message)
    return message


def ros_debug(topic: Topic, text: str) -> None:
    """Log a line for debugging, if the level of the topic lets it pass."""
    logging.log_about(logging.DEBUG, topic, text)


def ros_info(topic: Topic, text: str) -> None:
    """Log a line: ``ros_info("arm", f"at {speed} m/s")``. It goes to the standard output, to the log file and to ``/rosout``."""
    logging.log_about(logging.INFO, topic, text)


def ros_warn(topic: Topic, text: str) -> None:
    """Log a warning."""
    logging.log_about(logging.WARN, topic, text)


def ros_error(topic: Topic, text: str) -> None:
    """Log an error."""
    logging.log_about(logging.ERROR, topic, text)


def ros_fatal(topic: Topic, text: str) -> None:
    """Log an error that ends the program."""
    logging.log_about(logging.FATAL, topic, text)


def log_level(topic: Topic, level: str | int) -> None:
    """Print lines about ``topic`` from ``level`` on: "debug", "info", "warn", "error" or "fatal". Errors: an unknown level."""
    logging.set_debug_level(topic, level.upper() if isinstance(level, str) else level)
