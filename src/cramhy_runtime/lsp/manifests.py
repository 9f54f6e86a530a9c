"""``package.xml``: the manifest of a ROS package (REP 127, REP 140, REP 149). Nothing outside of the text is looked at."""

from __future__ import annotations

import re
from xml.parsers import expat

from cramhy_runtime.lisp_core.packages import near_names

from .findings import ERROR, WARNING, Finding, meant

ONCE = ("name", "version", "description")
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
            near = near_names(name, _KNOWN)
            hint = f"\n{meant(near)}" if near else ""
            fixes = tuple((f"Write {each}", at, at + len(name), each) for each in near)
            found.append(Finding(at, at + len(name), WARNING, f"A manifest has no element <{name}>.{hint}", fixes))
        elif len(stack) == 2 and name in ONCE and name in seen:
            found.append(Finding(at, at + len(name), ERROR, f"A manifest has one <{name}>, and this is the second."))
        if name == "package" and attributes.get("format", "1") not in ("1", "2", "3"):
            where = text.text.find("format", at)
            found.append(Finding(where, text.text.find(">", where), ERROR, "The format of a manifest is 1, 2 or 3."))
        if name == "maintainer" and not attributes.get("email"):
            found.append(Finding(at, at + len(name), ERROR, 'A maintainer has an address: <maintainer email="user@example.org">.'))
        if name == "export":
            export.append(name)

    def end(name):
        element, at, content = stack.pop()
        if name == "export":
            export.clear()
        if len(stack) == 1:
            seen[element] = content.strip()
            places[element] = at
            if "depend" in element and not content.strip():
                found.append(Finding(at, at + len(element), ERROR, f"This <{element}> names no package."))

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
        written = re.match(r"[\w.-]*", text.text[at:])[0]
        if stack and problem.code == expat.errors.codes[expat.errors.XML_ERROR_TAG_MISMATCH]:
            name, opened, _ = stack[-1]
            line = text.place(opened)[0] + 1
            message = f"This is no XML: </{written}> does not close the <{name}> of line {line}."
            fix = (f"Write {name}", at, at + len(written), name), (f"Close <{name}> before it", at - 2, at - 2, f"</{name}>")
            return [*found, Finding(at, at + len(written), ERROR, message, fix)]
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
