"""Messages as JSON, in the form of rosbridge v2. The bridge, the recorder and the page send and read it.

`to_json` returns plain dicts, lists, numbers and texts. `from_json` reads such data and returns the message that a subscriber
would get. The data come from outside, so anything wrong in them raises `MessageJsonError`. A page with many turtles needs
thousands of messages per second, so each type has one generated Python function per direction.

* A number that is not finite is written as null, and null is read as not-a-number. Recordings keep infinities (`to_record_text`).
* ``uint8[]`` and ``char[]`` are written as base64 texts, and read from base64 texts or lists.
* A time is written as ``{"secs", "nsecs"}``; ROS 2's ``{"sec", "nanosec"}`` and ``"now"`` are read too.
* Texts are Unicode on both sides, as they are in UTF-8 on ROS's wire.

Sources: rosbridge protocol 2.0, sections 3.1 and 4; conversions as in rosbridge_library.
"""

from __future__ import annotations

import base64
import binascii
import json
import math
import reprlib

from cramhy_runtime.lisp_core.data import LispString, truth
from cramhy_runtime.lisp_core.floats import to_float32
from cramhy_runtime.lisp_core.numbers import is_real
from cramhy_runtime.utilities.generated_functions import generated_function
from . import messages
from .arrays import NONFINITE, QUICK, Octets, as_float, lisp_float
from .definition_text import INTEGERS
from .messages import RosMessage
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any, Generic, NamedTuple, Self, TypeVar

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from .messages import ServiceType
    from .signatures import MessageType

M = TypeVar("M", bound="RosMessage")
T = TypeVar("T")
Written = TypeVar("Written")

text_of: Callable[[object], str] = json.JSONEncoder(separators=(",", ":"), ensure_ascii=False, allow_nan=False).encode
"""The text of plain data, without spaces. A number that is not finite is a ValueError."""

MOST_TEXTS = 2048
"""Numbers whose texts are kept."""


class _Texts(dict[float, str]):
    """Number → its text as a float. Most numbers are told several times, as where a turtle is, and to make a text takes a microsecond."""

    def __missing__(self, number: float) -> str:
        text = float.__repr__(float(number))
        if number:  # zero has two texts
            if len(self) >= MOST_TEXTS:
                self.clear()
            self[number] = text
        return text


float_texts = _Texts()


class MessageJsonError(ValueError):
    """Data that do not fit the message type, or a message that has no JSON. The text names type, field, value and a remedy.

    ``problem``: the text, or a function that makes it from the type of the whole message and the field's full name. ``path``: the
    names of the fields from the outermost inwards, elements of arrays by their index: ``["poses", "[2]", "position", "x"]``.
    """

    def __init__(self, problem: str | Callable[[str, str], str], path: Sequence[str] = ()):
        super().__init__(problem)
        self.problem, self.path, self.type = problem, list(path), ""

    def below(self, field: str) -> Self:
        """Put ``field``, the field of the message around this one, before the path; returns this error."""
        self.path.insert(0, field)
        return self

    def of(self, ros_type: str) -> Self:
        """Set the type of the whole message, a text as ``"turtlesim/Pose"``; returns this error."""
        self.type = ros_type
        return self

    def __str__(self) -> str:
        return self.problem(self.type, ".".join(self.path).replace(".[", "[")) if callable(self.problem) else self.problem


def to_json(message: RosMessage) -> dict[str, Any]:
    """``message`` as plain data for ``json.dumps``: a dict by field name. A value without JSON raises `MessageJsonError`."""
    encode = DATA_FORM.encoders.get(message.__class__) or encoder(message.__class__, DATA_FORM)
    try:
        return encode(message)
    except (TypeError, ValueError, AttributeError, OverflowError):  # infinities as symbols, and what nobody has checked yet
        try:
            found: dict[str, Any] = _encode_with_care(message)
            return found
        except MessageJsonError as problem:
            raise problem.of(message.ros_type)


def to_json_text(message: RosMessage) -> str:
    """The text of ``message``: what `text_of` makes of `to_json`, but faster. A value without JSON raises `MessageJsonError`."""
    try:
        encode = _as_text.encoders.get(message.__class__) or encoder(message.__class__, _as_text)
        return encode(message)
    except (TypeError, ValueError, AttributeError, OverflowError):
        return text_of(to_json(message))


