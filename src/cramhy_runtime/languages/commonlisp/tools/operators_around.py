"""Which operators a place in Lisp text stands inside of, and which names come before it, found in the text itself.

``(def-fact-group animals (legs))`` in a package that has no such macro is a call of a function. Its arguments are evaluated before
anybody looks for the function, so all that is signalled is that ``animals`` is unbound. Where that happened the text tells the rest.
"""

from __future__ import annotations

import re

from cramhy_runtime.kernel.late_patterns import late_pattern
from cramhy_runtime.lisp_core.data import Symbol, UndefinedFunction
from cramhy_runtime.lisp_core.packages import COMMON_LISP, find_package
from ..printer.print_controls import PACKAGE

TOKEN = late_pattern(r'"(?:\\.|[^"\\])*"|;[^\n]*|#\|.*?\|#|#\\.[\w-]*|\(|\)|[^\s()"]+', re.S)
_FORMS_INSIDE = frozenset(
    """PROGN PROG1 IF WHEN UNLESS AND OR NOT SETF SETQ LET LET* RETURN DEFVAR DEFPARAMETER TOP-LEVEL SEQ PAR PURSUE
    TRY-ALL PERFORM DEF-FACT-GROUP""".split()
)
"""Operators that are no functions, but evaluate what stands in them, the lists of lists of ``let`` apart."""


def operators_around(position):
    """The first tokens of the lists that ``position`` (file, line, column) stands in, the outermost first; "" where a list begins one."""
    stack, opened = [], False
    for token in _tokens_before(position):
        if token == "(":
            if opened:
                stack[-1] = ""
            stack.append("")
        elif token == ")":
            del stack[-1:]
        elif opened:
            stack[-1] = token
        opened = token == "("
    return stack


def names_before(position):
    """The names, in capital letters, that the top-level form around ``position`` (file, line, column) has before that place."""
    names, depth = set(), 0
    for token in _tokens_before(position):
        if token in ("(", ")"):
            depth += 1 if token == "(" else -1
            if depth <= 0:
                names.clear()
        elif token[0] not in '";#':
            names.add(token.lstrip("'`,@").upper())
    return names


def token_at(position, offset=0):
    """The token ``offset`` characters behind ``position`` in its line, or ``""``."""
    filename, line, column = (*position, None)[:3]
    import linecache

    match = TOKEN.match(linecache.getline(filename, line), (column or 1) - 1 + offset)
    return match[0] if match else ""


def _tokens_before(position):
    filename, line, column = (*position, None)[:3]
    import linecache  # it imports the tokenizer

    return TOKEN.findall("".join(linecache.getlines(filename)[: line - 1]) + linecache.getline(filename, line)[: (column or 1) - 1])


def undefined_operator(position):
    """The symbol of the outermost operator around ``position`` that nobody has defined, so that it is taken for a function; or ``None``."""
    if not position:
        return None
    for token in operators_around(position):
        prefix, _, name = token.upper().rpartition(":")
        package = find_package(prefix.rstrip(":")) if prefix else PACKAGE.value
        symbol = package.lookup(name)[0] if package is not None else None
        if not isinstance(symbol, Symbol):
            return None
        undefined = symbol.macro is None and isinstance(symbol.function, UndefinedFunction)
        if undefined and symbol.package is not COMMON_LISP:
            return symbol
        if (undefined or symbol.macro is not None) and name not in _FORMS_INSIDE:
            return None
    return None
