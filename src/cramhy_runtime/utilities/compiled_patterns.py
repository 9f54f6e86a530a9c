"""Patterns that become Python functions: matching for those that are matched again and again.

``(pat-match '(a ?x b ?y) list)`` goes through both sides in `patterns.py`, which decides at each cons what the pattern has there. A
pattern that is met several times is usually a constant of the program. It becomes a function, in which these decisions are made: it
looks at the list only, and makes the bindings at the end.

A pattern is made of conses, and a program may change them. So the function looks at each cons of the pattern, too, before it relies on
it. If one has changed, it says so, and the pattern is met anew. The law: a match has the same result as in `patterns.py`.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import Cons, MultipleValues, Symbol
from cramhy_runtime.lisp_core.equality import eql
from cramhy_runtime.kernel.active import slice_over
from cramhy_runtime.kernel.budget import budget

from .generated_functions import generated_function
from .lazy_lists import lazy_cdr

LOOK_CLOSER = object()
"""What a function returns if it does not know: the pattern has changed, or there is a variable on the right."""
NO_MATCH = MultipleValues((None, None))
_MATCH = MultipleValues((None, True))
_MOST_PARTS = 120
_OFTEN = 3
_MOST_PATTERNS = 500
_MOST_MET = 50
_PLAIN = frozenset([int, str, float, Cons, type(None)])


class Matchers:
    """The functions of patterns, in the dict ``functions`` by the first cons of the pattern. `meet` enters them.

    anonymous: the variable that is not bound. helpers: names that the functions use, ``equal`` and ``substitute_vars``.
    """

    def __init__(self, anonymous, helpers):
        self.anonymous = anonymous
        self.functions, self.met = {}, {}
        self.scope = {
            **helpers,
            "Cons": Cons,
            "new": Cons.__new__,
            "Symbol": Symbol,
            "PLAIN": _PLAIN,
            "MultipleValues": MultipleValues,
            "MATCH": _MATCH,
            "NO_MATCH": NO_MATCH,
            "LOOK_CLOSER": LOOK_CLOSER,
            "lazy_cdr": lazy_cdr,
            "eql": eql,
            "failed": _failed,
            "budget": budget,
            "slice_over": slice_over,
        }

    def meet(self, pattern):
        """Note that a pattern without a function was matched. If that happens often, it gets one."""
        times = self.met.get(pattern, 0) + 1
        if times < _OFTEN:
            if len(self.met) >= _MOST_MET:
                self.met.clear()
            self.met[pattern] = times
            return
        self.met.pop(pattern, None)
        if len(self.functions) >= _MOST_PATTERNS:
            self.functions.clear()
        self.functions[pattern] = _Writer(self.anonymous).function(pattern, dict(self.scope))


class _Unfit(Exception):
    """A pattern has a segment variable, or is too large, perhaps without end."""


class _Writer:
    """Writes the function of one pattern."""

    def __init__(self, anonymous):
        self.anonymous = anonymous
        self.lines, self.constants, self.parts = [], {}, 0
        self.variables = {}  # symbol → the Python variable with its value, in order of occurrence
        self.bound = "None"  # the Python variable with the bindings that are made already

    def function(self, pattern, scope):
        try:
            repeated = self.repeated(pattern)
            self.lines = ["left = budget.left = budget.left - 1", "if left < 0: slice_over()"]
            self.list(pattern, "thing", repeated)
        except _Unfit:
            return unfit
        if not repeated:
            for symbol, value in self.variables.items():
                self.bind(symbol, value)
        self.lines.append("return MATCH" if self.bound == "None" else f"return MultipleValues(({self.bound}, True))")
        return generated_function("match of a pattern", "match", ["thing"], self.lines, {**scope, **self.constants})

    def repeated(self, pattern):
        """Whether a variable occurs twice. Then bindings are made on the way, since the next values are compared with them."""
        found, waiting, again = set(), [pattern], False
        while waiting:
            self.parts += 1
            part = waiting.pop()
            if self.parts > _MOST_PARTS:
                raise _Unfit
            if isinstance(part, Cons):
                waiting += (part.cdr, part.car)
            elif isinstance(part, Symbol) and part.name[:1] == "?" and part is not self.anonymous:
                again = again or part in found
                found.add(part)
        return again

    def constant(self, value):
        name = f"P{len(self.constants)}"
        self.constants[name] = value
        return name

    def list(self, cell, thing, repeated):
        """Lines that match the list that begins with ``cell`` with the Python variable ``thing``."""
        self.lines.append(f"if {thing}.__class__ is not Cons: return failed({thing})")
        pattern = self.constant(cell)
        while True:
            car, cdr = self.constant(cell.car), self.constant(cell.cdr)
            number = len(self.constants)
            item, rest = f"v{number}", f"r{number}"
            self.lines.append(f"if {pattern}.car is not {car} or {pattern}.cdr is not {cdr}: return LOOK_CLOSER")
            self.lines.append(f"{item} = {thing}.car")
            if isinstance(cell.car, Cons):
                self.list(cell.car, item, repeated)
            else:
                self.atom(cell.car, car, item, repeated)
            self.lines.append(f"{rest} = {thing}.cdr")
            if not isinstance(cell.cdr, Cons):
                if cell.cdr is not None:
                    lazy = f"if {rest}.__class__ not in PLAIN and {rest}.__class__ is not Symbol: {rest} = lazy_cdr({thing})"
                    if isinstance(cell.cdr, Symbol):
                        self.lines.append(lazy)
                        self.atom(cell.cdr, cdr, rest, repeated)
                    else:
                        self.lines += [f"if {rest} is not {cdr}:", "    " + lazy]
                        self.lines.append(f"    if eql({cdr}, {rest}) is None: return failed({rest})")
                else:
                    self.lines.append(f"if {rest} is not None:")
                    self.lines.append(f"    {rest} = lazy_cdr({thing})")
                    self.lines.append(f"    if {rest} is not None and {rest} is not False: return failed({rest})")
                return
            self.lines.append(f"if {rest}.__class__ is not Cons:")
            self.lines.append(f"    {rest} = lazy_cdr({thing})")
            self.lines.append(f"    if {rest}.__class__ is not Cons: return failed({rest})")
            cell, pattern, thing = cell.cdr, cdr, rest

    def atom(self, part, constant, thing, repeated):
        """Lines that match the atom ``part``, which is in the Python variable ``constant``."""
        if not isinstance(part, Symbol):
            self.lines.append(f"if {thing} is not {constant} and eql({constant}, {thing}) is None: return failed({thing})")
            return
        if part.name[:2] == "!?":
            raise _Unfit
        if part.name[:1] != "?":
            self.lines.append(f"if {thing} is not {constant}: return failed({thing})")
            return
        self.lines.append(f"if {thing}.__class__ is Symbol:")
        # Most names begin with a letter, which comes after both signs, and one comparison takes half the time.
        self.lines.append(f"    if {thing}.name < '@' and {thing}.name[:1] in '?!': return LOOK_CLOSER")
        self.lines.append(f"elif {thing}.__class__ not in PLAIN and failed({thing}) is LOOK_CLOSER: return LOOK_CLOSER")
        if part is self.anonymous:
            return
        known = self.variables.get(part)
        if known is None:
            self.variables[part] = thing
            if repeated:
                self.bind(part, thing)
        else:
            self.lines.append(f"if not equal(substitute_vars({known}, {self.bound}), {thing}): return NO_MATCH")

    def bind(self, symbol, value):
        pair, entry = f"p{value}", f"b{value}"
        self.lines.append(f"{pair} = new(Cons); {pair}.car = {self.constant(symbol)}; {pair}.cdr = {value}")
        self.lines.append(f"{entry} = new(Cons); {entry}.car = {pair}; {entry}.cdr = {self.bound}")
        self.bound = entry


def unfit(thing):
    """Stands for the function of a pattern that cannot have one."""
    return LOOK_CLOSER


def _failed(thing):
    """The result where ``thing`` does not match. A variable on the right is an error, which `patterns.py` signals."""
    return LOOK_CLOSER if isinstance(thing, Symbol) and thing.name[:1] in ("?", "!", "") else NO_MATCH
