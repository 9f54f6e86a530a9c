"""What the macros of ``hy_src/cramhy/roslisp.hy`` expand into: field paths and specs arrive as Lisp lists."""

from __future__ import annotations

from ..lisp.data import Symbol, python_list, truth
from ..lisp.faces import define_face
from ..lisp.packages import symbol_name
from . import logging, message_building, node, services, time, topics, utilities


def _path(spec):
    """The field path of a spec: a symbol, or a list of symbols read inside-out; a trailing ``-val`` of a name is dropped."""
    names = [symbol_name(name) for name in ([spec] if isinstance(spec, Symbol) else python_list(spec))]
    return tuple(name.removesuffix("-VAL") for name in names)


_paths: dict = {}


def _specs(paths, values):
    # ``paths`` is a constant of the program, so it is turned into Python once
    known = _paths.get(id(paths))
    if known is None or known[0] is not paths:
        known = _paths[id(paths)] = (paths, [_path(spec) for spec in python_list(paths)])
    return list(zip(known[1], values))


def build_message(designator, paths, *values):
    return message_building.make_message(designator, _specs(paths, values))


def build_request(designator, paths, *values):
    return message_building.make_request(designator, _specs(paths, values))


def build_publisher_message(publication, paths, *values):
    return message_building.make_message(topics.publication_type(publication), _specs(paths, values))


def changed_message(message, paths, *values):
    return message_building.modify_message_copy(message, _specs(paths, values))


def message_field(message, path):
    return message_building.get_field(message, _path(path))


def log_enabled(level, topic):
    """Whether a line of ``level`` (a number) under ``topic`` (a list) would be printed."""
    return True if logging.enabled(level, tuple(logging.topic_path(topic))) else None


def log_line(level, topic, control, *arguments):
    return logging.ros_log(level, topic, control, *arguments)


def set_debug_levels(names, *levels):
    return logging.set_debug_levels(*[item for pair in zip(python_list(names), levels) for item in pair])


def with_ros_node(options, spin, body):
    name, *rest = python_list(options)
    keywords = {key.name.lower().replace("-", "_"): value for key, value in zip(rest[::2], rest[1::2])}
    return node.with_ros_node(name, body, spin=truth(spin), **keywords)


def spin_until(test, increment, timeout, body):
    return time.spin_until(test, increment, body, timeout)


def call_named_service(service_name, service_symbol, return_field, request):
    return services.call_named(service_name, service_symbol, return_field, *python_list(request))


define_face(
    "CRAMHY",
    functions={
        "build-message": build_message,
        "build-request": build_request,
        "build-publisher-message": build_publisher_message,
        "changed-message": changed_message,
        "message-field": message_field,
        "log-enabled": log_enabled,
        "ros-log-line": log_line,
        "set-debug-levels": set_debug_levels,
        "with-ros-node": with_ros_node,
        "ros-spin-until": spin_until,
        "loop-at-most-every": time.loop_at_most_every,
        "with-parallel-thread": time.with_parallel_thread,
        "register-init-function": utilities.register_ros_init_function,
        "register-cleanup-function": utilities.register_ros_cleanup_function,
        "register-service-of": services.register_service,
        "make-service-response": message_building.make_response,
        "call-named-service": call_named_service,
    },
)
