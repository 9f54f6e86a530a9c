"""Check and convert messages on their way through the graph: roslisp's serialisation, without the bytes.

A message may hold any values; sending it checks their types. `transmit` returns the object for a receiver: a fresh one, with
integers cut to their bits, reals as double-floats (a ``float32`` rounded to 32 bits), booleans as True or False, which is NIL in
Lisp. Numbers and arrays of numpy are numbers and lists (``arrays.py``). ``received.py`` makes of it what Python and Lisp get where they
differ. The sender's task gets the errors of roslisp (roslisp.md 5.2). Their hint says where in the message the wrong value is; only an
error starts the search for it. `strict.py` has the checks of rospy for Python.
"""

from __future__ import annotations

import math

from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.lisp_core.condition_types import FloatingPointOverflow, SimpleError, TypeError_
from cramhy_runtime.lisp_core.data import Character, Cons, LispString, Symbol, truth
from cramhy_runtime.lisp_core.floats import FLOATS, to_float32
from cramhy_runtime.lisp_core.numbers import is_real
from cramhy_runtime.lisp_core.dispatch.generic_errors import no_applicable_method
from cramhy_runtime.lisp_core.printing import prin1_to_string
from cramhy_runtime.utilities.generated_functions import generated_function
from . import messages
from .arrays import (
    NEGATIVE_INFINITY as NEGATIVE_INFINITY,
    NONFINITE as NONFINITE,
    NOT_A_NUMBER as NOT_A_NUMBER,
    OCTETS,
    POSITIVE_INFINITY as POSITIVE_INFINITY,
    QUICK,
    Octets,
    as_float as as_float,
    lisp_float as lisp_float,
    octets,
)
from .definition_text import INTEGERS
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any, NoReturn, TypeVar

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from .definition_text import Field
    from .messages import RosMessage

M = TypeVar("M", bound="RosMessage")
on_misfit: list[Callable[[str], object]] = []
"""Functions of a text. They are called with the text that roslisp logs before the error about a value that is not a message.

The log of roslisp, a higher module, adds itself here."""


class Misfit(Exception):
    """A value cannot be sent. ``signal(hint)`` signals roslisp's error for it."""

    def __init__(self, signal: Callable[[str | None], NoReturn]):
        super().__init__()
        self.signal = signal


def _misfit(value, expected, context=""):
    def signal(hint):
        condition = TypeError_(value, expected)
        condition.context = context
        return conditions.error(condition, hint=hint)

    return Misfit(signal)


def _overflow(hint):
    return conditions.error(FloatingPointOverflow(), hint=hint)


def ros_text(text: str) -> str:
    """``text`` as messages can hold it: half of a surrogate pair, as in the names of some files, becomes a question mark."""
    return text if text.isascii() else text.encode("utf-8", "replace").decode()


def plain(value: Any) -> Any:
    """``value``, or the number of Python that it is: numbers of numpy, arrays without dimensions, and members of an `IntEnum`."""
    if getattr(value, "shape", None) == () and hasattr(value, "item"):
        return value.item()
    return int(value) if isinstance(value, int) and value.__class__ is not bool else value


def _real(value):
    if value.__class__ is int or is_real(value):
        return value
    number = plain(value)
    if number is not value:
        return _real(number)
    if isinstance(value, Symbol) and value in NONFINITE:
        return as_float(value)
    raise _misfit(value, "REAL", "\nwhen binding SB-KERNEL::X")


def _float64(value):
    if value.__class__ is float and math.isfinite(value):
        return value
    return lisp_float(float(_real(value)))


def _float32(value):
    return lisp_float(to_float32(float(_real(value))))


def _integer(bits, signed):
    mask, sign = (1 << bits) - 1, 1 << (bits - 1)

    def convert(value):
        if value.__class__ is not int:
            value = plain(value)
            if value.__class__ is not int:
                raise _misfit(None if value is False else value, "INTEGER")
        value &= mask
        return value - mask - 1 if signed and value & sign else value

    return convert


def _bool(value):
    return truth(value)


def _string(value):
    if value is None:
        return ""
    if not isinstance(value, (str, LispString)):
        raise _misfit(value, "STRING")
    text = str(value)
    try:
        text.encode()
    except UnicodeEncodeError as problem:  # half of a surrogate pair
        raise _misfit(ord(text[problem.start]), "CHARACTER") from None
    return text


def _time(value):
    value = _real(value)
    seconds = math.floor(value)
    return seconds + round((float(value) - seconds) * 1e9) / 1e9


_primitives = {"float64": _float64, "float32": _float32, "bool": _bool, "string": _string, "time": _time, "duration": _time}
_primitives.update({name: _integer(*size) for name, size in INTEGERS.items()})


def _part(base):
    def convert(value):
        if isinstance(value, messages.RosMessage):
            if value.ros_type == base:
                cls = value.__class__
                return (_transmitters.get(cls) or _transmitter(cls))(value)
            raise _misfit(value, messages.message_class_exact(base).lisp_name.replace("::", ":"))
        raise Misfit(lambda hint: no_message(value, hint))

    def no_message(value, hint):
        for complain in on_misfit:
            complain(
                f"Hmm... unexpectedly asked for serialization length of {prin1_to_string(value)}.  Most likely "
                "because the aforementioned object was found some place where a (nonprimitive) ros message was expected."
            )
        return no_applicable_method("ROSLISP-MSG-PROTOCOL:SERIALIZE", 2, value, advice=hint)

    return convert


