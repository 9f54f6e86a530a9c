"""How values are told in messages: on one line, and not too long."""

from __future__ import annotations

from cramhy_runtime.cpl.tree.tree_report import cut, short
from cramhy_runtime.ground.data import Cons
from ..ros.messages import RosMessage

LONGEST = 160
"""Characters of a message that are shown."""


def value_text(value):
    """``value`` on one line: printed, but a message as its fields, ``x 5.544 y 5.544 theta 0``."""
    if value.__class__ is int or value is None or value is True:
        return _quick(value)
    if not isinstance(value, RosMessage):
        return short(value)
    text = " ".join(f"{name} {shown}" for name, shown in _fields(value, ""))
    return text if len(text) <= LONGEST else text[: LONGEST - 3] + "..."


def _quick(value):
    """What `short` gives for the commonest values."""
    return "NIL" if value is None else "T" if value is True else cut(str(value))


def _fields(message, prefix):
    for field, value in zip(message.fields, message.values()):
        name = prefix + field.name
        if isinstance(value, float):
            yield name, f"{value:.4g}"
        elif value.__class__ is int or value is None or value is True:
            yield name, _quick(value)
        elif isinstance(value, RosMessage):
            yield from _fields(value, name + ".")
        elif isinstance(value, (list, tuple, Cons)):
            yield name, f"({len(list(value))} elements)"
        else:
            yield name, short(value)
