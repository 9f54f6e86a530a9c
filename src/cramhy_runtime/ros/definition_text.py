"""The language of ``.msg`` and ``.srv`` files: lines ``TYPE NAME``, constants ``TYPE NAME=VALUE``, comments, ``---``.

Our own copies of the common packages lie in ``definitions/``; further folders that hold ROS packages are named with
`add_package_directory`, so that a user's own ``my_msgs/msg/Thing.msg`` is found as in a catkin workspace.
Source: wiki.ros.org/msg; `Header` alone means ``std_msgs/Header``.
"""

from __future__ import annotations

import keyword
from pathlib import Path

INTEGERS = {
    "int8": (8, True),
    "int16": (16, True),
    "int32": (32, True),
    "int64": (64, True),
    "uint8": (8, False),
    "uint16": (16, False),
    "uint32": (32, False),
    "uint64": (64, False),
    "byte": (8, False),
    "char": (8, False),
}
"""Bits and signedness. `byte` and `char` arrive as 0 … 255 (roslisp.md 5.2)."""
PRIMITIVES = {*INTEGERS, "float32", "float64", "bool", "string", "time", "duration"}

_directories = [Path(__file__).parent / "definitions"]


class DefinitionError(ValueError):
    """A line of a definition that is neither a field nor a constant; the text names file and line."""


class Field:
    """One field: ``base`` is its type without brackets; ``length`` is ``None``, ``0`` for ``T[]``, or the n of ``T[n]``.
    ``attribute`` is the slot's name in Python."""

    __slots__ = ("name", "base", "length", "attribute")

    def __init__(self, name, base, length=None):
        self.name, self.base, self.length = name, base, length
        self.attribute = name + "_" if keyword.iskeyword(name) else name

    @property
    def is_array(self):
        return self.length is not None

    @property
    def primitive(self):
        return self.base in PRIMITIVES

    @property
    def type(self):
        """As in the file: ``float64[36]``."""
        return self.base + ("" if self.length is None else "[]" if self.length == 0 else f"[{self.length}]")

    def __repr__(self):
        return f"{self.type} {self.name}"


class Definition:
    """The fields and constants of one message; ``lines`` is what ``rosmsg show`` prints of it."""

    __slots__ = ("fields", "constants", "lines")

    def __init__(self, fields, constants, lines):
        self.fields, self.constants, self.lines = fields, constants, lines


def parse_message(text, package, where="message definition"):
    """The `Definition` in ``text``; names of other messages are completed with ``package``."""
    fields, constants, lines = [], {}, []
    for number, line in enumerate(text.splitlines(), 1):
        bare = line.split("#", 1)[0].strip()
        if not bare:
            continue
        type_name, _, rest = bare.partition(" ")
        rest = rest.strip()
        if "=" in rest:
            if type_name == "string":  # a text constant goes to the end of the line, number signs included
                rest = line.strip().partition(" ")[2].strip()
            name, _, value = rest.partition("=")
            constants[name.strip()] = _constant(type_name, value.strip(), where, number)
            lines.append(f"{type_name} {name.strip()}={value.strip()}")
        elif type_name and rest.isidentifier():
            fields.append(_field(type_name, rest, package, where, number))
            lines.append(repr(fields[-1]))
        else:
            raise DefinitionError(
                f'{where}, line {number}: "{line.strip()}" is neither a field (TYPE NAME) nor a constant (TYPE NAME=VALUE).'
            )
    return Definition(fields, constants, lines)


def parse_service(text, package, where="service definition"):
    """The two `Definition` objects, of the request and of the response."""
    request, separator, response = ("\n" + text).partition("\n---")
    if not separator:
        raise DefinitionError(f"{where}: a line of three dashes must separate request and response.")
    return parse_message(request, package, where), parse_message(response, package, where)


def _field(type_name, name, package, where, number):
    base, bracket, size = type_name.partition("[")
    length = None
    if bracket:
        if not size.endswith("]") or (size != "]" and not size[:-1].isdigit()):
            raise DefinitionError(f'{where}, line {number}: "{type_name}" is not a type. Arrays are written T[] or T[3].')
        length = 0 if size == "]" else int(size[:-1])
    if base == "Header":
        base = "std_msgs/Header"
    elif base not in PRIMITIVES and "/" not in base:
        base = f"{package}/{base}"
    return Field(name, base, length)


def _constant(type_name, value, where, number):
    try:
        if type_name in INTEGERS:
            return int(value, 0)
        if type_name.startswith("float"):
            return float(value)
    except ValueError:
        raise DefinitionError(f"{where}, line {number}: {value} is not a {type_name}.") from None
    if type_name == "bool":
        return True if value.lower() in ("1", "true") else None
    return value


def add_package_directory(directory):
    """Look for ROS packages in the sub-folders of ``directory`` too. Ours come first."""
    directory = Path(directory)
    if directory not in _directories:
        _directories.append(directory)


def known_packages():
    """The names of all packages with definitions."""
    return sorted(
        {
            entry.name
            for directory in _directories
            if directory.is_dir()
            for entry in directory.iterdir()
            if (entry / "msg").is_dir() or (entry / "srv").is_dir()
        }
    )


def definition_files(package, kind):
    """The files of ``package``, of kind ``"msg"`` or ``"srv"``, by the name of what they define."""
    for directory in _directories:
        folder = directory / package / kind
        if folder.is_dir() or (directory / package).is_dir():
            return {path.stem: path for path in sorted(folder.glob("*." + kind))}
    return {}
