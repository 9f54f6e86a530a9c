"""Lisp text as lists of words, and what kind of name a word is: what `lisp_to_hy` reads and asks."""

from __future__ import annotations

import re

from cramhy_runtime.cpl import hooks
from cramhy_runtime.lisp_core.data import UndefinedFunction
from cramhy_runtime.lisp_core.packages import COMMON_LISP, find_package
from cramhy_runtime.languages.hy.plan_macros import WITHOUT_PREFIX

_TOKEN = re.compile(r"""\s+|;[^\n]*|(?P<token>\(|\)|'|`|,@|,|\#'|"(?:[^"\\]|\\.)*"|[^\s()'"`,;]+)""")


class NotConvertible(Exception):
    """There is no plain Hy for a form."""


class Marked:
    """``'x``, ``#'x``, ``,x``: mark and form."""

    def __init__(self, mark, form):
        self.mark, self.form = mark, form


class Literal(str):
    """A string with its quotes."""


def read(text):
    """The forms of a Lisp text: lists, words (`str`), `Literal` strings, and `Marked` forms."""
    tokens = [found["token"] for found in _TOKEN.finditer(text) if found["token"]]
    forms, place = [], 0
    while place < len(tokens):
        form, place = _form(tokens, place)
        forms.append(form)
    return forms


def _form(tokens, place):
    token = tokens[place]
    place += 1
    if token == "(":
        items = []
        while tokens[place] != ")":
            item, place = _form(tokens, place)
            items.append(item)
        return items, place + 1
    if token in ("'", "`", ",", ",@", "#'"):
        form, place = _form(tokens, place)
        return Marked(token, form), place
    return (Literal(token) if token[0] == '"' else token), place


def ours(name):
    """Whether a function of our packages has the name, with or without a prefix."""
    prefix, _, short = name.rpartition(":")
    packages = [prefix.rstrip(":").upper()] if prefix else WITHOUT_PREFIX
    for each in packages:
        package = find_package(each)
        symbol = package and package.external.get(short.upper())
        if symbol is not None and hasattr(symbol, "function") and not isinstance(symbol.function, UndefinedFunction):
            if symbol.package is not COMMON_LISP:
                return True
    return False


def implementation(name):
    """Whether a function has the name that only CRAM-LANGUAGE-IMPLEMENTATION exports."""
    return ours(f"cpl-impl::{name}") if ":" not in name else False


def is_special(name):
    """Whether a special variable of ours, or of Common Lisp, has the name."""
    if len(name) < 3 or not name[0] == name[-1] in "*+":
        return False
    symbols = (package.external.get(name.upper()) for package in (find_package("CRAM-LANGUAGE-IMPLEMENTATION"), COMMON_LISP))
    return any(symbol is not None and symbol.special for symbol in symbols)


def is_hook(name):
    """Whether a hook of the plan language has the name."""
    return name.startswith("on-") and hasattr(hooks, name.replace("-", "_"))


def is_declaration(form):
    return isinstance(form, list) and form[:1] == ["declare"]


def lisp_function(name):
    symbol = COMMON_LISP.external.get(name.upper())
    return symbol is not None and getattr(symbol, "macro", None) is None and not isinstance(symbol.function, UndefinedFunction)
