"""Messages as data for CBOR, in the form that rosbridge sends to clients that ask for ``"compression": "cbor"``.

It is the form of ``message_json.py`` where CBOR has no more than JSON. Floats are floats, also those that are not finite. A ``uint8[]``
is a byte string, and an array of other numbers a typed array (RFC 8746) of little-endian bytes. Source: rosbridge_library, cbor_conversion.
"""

from __future__ import annotations

import struct

from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any

from .arrays import Octets, as_float
from .message_json import DATA_FORM, Form, MessageJsonError, encoder, to_json

if TYPE_CHECKING:
    from collections.abc import Callable

    from .messages import RosMessage

TAGS = {
    "uint16": (69, "H"),
    "uint32": (70, "I"),
    "uint64": (71, "Q"),
    "byte": (72, "b"),
    "int8": (72, "b"),
    "int16": (77, "h"),
    "int32": (78, "i"),
    "int64": (79, "q"),
    "float32": (85, "f"),
    "float64": (86, "d"),
}
"""Base type → the tag of its typed arrays, and the letter of `struct` for an element."""


def to_cbor_data(message: RosMessage) -> dict[str, object]:
    """The data of ``message`` for ``cbor2.dumps``. A value that CBOR cannot have so raises `MessageJsonError`.

    It imports cbor2, which the extra ``web`` has.
    """
    encode = _forms[0].encoders.get(message.__class__) if _forms else None
    try:
        return (encode or encoder(message.__class__, _form()))(message)
    except (TypeError, ValueError, AttributeError, OverflowError, struct.error) as problem:
        to_json(message)  # it says which field it is
        raise MessageJsonError(f"{message.ros_type}: {problem}") from None


_forms: list[Form[dict[str, Any]]] = []


def _form() -> Form[dict[str, Any]]:
    if not _forms:
        scope = {**DATA_FORM.scope, "octets": _bytes, "number": as_float, **{f"array_{base}": _typed_array(base) for base in TAGS}}
        _forms.append(
            DATA_FORM._replace(
                values={**DATA_FORM.values, "float32": "number({0})", "float64": "number({0})"},
                arrays={base: f"array_{base}({{0}})" for base in TAGS},
                scope=scope,
                encoders={},
            )
        )
    return _forms[0]


def _typed_array(base: str) -> Callable[[Any], Any]:
    from cbor2 import CBORTag

    tag, letter = TAGS[base]
    read: Callable[[Any], Any] = as_float if letter in "fd" else _signed if base == "byte" else int

    def typed_array(values: Any) -> Any:
        values = values or ()
        try:
            packed = struct.pack(f"<{len(values)}{letter}", *values)
        except (struct.error, TypeError):  # keywords for floats that are not finite; roslisp's bytes from 128 on
            packed = struct.pack(f"<{len(values)}{letter}", *map(read, values))
        return CBORTag(tag, packed)

    return typed_array


def _signed(value: int) -> int:
    return value - 256 if value > 127 else value


def _bytes(values: Any) -> bytes:
    return bytes(Octets(values or b""))
