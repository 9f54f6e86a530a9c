"""Messages printed as ``rostopic echo`` prints them.

Messages come as plain data (`ros.message_json`), and their `Definition` says how each field looks: a text in quotes, a time as two
lines, the elements of a list of messages each below a dash. (Parameters are YAML, as `yaml_library` writes them.)
"""

from __future__ import annotations

import base64
import json
import re

from .definitions import message_definition

_TIMES = ("time", "duration")


def message_lines(data, definition, indent="", keep=lambda field: True):
    """The lines of a message as ``rostopic echo`` prints them, without the dashes. keep: which fields are shown."""
    lines = []
    for field in definition.fields:
        if keep(field):
            head, value = f"{indent}{field.name}: ", data.get(field.name)
            below = _lines_below(field, value, indent + "  ", keep)
            lines += [head + inline_text(field, value)] if below is None else [head, *below]
    return lines


def _lines_below(field, value, indent, keep):
    """The lines that a value takes below its field's name; ``None`` for one that fits beside it."""
    if field.is_array:
        if field.primitive and field.base not in _TIMES or not value:
            return None
        lines = []
        for element in value:
            lines += [f"{indent}- ", *_part_lines(field, element, indent + "  ", keep)]
        return lines
    return None if field.primitive and field.base not in _TIMES else _part_lines(field, value, indent, keep)


def _part_lines(field, value, indent, keep):
    if field.base in _TIMES:
        return [f"{indent}secs: {value['secs']}", f"{indent}nsecs: {value['nsecs']:9d}"]
    return message_lines(value, message_definition(field.base), indent, keep)


def inline_text(field, value):
    """A primitive value, or a list of such, on one line."""
    if field.is_array:
        if isinstance(value, str):  # bytes travel in base64
            value = list(base64.b64decode(value))
        return "[" + ", ".join(repr(each) if field.base == "string" else _plain(each) for each in value or ()) + "]"
    if field.base == "string":
        return quoted(value) if value else "''"
    return _plain(value)


def _plain(value):
    return "nan" if value is None else str(value)  # null stands for what is no number


def quoted(text):
    """``text`` between double quotes, as YAML escapes it."""
    return re.sub(r"\\u00([0-9a-f]{2})", lambda found: f"\\x{found.group(1).upper()}", json.dumps(text))


def field_lines(field, value, keep=lambda field: True):
    """The lines of one field's value alone, as ``rostopic echo /turtle1/pose/x`` prints it."""
    below = _lines_below(field, value, "", keep)
    return [inline_text(field, value)] if below is None else below


def csv_names(definition, prefix="field."):
    """The head of the columns of ``rostopic echo -p``."""
    for field in definition.fields:
        if field.primitive or field.is_array:
            yield prefix + field.name
        else:
            yield from csv_names(message_definition(field.base), f"{prefix}{field.name}.")


def csv_values(data, definition):
    """The values of a message in the columns of `csv_names`."""
    for field in definition.fields:
        value = data.get(field.name)
        if field.is_array:
            yield inline_text(field, value) if field.primitive and field.base not in _TIMES else json.dumps(value)
        elif field.base in _TIMES:
            yield str(value["secs"] * 1_000_000_000 + value["nsecs"])
        elif field.primitive:
            yield str(value) if field.base == "string" else str(int(value)) if field.base == "bool" else _plain(value)
        else:
            yield from csv_values(value, message_definition(field.base))
