"""What rospy refuses and roslisp does not: integers out of range, and truth values or parts that are none. For messages that Python sends.

roslisp cuts integers to their bits, and takes every value but NIL for true (roslisp.md 5.2), so messages of Lisp are not checked here.
Source: genpy's checks in ``rospy.Publisher.publish``.
"""

from __future__ import annotations

import reprlib

from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any

from .arrays import OCTETS, QUICK
from .definition_text import INTEGERS
from .messages import RosMessage
from .wire import plain

if TYPE_CHECKING:
    from collections.abc import Callable

    from .definition_text import Field

    Check = Callable[[Any, str], None]

_checks: dict[type, list[tuple[str, Check]]] = {}
"""Class of messages → the attributes with something to check, and the functions of their value and its full name that check it."""


def check(message: RosMessage) -> None:
    """Raise a ValueError for an integer of ``message`` that is out of range, and a TypeError for a truth value or a part that is none.

    Values of other wrong types are left to `wire.transmit`. Floats and texts, of which most messages are made, cost nothing here.
    """
    _check(message, message.ros_type)


def check_type(message: object, cls: type[RosMessage], place: str) -> None:
    """Raise a TypeError unless ``message`` is of the class ``cls``; then `check` it. ``place``: the topic or service, for the error."""
    if not isinstance(message, RosMessage):
        return  # the error of roslisp says more
    if message.ros_type != cls.ros_type:
        raise TypeError(f"{place} has messages of the type {cls.ros_type}, not {message.ros_type}.")
    _check(message, message.ros_type)


def _check(message: RosMessage, name: str) -> None:
    cls = message.__class__
    checks = _checks.get(cls)
    if checks is None:
        checks = _checks[cls] = [(field.attribute, found) for field in cls.fields if (found := _check_of(field)) is not None]
    for attribute, found in checks:
        found(getattr(message, attribute), f"{name}.{attribute}")


def _check_of(field: Field) -> Check | None:
    one = _check_of_one(field)
    if one is None or not field.is_array:
        return one
    quick, narrow = QUICK.get(field.base), field.base in OCTETS

    def check_all(values: Any, name: str) -> None:
        if narrow and (isinstance(values, (bytes, bytearray)) or getattr(values, "dtype", None) == "uint8"):
            return
        if hasattr(values, "tolist"):
            values = values.tolist()
        if isinstance(values, (list, tuple)) and (quick is None or quick(values) is None):
            for index, value in enumerate(values):
                one(value, f"{name}[{index}]")

    return check_all


def _check_of_one(field: Field) -> Check | None:
    if field.base in INTEGERS:
        return _integer(field.base, *INTEGERS[field.base])
    if field.base == "bool":
        return _bool
    return None if field.primitive else _part(field.base)


def _part(base: str) -> Check:
    def check_part(value: Any, name: str) -> None:
        if isinstance(value, RosMessage):
            _check(value, name)
        elif value is not None:  # of nil roslisp's error says more
            raise TypeError(f'{name} holds {reprlib.repr(value)}, which is no {base}. message_class("{base}") makes one.')

    return check_part


def _integer(base: str, bits: int, signed: bool) -> Check:
    least, most = (-(1 << (bits - 1)), (1 << (bits - 1)) - 1) if signed else (0, (1 << bits) - 1)
    if base == "byte":
        least = -128  # rospy has it signed, and roslisp does not

    def check_integer(value: Any, name: str) -> None:
        if value.__class__ is not int:
            value = plain(value)
        if value.__class__ is int and not least <= value <= most:
            raise ValueError(f"{name} holds {value}, which is out of the range of {base}: {least} to {most}.")

    return check_integer


def _bool(value: Any, name: str) -> None:
    if value is True or value is False or value is None:
        return
    value = plain(value)
    if value.__class__ is not bool:
        raise TypeError(f"{name} holds {reprlib.repr(value)}, which is no truth value. Write True or False.")
