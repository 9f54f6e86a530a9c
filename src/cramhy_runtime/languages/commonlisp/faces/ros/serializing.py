"""The functions of ROSLISP-MSG-PROTOCOL that write messages to streams of bytes and read them, as ROS 1 has them on its wire.

Programs keep messages in files so, or compare their sizes. They are generic, as in the original. Source: roslisp.md 5.6, 15.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.lisp_core.condition_types import SimpleError
from cramhy_runtime.lisp_core.data import Symbol, list_from
from cramhy_runtime.lisp_core.dispatch.generic_errors import no_applicable_method
from cramhy_runtime.lisp_core.dispatch.open_functions import open_to_methods
from cramhy_runtime.ros import messages, serialization
from cramhy_runtime.ros.messages import RosMessage
from cramhy_runtime.ros.received import for_lisp

from ...files.file_stream_functions import read_byte, write_byte


def serialize(msg, ostream):
    """Write the bytes of the message ``msg`` to ``ostream``, an output stream of ``(unsigned-byte 8)``. Returns nil."""
    for byte in _bytes(msg, "SERIALIZE", ostream):
        write_byte(byte, ostream)


def deserialize(msg, istream):
    """Read the fields of ``msg``, a message, which is filled and returned, or a class symbol, from a stream of ``(unsigned-byte 8)``."""
    if isinstance(msg, RosMessage):
        found = _read(type(msg), istream)
        for field in msg.fields:
            setattr(msg, field.attribute, getattr(found, field.attribute))
        return msg
    if not isinstance(msg, Symbol):
        return no_applicable_method("ROSLISP-MSG-PROTOCOL:DESERIALIZE", 2, msg, istream)
    return _read(messages.message_class(msg), istream)


def _read(message_type, istream):
    return for_lisp(serialization.deserialize(message_type, lambda count: bytes([read_byte(istream) for _ in range(count)])))


def serialization_length(msg):
    """The number of bytes that ``msg`` takes on ROS's wire."""
    return len(_bytes(msg, "SERIALIZATION-LENGTH"))


def _bytes(msg, function, *others):
    if not isinstance(msg, RosMessage):
        return no_applicable_method(f"ROSLISP-MSG-PROTOCOL:{function}", 2, msg, *others)
    try:
        return serialization.serialize(msg)
    except ValueError as problem:
        return conditions.error(SimpleError("~a", str(problem)))


def service_request_type(msg):
    """The symbol of the class of the requests of a service: ``turtlesim-srv:spawn-request``."""
    return messages.service_type(msg).request.lisp_symbol


def service_response_type(msg):
    """The symbol of the class of the responses of a service."""
    return messages.service_type(msg).response.lisp_symbol


FUNCTIONS = {
    "serialize": (serialize, "(msg ostream)", 2),
    "deserialize": (deserialize, "(msg istream)", 2),
    "serialization-length": (serialization_length, "(msg)", 1),
    "service-request-type": (service_request_type, "(msg)", 1),
    "service-response-type": (service_response_type, "(msg)", 1),
}


def open_functions():
    """Let users define methods on them."""
    for name, (function, lambda_list, required) in FUNCTIONS.items():
        open_to_methods(function, f"ROSLISP-MSG-PROTOCOL::{name.upper()}", lambda_list, *[None] * required)


def tokens(string, *, start=0, separators=None):
    """The words of ``string`` from ``start`` on, a list: what stands between ``separators``, a list of characters (white space)."""
    marks = frozenset(separator.char for separator in separators) if separators is not None else frozenset(" \r\n\t")
    words = [""]
    for character in str(string)[start:]:
        if character in marks:
            words.append("")
        else:
            words[-1] += character
    return list_from([word for word in words if word])
