"""Packages beyond ANSI that programs name: SB-EXT and SB-MOP of SBCL, and ALEXANDRIA, which nearly every system depends on.

Only what plan code uses is here. CRAM's packages import ``curry``, ``rcurry`` and ``compose`` from ALEXANDRIA (prolog.md 1,
designators.md 1). Source: the manuals of SBCL and of alexandria.
"""

from __future__ import annotations

import math
from fractions import Fraction

from . import hash_tables, protocol, random_state
from .arithmetic import single
from .data import Cons, DoubleFloat, list_from, one, python_list
from .faces import define_face
from .functions import function_of
from .packages import KEYWORD, string_designator, sym

INFINITIES = {f"{kind}-float-{sign}-infinity": value
              for sign, infinity in (("positive", math.inf), ("negative", -math.inf))
              for kind, value in (("short", infinity), ("single", infinity), ("double", DoubleFloat(infinity)),
                                  ("long", DoubleFloat(infinity)))}
"""Constants of SB-EXT: what the printer writes for numbers without end must be read back."""


def curry(function, *arguments):
    """``alexandria:curry``: ``function`` with its first ``arguments`` given."""
    function = function_of(function)
    return lambda *more: function(*arguments, *more)


def rcurry(function, *arguments):
    """``alexandria:rcurry``: ``function`` with its last ``arguments`` given."""
    function = function_of(function)
    return lambda *more: function(*more, *arguments)


def compose(function, *more_functions):
    """``alexandria:compose``: the last function takes the arguments, each other one the primary value of the one after it."""
    *outer, innermost = map(function_of, (function, *more_functions))

    def composed(*arguments):
        value = innermost(*arguments)
        for outer_function in reversed(outer):
            value = outer_function(one(value))
        return value

    return composed


def ensure_list(thing):
    """``alexandria:ensure-list``: ``thing`` if it is a list, else the list of it."""
    return thing if thing is None or isinstance(thing, Cons) else Cons(thing)


def flatten(tree):
    """``alexandria:flatten``: the atoms of ``tree`` but ``nil``, as one list."""
    found, stack = [], [tree]
    while stack:
        item = stack.pop()
        while isinstance(item, Cons):
            stack.append(item.cdr)
            item = item.car
        if item is not None:
            found.append(item)
    return list_from(found)


def iota(n, *, start=0, step=1):
    """``alexandria:iota``: ``n`` numbers from ``start`` on, ``step`` apart."""
    return list_from([_sum(start, index, step) for index in range(n)])


def _sum(start, index, step):
    value = start + index * step
    if isinstance(value, float) and value.__class__ is float:
        return single(value)
    return int(value) if isinstance(value, Fraction) and value.denominator == 1 else value


def mappend(function, first, *more):
    """``alexandria:mappend``: the results of ``mapcar``, which are lists, appended."""
    function = function_of(function)
    parts = [one(function(*elements)) for elements in zip(*(python_list(lst) for lst in (first, *more)), strict=False)]
    return list_from([element for part in parts for element in part or ()])


def make_keyword(name):
    """``alexandria:make-keyword``: the keyword with that name, a string, symbol or character."""
    return KEYWORD.intern(string_designator(name))


def define_faces():
    """Declare the packages; called once, by `package.fill`."""
    define_face("SB-EXT", functions={hash_tables: hash_tables.EXTENSION_NAMES, random_state: random_state.EXTENSION_NAMES},
                variables=INFINITIES)
    for name in INFINITIES:
        sym(f"SB-EXT::{name.upper()}").constant = True
    define_face("SB-MOP", functions={protocol: protocol.MOP_NAMES})
    define_face("ALEXANDRIA", functions={
        hash_tables: hash_tables.ALEXANDRIA_NAMES, "curry": curry, "rcurry": rcurry, "compose": compose, "ensure-list": ensure_list,
        "flatten": flatten, "iota": iota, "mappend": mappend, "make-keyword": make_keyword})
