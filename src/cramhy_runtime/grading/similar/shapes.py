"""A program as shapes: fingerprints of its lists that do not change when names are changed or definitions are moved.

In a shape, a name that the program defines or binds (a function, a variable, an argument) is a place: 1 for the first one in the form,
2 for the second. Names of the language and of the course stay, because they are what a program does. Numbers, strings and characters are
marks of their kinds. Words that mean nearly the same, such as ``first`` and ``car``, are one. The arguments of ``+`` and of other operators
whose order means nothing are sorted, as are the clauses of ``par``.
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
_FUNCTIONS = {"defun", "defn", "defmacro", "defmethod", "defgeneric", "def-process-module", "def-cram-function", "functiondef", "classdef"}
_NAMES_FIRST = {"defvar", "defparameter", "defconstant", "setv", "assign", "annassign", "def-fact-group", "define-condition", "defstruct"}
_LAMBDAS = {"lambda", "fn", "arguments"}
_LETS = {"let", "let*", "prog", "prog*", "do", "do*"}
_LOCAL_FUNCTIONS = {"flet", "labels", "macrolet"}
_ONE_VARIABLE = {"dolist", "dotimes", "for", "lazy-dolist"}
_SEVERAL_VARIABLES = {"with-fields", "multiple-value-bind", "destructuring-bind", "with-desig-props", "with-slots"}
_UNORDERED = {"+", "*", "and", "or", "par", "pursue", "try-all", "max", "min", "=", "eql", "equal"}
_SYNONYMS = {
    **{"first": "car", "second": "cadr", "third": "caddr", "fourth": "cadddr", "rest": "cdr"},
    **{"null": "not", "endp": "not", "let*": "let", "setq": "setf", "prog": "let", "do*": "do", "eql": "equal", "eq": "equal"},
}
"""Words that somebody puts for others to hide a copy, and that mean nearly the same."""
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
    shaper, found = _Shaper(_own_names(top)), {}
    for form in top:
        _visit(form, shaper, found)
    return found


def _own_names(form, own=None):
    """The names that a program defines or binds anywhere."""
    own = set() if own is None else own
    if isinstance(form, Group):
        if form and isinstance(form[0], str):
            own.update(_bound(form[0].rpartition(":")[2], list(form[1:])))
        for part in form:
            _own_names(part, own)
    return own


def _bound(head, parts):
    """The names that a form defines or binds."""
    first = parts[0] if parts else ""
    if head in _FUNCTIONS or head in _NAMES_FIRST:
        yield from _words([first])
        if head in _FUNCTIONS and len(parts) > 1 and isinstance(parts[1], Group):
            yield from _variables(parts[1])
    elif head in _LAMBDAS:
        yield from _variables(first if isinstance(first, Group) else parts)
    elif head in _LETS and isinstance(first, Group):
        yield from _variables(first)
    elif head in _LOCAL_FUNCTIONS and isinstance(first, Group):
        for entry in first:
            if isinstance(entry, Group):
                yield from _bound("defun", list(entry))
    elif head in _ONE_VARIABLE:
        yield from _words(first[:1] if isinstance(first, Group) else [first])
    elif head in _SEVERAL_VARIABLES and isinstance(first, Group):
        yield from words_of(first)
    elif head == "loop":
        for before, word in zip(parts, parts[1:]):
            if before in ("for", "as", "with"):
                yield from words_of(word)


def _variables(group):
    """The names in a lambda list, or of the bindings of ``let``."""
    for part in group:
        yield from _words(part[:1] if isinstance(part, Group) else [part])


def _words(parts):
    return [part.rpartition(":")[2] for part in parts if not isinstance(part, (Group, Text)) and not part.startswith("&")]


def _visit(form, shaper, found):
    if not isinstance(form, Group) or (form and isinstance(form[0], str) and form[0] in _QUOTING):
        return
    size = sum(1 for _ in words_of(form))
    if size >= LEAST:
        mark = hashlib.sha256(shaper.shape(form, {}).encode(errors="backslashreplace")).hexdigest()[:16]
        head = " ".join(word for word in list(form)[:2] if isinstance(word, str))
        found.setdefault(mark, Shape(mark, size, form.line, f"({head} ...)"))
    for part in form:
        _visit(part, shaper, found)


class _Shaper:
    """Makes shapes of the forms of one program. own: the names that it defines or binds.

    The arguments of an operator without order are sorted by what they look like without new places, so that the same arguments get the same
    places in any order. Each form is looked at once for that: else the work would double with each level of such operators.
    """

    def __init__(self, own):
        self.own = own
        self.without_places = _Known({})

    def shape(self, form, places):
        """The shape of a form as text. places: of the names so far, by name; new ones are added."""
        known = getattr(places, "shapes", None)
        if known is not None and id(form) in known:
            return known[id(form)]
        found = self._shape(form, places)
        if known is not None and isinstance(form, Group):
            known[id(form)] = found
        return found

    def _shape(self, form, places):
        if isinstance(form, Text):
            return "text"
        if not isinstance(form, Group):
            return self._word(form, places)
        if form and isinstance(form[0], str) and form[0] in _UNORDERED:
            settled = places if isinstance(places, _Known) else _Known(places)
            rest = sorted(form[1:], key=lambda part: (self.shape(part, self.without_places), self.shape(part, settled)))
            return f"({form[0]} {' '.join([self.shape(part, places) for part in rest])})"
        parts = form[:]
        if len(parts) > 3 and isinstance(parts[0], str) and parts[0] in ("defun", "defn") and isinstance(parts[3], Text):
            del parts[3]  # documentation is words
        return f"({' '.join([self.shape(part, places) for part in parts])})"

    def _word(self, form, places):
        word = form.rpartition(":")[2] or form
        if word.startswith("&"):
            return word
        if word in self.own or form in self.own or (word.startswith("?") and len(word) > 1):
            return f"#{places.setdefault(word, len(places) + 1)}"
        return "number" if _NUMBER.match(word) else _SYNONYMS.get(word, word)


class _Known(dict):
    """Places that are known already; all others are one. ``shapes``: of the forms that were looked at with these places, by identity."""

    def __init__(self, places):
        super().__init__(places)
        self.shapes = {}

    def setdefault(self, word, place):
        return self.get(word, 0)
