"""What is told of a text: `Finding`s, whoever finds them."""

from __future__ import annotations

import re
from typing import NamedTuple

from cramhy_runtime.lisp_core.condition_types import StyleWarning, Warning_
from cramhy_runtime.lisp_core.data import UNBOUND, Symbol
from cramhy_runtime.lisp_core.packages import all_packages, near_names
from cramhy_runtime.languages.commonlisp.tools.advice import hint_for, report_text
from cramhy_runtime.session.arglists import arglist

from . import scopes

ERROR, WARNING, HINT = 1, 2, 4
"""Severities, as the protocol numbers them. HINT: of style."""
_MEANT = re.compile(r"Did you mean (\??[^?\n]+)\?")
_ELSEWHERE = re.compile(r"There is (\S+:[^\s:]+) in another package")
_NO_PACKAGE = re.compile(r'The name "([^"]+)" does not designate any package|[Pp]ackage "?([^\s"]+)"? (?:does not exist|not found)')
_FAILED_MACRO = re.compile(r"The macro call .* fails, and will be an error when it is reached:", re.S)
_WRONG_CALL = re.compile(r"^The function \S+(?: is)? called with|known argument keyword")
_LONG_FORM = re.compile(r"(The \S+ form) (\(.*\)) is malformed: (.*)", re.S)
_BLAMED = re.compile(
    r"unknown LOOP keyword: (\S+)|^(\S+) is an unknown keyword in FOR|for unknown block: (\S+)|nonexistent tag: (\S+)"
    r"|variable (\S+) occurs more than once|duplicate slot name (\S+)|bogus DEFPACKAGE option: \((\S+)|no retry counter (\S+)"
    r"|unknown DEFSTRUCT option:\s+\((\S+)|^(\S+) is not the name of a structure type|symbol \"(\S+)\" is not found"
    r"|no symbol named \"(\S+)\"|DEFPACKAGE \S+: [^\n]*package (\S+)|^\"(\S+)\" is already a nickname|^([&:]\S+) is not a known argument"
    r"|depends on \"([^\"]+)\", which is not|Circular dependency in system \S+: (\S+)|\"name\" \.\.\.\), not \((:[\w-]+)\)"
    r"|(&\w+)\b(?=[^\n]*\n?[^\n]*is malformed: a parameter)|[\s(]\S*::(&\S+)"
)
_MOST_FIXES = 5


class Finding(NamedTuple):
    """start, end: offsets in the text. fixes: [(title, start, end, new text)]."""

    start: int
    end: int
    severity: int
    message: str
    fixes: tuple = ()


def meant(names, before=""):
    """The hint that asks for one of ``names``, or ``None`` if there are none. before: what stands before each of them in the text."""
    return f"Did you mean {' or '.join(before + name for name in names)}?" if names else None


def meant_in_lisp(names, before=""):
    """The same for names in capitals, which a text of Lisp has in small letters."""
    return meant([name.lower() for name in names], before)


def of_condition(condition, text, filename):
    """The `Finding` that tells of ``condition``, or ``None`` if its place is in another file."""
    position = getattr(condition, "position", None)
    if position is not None and position[0] != filename:
        return None
    message, hint = _shortened(report_text(condition)), hint_for(condition)
    start = 0 if position is None else text.offset_of_reader(position[1] or 1, (position[2] if len(position) > 2 else 1) or 1)
    named = _narrowed(condition, text, start) or _blamed(message, text, start)
    start, end = named or (start, _end(text, start))
    if hint is None and getattr(condition, "undefined", None) in ("function", "variable") and named:
        near = near_names(condition.name.name, _names_of(condition.name, condition.undefined, text, start))
        hint = meant_in_lisp(near)
    hint = hint and _MEANT.sub(
        lambda match: match[0] if re.search("[a-z]", match[1].replace(" or ", " ")) else f"Did you mean {match[1].lower()}?", hint
    )
    severity = _severity(condition, message)
    return Finding(start, end, severity, f"{message}\n{hint}" if hint else message, tuple(fixes(message, hint, text, start, end)))


