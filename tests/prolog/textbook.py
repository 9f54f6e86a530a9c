"""A tiny Prolog in the way of textbooks, slow and plain, to compare the engine with.

Bindings are dicts, clauses are renamed at every use, solutions come from recursive generators. It knows the constructs of control,
``findall``, ``bagof``, ``==`` and clauses. A cut lets the goals behind it give all their solutions, and then tells those before it to
stop, up to its barrier.
"""

from itertools import count

from cramhy_runtime.lisp_core.data import Cons, Symbol, list_from
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


class Barrier:
    """Where a cut stops: ``cut`` is true once all that the cut leaves open has been tried."""

    cut = False


def solve(goal, clauses, bindings, barrier):
    name, arguments = goal.car.name, list(goal.cdr or ())
    if name == "AND":
        yield from conjunction(goal.cdr, clauses, bindings, barrier)
    elif name == "OR":
        barrier = Barrier()
        for branch in arguments:
            yield from solve(branch, clauses, bindings, barrier)
            if barrier.cut:
                return
    elif name == "CUT":
        yield bindings
        barrier.cut = True
    elif name in ("TRUE", "FAIL"):
        if name == "TRUE":
            yield bindings
    elif name == "NOT":
        if next(solve(arguments[0], clauses, bindings, Barrier()), None) is None:
            yield bindings
    elif name == "FORALL":
        if all(
            next(solve(arguments[1], clauses, found, Barrier()), None) is not None
            for found in solve(arguments[0], clauses, bindings, Barrier())
        ):
            yield bindings
    elif name == "CALL":
        yield from solve(arguments[0], clauses, bindings, Barrier())
    elif name == "ONCE":
        found = next(conjunction(goal.cdr, clauses, bindings, Barrier()), None)
        if found is not None:
            yield found
    elif name in ("FINDALL", "BAGOF"):
        template, inner, result = arguments
        found = [substitute(template, solution) for solution in solve(inner, clauses, bindings, Barrier())]
        unified = unify(result, list_from(found), bindings)
        if unified is not None and (found or name == "FINDALL"):
            yield unified
    elif name == "==":
        unified = unify(*arguments, bindings)
        if unified is not None:
            yield unified
    elif name in ("->", "*->"):
        condition, then, *otherwise = arguments
        some = False
        for found in solve(condition, clauses, bindings, Barrier()):
            some = True
            yield from solve(then, clauses, found, barrier)
            if barrier.cut or name == "->":
                return
        if not some and otherwise:
            yield from solve(otherwise[0], clauses, bindings, barrier)
    else:
        barrier = Barrier()
        for clause in clauses:
            if clause.car.car is goal.car:
                renamed = rename(clause, {})
                unified = unify(renamed.car, goal, bindings)
                if unified is not None:
                    yield from conjunction(renamed.cdr, clauses, unified, barrier)
                    if barrier.cut:
                        return


def conjunction(goals, clauses, bindings, barrier):
    if goals is None:
        yield bindings
        return
    for found in solve(goals.car, clauses, bindings, barrier):
        yield from conjunction(goals.cdr, clauses, found, barrier)
        if barrier.cut:
            return
