"""Passes: the optimisations of the compiler by name, and which of them are on.

The plain generator (``generator/``) knows none. An *opening* offers shorter code for a call, a test, a place or another node, and enters
itself here under the name of its pass. The generator asks the openings of a symbol in the order in which they were entered and makes
the plain code where none answers. An opening that declines returns ``None``; one that has delivered its result returns ``(result,)``.

``CRAMHY_PASSES`` switches passes: ``CRAMHY_PASSES=lists,slots`` has these alone, ``CRAMHY_PASSES=-lists`` all but these,
``CRAMHY_PASSES=none`` none. It is read once. Code that was compiled with other passes is not used (``languages/compiler_stamp.py``).
"""

from __future__ import annotations

import os

NAMES = frozenset(
    """arithmetic characters checks comparisons copies counting elements errors format generic-calls growth hash-tables
instances keywords kinds lists loops mapping next-methods number-functions places predicates searching several-values slots
standard-keywords vector-push versions""".split()
)
"""The passes, all of which are on by default."""
VARIABLE = "CRAMHY_PASSES"

CALLS: dict = {}
"""Symbol → openings (generator, node, destination) of calls whose value is wanted."""
EFFECTS: dict = {}
"""Symbol → the same for calls whose value nobody wants."""
CALL_TESTS: dict = {}
"""Symbol → openings (generator, node) that give a Python test, true when the value of the call is."""
SETTERS: dict = {}
"""Symbol → openings (generator, node, destination) of calls of ``(setf symbol)``."""
GENERAL_CALLS: list = []
"""Openings (generator, node, models) of a call of any symbol, whose arguments are evaluated: (expression, node that says what it gives)."""
GENERAL_SETTERS: list = []
"""Openings (generator, node, models, destination) of a call of any function ``(setf symbol)``."""
BINDINGS: list = []
"""Functions (generator, bindings, body) of a ``let``: the bindings that are left to make."""
VALUES: list = []
"""Openings (generator, names, node): an expression of exactly as many values of ``node`` as there are ``names``."""
FUNCTIONS: list = []
"""Openings (generator, node, name, given) of the definition of a function: the expression for it."""
ENTRIES: list = []
"""Functions (generator, node, returning) that emit what stands before the body of a function."""
ONE_VALUE: set = set()
"""Functions of several values whose calls give one value as a test."""
JUMPS: set = set()
"""Functions of which a call may continue in a clause of the ``handler-case`` around it."""
WRITTEN_OUT: set = set()
"""Functions of functions whose calls are written as loops (``open_coding.py``)."""
ON: set = set()
"""The passes that are on."""

_ENTERED: list = []
"""(pass, what to do when it is on) in the order of the imports."""


class UnknownPass(ValueError):
    """``CRAMHY_PASSES`` has a name that no pass has."""


def chosen(text):
    """The names that ``text``, a value of ``CRAMHY_PASSES``, leaves on; `UnknownPass` for a name that no pass has."""
    words = text.replace(",", " ").split()
    unknown = sorted({word.removeprefix("-") for word in words} - NAMES - {"all", "none"})
    if unknown:
        raise UnknownPass(f"{VARIABLE}: unknown pass {', '.join(unknown)}. The passes are: {', '.join(sorted(NAMES))}; all; none.")
    off = {word[1:] for word in words if word.startswith("-")}
    named = {word for word in words if not word.startswith("-")}
    on = set(NAMES) if not named or "all" in named else named & NAMES
    return frozenset(on - off)


def from_environment():
    """The passes that the environment leaves on; `UnknownPass`."""
    return chosen(os.environ.get(VARIABLE, ""))


# ------------------------------------------------------------------------------------------------------------------- entering


def enter(name):
    """Decorator: call the function when the pass ``name`` is switched on."""

    def entering(function):
        _ENTERED.append((name, function))
        return function

    return entering


def _append(table, symbols, opening):
    for symbol in symbols:
        table[symbol] = (*table.get(symbol, ()), opening)


def opens_call(name, *symbols, effect=False):
    """Decorator: an opening of calls of ``symbols``. effect: also of those whose value nobody wants."""

    def entering(opening):
        @enter(name)
        def switch_on():
            _append(CALLS, symbols, opening)
            if effect:
                _append(EFFECTS, symbols, opening)

        return opening

    return entering


def opens_effect(name, *symbols):
    """Decorator: an opening of calls of ``symbols`` whose value nobody wants."""
    return _opens(name, EFFECTS, symbols)


def opens_test(name, *symbols, value=True, effect=False):
    """Decorator: an opening of tests by a call of ``symbols``. value: a call whose value is wanted opens as a choice of t and nil."""

    def entering(opening):
        def as_value(generator, node, destination):
            test = opening(generator, node)
            return None if test is None else (generator.finish(generator.truth_value(test), node, destination),)

        @enter(name)
        def switch_on():
            _append(CALL_TESTS, symbols, opening)
            if value:
                _append(CALLS, symbols, as_value)
            if effect:
                _append(EFFECTS, symbols, as_value)

        return opening

    return entering


def opens_setter(name, *symbols):
    """Decorator: an opening of calls of ``(setf symbol)`` for each of ``symbols``."""
    return _opens(name, SETTERS, symbols)


def _opens(name, table, symbols):
    def entering(opening):
        enter(name)(lambda: _append(table, symbols, opening))
        return opening

    return entering


def opens(name, table):
    """Decorator: an opening for one of the lists above."""

    def entering(opening):
        enter(name)(lambda: table.append(opening))
        return opening

    return entering


def opens_node(name, generators, kind):
    """Decorator: an opening (generator, node, destination) of nodes of ``kind``, before the plain function of the table ``generators``."""
    plain = generators[kind]

    def entering(opening):
        def opened(generator, node, destination):
            done = opening(generator, node, destination)
            return plain(generator, node, destination) if done is None else done[0]

        @enter(name)
        def switch_on():
            generators[kind] = opened

        _PLAIN.append((generators, kind, plain))
        return opening

    return entering


_PLAIN: list = []
"""(table, kind of node, plain function) of what `opens_node` replaces."""


def switch(on):
    """Let the passes ``on``, names, be those that are on. All openings must have been entered."""
    for table in (CALLS, EFFECTS, CALL_TESTS, SETTERS, GENERAL_CALLS, GENERAL_SETTERS, BINDINGS, VALUES, FUNCTIONS, ENTRIES):
        table.clear()
    for symbols in (ONE_VALUE, JUMPS, WRITTEN_OUT):
        symbols.clear()
    for generators, kind, plain in _PLAIN:
        generators[kind] = plain
    ON.clear()
    ON.update(on)
    for name, switch_on in _ENTERED:
        if name in ON:
            switch_on()


__all__ = ["NAMES", "ON", "UnknownPass", "chosen", "enter", "from_environment", "opens", "opens_call", "opens_node", "opens_test", "switch"]
