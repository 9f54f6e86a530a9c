"""Joins: queries whose goals are all rows of relations become loops within loops.

``(and (edge ?x ?y) (edge ?y ?z))`` needs no machine: for each row of the first goal, a loop goes through the rows of the second that fit.
When a query of the same shape is asked again, a Python generator is written for it. It has a loop for each goal over the rows in the
table for its known arguments (``relations.py``), and the innermost loop makes the binding list of the solution. Queries have the same
shape if they differ only in their constants, which the generator gets.

If facts change between two solutions, a conjunction sees the changes as the machine would: a goal that is entered anew sees them, a goal
whose rows are being gone through does not.
"""

from __future__ import annotations

import gc

from cramhy_runtime import kernel
from cramhy_runtime.kernel.budget import budget
from cramhy_runtime.lisp_core.data import Cons, Keyword, Symbol
from cramhy_runtime.utilities.generated_functions import generated_function
from cramhy_runtime.utilities.lazy_lists import tail
from cramhy_runtime.utilities.patterns import ANONYMOUS, same_atom

from . import database
from .database import find_predicate, valid_functor
from .machine import SOLVED, Machine
from .list_shapes import index_key
from ..symbols import sym
from ..terms.terms import Var, resolve

_AND = sym("AND")
_NEXT_GOAL, _CONSTANT = object(), object()
_PLAIN = frozenset([Symbol, Keyword, int, str])
_PAUSE = object()
"""A generator yields this instead of a solution after many rows, so that other tasks get their turn."""
_ROWS = 1000
"""The number of rows between two pauses."""
_MOST = 500
"""The number of shapes that are remembered."""
_joins: dict = {}


def find_join(query):
    """The `Solutions` of a query (Lisp data) if it is a join that was asked before, else ``None``."""
    functor = query.car
    if functor.__class__ is not Symbol:
        return None
    shape, constants = [functor], []
    if functor is _AND:
        goals = query.cdr
        while goals.__class__ is Cons:
            goal = goals.car
            if goal.__class__ is not Cons:
                return None
            shape.append(_NEXT_GOAL)
            shape.append(goal.car)
            if not _describe(goal.cdr, shape, constants):
                return None
            goals = goals.cdr
        if goals is not None or len(shape) == 1:
            return None
    elif not _describe(query.cdr, shape, constants):
        return None
    shape = tuple(shape)
    join = _joins.get(shape)
    if join is None:
        if len(_joins) >= _MOST:
            _joins.clear()
        _joins[shape] = Join(query)
        return None
    if join.version != database.version.value and not join.revise():
        return None
    return Solutions(join.generator(constants)) if join.generator is not None else None


def _describe(arguments, shape, constants):
    while arguments.__class__ is Cons:
        item = arguments.car
        kind = item.__class__
        if kind is Symbol and item.name[:1] == "?":
            shape.append(item)
        elif kind in _PLAIN:
            shape.append(_CONSTANT)
            constants.append(item)
        else:
            return False
        arguments = arguments.cdr
    return arguments is None


class Join:
    """The queries of one shape. ``generator(constants)`` yields their solutions; it is ``None`` if it is not needed or not possible."""

    def __init__(self, query):
        self.goals = list(query.cdr) if query.car is _AND else [query]
        self.version = self.generator = None

    def revise(self):
        """Look whether all goals are rows of relations now, and write the generator if necessary. Returns whether there is one."""
        self.version = database.version.value
        if not all(self._is_relation(goal) for goal in self.goals):
            self.generator = None
            return False
        if self.generator is None:
            self.generator = _written(self.goals)
        return True

    def _is_relation(self, goal):
        functor = goal.car
        if not valid_functor(functor) or functor in database.in_place or functor in database.traced:
            return False
        relation = find_predicate(functor, len(goal.cdr or ())).as_relation()
        return relation is not None and relation.exact and relation.arity > 0


class Solutions:
    """The solutions of a generator, as a lazy list."""

    __slots__ = ("generator", "found")

    def __init__(self, generator):
        self.generator = generator
        self.found = []

    def lazy_list(self):
        """The lazy list of the solutions that are left. Its first element is computed now."""
        if self.found:  # the walk through all of them was interrupted
            return Cons(self.found.pop(0), tail(self.lazy_list, self.remaining))
        for solution in self.generator:
            if solution is not _PAUSE:
                return Cons(solution, tail(self.lazy_list, self.remaining))
            pause()
        return None

    def remaining(self):
        """All solutions that are left, as a Python list.

        The garbage collector is off between two pauses, since everything that is made there is kept.
        """
        append, collecting = self.found.append, gc.isenabled()
        try:
            gc.disable()
            for solution in self.generator:
                if solution is not _PAUSE:
                    append(solution)
                else:
                    if collecting:
                        gc.enable()
                    pause()
                    gc.disable()
        finally:
            if collecting:
                gc.enable()
        return self.found


