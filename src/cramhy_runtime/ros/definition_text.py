"""The language of ``.msg``, ``.srv`` and ``.action`` files: lines ``TYPE NAME``, constants ``TYPE NAME=VALUE``, comments, ``---``.

Any other line raises a `DefinitionError`, which names file, line and column and tells the right form. ``definition_files.py``
finds the files. What ROS's genmsg accepts is accepted, but for arrays of no elements (``T[0]``) and constants whose names no language
accepts. Source: genmsg 0.6; wiki.ros.org/msg, /srv, and /actionlib for the messages of an action. `Header` alone means
``std_msgs/Header``.
"""

from __future__ import annotations

import keyword
import re
from collections import namedtuple

from cramhy_runtime.kernel.late_patterns import late_pattern
from cramhy_runtime.lisp_core.packages import near_names
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, NoReturn

if TYPE_CHECKING:
    from collections.abc import Iterable


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
OTHER_NAMES = {"int": "int32", "uint": "uint32", "long": "int64", "float": "float32", "double": "float64", "boolean": "bool",
               "str": "string", "octet": "byte"}  # fmt: skip
"""Names that other languages use for these types, each with the name in ROS; hints suggest it."""
RESERVED = {"attributes", "constants", "copy", "definition", "field_names", "fields", "initargs", "keywords", "lisp_init", "lisp_name",
            "lisp_symbol", "python_attributes", "ros_type", "values"}  # fmt: skip
"""Attributes of every message class; a field with one of these names gets an underscore after it in Python."""

_LINE = late_pattern(r"(?P<type>[^\s=]+)(?:\s+(?P<name>[^=]*?))?\s*(?P<constant>=\s*(?P<value>.*))?$")
_NAME = late_pattern(r"[A-Za-z][A-Za-z0-9_]*$")
_TRUTHS = {"true": True, "false": False}
_CONSTANT_NAME = late_pattern(r"[A-Za-z_][A-Za-z0-9_]*$")
_TYPE = late_pattern(r"(?P<base>[A-Za-z][A-Za-z0-9_]*(?:/[A-Za-z][A-Za-z0-9_]*)?)(?P<array>\[(?P<length>[0-9]*)\])?$")


class DefinitionError(ValueError):
    """An error in a definition. ``problem`` names file, line and column; ``hint`` says what to try, or is ``None``."""

    def __init__(self, problem: str, hint: str | None = None):
        super().__init__(problem if hint is None else f"{problem} {hint}")
        self.problem, self.hint = problem, hint


class Field:
    """One field of a message.

    ``base``: its type without brackets. ``length``: ``None``, ``0`` for ``T[]``, or the n of ``T[n]``. ``attribute``: its name in
    Python. ``place``: line and column of its type in the file.
    """

    __slots__ = ("name", "base", "length", "attribute", "place")

    def __init__(self, name: str, base: str, length: int | None = None, place: tuple[int, int] = (1, 1)):
        self.name, self.base, self.length, self.place = name, base, length, place
        self.attribute = name + "_" if keyword.iskeyword(name) or name in RESERVED else name

    @property
    def is_array(self) -> bool:
        """Whether the type is ``T[]`` or ``T[n]``."""
        return self.length is not None

    @property
    def primitive(self) -> bool:
        """Whether ``base`` is a type of the language itself, no other message."""
        return self.base in PRIMITIVES

    @property
    def type(self) -> str:
        """The type as the file writes it, with the package of another message: ``float64[36]``, ``geometry_msgs/Point[]``."""
        return self.base + ("" if self.length is None else "[]" if self.length == 0 else f"[{self.length}]")

    def __repr__(self) -> str:
        return f"{self.type} {self.name}"