def to_record_text(message: RosMessage) -> str:
    """As `to_json_text`, but an infinity is written as ``1e999``, which readers of JSON take for one: a recording keeps it."""
    try:
        encode = _as_text.encoders.get(message.__class__) or encoder(message.__class__, _as_text)
        return encode(message)
    except (TypeError, ValueError, AttributeError, OverflowError):
        try:
            encode = _as_record.encoders.get(message.__class__) or encoder(message.__class__, _as_record)
            return encode(message)
        except (TypeError, ValueError, AttributeError, OverflowError):
            return text_of(to_json(message))


def from_json(cls: type[M], data: object, now: float | None = None) -> M:
    """The message of class ``cls`` that ``data``, a dict as from ``json.loads``, describes.

    Missing fields get their defaults. ``now``: the time that the text ``"now"`` means, in seconds since 1970; if given, a header
    without a stamp gets it too, as in rosbridge. The values are the ones that a subscriber sees. Data that do not fit ``cls``
    raise `MessageJsonError`.
    """
    decode = _decoders.get(cls) or _decoder(cls)
    try:
        return decode(data, now)
    except MessageJsonError as problem:
        raise problem.of(cls.ros_type)


def request_from_json(cls: type[M], data: object, now: float | None = None) -> M:
    """The request that the arguments of a service call describe, as `from_json` does.

    ``data`` may also be a list of values in the order of the fields, or ``None`` for no arguments.
    """
    if data is None:
        data = {}
    elif data.__class__ is list:
        if len(data) > len(cls.fields):
            wanted = f"{_counted(len(cls.fields), 'argument')} ({_names(cls)})"
            raise MessageJsonError(f"{cls.ros_type} takes {wanted}, but {len(data)} were given.")
        data = {field.name: value for field, value in zip(cls.fields, data)}
    return from_json(cls, data, now)


def type_named(name: object, find: Callable[[str], Any] = messages.message_class_exact) -> MessageType:
    """The message class with the name ``"turtlesim/Pose"``, or in ROS 2's form ``"turtlesim/msg/Pose"``.

    ``find``: the function that finds it by the first form. Raises `MessageJsonError` if there is none. Call it in the kernel,
    since it may read a package's definitions.
    """
    if isinstance(name, str):
        parts = name.split("/")
        if len(parts) == 3 and parts[1] in ("msg", "srv"):
            parts = parts[::2]
        if len(parts) == 2 and all(part.isidentifier() for part in parts):
            found = find("/".join(parts))
            if found is not None:
                return found
    raise MessageJsonError(f'There is no type {_shown(name)}. A type is written "package/Name"; its package must be on ROS_PACKAGE_PATH.')


def service_named(name: object) -> ServiceType:
    """The `ServiceType` with the name ``"turtlesim/Spawn"`` or ``"turtlesim/srv/Spawn"``; errors as in `type_named`."""
    return type_named(name, messages.service_type_exact)


# -------------------------------------------------------------------------------------------------------------- the values


_brief = reprlib.Repr()
_brief.maxlevel = 2
_brief.maxstring = _brief.maxother = 40


def _shown(value: object) -> str:
    """``value`` in an error text: short, however large or deep it is."""
    try:
        return _brief.repr(value)
    except (ValueError, RecursionError):
        return f"a very large {type(value).__name__}"


_JSON_NAMES = {dict: "an object", list: "a list", str: "a text", bool: "a truth value", int: "an integer", float: "a number"}


def _wrong(type_name: str, value: object, why: str = "") -> MessageJsonError:
    kind = "null" if value is None else f"{_JSON_NAMES.get(value.__class__, type(value).__name__)}, {_shown(value)}"
    return _mismatch(type_name, kind + (why and ": " + why))


def _mismatch(type_name: str, given: str) -> MessageJsonError:
    return MessageJsonError(
        lambda ros_type, field: f"{ros_type} message requires a {type_name}{field and ' for field ' + field}, but got {given}."
    )


def _counted(number: int, what: str) -> str:
    return f"{number} {what}{'' if number == 1 else 's'}"


def _names(cls: MessageType) -> str:
    return ", ".join(field.name for field in cls.fields) or "none"


def _integer(name, bits, signed):
    least, most = (-(1 << (bits - 1)), (1 << (bits - 1)) - 1) if signed else (0, (1 << bits) - 1)

    def read(value):
        if value.__class__ is int and least <= value <= most:
            return value
        raise _wrong(name, value, f"{least} to {most} is its range" if value.__class__ is int else "")

    return read


