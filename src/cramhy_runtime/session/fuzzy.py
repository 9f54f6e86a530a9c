"""Fuzzy completion: names that contain the typed letters in order, the likeliest first.

``mvb`` finds ``multiple-value-bind``: its letters begin the parts of the name. A letter at the beginning of a part counts more than one
inside of it, and letters that follow one another count more than scattered ones.
"""

from __future__ import annotations

import re

from cramhy_runtime.kernel.typing_names import NamedTuple
from cramhy_runtime.lisp_core.data import UNBOUND, Symbol, UndefinedFunction
from cramhy_runtime.lisp_core.dispatch.generic_functions import GenericFunction
from cramhy_runtime.lisp_core.packages import KEYWORD, find_package, registered
from cramhy_runtime.languages.commonlisp.evaluation.forms import SPECIAL_OPERATORS
from cramhy_runtime.languages.commonlisp.objects.classes import registered_class

_BREAKS = "-/*+:."


class Match(NamedTuple):
    """name: with the prefix that was typed. score: a number, more is likelier. chunks: [[place, text], ...] of what was typed in the
    name. flags: ``"-f------"``, what the symbol is."""

    name: str
    score: float
    chunks: list
    flags: str


def _split(word, package):
    """(prefix with colons, rest of the word, {name: symbol} of what it may mean)."""
    prefix, colons, rest = word.rpartition(":")
    if not colons:
        names = {}
        for table in (package.internal, package.external, *(used.external for used in package.use)):
            for name, symbol in table.items():
                names.setdefault(name, symbol)
        return "", rest, names
    home = KEYWORD if not prefix.strip(":") else find_package(prefix.rstrip(":").upper())
    if home is None:
        return "", "", {}
    names = dict(home.external)
    if prefix.endswith(":"):
        names.update(home.internal)
    return prefix + colons, rest, names


def completions(word, package, most=300):
    """The `Match`es of ``word``, as typed, in ``package``; at most ``most``, the likeliest first."""
    prefix, rest, names = _split(word, package)
    if not rest and not prefix:
        return []
    letters = rest.upper()
    in_order = re.compile("".join(f"[^{each}]*{each}" for each in map(re.escape, letters)))  # no letter is passed over: one way only
    found = []
    for name in names:
        if in_order.match(name) is not None:
            chunks = _chunks(letters, name)
            found.append((-_score(chunks, rest, name), len(name), name, chunks))
    found.sort()
    return [
        Match(prefix + name, -score, [[place + len(prefix), text.lower()] for place, text in chunks], flags(names[name]))
        for score, _, name, chunks in found[:most]
    ]


def _chunks(letters, name):
    """Where the letters, which are in the name in this order, stand in it: [(place, text)], beginnings of parts before others."""
    if not letters:
        return []
    whole = name.find(letters)
    if whole >= 0:
        return [(whole, letters)]
    places = _places(letters, name, True) or _places(letters, name, False)
    chunks = []
    for place, letter in zip(places, letters, strict=True):
        if chunks and chunks[-1][0] + len(chunks[-1][1]) == place:
            chunks[-1] = (chunks[-1][0], chunks[-1][1] + letter)
        else:
            chunks.append((place, letter))
    return chunks


def _places(letters, name, at_parts):
    places, at = [], 0
    for letter in letters:
        found = name.find(letter, at)
        if at_parts:
            while found >= 0 and not (found == at and places or found == 0 or name[found - 1] in _BREAKS):
                found = name.find(letter, found + 1)
        if found < 0:
            return None
        places.append(found)
        at = found + 1
    return places


def _score(chunks, letters, name):
    """From 0 to 100: how much of the name was typed, and at which places."""
    if not chunks:
        return 0.0
    good = 0.0
    for place, text in chunks:
        begins = place == 0 or name[place - 1] in _BREAKS
        good += (10 if place == 0 else 8 if begins else 1) + len(text) * (1 + 0.3 * (len(text) - 1))
    best = 10 + len(letters) * (1 + 0.3 * (len(letters) - 1))
    return round(min(100.0, 80 * good / best / (1 + 0.2 * (len(chunks) - 1)) + 20 * len(letters) / len(name)), 2)


def flags(symbol):
    """What SLIME shows of a symbol: b bound, f function, g generic, c class, t type, m macro, s special operator, p package."""
    if not isinstance(symbol, Symbol):
        return "b-------"
    function = None if isinstance(symbol.function, UndefinedFunction) else symbol.function
    kinds = [
        ("b", symbol.value is not UNBOUND),
        ("f", function is not None),
        ("g", isinstance(function, GenericFunction)),
        ("c", registered_class(symbol) is not None),
        ("t", registered_class(symbol) is not None),
        ("m", symbol.macro is not None),
        ("s", symbol in SPECIAL_OPERATORS),
        ("p", registered(symbol.name) is not None),
    ]
    return "".join(letter if is_so else "-" for letter, is_so in kinds)


def by_parts(word, package):
    """The names whose parts begin with the parts of ``word``: ``m-v-b`` finds ``multiple-value-bind``."""
    prefix, rest, names = _split(word, package)
    if not rest:
        return []
    wanted = re.compile("-".join(f"{re.escape(part)}[^-]*" for part in rest.upper().split("-")))
    return [prefix + name for name in names if wanted.match(name)]