def pause():
    """Let other tasks run if this one has used up its turn."""
    budget.left -= _ROWS
    if budget.left < 0:
        kernel.checkpoint()


class _Proved:
    """Stands for the table of a predicate that is not a relation any more: its solutions are proved for each key."""

    def __init__(self, predicate, mask):
        self.predicate, self.known = predicate, [i for i in range(predicate.arity) if mask >> i & 1]

    def get(self, key, default=()):
        arguments = [Var() for _ in range(self.predicate.arity)]
        for i, value in zip(self.known, [key] if len(self.known) == 1 else key):
            arguments[i] = True if value == (True,) else value[1] if value.__class__ is tuple else value
        unknown = [argument for argument in arguments if argument.__class__ is Var]
        machine, rows = Machine(), []
        machine.prove((self.predicate.call, SOLVED, *arguments))
        while machine.next_solution():
            values = tuple([resolve(variable) for variable in unknown])
            rows.append(values[0] if len(values) == 1 else values)
        return rows


def table(predicate, mask):
    """The present table of ``predicate`` for goals whose arguments in ``mask`` are known."""
    relation = predicate.as_relation()
    return relation.table(mask) if relation is not None and relation.exact else _Proved(predicate, mask)


def _written(goals):
    """Write the generator for ``goals``."""
    space = {
        "Cons": Cons,
        "new": Cons.__new__,
        "Symbol": Symbol,
        "index_key": index_key,
        "same_atom": same_atom,
        "table": table,
        "database": database,
        "PAUSE": _PAUSE,
    }
    lines, tables, values = [], [], {}
    depth, constants, names = 0, 0, 0

    def emit(line):
        lines.append("    " * depth + line)

    for number, goal in enumerate(goals):
        known, unknown, same = [], [], []
        for i, argument in enumerate(goal.cdr):
            if argument.__class__ is not Symbol or argument.name[:1] != "?":
                known.append((i, f"c{constants}"))
                constants += 1
            elif argument in values:
                known.append((i, f"({values[argument]} if {values[argument]}.__class__ is Symbol else index_key({values[argument]}))"))
            else:
                unknown.append((i, argument))
        mask = sum(1 << i for i, _ in known)
        predicate = space[f"P{number}"] = find_predicate(goal.car, len(goal.cdr))
        assert predicate is not None
        tables.append(f"t{number} = table(P{number}, {mask})")
        targets, fresh = [], {}
        for _, argument in unknown:
            name = f"v{names}"
            names += 1
            targets.append(name)
            if argument in fresh:
                same.append(f"same_atom({fresh[argument]}, {name})")
            elif argument is not ANONYMOUS:
                fresh[argument] = name
        key = known[0][1] if len(known) == 1 else f"({', '.join(code for _, code in known)})"
        if number == len(goals) - 1:
            emit("count += 1")
            emit(f"if count > {_ROWS}:")
            emit("    count = 0")
            emit("    yield PAUSE")
            emit("    if database.version.value != version: REFRESH")
        emit(f"for {', '.join(targets) or '_'} in t{number}.get({key}, ()):")
        depth += 1
        if same:
            emit(f"if not ({' and '.join(same)}): continue")
        for argument, name in fresh.items():
            space[f"S_{name}"] = argument
            emit(f"p_{name} = new(Cons); p_{name}.car = S_{name}; p_{name}.cdr = {name}")
        values.update(fresh)
    answer = "None"
    for name in reversed(values.values()):
        emit(f"b_{name} = new(Cons); b_{name}.car = p_{name}; b_{name}.cdr = {answer}")
        answer = f"b_{name}"
    emit(f"yield {answer}")
    emit("if database.version.value != version: REFRESH")
    refresh = f"version = database.version.value; {'; '.join(tables)}"
    taken = "".join(f"c{i}, " for i in range(constants))
    head = [*([f"{taken}= map(index_key, constants)"] if constants else []), "count = 0", refresh]
    body = [*head, *(line.replace("REFRESH", refresh) for line in lines)]
    return generated_function("solutions of a join", "solutions", ["constants"], body, space)
