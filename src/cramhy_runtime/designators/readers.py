"""Reader functions of designators, under the Lisp names of their slots."""

from __future__ import annotations

from ..lisp.condition_types import UnboundSlot
from ..lisp.conditions import error
from ..lisp.data import UNBOUND
from .symbols import sym


def description(designator):
    """The whole description, a list of ``(key value)``."""
    return designator.description


properties = description


def parent(designator):
    return designator.parent


def successor(designator):
    return designator.successor


def effective(designator):
    return designator.effective


def quantifier(designator):
    return designator.quantifier


def timestamp(designator):
    """Seconds at which it was first resolved; nil before."""
    return designator.timestamp


def object_pose(data):
    return _slot(data, "pose")


def object_color(data):
    return _slot(data, "color")


def object_identifier(data):
    return _slot(data, "object_identifier")


def designator(condition):
    """The designator of a ``designator-error``."""
    return condition.designator


def _slot(data, attribute):
    value = getattr(data, attribute)
    return error(UnboundSlot(sym(f"DESIG::{attribute.upper()}"), data)) if value is UNBOUND else value
