"""Short lists of data, which every layout puts on one line: their text is made at once, without the pretty printer.

Nearly all lists that programs print are such: a few numbers, strings, symbols, and lists of these. A list that looks like a form, is
long, may not fit, or is to be cut, marked or printed by somebody's own function goes the usual way.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import Cons, Keyword, Symbol, UndefinedFunction
from cramhy_runtime.lisp_core.packages import COMMON_LISP
from cramhy_runtime.lisp_core.printing import LEVELS_COUNT
from .pprint_dispatch import PRINT_PPRINT_DISPATCH
from .pretty_stream import DEFAULT_LINE_LENGTH
from .print_controls import PRINT_LENGTH, PRINT_LEVEL, PRINT_PRETTY, PRINT_READABLY, PRINT_RIGHT_MARGIN

_SPARE = 10  # columns at the end of a line, where the layout decides
_PARTS, _DEPTH = 120, 8


def flat_text(lst, stream, escape, text_of_atom):
    """The text of the list ``lst`` for ``stream``, or ``None``. text_of_atom: class → function (object, whether escaped), or ``None``."""
    if (
        PRINT_LENGTH.value is not None
        or PRINT_LEVEL.value is not None
        or PRINT_READABLY.value is not None
        or LEVELS_COUNT.value is not None
    ):
        return None
    pretty = PRINT_PRETTY.value is not None
    if pretty and stream.is_pretty:
        return None
    parts: list[str] = []
    if not _collect(lst, escape, parts, pretty, _DEPTH, text_of_atom):
        return None
    text = "".join(parts)
    if pretty:
        width = PRINT_RIGHT_MARGIN.value or stream.line_length or DEFAULT_LINE_LENGTH
        if "\n" in text or stream.column + len(text) > width - _SPARE:
            return None
    return text


def _collect(lst, escape, parts, pretty, depth, text_of_atom):
    """Put the text of ``lst`` into ``parts``; whether it is such a list."""
    if pretty and _is_form(lst.car) or not depth:
        return False
    parts.append("(")
    while True:
        item = lst.car
        if item.__class__ is Cons:
            if not _collect(item, escape, parts, pretty, depth - 1, text_of_atom):
                return False
        else:
            text_of = text_of_atom(item.__class__)
            if text_of is None:
                return False
            parts.append(text_of(item, escape))
        lst = lst.cdr
        if lst is None:
            parts.append(")")
            return True
        if lst.__class__ is not Cons or len(parts) > _PARTS:
            return False
        parts.append(" ")


def _is_form(head):
    """Whether a list that begins with ``head`` may be a form, which has a layout of its own."""
    if not isinstance(head, Symbol) or isinstance(head, Keyword):
        return False
    if head.package is COMMON_LISP or head.macro is not None or head.function.__class__ is not UndefinedFunction:
        return True
    return head.name == "QUASIQUOTE" or head in PRINT_PPRINT_DISPATCH.value.operators


__all__ = ["flat_text"]
