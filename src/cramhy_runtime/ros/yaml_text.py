"""The little YAML that the ROS tools speak: values on a command line, messages and parameters printed.

Reading covers scalars, ``[a, b]`` and ``{key: value}``, which is what one types after ``rosservice call``; writing covers what
``rostopic echo`` and ``rosparam get`` print.
"""

from __future__ import annotations

import re

from .messages import RosMessage


class YamlError(ValueError):
    """Text that is not a value; says where."""


_TOKEN = re.compile(r"""\s*(?:([\[\]{},])|(:)(?=\s|$)|"((?:[^"\\]|\\.)*)"|'((?:[^']|'')*)'|((?:(?!:\s|:$)[^\[\]{},])+))""")
_INTEGER = re.compile(r"[-+]?(0x[0-9a-fA-F]+|\d+)$")
_FLOAT = re.compile(r"[-+]?(\d+\.\d*|\.\d+|\d+)([eE][-+]?\d+)?$")
_WORDS = {
    "true": True,
    "yes": True,
    "on": True,
    "false": False,
    "no": False,
    "off": False,
    "null": None,
    "~": None,
    "": None,
}
_SPECIAL = {".nan": float("nan"), ".inf": float("inf"), "-.inf": float("-inf")}


def read(text):
    """The value of ``text``. Block mappings of several lines are read as ``{key: value}``."""
    text = text.strip()
    tokens = _tokens(text)
    if len(tokens) > 1 and tokens[1] == (":", None):
        tokens = _tokens("{" + text.replace("\n", ", ") + "}")
    value, rest = _value(tokens, 0, text)
    if rest != len(tokens):
        raise YamlError(f"Cannot read {text!r}: there is something after the value.")
    return value


def _tokens(text):
    tokens, position = [], 0
    while position < len(text):
        match = _TOKEN.match(text, position)
        if not match or match.end() == position:
            if not text[position:].strip():
                break
            raise YamlError(f"Cannot read {text!r} at {text[position : position + 10]!r}.")
        mark, colon, double, single, plain = match.groups()
        if mark or colon:
            tokens.append((mark or colon, None))
        elif plain is None:
            tokens.append(("text", double.replace('\\"', '"') if double is not None else single.replace("''", "'")))
        elif plain.strip():
            tokens.append(("plain", plain.strip()))
        position = match.end()
    return tokens


def _value(tokens, index, text):
    if index >= len(tokens):
        return None, index
    kind, content = tokens[index]
    if kind == "text":
        return content, index + 1
    if kind == "plain":
        return scalar(content), index + 1
    if kind == "[":
        return _sequence(tokens, index + 1, text)
    if kind == "{":
        return _mapping(tokens, index + 1, text)
    raise YamlError(f"Cannot read {text!r}: {kind!r} where a value should be.")


def _sequence(tokens, index, text):
    items = []
    while index < len(tokens):
        if tokens[index][0] == "]":
            return items, index + 1
        item, index = _value(tokens, index, text)
        items.append(item)
        if index < len(tokens) and tokens[index][0] == ",":
            index += 1
    raise YamlError(f"Cannot read {text!r}: a ] is missing.")


def _mapping(tokens, index, text):
    items = {}
    while index < len(tokens):
        if tokens[index][0] == "}":
            return items, index + 1
        key = tokens[index][1]
        if key is None or index + 1 >= len(tokens) or tokens[index + 1][0] != ":":
            raise YamlError(f"Cannot read {text!r}: a mapping is written {{key: value}}.")
        items[str(key)], index = _value(tokens, index + 2, text)
        if index < len(tokens) and tokens[index][0] == ",":
            index += 1
    raise YamlError(f"Cannot read {text!r}: a }} is missing.")


def scalar(text):
    """The value of one plain word."""
    if text.lower() in _WORDS:
        return _WORDS[text.lower()]
    if _INTEGER.match(text):
        return int(text, 16) if "x" in text.lower() else int(text)
    if text.lower() in _SPECIAL:
        return _SPECIAL[text.lower()]
    return float(text) if _FLOAT.match(text) else text


def show_message(message, indent=""):
    """The lines of a message as ``rostopic echo`` prints them, without the dashes."""
    lines = []
    for field, value in zip(message.fields, message.values()):
        if isinstance(value, RosMessage):
            lines.append(f"{indent}{field.name}: ")
            lines += show_message(value, indent + "  ")
        elif isinstance(value, list) and value and isinstance(value[0], RosMessage):
            lines.append(f"{indent}{field.name}: ")
            for element in value:
                lines.append(f"{indent}  - ")
                lines += show_message(element, indent + "    ")
        else:
            lines.append(f"{indent}{field.name}: {show_value(value, field)}")
    return lines


def show_value(value, field=None):
    """One value on one line."""
    if value is None or value is True or value is False:
        return str(value is True) if field is None or field.base == "bool" else "''" if value is None else "1"
    if isinstance(value, str):
        return f'"{value}"'
    if isinstance(value, list):
        return "[" + ", ".join(show_value(element, field) for element in value) + "]"
    if isinstance(value, float):
        return float.__repr__(value)
    return str(value)


def show_parameter(value, indent=""):
    """A parameter as ``rosparam get`` prints it."""
    if isinstance(value, dict):
        if not value:
            return "{}"
        lines = []
        for key in sorted(value):
            below = value[key]
            if isinstance(below, dict) and below:
                lines.append(f"{indent}{key}:")
                lines.append(show_parameter(below, indent + "  "))
            else:
                lines.append(f"{indent}{key}: {show_parameter(below)}")
        return "\n".join(lines)
    if value is True or value is False:
        return str(value).lower()
    if isinstance(value, list):
        return "[" + ", ".join(show_parameter(element) for element in value) + "]"
    if isinstance(value, str) and (not value or scalar(value) != value):
        return f"'{value}'"
    return float.__repr__(value) if isinstance(value, float) else str(value)
