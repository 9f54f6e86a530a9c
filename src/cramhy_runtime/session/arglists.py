"""Arglists: how an operator or a function is called, and which argument the user is about to type."""

from __future__ import annotations

import re

from cramhy_runtime.cpl.forms.plans import plan_property
from cramhy_runtime.lisp_core.data import Cons, Keyword, Symbol, UndefinedFunction
from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.lisp_core.packages import find_package, is_symbol, symbol_name
from cramhy_runtime.languages.commonlisp.evaluation.forms import SPECIAL_OPERATORS
from cramhy_runtime.languages.commonlisp.evaluation.function_facts import lambda_list_of
from cramhy_runtime.languages.commonlisp.printer.print_controls import PACKAGE
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string
from cramhy_runtime.languages.operators import operator_of


def symbol_named(name, package):
    """The symbol that ``name`` means in ``package``; ``None`` if there is none. Nothing is interned."""
    prefix, colons, short = name.rpartition(":")
    if colons and not prefix.strip(":"):
        return None
    home = find_package(prefix.rstrip(":").upper()) if colons else package
    if home is None or not short:
        return None
    symbol, status = home.lookup(short.strip("|") if short.startswith("|") else short.upper())
    return symbol if status else None


def arglist(symbol):
    """How ``symbol`` is called, a list of texts: ``["DISTANCE", "&KEY", "(SPEED 1)"]``. ``None`` if nothing can be called by it."""
    operator = operator_of(symbol)
    if operator is not None:
        return _items(operator.shape)
    function = getattr(symbol, "macro", None) or getattr(symbol, "function", None)
    if function is None or isinstance(function, UndefinedFunction):
        shape = SPECIAL_OPERATORS_SHAPES.get(symbol_name(symbol)) if symbol in SPECIAL_OPERATORS else None
        return None if shape is None else shape.split()
    return _of_lambda_list(lambda_list_in_call(symbol, function))


def lambda_list_in_call(symbol, function):
    """The lambda list of ``function``, which ``symbol`` names. The function of a plan takes anything and hands it to the plan's task:
    then it is the plan's own list (cpl.md 8.1)."""
    found = lambda_list_of(function)
    handed_on = isinstance(found, Cons) and symbol_name(found.car) == "&REST" and plan_property(symbol, "PLAN-TYPE") is not None
    return plan_property(symbol, "PLAN-LAMBDA-LIST") if handed_on else found


SPECIAL_OPERATORS_SHAPES = {
    "IF": "TEST THEN &OPTIONAL ELSE",
    "LET": "BINDINGS &BODY BODY",
    "LET*": "BINDINGS &BODY BODY",
    "PROGN": "&REST FORMS",
    "QUOTE": "OBJECT",
    "FUNCTION": "NAME",
    "SETQ": "&REST PAIRS",
    "BLOCK": "NAME &REST FORMS",
    "RETURN-FROM": "NAME &OPTIONAL VALUE",
    "CATCH": "TAG &REST FORMS",
    "THROW": "TAG RESULT",
    "FLET": "DEFINITIONS &BODY BODY",
    "LABELS": "DEFINITIONS &BODY BODY",
    "MACROLET": "DEFINITIONS &BODY BODY",
    "SYMBOL-MACROLET": "BINDINGS &BODY BODY",
    "UNWIND-PROTECT": "PROTECTED &REST CLEANUP",
    "EVAL-WHEN": "SITUATIONS &BODY BODY",
    "THE": "TYPE FORM",
    "LOCALLY": "&BODY BODY",
    "TAGBODY": "&REST STATEMENTS",
    "GO": "TAG",
    "MULTIPLE-VALUE-CALL": "FUNCTION &REST FORMS",
    "MULTIPLE-VALUE-PROG1": "FIRST-FORM &REST FORMS",
    "PROGV": "SYMBOLS VALUES &BODY BODY",
    "LOAD-TIME-VALUE": "FORM &OPTIONAL READ-ONLY-P",
}
"""Special operators have no function that could tell it."""


def _of_lambda_list(lambda_list):
    items = []
    while isinstance(lambda_list, Cons):
        items.append(_text(lambda_list.car))
        lambda_list = lambda_list.cdr
    if lambda_list is not None:
        items += [".", _text(lambda_list)]
    return items