class Definition:
    """One message.

    ``fields``: `Field` objects. ``constants``: name → value. ``constant_lines``: as written, without spaces around the equals
    sign. ``text``: the lines of the file without comments. ``where``: its file.
    """

    __slots__ = ("fields", "constants", "constant_lines", "text", "where")

    def __init__(self, where: str = ""):
        self.fields: list[Field] = []
        self.constants: dict[str, str | int | float | bool | None] = {}
        self.constant_lines: list[str] = []
        self.text, self.where = "", where

    @property
    def lines(self) -> list[str]:
        """The lines that ``rosmsg show`` prints: the constants, then the fields."""
        return [*self.constant_lines, *map(repr, self.fields)]


def parse_message(text: str, package: str, where: str = "message definition", first: int = 1) -> Definition:
    """Read a message definition; returns a `Definition`. An error in it raises `DefinitionError`.

    ``text``: the lines. ``package``: the ROS package, which completes the names of other messages. ``where``: the name of the
    file in errors. ``first``: the number of the first line, in errors.
    """
    definition, kept = Definition(where), []
    for number, line in enumerate(text.removeprefix("\ufeff").split("\n"), first):
        bare = line.split("#", 1)[0].rstrip()
        if not bare.strip():
            continue
        column = len(bare) - len(bare.lstrip()) + 1
        match = _LINE.match(bare.lstrip())
        if match is None or not match["name"] or match["constant"] and not match["value"] and match["type"] != "string":
            _fail(
                where,
                number,
                column,
                f'"{bare.strip()}" is neither a field (TYPE NAME) nor a constant (TYPE NAME=VALUE).',
                "Write for instance  float64 x  or  uint8 RED=1  ; a comment begins with #.",
            )
        type_name, name = match["type"], match["name"].strip()
        name_column = column + match.start("name")
        if not (_CONSTANT_NAME if match["constant"] else _NAME).match(name):
            _fail(
                where,
                number,
                name_column,
                f'"{name}" is not a name for a {"constant" if match["constant"] else "field"}.',
                "A name begins with a letter; letters, digits and underscores follow.",
            )
        base, length = _type(type_name, package, where, number, column)
        if match["constant"]:
            if type_name not in PRIMITIVES or type_name in ("time", "duration"):
                _fail(
                    where,
                    number,
                    column,
                    f"A constant cannot be of type {type_name}.",
                    "Constants are integers, floats, bools and strings.",
                )
            value = match["value"].strip()
            if base == "string":  # a text constant goes to the end of the line, number signs included
                value = line.partition("=")[2].strip()
            _no_second(definition, name, where, number, name_column)
            definition.constants[name] = _constant(base, value, where, number, column + match.start("value"))
            definition.constant_lines.append(f"{type_name} {name}={value}")
            kept.append(definition.constant_lines[-1])
        else:
            _no_second(definition, name, where, number, name_column)
            definition.fields.append(Field(name, base, length, (number, column)))
            kept.append(f"{type_name} {name}")
    definition.text = "\n".join(kept)
    return definition


def parse_service(text: str, package: str, where: str = "service definition") -> tuple[Definition, ...]:
    """Read a service definition, as `parse_message`; returns the `Definition` objects of the request and of the response.

    As for ROS, all is of the request if there is no line of dashes, and further ones after the first do not count.
    """
    request, *others = _split(text)
    response = _Part("".join(part.text for part in others), others[0].first if others else 1)
    return tuple(parse_message(part.text, package, where, part.first) for part in (request, response))


def parse_action(text: str, package: str, where: str = "action definition") -> tuple[Definition, ...]:
    """Read an action definition, as `parse_message`; returns the `Definition` objects of goal, result and feedback."""
    parts, names = _split(text), ("goal", "result", "feedback")
    if len(parts) != len(names):
        line = parts[len(names)].first if len(parts) > len(names) else text.count("\n") + 1
        _fail(
            where,
            line,
            1,
            f"Lines of three dashes separate {', '.join(names[:-1])} and {names[-1]}: there must be {len(names) - 1}, "
            f"not {len(parts) - 1}.",
            f"Write --- on a line of its own after the fields of the {names[0]}, also when a part is empty.",
        )
    return tuple(parse_message(part.text, package, where, part.first) for part in parts)


ACTION_PARTS = ("Goal", "Result", "Feedback")


