"""What is told of a text: `Finding`s, whoever finds them."""

from __future__ import annotations

import re
from typing import NamedTuple

from cramhy_runtime.ground.condition_types import StyleWarning, Warning_
from cramhy_runtime.ground.data import UNBOUND, Symbol
from cramhy_runtime.ground.packages import all_packages, near_names
from cramhy_runtime.languages.commonlisp.tools.advice import hint_for, report_text
from cramhy_runtime.session.arglists import arglist

ERROR, WARNING, HINT = 1, 2, 4
"""Severities, as the protocol numbers them. HINT: of style."""
_MEANT = re.compile(r"Did you mean ([^?\n]+)\?")
_ELSEWHERE = re.compile(r"There is (\S+:[^\s:]+) in another package")
_NO_PACKAGE = re.compile(r'The name "([^"]+)" does not designate any package|[Pp]ackage "?([^\s"]+)"? (?:does not exist|not found)')
_MOST_FIXES = 5


class Finding(NamedTuple):
    """start, end: offsets in the text. fixes: [(title, start, end, new text)]."""

    start: int
    end: int
    severity: int
    message: str
    fixes: tuple = ()


def of_condition(condition, text, filename):
    """The `Finding` that tells of ``condition``, or ``None`` if its place is in another file."""
    position = getattr(condition, "position", None)
    if position is not None and position[0] != filename:
        return None
    message, hint = report_text(condition), hint_for(condition)
    start = 0 if position is None else text.offset_of_reader(position[1] or 1, (position[2] if len(position) > 2 else 1) or 1)
    named = _narrowed(condition, text, start)
    start, end = named or (start, _end(text, start))
    severity = WARNING if isinstance(condition, Warning_) and not isinstance(condition, StyleWarning) else ERROR
    severity = HINT if isinstance(condition, StyleWarning) and not getattr(condition, "undefined", None) else severity
    severity = WARNING if isinstance(condition, StyleWarning) and getattr(condition, "undefined", None) else severity
    if hint is None and getattr(condition, "undefined", None) in ("function", "variable") and named:
        near = near_names(condition.name.name, _names_of(condition.name, condition.undefined))
        hint = f"Did you mean {' or '.join(name.lower() for name in near)}?" if near else None
    return Finding(start, end, severity, f"{message}\n{hint}" if hint else message, tuple(fixes(message, hint, text, start, end)))


def _names_of(missing, what):
    """The names of functions or variables, as ``what`` says, that can be seen from the package of the symbol ``missing``."""
    package = missing.package
    for table in (package.internal, package.external, *(used.external for used in package.use)) if package is not None else ():
        for name, symbol in table.items():
            if (
                isinstance(symbol, Symbol)
                and symbol is not missing
                and (arglist(symbol) if what == "function" else symbol.value is not UNBOUND)
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
        for near in near_names(name, [each for package in all_packages() for each in package.names]) if at >= 0 else ():
            yield f"Write {near.lower()}", at, at + len(name), near.lower()
    if meant and written and "\n" not in written:
        for name in re.split(r",\s*|\s+or\s+", meant[1])[:_MOST_FIXES]:
            name = name.strip()
            if name and " " not in name and "(" not in written:
                new = name if not written.startswith(":") or name.startswith(":") else f":{name}"
                new = new.lower() if written.islower() else new
                yield f"Write {new}", start, end, new
