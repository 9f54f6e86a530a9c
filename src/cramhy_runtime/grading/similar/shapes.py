"""A program as shapes: fingerprints of its lists that do not change when names are changed or definitions are moved.

In a shape, a name that the program defines or binds (a function, a variable, an argument) is a place: 1 for the first one in the form,
2 for the second. Names of the language and of the course stay, because they are what a program does. Numbers, strings and characters are
marks of their kinds. The arguments of ``+`` and of other operators whose order means nothing are sorted, as are the clauses of ``par``.
Source of the idea: fingerprinting by trees, as in Baxter et al., "Clone Detection Using Abstract Syntax Trees" (1998).
"""

from __future__ import annotations

import hashlib
import re
from typing import NamedTuple

from ..forms import Group, Text, forms_of, words_of

LEAST = 6
"""Words that a list must have to be compared: all short ones are alike."""
_NUMBER = re.compile(r"[-+]?\.?\d[\d./eds+-]*$")
_DEFINES = re.compile(
    r"def|let$|let\*$|flet|labels|lambda|fn$|do(list|times)?$|for$|setv|destructuring|with-fields|multiple-value-bind|arg|name"
)
_UNORDERED = {"+", "*", "and", "or", "par", "pursue", "try-all", "max", "min", "=", "eql", "equal"}
_QUOTING = {"declare", "in-package", "require", "export", "import"}


class Shape(NamedTuple):
    """A fingerprint, how many words it is made of, the line where it begins, and the first words of the list."""

    mark: str
    size: int
    line: int
    head: str


def shapes_of(text, name):
    """The shapes of a program, a dictionary from marks to `Shape`; of several alike the first. name: of the file."""
    top = forms_of(text, name)
    own = _own_names(top)
    found = {}
    for form in top:
        _visit(form, own, found)
    return found


def _own_names(form, own=None):
    """The names that a program defines or binds anywhere."""
    own = set() if own is None else own
    if isinstance(form, Group):
        if form and isinstance(form[0], str) and not isinstance(form[0], Text) and _DEFINES.match(form[0].rpartition(":")[2]):
            own.update(_bound(form[1:3]))
        for part in form:
            _own_names(part, own)
    return own


def _bound(parts):
    """The names in the first two places of a defining form: the name itself, arguments, variables of ``let``."""
    for place, part in enumerate(parts):
        if isinstance(part, Group):
            for each in part:
                if isinstance(each, Group):
                    yield from (word for word in list(each)[:1] if isinstance(word, str))
                elif not isinstance(each, Text):
                    yield each
        elif place == 0 and not isinstance(part, Text):
            yield part


def _visit(form, own, found):
    if not isinstance(form, Group) or (form and form[0] in _QUOTING):
        return
    size = sum(1 for _ in words_of(form))
    if size >= LEAST:
        mark = hashlib.sha256(_shape(form, own, {}).encode()).hexdigest()[:16]
        head = " ".join(word for word in list(form)[:2] if isinstance(word, str))
        found.setdefault(mark, Shape(mark, size, form.line, f"({head} ...)"))
    for part in form:
        _visit(part, own, found)


def _shape(form, own, places):
    if isinstance(form, Text):
        return "text"
    if not isinstance(form, Group):
        word = form.rpartition(":")[2] or form
        if word.startswith("&"):
            return word
        if word in own or form in own or (word.startswith("?") and len(word) > 1):
            return f"#{places.setdefault(word, len(places) + 1)}"
        return "number" if _NUMBER.match(word) else word
    if form and form[0] in _UNORDERED:
        # sorted by what they look like without places, so that the same arguments get the same places in any order
        rest = sorted(form[1:], key=lambda part: _shape(part, own, _Everywhere()))
        return f"({form[0]} {' '.join(_shape(part, own, places) for part in rest)})"
    parts = form[:]
    if len(parts) > 3 and parts[0] in ("defun", "defn") and isinstance(parts[3], Text):
        del parts[3]  # documentation is words
    return f"({' '.join(_shape(part, own, places) for part in parts)})"


class _Everywhere(dict):
    """Places that are all one."""

    def setdefault(self, word, place):
        return 0
