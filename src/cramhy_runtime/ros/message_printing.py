"""How messages and roslisp's own objects print.

A message is a block, its fields one below the other, names at column 3 and values at column 5 after the bracket; a part of a
message is shown in its list form, and what lies below that as a block again, because that is what roslisp's pretty-print
function does (roslisp.md 5.7). Without ``*print-pretty*``, or with the initial dispatch table of Common Lisp (as
``with-standard-io-syntax`` has it), a message is ``#<TURTLESIM-MSG:POSE {...}>``.
"""

from __future__ import annotations

from ..lisp.data import list_from
from ..lisp.packages import sym
from ..lisp.printer.pprint_dispatch import INITIAL, PRINT_PPRINT_DISPATCH
from ..lisp.printer.pretty import logical_block, pprint_indent, pprint_newline
from ..lisp.printer.print_controls import PRINT_PRETTY
from ..lisp.printer.printer import define_printer, output_object, print_unreadable
from ..lisp.printer.standard_printers import print_slots
from ..lisp.streams.streams import output_stream
from .message_building import ros_message_to_list
from .messages import RosMessage, ServiceType
from .node import Uri
from .services import Service, ServiceClient
from .topics import Publication, Subscriber, Subscription


def print_message(message, stream):
    """The printer of all messages."""
    if PRINT_PRETTY.value is None or PRINT_PRETTY.value is False or PRINT_PPRINT_DISPATCH.value is INITIAL:
        print_unreadable(message, stream, body=lambda: output_object(message.lisp_symbol, stream), identity=True)
        return
    with logical_block(stream, "[", "]") as out:
        output_object(message.lisp_symbol, out)
        for field, value in zip(message.fields, message.values()):
            pprint_indent("block", 2, out)
            pprint_newline("mandatory", out)
            out.write(field.name.upper() + ":")
            pprint_indent("block", 4, out)
            pprint_newline("mandatory", out)
            output_object(ros_message_to_list(value) if isinstance(value, RosMessage) else value, out)


def pprint_ros_message(stream_or_message, message=None):
    """``roslisp:pprint-ros-message``: ``(message)`` or ``(stream message)``."""
    if message is None:
        print_message(stream_or_message, sym("*STANDARD-OUTPUT*").value)
    else:
        print_message(message, output_stream(stream_or_message))


class _Named:
    """Something that prints as ``#<text>``: what stands for a socket or a thread in the printed form of a subscriber."""

    def __init__(self, text):
        self.text = text


def _print_named(obj, stream):
    stream.write(f"#<{obj.text}>")


def _print_publication(publication, stream):
    connections = list_from([_Named(f"CONNECTION to {subscription.node.name}") for subscription in publication.connections])
    print_slots(
        sym("ROSLISP::PUBLICATION"),
        [
            ("PUB-TOPIC-TYPE", publication.type.ros_type),
            ("SUBSCRIBER-CONNECTIONS", connections),
            ("IS-LATCHING", True if publication.latch else None),
            ("LAST-MESSAGE", publication.last_message),
        ],
        stream,
    )


def _print_subscription(subscription, stream):
    topic = subscription.node.graph.topics.get(subscription.name)
    publishers = [_Named(f"CONNECTION from {publication.node.name}") for publication in (topic.publications if topic else ())]
    queue = _Named(f"ROSLISP-QUEUE:QUEUE with {len(subscription.queue)} elements")
    print_slots(
        sym("ROSLISP::SUBSCRIPTION"),
        [
            ("SUB-TOPIC-TYPE", subscription.type.ros_type),
            ("BUFFER", queue),
            ("TOPIC-THREAD", _Named(f'SB-THREAD:THREAD "{subscription.task_name}"')),
            ("CALLBACKS", list_from(subscription.callbacks)),
            ("PUBLISHER-CONNECTIONS", list_from(publishers)),
        ],
        stream,
    )


def _print_subscriber(subscriber, stream):
    print_slots(
        sym("ROSLISP::SUBSCRIBER"),
        [("TOPIC", subscriber.topic), ("SUBSCRIPTION", subscriber.subscription), ("CALLBACK", subscriber.callback)],
        stream,
    )


def _print_service(service, stream):
    print_slots(sym("ROSLISP::SERVICE"), [("NAME", service.name), ("ROS-TYPE", service.type.name)], stream)


def _print_uri(uri, stream):
    print_slots(sym("ROSLISP::URI"), [("ADDRESS", uri.address), ("PORT", uri.port)], stream)


def _print_client(client, stream):
    print_slots(sym("ROSLISP::SERVICE-CLIENT"), [("SERVICE-NAME", client.name), ("SERVICE-TYPE", client.type.name)], stream)


define_printer(RosMessage, print_message)
define_printer(_Named, _print_named)
define_printer(Publication, _print_publication)
define_printer(Subscription, _print_subscription)
define_printer(Subscriber, _print_subscriber)
define_printer(Service, _print_service)
define_printer(Uri, _print_uri)
define_printer(ServiceClient, _print_client)
define_printer(ServiceType, lambda service, stream: stream.write(f"#<SERVICE-TYPE {service.name}>"))
