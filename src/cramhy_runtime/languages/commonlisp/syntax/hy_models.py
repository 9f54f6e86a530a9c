"""Hy models as Lisp data: what the macros that are written in Hy return, and the atoms of plans in Hy.

A model stands in for the Lisp object of the same text; Lisp data among the models stays as it is. An unqualified symbol is that of Common
Lisp if there is one, else one of the macro file's package.
"""

from __future__ import annotations

from fractions import Fraction

from hy import models

from cramhy_runtime.lisp_core.data import Character, Cons, Keyword, Symbol, list_from
from cramhy_runtime.lisp_core.packages import keyword, sym
from .macro_symbols import symbol_in


def atom(model):
    """The Lisp object for a keyword, a string or a number of Hy; any other object as it is."""
    if isinstance(model, models.Keyword):
        return keyword(model.name.upper())
    if isinstance(model, models.String):
        return str(model)
    if isinstance(model, models.Integer):
        return int(model)
    if isinstance(model, models.Float):
        return float(model)
    return model


def from_hy(model, package, form=None):
    """Lisp data for a Hy model; forms inside it that are Lisp data already stay as they are.

    A Python list is a list of forms if the macro made it, and a literal vector if it stands in the ``form`` that is expanded.
    """
    kept = None

    def convert(model):
        nonlocal kept
        kind = model.__class__
        if kind in _LISTS:
            if kind is list:
                if kept is None:
                    kept = _vectors_in(form)
                if id(model) in kept:
                    return model
            items = [item if item.__class__ in _AS_THEY_ARE else convert(item) for item in model]
            if len(items) > 2 and items[-2] is _DOT:
                return list_from(items[:-2], items[-1])
            return list_from(items)
        if kind in _AS_THEY_ARE:
            return model
        if isinstance(model, models.Symbol):
            return symbol_in(str(model), package)
        if kind is bool:
            return model or None
        return atom(model)

    return convert(model)


def _vectors_in(form):
    """The identities of the vectors that stand in ``form``."""
    found, seen, rest = set(), set(), [form]
    while rest:
        item = rest.pop()
        while isinstance(item, Cons) and id(item) not in seen:
            seen.add(id(item))
            rest.append(item.car)
            item = item.cdr
        if type(item) is list:
            found.add(id(item))
    return found


_AS_THEY_ARE = frozenset((Cons, Symbol, Keyword, str, int, float, Fraction, Character, type(None)))
_LISTS = frozenset((models.Expression, models.List, models.Tuple, list, tuple))
_DOT = sym("CRAMHY::|.|")
