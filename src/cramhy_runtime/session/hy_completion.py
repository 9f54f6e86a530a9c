"""What the Tab key offers in Hy, at a prompt and in a notebook.

It is what Hy's own `hy.completer.Completer` offers, and besides:

* Hy's own macros: ``lfor``, ``defn``,
* packages, and after a prefix the names in them: ``cp`` becomes ``cpl:``, ``cpl:pa`` ``cpl:par``,
* keywords of the operator or function that is called: ``(make-fluent :na``,
* where symbols of Lisp stand, those of the module's package: after a quote, ``'turtlesim-na``, and in designators and facts.

Hy's completer makes all candidates anew for each one that is asked for. With the thousands of names of our packages that takes half a
minute for one key. So they are made once for each key here.
"""

from __future__ import annotations

import builtins
import inspect
import re

import hy
from hy.completer import Completer

from cramhy_runtime.languages.hy.brackets import open_brackets
from cramhy_runtime.languages.hy.lisp_data import package_of
from cramhy_runtime.languages.operators import DESIGNATORS, PROLOG

from .completion import Keywords, completions, keywords_at_hand, keywords_of_symbol

_WITH_SYMBOLS = {operator.name for table in (DESIGNATORS, PROLOG) for operator in table.values()}
"""Operators in whose calls words are symbols of Lisp."""


def completions_in_hy(text, word, module):
    """The names, sorted, that ``word``, the last one of ``text``, may become in a Python module of Hy."""
    if word.startswith(":"):
        keywords = keywords_at_hand(text, lambda name: _keywords_of(name, module)) or ()
        return [f":{name.lower()}" for name in sorted(keywords) if name.startswith(word[1:].upper())]
    quoted = text[: len(text) - len(word)].endswith("'")
    found = set() if quoted else _hy_names(word, module)
    if word and (quoted or _among_symbols(text)):
        found |= _symbols(word, module)
    return sorted(found)


def _hy_names(word, module):
    names = Completer(vars(module))
    if "." in word:
        return set(names.attr_matches(word))
    found = {*names.global_matches(word), *(name for name in map(hy.unmangle, builtins._hy_macros) if name.startswith(word))}
    if ":" not in word:
        return {re.sub(r"^(.+?):.*", r"\1:", name) for name in found}
    return found if "::" in word else {name for name in found if "::" not in name}


def _symbols(word, module):
    package = package_of(module.__name__)
    if ":" in word:
        return {name for name, _ in completions(word, package)[0]}
    return {name.lower() for name in {**package.internal, **package.external} if name.startswith(word.upper())}


def _among_symbols(text):
    return any(_WITH_SYMBOLS & {name.upper().rpartition(":")[2]} for name in _heads(text))


def _keywords_of(name, module):
    mangled = hy.mangle(name)
    macro = module._hy_macros.get(mangled) if mangled not in vars(module) else None
    if macro is not None:
        operator, symbol = getattr(macro, "operator", None), getattr(macro, "symbol", None)
        if operator is not None:
            return Keywords(operator.options, of_operator=True)
        return _parameters(macro) if symbol is None else keywords_of_symbol(symbol)
    first, *others = name.split(".")
    value = vars(module).get(hy.mangle(first), getattr(builtins, hy.mangle(first), None))
    for attribute in others:
        value = getattr(value, hy.mangle(attribute), None)
    return _parameters(value) if callable(value) else None


def _heads(text):
    """The names behind the open parentheses of ``text``."""
    lines = text.split("\n")
    for bracket, line, column in open_brackets(text):
        head = re.match(r"[^\s()\[\]{}]+", lines[line - 1][column:]) if bracket == "(" else None
        if head:
            yield head[0]


def _parameters(function):
    """The `Keywords` of a function of Python's or Hy's: the names, as Lisp's, of its parameters that may be given so."""
    try:
        parameters = inspect.signature(function).parameters.values()
    except (TypeError, ValueError):
        return None
    given = [each for each in parameters if each.kind in (each.POSITIONAL_OR_KEYWORD, each.KEYWORD_ONLY)]
    return Keywords([hy.unmangle(each.name).upper() for each in given if not each.name.startswith("_")])


__all__ = ["completions_in_hy"]