def _floating(name, rounded):
    def read(value):
        if value is None:
            return lisp_float(math.nan)
        if value.__class__ is not float:
            if value.__class__ is not int:
                raise _wrong(name, value)
            try:
                value = float(value)
            except OverflowError:
                raise _wrong(name, value, "its range ends at 1.8e308") from None
        return lisp_float(rounded(value))

    return read


def _read_bool(value):
    if value.__class__ is bool:
        return value
    raise _wrong("bool", value, "write true or false")


def _read_string(value):
    if value.__class__ is not str:
        raise _wrong("string", value)
    if value.isascii():
        return value
    try:
        value.encode()
    except UnicodeEncodeError:
        raise _wrong("string", value, "half of a surrogate pair is no character") from None
    return value


def _write_string(text):
    return "" if text is None else str(text)


def _moment(name, signed):
    least, most = (-(1 << 31), (1 << 31) - 1) if signed else (0, (1 << 32) - 1)

    def read(value, now):
        if value == "now" and not signed:
            return float(now or 0.0)
        if value.__class__ is not dict:
            raise _wrong(name, value, 'write {"secs": 1, "nsecs": 500000000}')
        second, nanosecond = ("sec", "nanosec") if "sec" in value or "nanosec" in value else ("secs", "nsecs")
        if value.keys() - {second, nanosecond}:
            raise _wrong(name, value, f'it has the fields "{second}" and "{nanosecond}"')
        parts = value.get(second, 0), value.get(nanosecond, 0)
        for part in parts:
            if part.__class__ is not int or not least <= part <= most:
                raise _wrong(name, value, f"{_shown(part)} is no integer from {least} to {most}")
        return float(parts[0] + parts[1] / 1e9)

    return read


def _write_moment(value):
    seconds = math.floor(value)
    nanoseconds = round((value - seconds) * 1e9)
    return {"secs": seconds + 1, "nsecs": 0} if nanoseconds == 1_000_000_000 else {"secs": seconds, "nsecs": nanoseconds}


def _read_bytes(name):
    def read(value):
        if value.__class__ is str:
            try:
                return Octets(base64.b64decode(value, validate=True))
            except (binascii.Error, ValueError):
                raise _wrong(name, value, "a text must be base64") from None
        if value.__class__ is not list:
            raise _wrong(name, value, "write a list, or a text in base64")
        if QUICK["uint8"](value) is not None:
            return Octets(value)
        index = next(i for i, element in enumerate(value) if element.__class__ is not int or not 0 <= element <= 255)
        raise _wrong(name, value[index], f"element {index} is no integer from 0 to 255")

    return read


def _write_bytes(octets):
    return base64.b64encode(bytes(octets or b"")).decode("ascii")


_readers = {name: _integer(name, *size) for name, size in INTEGERS.items()}
_readers.update(
    float64=_floating("float64", lambda value: value), float32=_floating("float32", to_float32), bool=_read_bool, string=_read_string
)
_moments = {"time": _moment("time", False), "duration": _moment("duration", True)}
_DEFAULTS = {"bool": "False", "string": '""', "float32": "zero", "float64": "zero", **dict.fromkeys(INTEGERS, "0")}


def _is_binary(field):
    return field.is_array and field.base in ("uint8", "char")


# --------------------------------------------------------------------------------------------------------------- encoders


def _write_floats(values):
    values = values or ()
    if all(map(math.isfinite, values)):
        return list(map(float, values))
    return [float(value) if math.isfinite(value) else None for value in values]


class Form(NamedTuple, Generic[Written]):
    """A form of messages: plain data, or the text of those data. Its encoders are generated, one for each type of message.

    ``values``: the expression for a value, ``{0}``, of each base type. ``integer``: for those of the other base types. ``row``: for a
    list whose elements, ``each`` of ``{1}``, are ``{0}``. ``octets``: for ``uint8[]``, ``arrays``: for other arrays, by their base type.
    ``message``: what an encoder returns, of the names of the fields and their expressions. ``scope``: what the expressions use.
    ``encoders``: those made.
    """

    values: dict[str, str]
    integer: str
    row: str
    octets: str
    arrays: dict[str, str]
    message: Callable[[list[tuple[str, str]]], list[str]]
    scope: dict[str, object]
    encoders: dict[type[RosMessage], Callable[[RosMessage], Written]]


_FINITE = "if isfinite(value := {0}) else"
_TRUE = "(value := {0}) is True or truth(value)"
_TEXT = "value if (value := {0}).__class__ is str and value.isascii() else string(value)"

