"""XML as a tree of elements that know their line: what URDF and Collada are read from.

Entities that a document defines itself are refused: a small file can make them huge. Errors are `DescriptionError`, with file and line.
"""

from __future__ import annotations

from typing import TYPE_CHECKING
from xml.parsers import expat

from .descriptions import DescriptionError

if TYPE_CHECKING:
    from collections.abc import Iterator

MOST_ELEMENTS = 200_000


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


def parsed(text: str | bytes, file: str) -> Element:
    """The root element of an XML text; ``file`` stands in errors. Errors: `DescriptionError`."""
    parser, stack, roots, count = expat.ParserCreate(), [], [], 0
    parser.buffer_text = True

    def start(name: str, attributes: dict[str, str]) -> None:
        nonlocal count
        count += 1
        element = Element(name, attributes, parser.CurrentLineNumber)
        if count > MOST_ELEMENTS:
            raise DescriptionError(f"it has more than {MOST_ELEMENTS} elements.", file, element.line, name)
        (stack[-1].inside if stack else roots).append(element)
        stack.append(element)

    def refused(*arguments: object) -> None:
        raise DescriptionError("entities of its own are not read: they can make a small file huge.", file, parser.CurrentLineNumber)

    parser.StartElementHandler = start
    parser.EndElementHandler = lambda name: stack.pop()
    parser.CharacterDataHandler = lambda text: stack[-1].add_text(text)
    parser.EntityDeclHandler = refused
    try:
        parser.Parse(text, True)
    except expat.ExpatError as problem:
        within = stack[-1].name if stack else ""
        reason = f"this is no XML: {expat.ErrorString(problem.code)}, column {problem.offset + 1}."
        raise DescriptionError(reason, file, problem.lineno, within) from None
    return roots[0]
