"""A message as the bytes that ROS 1 puts on its wire: for roslisp's `serialize`, and for clients that ask for ``cbor-raw``.

Little-endian numbers one after the other; strings and arrays of no fixed length begin with their length in 32 bits; a time is two
integers. Source: wiki.ros.org/msg, "Serialization".
"""

from __future__ import annotations

import math
import reprlib
import struct

from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any

from cramhy_runtime.lisp_core.data import truth
from .messages import part_class
from .arrays import OCTETS, QUICK, Octets, as_float, lisp_float, octets

if TYPE_CHECKING:
    from collections.abc import Callable

    from .definition_text import Field
    from .messages import RosMessage
    from .signatures import MessageType

_FORMATS = {
    "bool": "B",
    "int8": "b",
    "byte": "b",
    "uint8": "B",
    "char": "B",
    "int16": "h",
    "uint16": "H",
    "int32": "i",
    "uint32": "I",
    "int64": "q",
    "uint64": "Q",
    "float32": "f",
    "float64": "d",
}
_LENGTH = struct.Struct("<I")


def serialize(message: RosMessage) -> bytes:
    """The bytes of MESSAGE, as the graph delivers it. Raises ValueError with the field that ROS 1 cannot write."""
    parts: list[bytes | bytearray] = []
    _write(message, parts.append)
    return b"".join(parts)


def _write(message: RosMessage, put: Callable[[bytes | bytearray], object]) -> None:
    for field in message.fields:
        value = getattr(message, field.attribute)
        try:
            _write_field(field, value, put)
        except (struct.error, OverflowError, TypeError):  # a ValueError is that of a message in this one
            raise ValueError(
                f"{message.ros_type}: the field {field.name} holds {reprlib.repr(value)}, which ROS 1 cannot write as {field.type}."
            ) from None


def _write_field(field: Field, value: Any, put: Callable[[bytes | bytearray], object]) -> None:
    if not field.is_array:
        _write_one(field.base, value, put)
        return
    if value is None:
        value = ()
    if not field.length:
        put(_LENGTH.pack(len(value)))
    if field.base in OCTETS and (packed := octets(value)) is not None:
        put(packed)
    elif field.base in _FORMATS and field.base != "bool":
        form = f"<{len(value)}{_FORMATS[field.base]}"
        try:
            put(struct.pack(form, *value))
        except struct.error:  # floats that are not finite, and values that nobody has checked
            put(struct.pack(form, *(_number(field.base, each) for each in value)))
    else:
        for each in value:
            _write_one(field.base, each, put)


def _write_one(base: str, value: Any, put: Callable[[bytes | bytearray], object]) -> None:
    form = _FORMATS.get(base)
    if form is not None:
        put(struct.pack("<" + form, _number(base, value)))
    elif base == "string":
        data = str(value or "").encode("utf-8", "replace")
        put(_LENGTH.pack(len(data)) + data)
    elif base in ("time", "duration"):
        seconds = math.floor(value)
        nanoseconds = round((float(value) - seconds) * 1e9)
        if nanoseconds == 10**9:
            seconds, nanoseconds = seconds + 1, 0
        put(struct.pack("<II" if base == "time" else "<ii", seconds, nanoseconds))
    else:
        _write(value, put)


def _number(base: str, value: Any) -> Any:
    if base == "bool":
        return truth(value)
    if base in ("float32", "float64"):
        return value if isinstance(value, float) else as_float(value)
    if base == "byte":
        return value - 256 if value > 127 else value
    return value


def deserialize(message_type: MessageType, take: Callable[[int], bytes]) -> RosMessage:
    """The message of MESSAGE_TYPE whose bytes ``take(count)`` gives, one piece after the other. It may raise what it likes at an end."""
    message = message_type()
    for field in message_type.fields:
        setattr(message, field.attribute, _read_field(field, take))
    return message


def _read_field(field: Field, take: Callable[[int], bytes]) -> Any:
    if not field.is_array:
        return _read_one(field.base, take)
    count = field.length or _LENGTH.unpack(take(4))[0]
    if field.base in OCTETS:
        return Octets(take(count))
    if field.base in _FORMATS and field.base not in ("bool", "byte"):
        form = struct.Struct(f"<{count}{_FORMATS[field.base]}")
        numbers = form.unpack(take(form.size))
        return QUICK[field.base](numbers) if field.base in ("float32", "float64") else list(numbers)
    return [_read_one(field.base, take) for _ in range(count)]


def _read_one(base: str, take: Callable[[int], bytes]) -> Any:
    form = _FORMATS.get(base)
    if form is not None:
        (number,) = struct.unpack("<" + form, take(struct.calcsize(form)))
        if base == "bool":
            return bool(number)
        if base == "byte":
            return number & 255  # as it arrives from a topic
        return lisp_float(number) if base in ("float32", "float64") else number
    if base == "string":
        return take(_LENGTH.unpack(take(4))[0]).decode("utf-8", "replace")
    if base in ("time", "duration"):
        seconds, nanoseconds = struct.unpack("<II" if base == "time" else "<ii", take(8))
        return lisp_float(seconds + nanoseconds / 1e9)
    return deserialize(part_class(base), take)
