"""XML as a tree of elements that know their line: what URDF and Collada are read from.

The files are other people's, so each size has a bound. Entities that a document defines itself are refused: a small file can make them
huge, or have other files in it. Text is parsed in pieces, so an interrupt ends a long one. Errors are `DescriptionError`, with file and
line.
"""

from __future__ import annotations

import os
from contextlib import suppress
from pathlib import Path
from stat import S_ISREG
from typing import TYPE_CHECKING
from xml.parsers import expat

from .descriptions import DescriptionError

if TYPE_CHECKING:
    from collections.abc import Iterator

MOST_ELEMENTS = 200_000
MOST_BYTES = 256 * 1024 * 1024
"""Of a file. The Collada files of the robots that people publish have up to 40 MB."""
MOST_WITHIN = 1_000
"""Elements around an element."""
_NAME = "this is the name of a file, not the text in it."
_NO_FILE = "there is no file of this name, and it is not the text of a description: that begins with <."
_PIECE = 1 << 16  # bytes or characters that are parsed at once


class Element:
    """An XML element: its name, attributes, elements inside, line, and the text directly in it."""

    __slots__ = ("name", "attributes", "inside", "line", "_texts")

    def __init__(self, name: str, attributes: dict[str, str], line: int) -> None:
        self.name, self.attributes, self.line = name, attributes, line
        self.inside: list[Element] = []
        self._texts: list[str] = []

    @property
    def text(self) -> str:
        return "".join(self._texts)

    def add_text(self, text: str) -> None:
        self._texts.append(text)

    def all(self, name: str) -> list[Element]:
        """The elements of that name directly inside."""
        return [each for each in self.inside if each.name == name]

    def first(self, name: str) -> Element | None:
        """The first element of that name directly inside."""
        return next((each for each in self.inside if each.name == name), None)

    def everywhere(self) -> Iterator[Element]:
        """This element and all below it, in the order of the file."""
        waiting = [self]
        while waiting:
            element = waiting.pop()
            yield element
            waiting += reversed(element.inside)


class _Enough(Exception):
    """What was asked is known."""


def read_bytes(path: str | Path) -> bytes:
    """The bytes of a regular file. Errors: `DescriptionError`, for a pipe, a device, or a file that is too large; OSError."""
    with open(path, "rb", opener=_without_waiting) as file:
        if not S_ISREG(os.fstat(file.fileno()).st_mode):
            raise DescriptionError("this is not a regular file; a description is read from a file of finite size.", str(path))
        data = file.read(MOST_BYTES + 1)
    if len(data) > MOST_BYTES:
        raise DescriptionError(f"it has more than {MOST_BYTES >> 20} MiB.", str(path))
    return data


def _without_waiting(path: str, flags: int) -> int:
    return os.open(path, os.O_RDONLY | flags | getattr(os, "O_NONBLOCK", 0))  # a pipe that nobody writes to is opened, and then refused


def root_name(text: str | bytes) -> str:
    """The name of the element around all, as far as this is XML; else ``""``."""
    parser, found = expat.ParserCreate(), [""]

    def start(name: str, attributes: dict[str, str]) -> None:
        found[0] = name
        raise _Enough

    def refused(*arguments: object) -> None:
        raise _Enough

    parser.StartElementHandler, parser.EntityDeclHandler = start, refused
    with suppress(_Enough, expat.ExpatError):
        _feed(parser, text.lstrip())  # MuJoCo takes files that begin with white space
    return found[0]


def _feed(parser: expat.XMLParserType, text: str | bytes) -> None:
    for begin in range(0, len(text), _PIECE):
        parser.Parse(text[begin : begin + _PIECE], False)
    parser.Parse(b"", True)


def file_name(text: str | bytes) -> str | None:
    """``text`` if it names a file rather than being one, such as ``robots/arm.urdf`` or ``package://arm/arm.urdf``; else ``None``."""
    name = (text if isinstance(text, str) else text.decode("utf-8", "replace")).strip()
    looks_so = "/" in name or name.endswith((".urdf", ".xacro", ".xml", ".mjcf", ".dae"))
    return name if looks_so and len(name) < 1000 and not any(mark in name for mark in "<\n\0") else None


def parsed(text: str | bytes, file: str) -> Element:
    """The root element of an XML text; ``file`` stands in errors. Errors: `DescriptionError`, also for a file's name."""
    parser, stack, roots, count = expat.ParserCreate(), [], [], 0
    parser.buffer_text = True

    def start(name: str, attributes: dict[str, str]) -> None:
        nonlocal count
        count += 1
        element = Element(name, attributes, parser.CurrentLineNumber)
        if count > MOST_ELEMENTS:
            raise DescriptionError(f"it has more than {MOST_ELEMENTS} elements.", file, element.line, name)
        if len(stack) >= MOST_WITHIN:
            raise DescriptionError(f"more than {MOST_WITHIN} elements are around this one.", file, element.line, name)
        (stack[-1].inside if stack else roots).append(element)
        stack.append(element)

    def refused(*arguments: object) -> None:
        raise DescriptionError("entities of its own are not read: they can make a small file huge.", file, parser.CurrentLineNumber)

    parser.StartElementHandler = start
    parser.EndElementHandler = lambda name: stack.pop()
    parser.CharacterDataHandler = lambda text: stack[-1].add_text(text)
    parser.EntityDeclHandler = refused
    try:
        _feed(parser, text)
    except expat.ExpatError as problem:
        if not text.strip():
            raise DescriptionError("this is no XML: it is empty.", file, 1) from None
        if not file and (name := file_name(text)):
            raise DescriptionError(_NAME if Path(name).exists() else _NO_FILE, name) from None
        within = stack[-1].name if stack else ""
        reason = f"this is no XML: {expat.ErrorString(problem.code)}, column {problem.offset + 1}."
        raise DescriptionError(reason, file, problem.lineno, within) from None
    return roots[0]