DATA_FORM: Form[dict[str, Any]] = Form(
    values={
        **dict.fromkeys(("float32", "float64"), f"float(value) {_FINITE} None"),
        "bool": _TRUE,
        "string": _TEXT,
        **dict.fromkeys(("time", "duration"), "moment({0})"),
    },
    integer="{0}",
    row="[{0} for each in {1} or ()]",
    octets="octets({0})",
    arrays=dict.fromkeys(("float32", "float64"), "floats({0})"),
    message=lambda parts: ["return {", *(f"    {name!r}: {value}," for name, value in parts), "}"],
    scope={
        "isfinite": math.isfinite,
        "truth": truth,
        "moment": _write_moment,
        "octets": _write_bytes,
        "string": _write_string,
        "floats": _write_floats,
    },
    encoders={},
)
_as_text: Form[str] = Form(
    values={
        **dict.fromkeys(("float32", "float64"), f"numbers[value] {_FINITE} 'null'"),
        "bool": f"'true' if {_TRUE} else 'false'",
        "string": f"quoted({_TEXT})",
        **dict.fromkeys(("time", "duration"), "text(moment({0}))"),
    },
    integer="digits(value) if (value := {0}).__class__ is int else text(value)",
    row="'[' + ','.join([{0} for each in {1} or ()]) + ']'",
    octets="text(octets({0}))",
    arrays=dict.fromkeys(("float32", "float64"), "text(floats({0}))"),
    message=lambda parts: [
        "return '{" + ",".join([f'"{name}":%s' for name, _ in parts]) + "}' % (",
        *(f"    {value}," for _, value in parts),
        ")",
    ],
    scope={**DATA_FORM.scope, "numbers": float_texts, "quoted": json.encoder.encode_basestring, "digits": int.__repr__, "text": text_of},
    encoders={},
)


def _record_number(value: Any) -> str:
    number = as_float(value)
    return float_texts[number] if math.isfinite(number) else "null" if number != number else "1e999" if number > 0 else "-1e999"


_as_record = _as_text._replace(
    values={**_as_text.values, **dict.fromkeys(("float32", "float64"), "number({0})")},
    arrays=dict.fromkeys(("float32", "float64"), "'[' + ','.join(map(number, {0} or ())) + ']'"),
    scope={**_as_text.scope, "number": _record_number},
    encoders={},
)
"""As `_as_text`, for messages with floats that are not finite."""


def encoder(cls: type[RosMessage], form: Form[Written]) -> Callable[[RosMessage], Written]:
    """Generate, compile and keep the function that turns a message of class ``cls`` into ``form``."""
    if not (isinstance(cls, type) and issubclass(cls, RosMessage)):
        raise MessageJsonError(f"Only a message can be sent, not an object of class {getattr(cls, '__name__', cls)}.")
    scope, parts = dict(form.scope), []
    for field in cls.fields:
        value, text = f"message.{field.attribute}", form.values.get(field.base, form.integer)
        if not field.primitive:
            part = _part_class(field)
            scope[f"part_{field.attribute}"] = form.encoders.get(part) or encoder(part, form)
            text = f"part_{field.attribute}({{0}})"
        if _is_binary(field):
            text = form.octets.format(value)
        elif field.is_array and field.base in form.arrays:
            text = form.arrays[field.base].format(value)
        elif field.is_array:
            text = form.row.format(text.format("each"), value)
        else:
            text = text.format(value)
        parts.append((field.name, text))
    encode = form.encoders[cls] = generated_function(f"encoding {cls.ros_type}", "encode", ["message"], form.message(parts), scope)
    return encode


def _part_class(field):
    found = messages.message_class_exact(field.base)
    if found is None:
        raise MessageJsonError(
            lambda ros_type, name: (
                f"{field.base}, the type of the field {name} of {ros_type}, is not known. Is its package on ROS_PACKAGE_PATH?"
            ),
            [field.name],
        )
    return found


def _encode_with_care(message):
    """Encode as the generated functions do, for values that these do not expect."""
    result = {}
    for field in message.fields:
        value = getattr(message, field.attribute)
        try:
            if _is_binary(field):
                result[field.name] = _write_bytes(value)
            elif field.is_array:
                result[field.name] = [_plain(field, each) for each in value or ()]
            else:
                result[field.name] = _plain(field, value)
        except MessageJsonError as problem:
            raise problem.below(field.name)
        except (TypeError, ValueError, AttributeError, OverflowError):
            raise _wrong(field.type, value).below(field.name) from None
    return result


