"""Control strings that are only text with places for arguments: ``"~a is at ~d.~%"``.

Most are. With atoms for arguments (strings, numbers, symbols, characters) their output depends on nothing but the arguments, so
Python's own formatting can make it from a template. A list or an object may be broken into lines, or have a print function that
looks at its stream: then, and for all other directives, ``format`` walks over the control (``format.py``). The compiler uses the
templates of constant controls in place.
"""

from __future__ import annotations

import re

from cramhy_runtime.lisp_core.data import Keyword
from ..printer.print_controls import PRINT_CASE, PRINT_CIRCLE, PRINT_BASE, PRINT_RADIX, PRINT_READABLY, UPCASE
from ..printer.print_names import symbol_text
from ..printer.printer import PRINT_PPRINT_DISPATCH, atom_text
from ..reader.readtables import READTABLE
from .format_pieces import Piece, piece
from .format_parser import FormatError, parse

SMALL = 10**18
_LEAST = -SMALL
_keywords: dict = {}
_templates: dict = {}


def template(control):
    """(text with ``%s`` for each argument, what makes the texts, whether it begins a line) of a control string; ``None`` when it is not
    so simple. What makes a text: the character of a directive in `TEXTS`, or a `Piece`.
    """
    if control in _templates:
        return _templates[control]
    try:
        nodes = parse(control)
    except FormatError:
        return None
    text, kinds, found, fresh = [], [], None, False
    for index, node in enumerate(nodes):
        if node.__class__ is str:
            text.append(node.replace("%", "%%"))
            continue
        if node.params or node.colon or node.at or node.char not in ("A", "S", "D", "%", "~"):
            if node.char == "&" and not (index or node.params or node.colon or node.at):
                fresh = True
                continue
            text_of = piece(node, TEXTS)
            if text_of is None:
                break
            text.append("%s")
            kinds.append(Piece(control, index, text_of))
            continue
        if node.char == "%":
            text.append("\n")
        elif node.char == "~":
            text.append("~")
        else:
            text.append("%s")
            kinds.append(node.char)
    else:
        found = "".join(text), tuple(kinds), fresh
    if len(_templates) > 5000:
        _templates.clear()
    _templates[control] = found
    return found


def piece_of(control, index):
    """The `Piece` of directive number ``index`` of ``control``, as compiled code that was kept asks for it."""
    return Piece(control, index, piece(parse(control)[index], TEXTS))


def with_known(text, known):
    """The text of a template with the arguments put in that are ``known`` (``None``: not known, its ``%s`` stays)."""
    rest = iter(known)
    return re.sub("%%|%s", lambda match: _escaped(next(rest)) if match[0] == "%s" else "%%", text)


def _escaped(text):
    return "%s" if text is None else text.replace("%", "%%")


def princ_atom(obj):
    """What ``~A`` makes of an atom; ``None`` for other objects."""
    if obj.__class__ is str:
        return obj
    if isinstance(obj, str):
        return str(obj)
    return _atom(obj, False)


def prin1_atom(obj):
    """What ``~S`` makes of an atom; ``None`` for other objects."""
    if obj.__class__ is Keyword and PRINT_CASE.value is UPCASE and PRINT_BASE.value == 10 and READTABLE.value.case is UPCASE:
        text = _keywords.get(obj)
        if text is None:
            text = _keywords[obj] = symbol_text(obj)
        return text
    return _atom(obj, True)


def decimal(obj):
    """What ``~D`` makes of an integer; ``None`` for other objects."""
    if obj.__class__ is int and _LEAST < obj < SMALL:
        return str(obj)
    return None


def _atom(obj, escape):
    if obj.__class__ is int and PRINT_BASE.value == 10 and PRINT_RADIX.value is None and _LEAST < obj < SMALL:
        return str(obj)
    text_of = atom_text(obj.__class__)
    if text_of is not None and PRINT_CIRCLE.value is None and PRINT_READABLY.value is None and not PRINT_PPRINT_DISPATCH.value.entries:
        return text_of(obj, escape)
    return None


TEXTS = {"A": princ_atom, "S": prin1_atom, "D": decimal}


def filled(found, arguments):
    """The text of the template ``found`` with ``arguments``; ``None`` when one of them is no atom, or is missing."""
    text, kinds, _ = found
    if len(arguments) < len(kinds):
        return None
    parts = []
    for kind, argument in zip(kinds, arguments):  # noqa: B905  there may be more arguments
        part = TEXTS[kind](argument) if kind.__class__ is str else kind.text_of(argument)
        if part is None:
            return None
        parts.append(part)
    return text % tuple(parts)
