"""What the keys of a notebook ask for: Tab completes, Shift-Tab inspects."""

from __future__ import annotations

import re

from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.languages.commonlisp.evaluation import evaluator
from cramhy_runtime.languages.commonlisp.printer.print_controls import PACKAGE
from cramhy_runtime.languages.commonlisp.tools.describing import description
from cramhy_runtime.languages.hy.brackets import open_brackets
from cramhy_runtime.session.arglists import arglist, call_text, symbol_named
from cramhy_runtime.session.completion import completions
from cramhy_runtime.session.hy_completion import completions_in_hy

from .cells import HY

MOST = 200
"""Completions that are sent."""
_WORD = re.compile(r"""[^\s()\[\]{}'"`,;]""")
_WORD_BEFORE = re.compile(r"""[^\s()\[\]{}'"`,;]*$""")
_HEAD = re.compile(r"""\(\s*([^\s()\[\]{}'"`,;]+)""")


def completed(notebook, text, cursor):
    """(names, what is known of each, where the word begins) for the word before ``cursor``, a number of characters of the cell ``text``."""
    language, rest = notebook.language_of(text)
    before = text[:cursor]
    if language == HY:
        return _completed_in_hy(notebook, before)
    found, length = completions(before if rest == text else rest[: max(0, cursor - len(text) + len(rest))], notebook.package)
    return [name for name, _ in found[:MOST]], [known for _, known in found[:MOST]], cursor - length


def _completed_in_hy(notebook, before):
    word = _WORD_BEFORE.search(before)[0]
    found = completions_in_hy(before, word, notebook.hy_module())[:MOST] if word else []
    return found, [""] * len(found), len(before) - len(word)


def inspected(notebook, text, cursor):
    """What is known of the name at ``cursor`` in the cell ``text``, or else of the call around it; ``None`` if nothing is."""
    package = notebook.package
    for name in (_word_at(text, cursor), _call_around(text[:cursor])):
        symbol = symbol_named(name.lstrip("#'"), package) if name else None
        if symbol is not None and (told := _described(symbol, package)):
            return told
    return None


def _word_at(text, cursor):
    start = end = min(cursor, len(text))
    while start and _WORD.match(text[start - 1]):
        start -= 1
    while end < len(text) and _WORD.match(text[end]):
        end += 1
    return text[start:end]


def _call_around(before):
    opened = open_brackets(before)
    if not opened:
        return ""
    _, line, column = opened[-1]
    lines = before.split("\n")
    head = _HEAD.match("\n".join([lines[line - 1][column - 1 :], *lines[line:]]))
    return head[1] if head else ""


def _described(symbol, package):
    with binding(evaluator.PACKAGE, package, PACKAGE, package):
        items = arglist(symbol)
        told = description(symbol).strip()
    call = "" if items is None else call_text(symbol.name.lower(), items) + "\n\n"
    return call + told
