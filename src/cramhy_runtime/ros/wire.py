"""What a message becomes on its way through the graph: roslisp's serialisation, without the bytes.

A message may hold anything; its types are looked at when it is sent. `transmit` gives the object that a receiver gets: a
fresh one, with integers cut to their bits, reals as double-floats (a ``float32`` rounded to 32 bits), booleans as T or NIL,
strings of Latin-1 characters. Errors are those of roslisp, signalled in the task of the sender (roslisp.md 5.2).
"""

from __future__ import annotations

import math

from ..lisp import conditions
from ..lisp.condition_types import SimpleError
from ..lisp.data import Cons, DoubleFloat, LispString, Symbol
from ..lisp.numbers.arithmetic import is_real, single
from ..lisp.objects.generic_errors import no_applicable_method
from ..lisp.packages import intern
from ..lisp.printer.printer import prin1_to_string
from . import messages
from .definition_text import INTEGERS

POSITIVE_INFINITY, NEGATIVE_INFINITY, NOT_A_NUMBER = NONFINITE = [
    intern(name, "KEYWORD") for name in ("POSITIVE-INFINITY", "NEGATIVE-INFINITY", "NOT-A-NUMBER")
]


def as_float(value):
    """A received real as a Python float: undoes the symbols for infinity and not-a-number."""
    if value.__class__ is DoubleFloat:
        return float(value)
    if isinstance(value, Symbol):
        return {POSITIVE_INFINITY: math.inf, NEGATIVE_INFINITY: -math.inf}.get(value, math.nan)
    return float(value)


def lisp_float(value):
    """A float as a receiver gets it: a double-float, or a symbol when it is not finite."""
    if value - value == 0.0:
        return DoubleFloat(value)
    if value != value:
        return NOT_A_NUMBER
    return POSITIVE_INFINITY if value > 0 else NEGATIVE_INFINITY


def _real(value):
    if is_real(value):
        return value
    if isinstance(value, Symbol) and value in NONFINITE:
        return as_float(value)
    return conditions.type_error(value, "REAL", "\nwhen binding SB-KERNEL::X")


def _float64(value):
    if value.__class__ is DoubleFloat and value - value == 0.0:
        return value
    return lisp_float(float(_real(value)))


def _float32(value):
    return lisp_float(single(float(_real(value))))


def _integer(bits, signed):
    mask, sign = (1 << bits) - 1, 1 << (bits - 1)

    def convert(value):
        if value.__class__ is not int:
            return conditions.type_error(None if value is False else value, "INTEGER")
        value &= mask
        return value - mask - 1 if signed and value & sign else value

    return convert


def _bool(value):
    return True if value is not None and value is not False else None


def _string(value):
    if value is None:
        return ""
    if not isinstance(value, (str, LispString)):
        return conditions.type_error(value, "STRING")
    text = str(value)
    if not text.isascii():
        for character in text:
            if ord(character) > 255:
                return conditions.type_error(ord(character), "(UNSIGNED-BYTE 8)")
    return text


def _time(value):
    value = _real(value)
    seconds = math.floor(value)
    return DoubleFloat(seconds + round((value - seconds) * 1e9) / 1e9)


_primitives = {
    "float64": _float64,
    "float32": _float32,
    "bool": _bool,
    "string": _string,
    "time": _time,
    "duration": _time,
}
_primitives.update({name: _integer(*size) for name, size in INTEGERS.items()})


def _part(base):
    def convert(value):
        if isinstance(value, messages.RosMessage):
            if value.ros_type == base:
                return transmit(value)
            return conditions.type_error(value, messages.message_class_exact(base).lisp_name.replace("::", ":"))
        from . import logging

        logging.log_text(
            logging.ERROR,
            ("ROSLISP",),
            f"Hmm... unexpectedly asked for serialization length of {prin1_to_string(value)}.  Most likely "
            "because the aforementioned object was found some place where a (nonprimitive) ros message was expected.",
        )
        return no_applicable_method("ROSLISP-MSG-PROTOCOL:SERIALIZE", 2, value)

    return convert


def _array(field, convert):
    def convert_all(value):
        if value is None:
            value = []
        elif isinstance(value, (Cons, str, LispString)) or not hasattr(value, "__iter__"):
            return conditions.type_error(value, "VECTOR")
        result = [convert(element) for element in value]
        if field.length and len(result) != field.length:
            return conditions.error(
                SimpleError(
                    "~a",
                    f"The field {field.name} is an array of {field.length} elements ({field.type}), but a vector "
                    f"of {len(result)} was given.",
                )
            )
        return result

    return convert_all


def _converter(field):
    convert = _primitives.get(field.base) or _part(field.base)
    return _array(field, convert) if field.is_array else convert


_converters: dict[type, list] = {}


def _converters_of(cls):
    found = _converters.get(cls)
    if found is None:
        found = _converters[cls] = [(field.attribute, _converter(field)) for field in cls.fields]
    return found


def transmit(message):
    """The fresh object that a receiver of ``message`` gets. Signals the type errors of serialisation."""
    cls = message.__class__
    return cls(*[convert(getattr(message, name)) for name, convert in _converters.get(cls) or _converters_of(cls)])


def fresh(message):
    """One more copy of an object that `transmit` gave: what another receiver gets."""
    return message.__class__(*[_fresh_value(value) for value in message.values()])


def _fresh_value(value):
    if isinstance(value, messages.RosMessage):
        return fresh(value)
    if value.__class__ is list:
        return [_fresh_value(element) for element in value]
    return value
