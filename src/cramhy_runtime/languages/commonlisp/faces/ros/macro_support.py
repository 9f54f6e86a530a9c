"""What the macros of ``hy_src/cramhy/roslisp.hy`` expand into: field paths and specs arrive as Lisp lists."""

from __future__ import annotations

import sys

from cramhy_runtime.lisp_core.data import Symbol, python_list, truth
from ....operators import ROSLISP
from ...packages.face_definition import define_face, define_meanings
from cramhy_runtime.lisp_core.packages import symbol_name
from cramhy_runtime.ros import message_building, messages
from cramhy_runtime.ros.roslisp import logging, node, services, time, topics, utilities
from cramhy_runtime.utilities.generated_functions import generated_function


def _path(spec):
    """The field path of a spec: a symbol, or a list of symbols read inside-out; a trailing ``-val`` of a name is dropped."""
    names = [symbol_name(name) for name in ([spec] if isinstance(spec, Symbol) else python_list(spec))]
    return tuple(name.removesuffix("-VAL") for name in names)


class _CallSite:
    """What ``make-message`` says of a message at one place of the program: its field paths, turned into Python once.

    ``makers`` has for each class a function of the values that makes the message directly, without default parts that would be
    replaced; or `message_building.make_message` with the specs does it, in the cases that need care: a field that is not there, or
    given twice, or inside of a part that is given as a whole.
    """

    __slots__ = ("paths", "specs", "makers")

    def __init__(self, paths):
        self.paths = paths  # held, so that its id is not given to another list
        self.specs = [_path(spec) for spec in python_list(paths)]
        self.makers = {}

    def maker(self, designator):
        cls = messages.message_class(designator)
        maker = self.makers.get(cls)
        if maker is None:
            maker = _direct_maker(cls, self.specs) or self._careful_maker(cls)
            self.makers[cls] = maker
        if designator.__class__ is str:
            self.makers[designator] = maker
        return maker

    def _careful_maker(self, cls):
        return lambda *values: message_building.make_message(cls, list(zip(self.specs, values)))


def _direct_maker(cls, specs):
    """A function of the values that makes a message of ``cls`` by calls of classes, or ``None`` when the specs are not that plain."""
    tree = {}
    for number, spec in enumerate(specs):
        space = tree
        for name in reversed(spec[1:]):
            space = space.setdefault(name, {})
            if space.__class__ is not dict:
                return None
        if space.setdefault(spec[0], number) != number:
            return None
    scope = {}

    def call(part, space):
        arguments = []
        for name, below in space.items():
            field = next((field for field in part.fields if field.name.upper() == name), None)
            if field is None:
                return None
            if below.__class__ is int:
                value = f"v{below}"
            else:
                inner = None if field.is_array or field.primitive else messages.message_class_exact(field.base)
                value = inner and call(inner, below)
                if value is None:
                    return None
            arguments.append(f"{field.attribute}={value}")
        name = f"c{len(scope)}"
        scope[name] = messages.maker(part)
        return f"{name}({', '.join(arguments)})"

    text = call(cls, tree)
    if text is None:
        return None
    parameters = [f"v{number}" for number in range(len(specs))]
    return generated_function(f"making {cls.ros_type}", "make", parameters, [f"return {text}"], scope)


MOST_SITES = 10_000  # a form typed at the REPL is a place of its own, which nobody comes back to
_sites: dict = {}


def _site(paths):
    site = _sites.get(id(paths))
    if site is None or site.paths is not paths:
        if len(_sites) >= MOST_SITES:
            _sites.clear()
        site = _sites[id(paths)] = _CallSite(paths)
    return site


def _specs(paths, values):
    return list(zip(_site(paths).specs, values))


def build_message(designator, paths, *values):
    """``make-message``: ``paths`` is a constant of the program, one list of field specs per call in the text."""
    site = _site(paths)
    maker = site.makers.get(designator) if designator.__class__ is str else None
    return (maker or site.maker(designator))(*values)


def build_request(designator, paths, *values):
    return message_building.make_request(designator, _specs(paths, values))


def build_publisher_message(publication, paths, *values):
    return build_message(topics.publication_type(publication), paths, *values)


def changed_message(message, paths, *values):
    return message_building.modify_message_copy(message, _specs(paths, values))


_symbol_paths = {}


def message_field(message, path):
    """The field that ``with-fields`` binds; a plan reads five in a tick, so the path of a symbol is made once."""
    names = _symbol_paths.get(path) if isinstance(path, Symbol) else _path(path)
    if names is None:
        names = _symbol_paths[path] = _path(path)
    return message_building.get_field(message, names)


def log_enabled(level, topic):
    """Whether a line of ``level`` (a number) under ``topic`` (a list) would be printed."""
    return True if logging.enabled(level, tuple(logging.topic_path(topic))) else None


def log_line(level, topic, control, *arguments):
    return logging.ros_log(level, topic, control, *arguments)


def with_ros_node(options, spin, body):
    name, *rest = python_list(options)
    keywords = {key.name.lower().replace("-", "_"): value for key, value in zip(rest[::2], rest[1::2])}
    return node.with_ros_node(name, body, spin=truth(spin), **keywords)


def spin_until(test, increment, timeout, body):
    return time.spin_until(test, increment, body, timeout)


def call_named_service(service_name, service_symbol, return_field, request):
    return services.call_named(service_name, service_symbol, return_field, *python_list(request))


def define():
    """Let Common Lisp see it; called once, when the image is made."""
    define_meanings(ROSLISP, logging, message_building, services, time, utilities, adapters=sys.modules[__name__])
    define_face("CRAMHY", functions={message_building: "make-response"})