def _severity(condition, message):
    """Style is a hint, but what will fail when it runs is a warning, and a call of a macro that has failed is an error."""
    if not isinstance(condition, Warning_) or _FAILED_MACRO.match(message):
        return ERROR
    style = isinstance(condition, StyleWarning) and not getattr(condition, "undefined", None) and not _WRONG_CALL.search(message)
    return HINT if style else WARNING


def _shortened(message):
    """Without the text of a long form, which stands at the place itself."""
    match = _LONG_FORM.match(message)
    if match is None or "\n" not in match[2]:
        return message
    return f"{match[1]} is malformed: {match[3]}"


def _blamed(message, text, start):
    """(start, end) of the word that ``message`` blames, if it stands in the form at ``start``; the last one of a name that is twice.

    They all come from messages of our own rooms, and begin where a name is named.
    """
    match = _BLAMED.search(message)
    if match is None:
        return None
    name = next(group for group in match.groups() if group).lstrip("(:").rpartition(":")[2].upper()
    end, wanted = text.end_of_datum(start), 2 if "more than once" in message or "duplicate" in message else 1
    for token in text.tokens:
        if start < token.start < end and token.kind in ("word", "string"):
            wanted -= token.text.strip('"').lstrip("':#").rpartition(":")[2].upper() == name
            if wanted == 0:
                return token.start, token.end
    return None


def _names_of(missing, what, text, start):
    """The names of functions or variables, as ``what`` says, that are seen from the package of the symbol ``missing``, or at ``start``."""
    package = missing.package
    if what == "variable":
        for form in text.around(start):
            yield from (each.text.upper() for each in scopes.binders(form))
    for table in (package.internal, package.external, *(used.external for used in package.use)) if package is not None else ():
        for name, symbol in table.items():
            if (
                isinstance(symbol, Symbol)
                and symbol is not missing
                and (arglist(symbol) if what == "function" else symbol.special or symbol.value is not UNBOUND)
            ):
                yield name


def _end(text, start):
    """An end that leaves the rest of a long list alone: that of its first line."""
    end = text.end_of_datum(start)
    line_end = text.text.find("\n", start)
    return min(end, line_end) if line_end > start else max(end, start)


def _narrowed(condition, text, start):
    """(start, end) of the name that ``condition`` is about, if it stands in the form at ``start``."""
    name = getattr(getattr(condition, "name", None), "name", None)
    if not isinstance(name, str):
        return None
    end = text.end_of_datum(start)
    for token in text.tokens:
        if start <= token.start < end and token.kind == "word" and token.text.rpartition(":")[2].upper() == name.upper():
            return token.start, token.end
    return None


def fixes(message, hint, text, start, end):
    """[(title, start, end, new text)] of what the words of a message and its hint offer."""
    meant = _MEANT.search(f"{message}\n{hint or ''}")
    written = text.text[start:end]
    elsewhere = _ELSEWHERE.search(hint or "")
    if elsewhere and "(" not in written:
        yield f"Write {elsewhere[1]}", start, end, elsewhere[1]
    missing = _NO_PACKAGE.search(message)
    if missing:
        name = missing[1] or missing[2]
        at = text.text.upper().find(name.upper(), start)
        near_it = near_names(name, {each for package in all_packages() for each in package.names}) if at >= 0 else ()
        for near in near_it:
            yield f"Write {near.lower()}", at, at + len(name), near.lower()
        if near_it:
            return
    if meant and written and "\n" not in written:
        for name in re.split(r",\s*|\s+or\s+", meant[1])[:_MOST_FIXES]:
            name = name.strip()
            if name and " " not in name and "(" not in written:
                new = name if not written.startswith(":") or name.startswith(":") else f":{name}"
                new = f'"{new}"' if written.startswith('"') else new
                new = new.lower() if written.islower() else new
                yield f"Write {new}", start, end, new
