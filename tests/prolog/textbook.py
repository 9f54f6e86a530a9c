"""A tiny Prolog in the way of textbooks, slow and plain, to compare the engine with.

Bindings are dicts, clauses are renamed at every use, solutions come from recursive generators. It knows ``and``, ``or``,
``not``, ``==``, ``->`` and clauses; no cut.
"""

from itertools import count

from cramhy_runtime.lisp.data import Cons, Symbol
from cramhy_runtime.utilities.patterns import variable

_fresh = count()


def walk(term, bindings):
    while variable(term) and term in bindings:
        term = bindings[term]
    return term


def unify(a, b, bindings):
    a, b = walk(a, bindings), walk(b, bindings)
    if a is b or (not isinstance(a, (Cons, Symbol)) and type(a) is type(b) and a == b):
        return bindings
    if variable(a):
        return bind(a, b, bindings)
    if variable(b):
        return bind(b, a, bindings)
    if isinstance(a, Cons) and isinstance(b, Cons):
        bindings = unify(a.car, b.car, bindings)
        return None if bindings is None else unify(a.cdr, b.cdr, bindings)
    return None


class Cyclic(Exception):
    """A variable would become part of its own value: what happens then is not defined."""


def bind(name, value, bindings):
    stack = [value]
    while stack:
        term = walk(stack.pop(), bindings)
        if isinstance(term, Cons):
            stack += [term.car, term.cdr]
        elif term is name:
            raise Cyclic
    return {**bindings, name: value}


def substitute(term, bindings):
    term = walk(term, bindings)
    return Cons(substitute(term.car, bindings), substitute(term.cdr, bindings)) if isinstance(term, Cons) else term


def rename(term, names):
    if variable(term):
        return names.setdefault(term, Symbol(f"?R{next(_fresh)}"))
    return Cons(rename(term.car, names), rename(term.cdr, names)) if isinstance(term, Cons) else term


def solve(goal, clauses, bindings):
    name = goal.car.name
    if name == "AND":
        yield from conjunction(goal.cdr, clauses, bindings)
    elif name == "OR":
        for branch in goal.cdr or ():
            yield from solve(branch, clauses, bindings)
    elif name == "NOT":
        if next(solve(goal.cdr.car, clauses, bindings), None) is None:
            yield bindings
    elif name == "==":
        unified = unify(goal.cdr.car, goal.cdr.cdr.car, bindings)
        if unified is not None:
            yield unified
    elif name == "->":
        condition, then, *otherwise = goal.cdr
        found = next(solve(condition, clauses, bindings), None)
        if found is not None:
            yield from solve(then, clauses, found)
        elif otherwise:
            yield from solve(otherwise[0], clauses, bindings)
    else:
        for clause in clauses:
            if clause.car.car is goal.car:
                renamed = rename(clause, {})
                unified = unify(renamed.car, goal, bindings)
                if unified is not None:
                    yield from conjunction(renamed.cdr, clauses, unified)


def conjunction(goals, clauses, bindings):
    if goals is None:
        yield bindings
    else:
        for found in solve(goals.car, clauses, bindings):
            yield from conjunction(goals.cdr, clauses, found)
