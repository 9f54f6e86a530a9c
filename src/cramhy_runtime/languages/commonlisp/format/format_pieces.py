"""Directives that take one argument and make a text of it, whatever stream it goes to: ``~5d``, ``~,2f``, ``~{~a~^, ~}``, ``~[a~;b~]``.

`piece` finds the function of such a directive: it gives the text for an argument, or ``None`` where ``format`` itself must look, as for
an object that has a print function or does not fit. Templates (``format_templates.py``) are made of these functions.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import FLOATS, Character, Cons
from .format_numbers import integer_field, write_fixed
from .format_parser import Directive

_LONG = 1000
"""A list of more elements is left to ``format``, which lets others have their turn and knows circular lists."""


class Piece:
    """The directive number ``index`` of ``control``. ``text_of(argument)`` gives its text, or ``None``."""

    __slots__ = ("control", "index", "text_of")

    def __init__(self, control, index, text_of):
        self.control, self.index, self.text_of = control, index, text_of


def piece(node, texts):
    """The function of the `Directive` ``node``, or ``None``. texts: those of ``~A``, ``~S`` and ``~D`` without parameters."""
    make = _MAKERS.get(node.char)
    values = [value for _, value in node.params]
    if make is None or any(value is not None and value.__class__ not in (int, str) for value in values):
        return None
    return make(node, values, texts)


def _padded(node, values, texts):
    if node.colon or len(values) != 1 or values[0].__class__ is not int or values[0] < 0:
        return None
    text_of, width, left = texts[node.char], values[0], node.at

    def padded(argument):
        text = text_of(argument)
        return None if text is None else text.rjust(width) if left else text.ljust(width)

    return padded


def _integer(node, values, texts):
    kinds = [int, str, str, int]
    if len(values) > 4 or any(value is not None and value.__class__ is not kind for value, kind in zip(values, kinds)):  # noqa: B905
        return None
    defaults = [0, " ", ",", 3]
    given = [default if value is None else value for value, default in zip(values, defaults)]  # noqa: B905
    given += defaults[len(given) :]
    if any(len(text) != 1 for text in given[1:3]) or given[3] < 1:
        return None
    commas, sign = node.colon, node.at
    return lambda argument: integer_field(argument, 10, commas, sign, *given) if argument.__class__ is int else None


class _Text:
    """What `write_fixed` writes to."""

    __slots__ = ("text",)

    def write(self, text):
        self.text = text


def _fixed(node, values, texts):
    if node.colon or len(values) > 2 or any(value.__class__ is str for value in values):
        return None
    width, digits = [*values, None, None][:2]
    sign = node.at

    def fixed(argument):
        if argument.__class__ not in FLOATS or argument - argument != 0:
            return None
        stream = _Text()
        write_fixed(stream, argument, width, digits, None, None, " ", sign)
        return stream.text

    return fixed


def _character(node, values, texts):
    if values or node.colon or node.at:
        return None
    return lambda argument: argument.char if argument.__class__ is Character else None


def _choice(node, values, texts):
    if values or node.at or any(len(clause) > 1 or clause and clause[0].__class__ is not str for clause in node.clauses):
        return None
    clauses = [clause[0] if clause else "" for clause in node.clauses]
    if node.colon:
        if len(clauses) != 2 or any(separator.colon for separator in node.separators):
            return None
        return lambda argument: clauses[0 if argument is None or argument is False else 1]
    default = clauses.pop() if node.separators and node.separators[-1].colon else ""
    count = len(clauses)

    def chosen(argument):
        if argument.__class__ is not int:
            return None
        return clauses[argument] if 0 <= argument < count else default

    return chosen


def _iteration(node, values, texts):
    if values or node.colon or node.at or node.close.colon or len(node.clauses) != 1:
        return None
    before, after, ends = [], [], False  # what stands before and behind ``~^``: texts, and functions of an element
    for item in node.clauses[0]:
        if item.__class__ is not str:
            if item.char == "^" and not (ends or item.params or item.colon or item.at):
                ends = True
                continue
            plain = not (item.params or item.colon or item.at) and texts.get(item.char)
            item = plain or piece(item, texts)
            if item is None:
                return None
        (after if ends else before).append(item)
    takes_before = sum(item.__class__ is not str for item in before)
    takes = takes_before + sum(item.__class__ is not str for item in after)
    if not takes_before:
        return None

    def iterated(argument):
        if argument is None:
            return ""
        if argument.__class__ is not Cons:
            return None
        items, cell = [], argument
        for _ in range(_LONG):
            if cell.__class__ is not Cons:
                break
            items.append(cell.car)
            cell = cell.cdr
        if cell is not None:
            return None
        left, parts = len(items), []
        rest = iter(items)
        while left:
            if left < takes_before or takes_before < left < takes:
                return None
            for part in before if left == takes_before and ends else (*before, *after):
                text = part if part.__class__ is str else part(next(rest))
                if text is None:
                    return None
                parts.append(text)
            left -= takes_before if left == takes_before and ends else takes
        return "".join(parts)

    return iterated


_MAKERS = {"A": _padded, "S": _padded, "D": _integer, "F": _fixed, "C": _character, "[": _choice, "{": _iteration}

__all__ = ["Directive", "Piece", "piece"]