def _elements(value: Any) -> Any:
    """The elements of the value of an array field that is neither a list nor a tuple."""
    if value is None:
        return []
    if isinstance(value, (str, LispString)):
        return list(map(Character, str(value)))  # a vector of characters
    if isinstance(value, (Cons, dict)) or not hasattr(value, "__iter__"):
        raise _misfit(value, "VECTOR")
    if hasattr(value, "dtype") and hasattr(value, "tolist"):
        if value.ndim != 1:
            raise _misfit(value, "VECTOR")
        return value.tolist()
    return list(value)


def _array(field: Field, convert: Callable[[Any], Any]) -> Callable[[Any], Sequence[Any]]:
    quick: Callable[[Any], Sequence[Any] | None] | None = QUICK.get(field.base)
    narrow = field.base in OCTETS

    def convert_all(value: Any) -> Sequence[Any]:
        result: Sequence[Any] | None = octets(value) if narrow else None
        if result is None:
            if value.__class__ is not list and value.__class__ is not tuple:
                value = _elements(value)
            result = quick(value) if quick is not None else None
            if result is None:
                result = [convert(element) for element in value]
            if narrow:
                result = Octets(result)
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


_transmitters: dict[type, Callable[[Any], Any]] = {}
_READY = {
    "float64": "{0} if {0}.__class__ is float and isfinite({0}) else {1}({0})",
    "float32": "to_float32({0}) if {0}.__class__ in floats and -3e38 < {0} < 3e38 else {1}({0})",
    "bool": "{0} if {0} is True or {0} is False else {1}({0})",
    "string": "{0} if {0}.__class__ is str and {0}.isascii() else {1}({0})",
}
"""Generated expressions for fields whose value usually can be sent as it is. All other fields call the converter."""


def _transmitter(cls: Any) -> Callable[[Any], Any]:
    """Generate, compile and keep the function that transmits messages of class ``cls``."""
    scope = {"new": cls.__new__, "cls": cls, "floats": FLOATS, "isfinite": math.isfinite}
    scope["to_float32"] = to_float32
    lines = ["result = new(cls)"]  # written out once per type: it is on the path of every message
    for field in cls.fields:
        name, convert = field.attribute, f"convert_{field.attribute}"
        converter = _converter(field)
        scope[convert] = _array(field, converter) if field.is_array else converter
        template = "{1}({0})" if field.is_array else _READY.get(field.base, "{1}({0})")
        lines += [f"value = message.{name}", f"result.{name} = {template.format('value', convert)}"]
    lines.append("return result")
    transmitted = _transmitters[cls] = generated_function(f"transmitting {cls.ros_type}", "transmitted", ["message"], lines, scope)
    return transmitted


def transmit(message: M) -> M:
    """The fresh object that a receiver of ``message`` gets. A wrong value in a field is a type error of serialisation."""
    cls = message.__class__
    try:
        return (_transmitters.get(cls) or _transmitter(cls))(message)
    except Misfit as problem:
        signal = problem.signal
    except OverflowError:
        signal = _overflow
    path, kind, value = _misplaced(message)
    held, limit = prin1_to_string(value), 60
    held = held if len(held) <= limit else held[:limit] + "..."
    half = kind == "string" and isinstance(value, (str, LispString))
    fault = "has half of a surrogate pair, which is no character" if half else f"is no {kind}"
    return signal(f"{message.ros_type}: {path} holds {held}, which {fault}.")


def _converter(field: Field) -> Callable[[Any], Any]:
    return _primitives.get(field.base) or _part(field.base)


def _misplaced(message):
    """Find the first value in ``message`` that cannot be sent: its path as in ROS, the expected type, the value."""
    for field in message.fields:
        value = getattr(message, field.attribute)
        parts = [(field.name, value)]
        if field.is_array:
            try:
                elements = value if isinstance(value, (list, tuple)) else _elements(value)
            except Misfit:
                return field.name, field.type, value
            parts = [(f"{field.name}[{index}]", element) for index, element in enumerate(elements)]
        for path, part in parts:
            try:
                _converter(field)(part)
            except (Misfit, OverflowError):
                if not isinstance(part, messages.RosMessage) or part.ros_type != field.base:
                    return path, field.base, part
                rest, kind, wrong = _misplaced(part)
                return f"{path}.{rest}", kind, wrong
    raise AssertionError("every value can be sent")


_copiers: dict[type, Callable[[Any], Any]] = {}


def _copier(cls: Any) -> Callable[[Any], Any]:
    """Generate, compile and keep the function that copies messages of class ``cls``."""
    scope = {"new": cls.__new__, "cls": cls, "fresh": fresh}
    lines = ["result = new(cls)"]
    for field in cls.fields:
        value = f"message.{field.attribute}"
        if field.is_array:
            value = f"{value}[:]" if field.primitive else f"[fresh(each) for each in {value}]"
        elif not field.primitive:
            value = f"fresh({value})"
        lines.append(f"result.{field.attribute} = {value}")
    lines.append("return result")
    copied = _copiers[cls] = generated_function(f"copying {cls.ros_type}", "copied", ["message"], lines, scope)
    return copied


def fresh(message: M) -> M:
    """A copy, for another receiver, of an object from `transmit`."""
    cls = message.__class__
    return (_copiers.get(cls) or _copier(cls))(message)
