"""What rospy refuses and roslisp does not: integers out of range, and truth values or parts that are none. For messages that Python sends.

roslisp cuts integers to their bits, and takes every value but NIL for true (roslisp.md 5.2), so messages of Lisp are not checked here.
Source: genpy's checks in ``rospy.Publisher.publish``.
"""

from __future__ import annotations

import reprlib

from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any

from cramhy_runtime.utilities.generated_functions import generated_function

from .arrays import OCTETS, QUICK
from .definition_text import INTEGERS
from .messages import RosMessage, part_class
from .wire import plain

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from .definition_text import Field

    Check = Callable[[Any, str], None]

_fine: dict[type, Callable[[Any], bool]] = {}
"""Class of messages → the generated function that tells quickly that nothing is wrong with one, as is usual."""
_checks: dict[type, list[tuple[str, Check]]] = {}
"""Class of messages → the attributes with something to check, and the functions of their value and its full name that check it."""


def check(message: RosMessage) -> None:
    """Raise a ValueError for an integer of ``message`` that is out of range, and a TypeError for a truth value or a part that is none.

    Values of other wrong types are left to `wire.transmit`. Floats and texts, of which most messages are made, cost nothing here.
    """
    cls = message.__class__
    if not (_fine.get(cls) or _fineness(cls))(message):
        _check(message, message.ros_type)


def _fineness(cls: type[RosMessage]) -> Callable[[Any], bool]:
    scope: dict[str, Any] = {}
    tests = list(_tests(cls, "message", scope))
    lines = [f"return {' and '.join(tests) or 'True'}"]
    found = _fine[cls] = generated_function(f"fineness of {cls.ros_type}", "fine", ["message"], lines, scope)
    return found


def _tests(cls: type[RosMessage], message: str, scope: dict[str, Any]) -> Iterator[str]:
    """The expressions that are true if nothing is wrong with the ``message``, an expression itself."""
    for field in cls.fields:
        value, name = f"{message}.{field.attribute}", f"name{len(scope)}"
        if field.is_array:
            found = _check_of(field)
            if found is not None:
                scope[name] = QUICK.get(field.base) if field.primitive else None
                yield f"({value}.__class__ is list and (not {value} or {name} is not None and {name}({value}) is not None))"
        elif field.base in INTEGERS:
            least, most = _range(field.base)
            yield f"{value}.__class__ is int and {least} <= {value} <= {most}"
        elif field.base == "bool":
            yield f"({value} is True or {value} is False)"
        elif not field.primitive:
            part = scope[name] = part_class(field.base)
            yield f"{value}.__class__ is {name}"
            yield from _tests(part, value, scope)


def check_type(message: object, cls: type[RosMessage], place: str) -> None:
    """Raise a TypeError unless ``message`` is of the class ``cls``; then `check` it. ``place``: the topic or service, for the error."""
    if not isinstance(message, RosMessage):
        return  # the error of roslisp says more
    if message.ros_type != cls.ros_type:
        raise TypeError(f"{place} has messages of the type {cls.ros_type}, not {message.ros_type}.")
    check(message)


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
        return _integer(field.base, *_range(field.base))
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


def _range(base: str) -> tuple[int, int]:
    """The least and the greatest integer of the type ``base``."""
    bits, signed = INTEGERS[base]
    least, most = (-(1 << (bits - 1)), (1 << (bits - 1)) - 1) if signed else (0, (1 << bits) - 1)
    return -128 if base == "byte" else least, most  # rospy has it signed, and roslisp does not


def _integer(base: str, least: int, most: int) -> Check:
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
