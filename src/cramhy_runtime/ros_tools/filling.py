"""From the words of a command line to the data of a message: values in order, or one mapping by names of fields.

Types are looked at here, before anything is sent, so that a mistake gets the text that the ROS tools print for it, with the
definition, and nothing reaches the session. A header may be ``auto`` and a time ``now``.
"""

from __future__ import annotations

from ..ros.definition_text import INTEGERS, Field
from .definitions import leaf_names, message_definition, service_text, text_of
from .arguments import CommandError
from .yaml_reading import YamlError, read


class BadArguments(Exception):
    """Arguments that do not fit the fields of a message; the text says how."""


class BadValue(BadArguments):
    """A value that its field cannot hold."""


def values(command, words):
    """The values of the words of a command line."""
    try:
        return [read(word) for word in words]
    except YamlError as problem:
        raise command.complaint(f"Argument error: {problem}") from None


def message_data(command, ros_type, arguments):
    """The data of the message that ``rostopic pub`` publishes."""
    definition = message_definition(ros_type)
    try:
        return fill(definition, arguments)
    except BadValue as problem:
        raise CommandError(
            f"ERROR: Unable to publish message. One of the fields has an incorrect type:\n  {problem}\n\nmsg file:\n{text_of(definition)}"
        ) from None
    except BadArguments as problem:
        raise CommandError(f"ERROR: {problem}\n\nArgs are: [{' '.join(leaf_names(definition))}]") from None


def request_data(parts, arguments):
    """The data of the request that ``rosservice call`` sends, for the two definitions of the service."""
    names = [field.name for field in parts[0].fields]
    try:
        if not (len(arguments) == 1 and isinstance(arguments[0], dict)) and len(arguments) != len(names):
            kind = "Not enough" if len(arguments) < len(names) else "Too many"
            raise BadArguments(f"{kind} arguments:\n * Given: {arguments}\n * Expected: {names}")
        return fill(parts[0], arguments)
    except BadValue as problem:
        raise CommandError(
            f"ERROR: Unable to send request. One of the fields has an incorrect type:\n  {problem}\n\nsrv file:\n{service_text(parts)}", 2
        ) from None
    except BadArguments as problem:
        shown = "\n".join(f" * {argument!r} (type {type(argument).__name__})" for argument in arguments)
        raise CommandError(
            f"ERROR: Incompatible arguments to call service:\n{problem}\nProvided arguments are:\n{shown}\n\n"
            f"Service arguments are: [{' '.join(names)}]",
            2,
        ) from None


def fill(definition, arguments, where=""):
    """The data of a message from one mapping, or one value per field. Fields that are not given have their defaults."""
    if len(arguments) == 1 and isinstance(arguments[0], dict):
        given = arguments[0]
        known = {field.name: field for field in definition.fields}
        for key in given:
            if key not in known:
                raise BadArguments(f"No field name [{where}{key}]")
        return {key: _value(known[key], value, where) for key, value in given.items()}
    if len(arguments) == 1 and isinstance(arguments[0], list) and len(definition.fields) > 1:
        arguments = arguments[0]
    if arguments and len(arguments) != len(definition.fields):
        kind = "Not enough" if len(arguments) < len(definition.fields) else "Too many"
        raise BadArguments(f"{kind} arguments:\n * Given: {arguments}\n * Expected: {[field.name for field in definition.fields]}")
    return {field.name: _value(field, value, where) for field, value in zip(definition.fields, arguments)}


def _value(field, value, where):
    name = where + field.name
    if field.is_array:
        if not isinstance(value, list):
            raise BadArguments(f"Field [{name}] must be a list or tuple, not {type(value).__name__}")
        if field.length and len(value) != field.length:
            raise BadArguments(f"Field [{name}] has incorrect number of elements: {len(value)} != {field.length}")
        return [_value(Field(f"{field.name}[{index}]", field.base), each, where) for index, each in enumerate(value)]
    if field.base in ("time", "duration"):
        return _moment(field, name, value)
    if not field.primitive:
        if field.base == "std_msgs/Header" and value == "auto":
            return {"stamp": "now"}
        definition = message_definition(field.base)
        if definition is None:
            raise BadArguments(f"The type {field.base} of the field [{name}] is not known")
        if not isinstance(value, (dict, list)) and not (value is None and not definition.fields):
            raise BadArguments(f"Field [{name}] must be a mapping or a list of the values of {field.base}, not {type(value).__name__}")
        return fill(definition, [] if value is None else value if isinstance(value, list) else [value], name + ".")
    return _primitive(field, name, value)


def _primitive(field, name, value):
    if field.base == "string":
        if isinstance(value, (list, dict)):
            raise BadValue(f"field {name} must be of type [str]")
        return "" if value is None else value if isinstance(value, str) else str(value)
    if field.base == "bool":
        if value not in (True, False):
            raise BadValue(f"field {name} is not a bool")
        return bool(value)
    if field.base in INTEGERS:
        bits, signed = INTEGERS[field.base]
        if not isinstance(value, int) or not signed and value < 0:
            raise BadValue(f"field {name} must be {'' if signed else 'unsigned '}integer type")
        low, high = (-(1 << bits - 1), (1 << bits - 1) - 1) if signed else (0, (1 << bits) - 1)
        if not low <= value <= high:
            raise BadValue(f"field {name} exceeds specified width [{field.base}]")
        return int(value)
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise BadValue(f"field {name} must be float type")
    return value


def _moment(field, name, value):
    """A time or duration: seconds, ``{secs: 1, nsecs: 5}``, or for a time ``now``."""
    if value == "now" and field.base == "time":
        return "now"
    least, most = (0, (1 << 32) - 1) if field.base == "time" else (-(1 << 31), (1 << 31) - 1)
    if isinstance(value, dict) and value.keys() <= {"secs", "nsecs"} and all(isinstance(part, int) for part in value.values()):
        seconds, nanoseconds = value.get("secs", 0), value.get("nsecs", 0)
    elif isinstance(value, (int, float)) and not isinstance(value, bool) and abs(value) < 1 << 33:
        seconds, rest = divmod(value, 1)
        seconds, nanoseconds = int(seconds), round(rest * 1e9)
    else:
        raise BadValue(f"field {name} must be a number of seconds or {{secs: integer, nsecs: integer}}")
    if not (least <= seconds <= most and 0 <= nanoseconds < 1_000_000_000):
        raise BadValue(f"field {name} exceeds specified width [{field.base}]")
    return {"secs": seconds, "nsecs": nanoseconds}