def action_messages(name: str) -> dict[str, str]:
    """The definition texts, by message name, of the four messages that carry the parts of the action ``name``."""
    return {
        f"{name}ActionGoal": f"Header header\nactionlib_msgs/GoalID goal_id\n{name}Goal goal",
        f"{name}ActionResult": f"Header header\nactionlib_msgs/GoalStatus status\n{name}Result result",
        f"{name}ActionFeedback": f"Header header\nactionlib_msgs/GoalStatus status\n{name}Feedback feedback",
        f"{name}Action": f"{name}ActionGoal action_goal\n{name}ActionResult action_result\n{name}ActionFeedback action_feedback",
    }


_Part = namedtuple("_Part", "text first")
"""A part of a definition: its text, and the number of its first line in the file."""


def _split(text: str) -> list[_Part]:
    """The parts of TEXT between lines of dashes."""
    parts, first = [], 1
    for part in re.split(r"^[ \t]*---[^\n]*$", text, flags=re.MULTILINE):
        parts.append(_Part(part, first))
        first += part.count("\n")
    return parts


def _fail(where: str, line: int, column: int, problem: str, hint: str | None = None) -> NoReturn:
    raise DefinitionError(f"{where}, line {line}, column {column}: {problem}", hint)


def _no_second(definition: Definition, name: str, where: str, number: int, column: int) -> None:
    if name in definition.constants or any(field.name == name for field in definition.fields):
        _fail(where, number, column, f"There already is a field or constant called {name}.", "Each name can be used once in a message.")


def _type(type_name: str, package: str, where: str, number: int, column: int) -> tuple[str, int | None]:
    match = _TYPE.match(type_name)
    if match is None or match["length"] and int(match["length"]) == 0:
        _fail(
            where, number, column, f'"{type_name}" is not a type.', "Types are written T, T[] or T[3], those of other packages package/T."
        )
    base = match["base"]
    if base == "Header":
        base = "std_msgs/Header"
    elif base not in PRIMITIVES and "/" not in base:
        base = f"{package}/{base}"
    return base, int(match["length"] or 0) if match["array"] else None


def _constant(type_name: str, value: str, where: str, number: int, column: int) -> str | int | float | bool | None:
    if type_name == "string":
        return value
    try:
        if type_name == "bool":
            truth = _TRUTHS[value.lower()] if value.lower() in _TRUTHS else float(value) != 0
            return True if truth else None
        constant = _integer(value) if type_name in INTEGERS else float(value)
    except ValueError:
        _fail(where, number, column, f"{value} is not a {type_name}.", "Write True or False." if type_name == "bool" else None)
    if type_name in INTEGERS:
        bits, signed = INTEGERS[type_name]
        least, most = (-(1 << (bits - 1)), (1 << (bits - 1)) - 1) if signed else (0, (1 << bits) - 1)
        if type_name == "byte":  # for rosmsg it is an int8, for roslisp an uint8
            least = -128
        if not least <= constant <= most:
            _fail(where, number, column, f"{value} is not a {type_name}.", f"Its range is {least} to {most}.")
    return constant


def _integer(text: str) -> int:
    """The integer that TEXT is: in decimal, with leading zeros or without, or as Python writes other bases."""
    try:
        return int(text)
    except ValueError:
        return int(text, 0)


def unknown_type(field: Field, package: str, where: str, candidates: Iterable[str], looked: str) -> NoReturn:
    """Raise a `DefinitionError`: the type of ``field`` in the file ``where`` of ``package`` does not exist.

    ``candidates``: the names of types that exist, for the hint. ``looked``: the hint if none of them is near: where it was looked for.
    """
    name = field.base.rpartition("/")[2]
    written = name if name in OTHER_NAMES or field.base.startswith(package + "/") else field.base
    near = [OTHER_NAMES[name]] if name in OTHER_NAMES else near_names(name, [*PRIMITIVES, *candidates], 2)
    hint = f"Did you mean {' or '.join(near)}?" if near else looked
    _fail(where, *field.place, f"There is no type {written}.", hint)