def _plain(field, value):
    if not field.primitive:
        if not isinstance(value, RosMessage):
            raise _wrong(field.base, value)
        return _encode_with_care(value)
    if field.base in ("float32", "float64"):
        if value in NONFINITE:
            return None
        if not is_real(value):
            raise _wrong(field.base, value)
        number = float(value)
        return number if math.isfinite(number) else None
    if field.base in INTEGERS:
        if value.__class__ is not int:
            raise _wrong(field.base, value)
        return value
    if field.base == "bool":
        return truth(value)
    if field.base == "string":
        if not (value is None or isinstance(value, (str, LispString))):
            raise _wrong("string", value)
        return _write_string(value)
    if not is_real(value):
        raise _wrong(field.base, value)
    return _write_moment(value)


# --------------------------------------------------------------------------------------------------------------- decoders


_decoders: dict[type, object] = {}
_MISSING = object()


def _decoder(cls):
    """Generate, compile and keep the function that reads a message of class ``cls``."""
    scope = {
        "cls": cls,
        "new": cls.__new__,
        "missing": _MISSING,
        "zero": 0.0,
        "problems": MessageJsonError,
        "no_object": _no_object,
        "unknown_field": _unknown_field,
        "elements": _elements,
        "inner": _inner,
    }
    lines = ["if data.__class__ is not dict: no_object(cls, data)", "message, given, get = new(cls), 0, data.get"]
    for field in cls.fields:
        target, name = f"message.{field.attribute}", field.name
        read, default = _reading(field, scope, cls)
        lines += [
            f"value = get({name!r}, missing)",
            f"if value is missing: {target} = {default}",
            "else:",
            "    given += 1",
            f"    try: {target} = {read}",
            f"    except problems as problem: raise problem.below({name!r})",
        ]
    lines += ["if given != len(data): unknown_field(cls, data)", "return message"]
    decode = _decoders[cls] = generated_function(f"decoding {cls.ros_type}", "decode", ["data", "now"], lines, scope)
    return decode


def _reading(field, scope, cls):
    """Two expressions for the value of a field: with the data in ``value``, and without data."""
    reader = f"read_{field.attribute}"
    if not field.primitive:
        part = _part_class(field)
        scope[reader] = _decoders.get(part) or _decoder(part)
        read, default = f"{reader}(value, now)", f"{reader}({{}}, now)"
    elif field.base in _moments:
        scope[reader] = _moments[field.base]
        read, default = f"{reader}(value, now)", "zero"
        if cls.ros_type == "std_msgs/Header" and field.name == "stamp":
            default = "zero if now is None else float(now)"
    elif field.base == "float64" and not field.is_array:
        scope[reader] = _readers["float64"]
        read, default = f"value if value.__class__ is float and value - value == 0.0 else {reader}(value)", "zero"
    else:
        scope[reader] = _readers[field.base]
        read, default = f"{reader}(value)", _DEFAULTS[field.base]
    if not field.is_array:
        return read, default
    if _is_binary(field):
        scope[reader] = _read_bytes(field.type)
        return f"elements({reader}(value), {field.length}, {field.type!r})", f"[0] * {field.length}"
    default = f"[{default} for _ in range({field.length})]"
    return f"inner(elements(value, {field.length}, {field.type!r}), lambda value: {read})", default


def _elements(value, length, type_name):
    """``value``, checked to be a list, of the right length when that is not 0."""
    if value.__class__ is not list and value.__class__ is not Octets:
        raise _wrong(type_name, value)
    if length and len(value) != length:
        raise _mismatch(type_name, f"a list of {_counted(len(value), 'element')}")
    return value


def _inner(values, read):
    """Read each element; an error gets its index."""
    try:
        return [read(value) for value in values]
    except MessageJsonError:
        pass
    for index, value in enumerate(values):
        try:
            read(value)
        except MessageJsonError as problem:
            raise problem.below(f"[{index}]")


def _no_object(cls, data):
    raise _wrong(cls.ros_type, data, f"write an object with some of the fields {_names(cls)}")


def _unknown_field(cls, data):
    known = {field.name for field in cls.fields}
    name = next(name for name in data if name not in known)
    shown = name if isinstance(name, str) and len(name) <= 40 else _shown(name)
    raise MessageJsonError(
        lambda ros_type, field: f"Message type {ros_type} does not have a field {field}. The fields of {cls.ros_type} are {_names(cls)}.",
        [shown],
    )
