"""Code that matches the arguments of a goal with the head of a clause, and code that builds terms.

The pattern is known when the clause is compiled, so its unification is written out test by test. Tests that the choice among the clauses
has made already are left out. A variable of the clause is a Python variable that holds a term: the argument itself, a part of it, or a
new `Var` if a term must be built before the variable has a value.

``names`` maps the variables that have occurred to Python expressions; ``failing`` of the `Source` is the statement that leaves on failure.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import Cons, Symbol
from cramhy_runtime.utilities.patterns import ANONYMOUS, variable

from ..engine.database import traced
from ..terms.terms import NEW_VARIABLE
from .generated_code import Rest, is_ground, variables

_DEEP = 4
_ALONG = 0.5
"""How much deeper the next element of a list counts than this one."""
UNKNOWN, A_LIST, UNBOUND, SAME = "unknown", "a list", "unbound", "same"
"""Knowledge about an argument: nothing; that it is a cons; an unset variable; or the atom that the clause has there."""


def _short(pattern):
    """Whether a list without variables has two atoms at most: tests for these are shorter than a call."""
    rest = pattern.cdr
    return not isinstance(pattern.car, Cons) and (
        not isinstance(rest, Cons) or not (isinstance(rest.car, Cons) or isinstance(rest.cdr, Cons))
    )


class Matching:
    """Writes code for heads and for terms into ``out``, a `Source`."""

    def __init__(self, out):
        self.out = out

    def fail_unless(self, test):
        """Emit code that fails unless the expression ``test`` is true."""
        self.out.emit(f"if not {test}: {self.out.failing}")

    def match_head(self, patterns, names, known=None, hole=None):
        """Emit code that matches the arguments ``a0``, ``a1``, ... with ``patterns``.

        ``known`` maps arguments to knowledge about them, such as `A_LIST`. ``hole`` is explained in ``list_building.py``.
        """
        for i, pattern in enumerate(patterns):
            if isinstance(pattern, Rest):
                break
            if variable(pattern) and pattern is not ANONYMOUS and pattern not in names:
                names[pattern] = f"a{i}"
        # A variable that stands alone as an argument is that argument; the other occurrences must be the same as it.
        # Arguments may be the same variable, so once something is matched none is known to be unset.
        count = len(self.out.lines)
        if hole is not None:
            self.out.emit(f"if hole is not None: hole.cdr = {self.build(patterns[hole], names)}")
            self.out.emit("else:")
            self.out.depth += 1
            self.match(patterns[hole], f"a{hole}", names, 0)
            self.out.depth -= 1
        for i, pattern in enumerate(patterns):
            if i == hole:
                continue
            if isinstance(pattern, Rest):
                self._match_rest(i, pattern, names)
            elif not (variable(pattern) and (pattern is ANONYMOUS or names[pattern] == f"a{i}")):
                kind = (known or {}).get(i)
                self.match(pattern, f"a{i}", names, 0, None if kind is UNBOUND and len(self.out.lines) > count else kind)

    def _match_rest(self, i, pattern, names):
        built = "None"
        for j in reversed(range(i, i + pattern.count)):
            built = f"Cons(a{j}, {built})"
        if pattern.name is not ANONYMOUS:
            if pattern.name in names:
                self.fail_unless(f"unify({names[pattern.name]}, {built}, trail)")
            else:
                names[pattern.name] = self.out.fresh("rest")
                self.out.emit(f"{names[pattern.name]} = {built}")

    def match(self, pattern, x, names, depth, known=None, own=False):
        """Emit code that unifies ``pattern`` with the term in the Python variable ``x``. If it is ``known``, it is dereferenced.

        own: nobody else needs ``x``, so the value of a variable may take its place.
        """
        if variable(pattern):
            if pattern is ANONYMOUS:
                return
            if pattern in names:
                known_term = names[pattern]
                self.out.emit(f"if {x}.__class__ is not Var and {known_term}.__class__ is Var and {known_term}.ref is UNSET:")
                self.out.emit(f"    {known_term}.ref = {x}; trail.append({known_term})")
                self.out.emit(f"elif not unify({known_term}, {x}, trail): {self.out.failing}")
            else:
                names[pattern] = x
            return
        if known is SAME:
            return
        if isinstance(pattern, Cons) and known is None and (depth >= _DEEP or (is_ground(pattern) and not _short(pattern))):
            self.fail_unless(f"unify({self.build(pattern, names)}, {x}, trail)")
            return
        if known is None and not own:
            term, x = x, self.out.fresh("x")
            self.out.emit(f"{x} = {term}")
        if isinstance(pattern, Cons):
            self._match_list(pattern, x, names, depth, known)
            return
        if known is None:
            self.follow(x)
        value = self.out.constant(pattern)
        if known is UNBOUND:
            self._set(x, value)
            return
        identical = isinstance(pattern, Symbol) or pattern is None or pattern is True
        self.out.emit(f"if {x} is not {value}:" if identical else f"if not same_atom({x}, {value}):")
        self.out.emit(f"    if {x}.__class__ is Var:")
        self.out.depth += 2
        self._set(x, value)
        self.out.depth -= 2
        other = f"{x}.__class__ is Symbol or " if identical else ""
        self.out.emit(f"    elif {other}not unify({x}, {value}, trail): {self.out.failing}")

    def follow(self, x):
        """Emit code after which ``x`` is the value, if it is a variable that has one."""
        self.out.emit(f"while {x}.__class__ is Var:")
        self.out.emit(f"    r = {x}.ref")
        self.out.emit("    if r is UNSET: break")
        self.out.emit(f"    {x} = r")

    def _set(self, x, value):
        self.out.emit(f"{x}.ref = {value}")
        self.out.emit(f"trail.append({x})")

    def _match_list(self, pattern, x, names, depth, known):
        if known is A_LIST:
            self._match_parts(pattern, x, names, depth)
            return
        if known is UNBOUND:
            self._set(x, self._cell(pattern, names))
            return
        self.out.emit(f"if {x}.__class__ is not Cons:")
        self.out.depth += 1
        self.follow(x)
        self.out.emit(f"if {x}.__class__ is LazyTail or {x}.__class__ is TermTail: {x} = {x}.force()")
        self.out.depth -= 1
        before = dict(names)
        self.out.emit(f"if {x}.__class__ is Cons:")
        self.out.depth += 1
        count = len(self.out.lines)
        self._match_parts(pattern, x, names, depth)
        if len(self.out.lines) == count:
            self.out.emit("pass")
        self.out.depth -= 1
        self.out.emit(f"elif {x}.__class__ is Var:")
        self.out.depth += 1
        inside = variables(pattern)
        for name in names:
            if name not in before and name in inside:
                self.new_variable(names[name], name)
        self._set(x, self._cell(pattern, dict(names)))
        self.out.depth -= 1
        self.out.emit(f"else: {self.out.failing}")

    def _match_parts(self, pattern, x, names, depth):
        for part, attribute, further in ((pattern.car, "car", 1), (pattern.cdr, "cdr", _ALONG)):
            if part is ANONYMOUS:
                continue
            if variable(part) and part not in names:
                names[part] = self.out.fresh("v")
                self.out.emit(f"{names[part]} = {x}.{attribute}")
            else:
                piece = self.out.fresh("p")
                self.out.emit(f"{piece} = {x}.{attribute}")
                self.match(part, piece, names, depth + further, own=True)

    # ------------------------------------------------------------------------------------------------------------ building terms

    def _cell(self, pattern, names):
        """Emit code for a new cons, without a call of its constructor. Returns the Python variable that holds it."""
        car, cdr = self.build(pattern.car, names), self.build(pattern.cdr, names)
        cell = self.out.fresh("n")
        self.out.emit(f"{cell} = new(Cons); {cell}.car = {car}; {cell}.cdr = {cdr}")
        return cell

    def build(self, pattern, names):
        """An expression for the term ``pattern``; new variables and conses are made on lines before it."""
        if variable(pattern):
            if pattern is ANONYMOUS:
                name = self.out.fresh("v")
                self.out.emit(NEW_VARIABLE.format(name))
                return name
            if pattern not in names:
                names[pattern] = self.out.fresh("v")
                self.new_variable(names[pattern], pattern)
            return names[pattern]
        if not isinstance(pattern, Cons) or is_ground(pattern):
            return self.out.constant(pattern)
        cells, cell = [], pattern
        while isinstance(cell, Cons) and not is_ground(cell) and len(cells) < 40:
            cells.append(self.build(cell.car, names))
            cell = cell.cdr
        end = self.build(cell, names)
        for car in reversed(cells):
            name = self.out.fresh("n")
            self.out.emit(f"{name} = new(Cons); {name}.car = {car}; {name}.cdr = {end}")
            end = name
        return end

    def first_occurrences(self, item, names):
        """Emit code for the variables of ``item`` that have not occurred yet."""
        for name in variables(item):
            if name not in names:
                names[name] = self.out.fresh("v")
                self.new_variable(names[name], name)

    def new_variable(self, python_name, symbol):
        """Emit code that makes a variable. While goals are traced, the variable knows its name in the clause."""
        self.out.emit(NEW_VARIABLE.format(python_name))
        self.name_variable(python_name, symbol)

    def name_variable(self, python_name, symbol):
        """While goals are traced, emit code that gives a variable its name in the clause."""
        if traced:
            self.out.emit(f"{python_name}.written = {self.out.constant(symbol)}")
