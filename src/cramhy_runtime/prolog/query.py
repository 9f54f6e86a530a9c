"""Queries: ``prolog``, and functions for Python.

For Lisp, `prolog` takes a goal and returns ``nil`` or a lazy list with one binding list per solution (prolog.md section 5). For Python:

* ``solve(goal)`` iterates over dicts {variable symbol: value};
* ``first(goal, variable)`` is the value in the first solution;
* ``ask(functor, *arguments)`` asks one predicate, with Python values as arguments and `Var` objects for the values to find, without
  building a goal; designators use it. It iterates over the values of the variables of each solution.
  ``ask_all(variable, *goals)`` asks several together, and returns all values of one variable.

All solutions are computed on demand, so a query that is dropped costs nothing more.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.conditions import type_error
from cramhy_runtime.lisp_core.data import FLOATS, Cons, Keyword, Symbol, python_list

from cramhy_runtime.lisp_core.functions import function_of
from cramhy_runtime.lisp_core.hooks import Hook

from .builtins import builtins, control  # noqa: F401  the predicates that every query may use
from .compiler import compiler  # noqa: F401  the clauses that they find
from .explanations import undefined  # noqa: F401  which warns of those that nobody has defined
from .engine.database import find_predicate
from cramhy_runtime.utilities.lazy_lists import beginning, tail
from .engine.joins import find_join
from .engine.machine import SOLVED, Machine
from cramhy_runtime.utilities.patterns import ANONYMOUS, entry, for_lisp, var_value, variables_of
from .terms.terms import UNSET, Var, import_term, resolve

_PLAIN = frozenset([Symbol, Keyword, int, str, *FLOATS])


on_prepare_prolog_prove = Hook("CUT::ON-PREPARE-PROLOG-PROVE", "(query binds)")
"""Called before a proof. Its first result goes to `on_finish_prolog_prove`."""
on_finish_prolog_prove = Hook("CUT::ON-FINISH-PROLOG-PROVE", "(log-id success)")
"""Called when it is known whether there is a solution."""


class Proof(Machine):
    """The proof of a goal that is given as Lisp data."""

    __slots__ = ("variables", "binds", "goal")

    def __init__(self, goal, binds=None):
        super().__init__(_Names(binds) if binds is not None else {})
        self.binds, self.goal = binds, goal
        self.start = _start, SOLVED, import_term(goal, self.names)
        self.variables = [*self.names.items()][::-1]
        if binds is not None:
            self.variables = [(symbol, variable) for symbol, variable in self.variables if entry(symbol, binds) is None]

    def bindings(self):
        """The binding list of the solution."""
        result = self.binds
        for symbol, variable in self.variables:
            value = variable.ref
            if value is UNSET:
                continue
            if value.__class__ not in _PLAIN:
                value = resolve(variable)
                if value is symbol:
                    continue
                value = for_lisp(value)
            result = Cons(Cons(symbol, value), result)
        return result

    def lazy_list(self):
        """The binding lists of all solutions that are left, as a lazy list. Its first element is computed now."""
        return Cons(self.bindings(), tail(self.lazy_list, self.remaining)) if self.next_solution() else None

    def remaining(self):
        """The binding lists of all solutions that are left, as a Python list."""
        found = []
        self.drain(lambda: found.append(self.bindings()))
        return found


def _start(m, step):
    return control.solve(m, step[2], step[1], 0)


class _Names(dict):
    """Symbol → `Var`. A symbol of a binding list comes with its value."""

    def __init__(self, binds):
        super().__init__()
        self.binds = binds

    def get(self, symbol, default=None):
        found = dict.get(self, symbol)
        if found is None:
            pair = entry(symbol, self.binds)
            if pair is not None:
                found = self[symbol] = Var()
                found.name = symbol
                if pair.cdr is not symbol:
                    found.ref = import_term(pair.cdr, self)
        return found


def prolog(query, binds=None):
    """``(prolog query &optional binds)``: a lazy list of the binding lists of all solutions, or ``nil``.

    The search runs up to the first solution now, and goes on when the list is forced. A query that is not a list is a type-error.
    """
    if query is not None and query.__class__ is not Cons:
        return type_error(query, "LIST")
    hooked = on_prepare_prolog_prove or on_finish_prolog_prove
    log = on_prepare_prolog_prove.first(query, binds) if hooked else None
    join = find_join(query) if binds is None and query is not None else None
    solutions = beginning(Proof(query, binds).lazy_list if join is None else join.lazy_list)
    if hooked:
        on_finish_prolog_prove(log, True if solutions is not None else None)
    return solutions


def solve(goal):
    """Iterate over the solutions of a goal (Lisp data), as dicts {variable symbol: value} without variables that have no value.

    If the iteration stops early, the generators of its predicates are closed.
    """
    proof = Proof(goal)
    try:
        while proof.next_solution():
            yield {symbol: resolve(variable) for symbol, variable in reversed(proof.variables) if variable.ref is not UNSET}
    finally:
        proof.choices.clear()


def first(goal, variable, default=None):
    """The value of ``variable`` in the first solution of ``goal``, or ``default``."""
    proof = Proof(goal)
    if not proof.next_solution():
        return default
    return resolve(proof.names.get(variable, variable))


def holds(goal):
    """Whether ``goal`` has a solution, as a Python bool."""
    return Proof(goal).next_solution()


def ask(functor, *arguments, causes=None):
    """Iterate over the solutions of ``(functor . arguments)``.

    Arguments are Lisp data without variables, and `Var` objects. Each solution is a tuple with the values of the `Var` objects, in
    order. ``causes``: a dict that gets, as keys, texts about the Lisp functions that signalled an error.
    """
    m = Machine()
    if causes is not None:
        m.warned_of().causes = causes
    wanted = [argument for argument in arguments if argument.__class__ is Var]
    m.prove((find_predicate(functor, len(arguments)).call, SOLVED, *arguments))
    while m.next_solution():
        yield tuple([resolve(variable) for variable in wanted])


def ask_all(wanted, *goals):
    """The values of the `Var` ``wanted`` in all solutions of ``goals`` together, a Python list without repetitions.

    A goal is a tuple (functor, argument...) with arguments as in `ask`.
    """
    m, step, found = Machine(), SOLVED, {}
    for functor, *arguments in reversed(goals):
        step = (find_predicate(functor, len(arguments)).call, step, *arguments)
    m.prove(step).drain(lambda: found.setdefault(resolve(wanted)))
    return list(found)


def query_var(var, function, query, *args):
    """The value of ``var`` in the first binding list that ``function`` (normally `prolog`) returns for ``query``."""
    solutions = function_of(function)(query, *args)
    return None if solutions is None else var_value(var, solutions.car)


def _pairs(bdgs):
    return [pair if isinstance(pair, Cons) else type_error(pair, "CONS") for pair in python_list(bdgs)]


def filter_bindings(form, bdgs, initial_bdgs=None):
    """The bindings of the variables of ``form`` (and of ``initial_bdgs``) in ``bdgs``, in front of ``initial_bdgs``."""
    symbols = [symbol for symbol in variables_of(form) if symbol is not ANONYMOUS]
    symbols += [pair.car for pair in _pairs(initial_bdgs) if pair.car not in symbols]
    result = initial_bdgs
    for symbol in reversed(symbols):
        value = var_value(symbol, bdgs)
        if value is not symbol and entry(symbol, initial_bdgs) is None:
            result = Cons(Cons(symbol, value), result)
    return result