def _text(item):
    if isinstance(item, Keyword):
        return f":{item.name}"
    if isinstance(item, Symbol):
        return item.name
    if isinstance(item, Cons):
        return f"({' '.join(_of_lambda_list(item))})"
    with binding(PACKAGE, PACKAGE.value):
        return prin1_to_string(item)


def _items(shape):
    """The items behind the name of an operator's shape, ``(par forms...)``."""
    text = shape.strip()
    text = text[1:-1] if text.startswith("(") and text.endswith(")") else text
    found, depth, item = [], 0, ""
    for character in text:
        if character in "([{":
            depth += 1
        elif character in ")]}":
            depth -= 1
        if character.isspace() and depth == 0:
            found.append(item)
            item = ""
        else:
            item += character
    return [part for part in [*found, item] if part][1:]


def call_text(name, items, place=None, before="", after=""):
    """``(name item ...)`` with the item number ``place`` between ``before`` and ``after``."""
    shown = [f"{before}{item}{after}" if index == place else item for index, item in enumerate(items)]
    return f"({' '.join([name, *shown])})"


def place_of_argument(items, index, keyword=None):
    """Which of the ``items`` of an arglist the argument number ``index`` (from 0) belongs to; ``None`` if it is none of them.

    keyword: the name of the keyword before the argument or of the argument itself, such as ``"SPEED"``, or ``None``.
    """
    position, at = 0, 0
    while at < len(items):
        item = items[at]
        if item == "&OPTIONAL":
            at += 1
            continue
        if item in ("&REST", "&BODY"):
            return at + 1 if at + 1 < len(items) and not ("&KEY" in items and keyword) else _key(items, keyword)
        if item == "&KEY":
            return _key(items, keyword)
        if item in ("&ENVIRONMENT", "&WHOLE"):
            at += 2
            continue
        if item in ("&AUX", "&ALLOW-OTHER-KEYS"):
            return None
        if item.endswith("...") or item.startswith("&"):
            return at
        if position == index:
            return at
        position += 1
        at += 1
    return None


def _key(items, keyword):
    if keyword is None or "&KEY" not in items:
        return None
    start = items.index("&KEY") + 1
    for at in range(start, len(items)):
        if items[at].strip("(").split(" ")[0].strip("(:") == keyword.upper():
            return at
    return None


_TOKEN = re.compile(r'"(?:\\.|[^"\\])*(?:"|\Z)|;[^\n]*|#\|.*?(?:\|#|\Z)|#\\(?:[\w-]+|.)|\(|\)|\|[^|]*(?:\||\Z)|[^\s()";]+', re.S)


def call_being_typed(text, package):
    """(name, items of its arglist, number of the item that is being typed or ``None``) of the innermost call that is known and open at the
    end of ``text``; ``None`` if there is none. package: the one that ``text`` is read in."""
    calls = []  # the items of each list that is open: words, or None for what is not a word
    end = 0
    for match in _TOKEN.finditer(text):
        token, end = match[0], match.end()
        if token.startswith((";", "#|")):
            continue
        if token == ")":
            del calls[-1:]
        elif calls:
            calls[-1].append(None if token[0] in '("' else token)
        if token == "(":
            calls.append([])
    for depth, call in enumerate(reversed(calls)):
        if not call or call[0] is None or (depth == 0 and len(call) == 1 and end == len(text)):
            continue  # its name is not there, or is being typed
        symbol = symbol_named(call[0].lstrip("#'"), package)
        items = arglist(symbol) if symbol is not None and is_symbol(symbol) else None
        if items is None:
            continue
        words = call[1:]
        at_new_one = depth == 0 and (not words or end < len(text))
        keyword = next((word[1:] for word in (words[-1:] if at_new_one else words[-2:]) if word and word.startswith(":")), None)
        index = len(words) - (0 if at_new_one else 1)
        return call[0], items, place_of_argument(items, index, keyword)
    return None


def is_callable(symbol):
    """Whether ``symbol`` names a function, a macro or an operator."""
    return is_symbol(symbol) and arglist(symbol) is not None
