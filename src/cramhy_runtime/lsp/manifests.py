"""``package.xml``: the manifest of a ROS package (REP 127, REP 140, REP 149). Nothing outside of the text is looked at."""

from __future__ import annotations

import re
from xml.parsers import expat

from .findings import ERROR, WARNING, Finding

REQUIRED = ("name", "version", "description", "maintainer", "license")
_NAME = re.compile(r"[a-z][a-z0-9_-]*\Z")
_VERSION = re.compile(r"\d+\.\d+\.\d+\Z")
_KNOWN = frozenset(
    """package name version description maintainer license url author depend build_depend build_export_depend buildtool_depend
    buildtool_export_depend run_depend exec_depend test_depend doc_depend conflict replace group_depend member_of_group export""".split()
)


class _Refused(Exception):
    pass


def check(text):
    """The `Finding`s of a manifest."""
    parser = expat.ParserCreate()
    stack, seen, places, found, export = [], {}, {}, [], []

    def here():
        return text.offset_of_reader(parser.CurrentLineNumber, parser.CurrentColumnNumber + 1)

    def start(name, attributes):
        at = here() + 1
        stack.append([name, at, ""])
        if len(stack) == 1:
            places[""] = at
            if name != "package":
                found.append(Finding(at, at + len(name), ERROR, f"A manifest is a <package>, and this is a <{name}>."))
        elif not export and len(stack) == 2 and name not in _KNOWN:
            found.append(Finding(at, at + len(name), WARNING, f"A manifest has no element <{name}>."))
        if name == "export":
            export.append(name)

    def end(name):
        element, at, content = stack.pop()
        if name == "export":
            export.clear()
        if len(stack) == 1:
            seen[element] = content.strip()
            places[element] = at

    def data(content):
        if stack:
            stack[-1][2] += content

    def refuse(*declaration):
        raise _Refused

    parser.StartElementHandler, parser.EndElementHandler, parser.CharacterDataHandler = start, end, data
    parser.EntityDeclHandler = refuse
    try:
        parser.Parse(text.text, True)
    except _Refused:
        at = here()
        return [Finding(at, at + 1, ERROR, "A manifest declares no entities.")]
    except expat.ExpatError as problem:
        at = text.offset_of_reader(problem.lineno, problem.offset + 1)
        return [*found, Finding(at, min(len(text.text), at + 1), ERROR, f"This is no XML: {expat.ErrorString(problem.code)}.")]
    at = places.get("", 0)
    for name in REQUIRED:
        if name not in seen:
            found.append(Finding(at, at + len("package"), ERROR, f"The manifest lacks <{name}>."))
    for name, pattern, words in (
        ("name", _NAME, "small letters, digits, _ and -, and begins with a letter"),
        ("version", _VERSION, "three numbers, such as 0.1.0"),
    ):
        if name in seen and not pattern.match(seen[name]):
            found.append(Finding(places[name], places[name] + len(name), ERROR, f"The {name} {seen[name]!r} is not made of {words}."))
    return found
