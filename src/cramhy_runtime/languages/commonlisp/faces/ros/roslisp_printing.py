"""How objects of roslisp print: publications, subscriptions, services. Messages: ``message_printing.py``."""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import list_from
from cramhy_runtime.lisp_core.packages import sym
from cramhy_runtime.lisp_core.printing import define_printer
from cramhy_runtime.lisp_core.printing import print_slots
from cramhy_runtime.ros.services import Service
from cramhy_runtime.ros.topics import Publication
from cramhy_runtime.ros.roslisp.master import Uri
from cramhy_runtime.ros.roslisp.services import ServiceClient
from cramhy_runtime.ros.roslisp.topics import Subscriber, Subscription


class _Named:
    """Something that prints as ``#<text>``: what stands for a socket or a thread in the printed form of a subscriber."""

    def __init__(self, text):
        self.text = text


def _print_named(obj, stream):
    stream.write(f"#<{obj.text}>")


def _print_publication(publication, stream):
    shown = [subscription for subscription in publication.connections if not subscription.node.hidden]
    connections = list_from([_Named(f"CONNECTION to {subscription.node.name}") for subscription in shown])
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
    publishers = [_Named(f"CONNECTION from {publication.node.name}") for publication in (topic.visible_publications if topic else ())]
    queue = _Named(f"ROSLISP-QUEUE:QUEUE with {len(subscription.queue)} elements")
    print_slots(
        sym("ROSLISP::SUBSCRIPTION"),
        [
            ("SUB-TOPIC-TYPE", subscription.type.ros_type),
            ("BUFFER", queue),
            ("TOPIC-THREAD", _Named(f'SB-THREAD:THREAD "{subscription.task_name}"')),
            ("CALLBACKS", list_from([subscriber.callback for subscriber in subscription.callbacks])),
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


def define():
    """Let Common Lisp see it; called once, when the image is made."""
    define_printer(_Named, _print_named)
    define_printer(Publication, _print_publication)
    define_printer(Subscription, _print_subscription)
    define_printer(Subscriber, _print_subscriber)
    define_printer(Service, _print_service)
    define_printer(Uri, _print_uri)
    define_printer(ServiceClient, _print_client)
