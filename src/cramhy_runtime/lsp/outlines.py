"""Outlines of a text: its definitions, what can be folded, and the kinds of its words."""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import UNBOUND, Symbol, UndefinedFunction
from cramhy_runtime.languages.commonlisp.evaluation.forms import SPECIAL_OPERATORS
from cramhy_runtime.languages.operators import operator_of
from cramhy_runtime.session.arglists import symbol_named

from .texts import is_number

KINDS = ["comment", "string", "number", "keyword", "macro", "function", "variable", "property", "type"]
"""The kinds of words, as the client is told them."""


def definitions(text):
    """[(operator, name, start, end, start of the name, end of the name)] of the top-level forms that define something."""
    found = []
    for form in text.forms:
        operator = form.word(0)
        if not operator.lower().rpartition(":")[2].startswith(("def", "declare-goal")) or len(form.items) < 2:
            continue
        item = form.items[1]
        name = form.word(1) or text.text[item.start : item.end]
        found.append((operator.lower(), name, form.start, form.end, item.start, item.end))
    return found


def folds(text):
    """[(first line, last line, whether it is a comment)] of lists and comments with several lines."""
    found, waiting, lines = [], list(text.forms), set()
    while waiting:
        form = waiting.pop(0)
        first, last = text.place(form.start)[0], text.place(form.end - 1)[0]
        if last > first:
            if first not in lines:
                lines.add(first)
                found.append((first, last, False))
            waiting += [item for item in form.items if hasattr(item, "items")]
    return sorted(found + _comments(text))


def _comments(text):
    found, first, last = [], None, None
    for token in text.tokens:
        if token.kind != "comment":
            continue
        begin, end = text.place(token.start)[0], text.place(token.end)[0]
        if last is not None and begin == last + 1:
            last = end
        else:
            if first is not None and last > first:
                found.append((first, last, True))
            first, last = begin, end
    if first is not None and last > first:
        found.append((first, last, True))
    return found


def kinds(text, package_at):
    """[(line, column, length, number of the kind)] of the tokens that have a kind. package_at: a function of an offset; ``None`` for Hy."""
    found, known = [], {}
    for token in text.tokens:
        kind = _kind(token, package_at, known)
        if kind is None:
            continue
        start = token.start
        for part in token.text.split("\n"):
            if part:
                line, column = text.place(start)
                found.append((line, column, len(part.encode("utf-16-le", "surrogatepass")) // 2, KINDS.index(kind)))
            start += len(part) + 1
    return found


def _kind(token, package_at, known):
    if token.kind in ("comment", "string"):
        return token.kind
    if token.kind == "character":
        return "string"
    if token.kind != "word":
        return None
    if token.text.startswith((":", "&")):
        return "property"
    if is_number(token.text):
        return "number"
    package = package_at(token.start)
    if package is None:
        return None
    key = token.text, package.name
    if key not in known:
        known[key] = _kind_of(symbol_named(token.text, package))
    return known[key]


def _kind_of(symbol):
    if not isinstance(symbol, Symbol):
        return None
    if symbol in SPECIAL_OPERATORS or operator_of(symbol) is not None:
        return "keyword"
    if symbol.macro is not None:
        return "macro"
    if symbol.function is not None and not isinstance(symbol.function, UndefinedFunction):
        return "function"
    return "variable" if symbol.value is not UNBOUND else None
