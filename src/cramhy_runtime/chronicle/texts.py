"""How values are told in messages: on one line, and not too long."""

from __future__ import annotations

from cramhy_runtime.cpl.tree.tree_report import cut, short
from cramhy_runtime.lisp_core.data import Cons
from cramhy_runtime.utilities.generated_functions import generated_function
from ..ros.messages import RosMessage

LONGEST = 160
"""Characters of a message that are shown."""


def value_text(value):
    """``value`` on one line: printed, but a message as its fields, ``x 5.544 y 5.544 theta 0``."""
    if value.__class__ is int or value is None or value is True:
        return _quick(value)
    if not isinstance(value, RosMessage):
        return short(value)
    text = _message_text(value)
    return text if len(text) <= LONGEST else text[: LONGEST - 3] + "..."


_texts = {}


def _message_text(message):
    """The fields of a message: by a function that is written for its type, since fluents that follow a turtle have a new one each tick."""
    cls = message.__class__
    text = _texts.get(cls)
    if text is None:
        parts = [
            f"    f'{field.name} {{value:.4g}}' if isinstance(value := message.{field.attribute}, float) else told({field.name!r}, value),"
            for field in cls.fields
        ]
        body = ["return ' '.join((", *parts, "))"]
        text = _texts[cls] = generated_function(f"telling {cls.ros_type}", "text", ["message"], body, {"told": _told})
    return text(message)


def _told(name, value):
    return " ".join(f"{field} {shown}" for field, shown in _field(name, value))


def _quick(value):
    """What `short` gives for the commonest values."""
    return "NIL" if value is None else "T" if value is True else cut(str(value))


def _field(name, value):
    if isinstance(value, float):
        yield name, f"{value:.4g}"
    elif value.__class__ is int or value is None or value is True:
        yield name, _quick(value)
    elif isinstance(value, RosMessage):
        for field, part in zip(value.fields, value.values()):
            yield from _field(f"{name}.{field.name}", part)
    elif isinstance(value, (list, tuple, Cons)):
        yield name, f"({len(list(value))} elements)"
    else:
        yield name, short(value)
