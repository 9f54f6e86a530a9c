"""Defining predicates in Python.

Three ways, from simple to fast. Each is a decorator with the name of the functor, ``"PACKAGE::NAME"``:

* ``@test(name)``: ``f(machine, *terms)`` succeeds once if it returns a true value. It may set variables with
  ``machine.unify(a, b, ...)``.
* ``@predicate(name)``: ``f(machine, *terms)`` is a generator. Each ``yield`` is a solution, made by ``machine.unify`` just before it.
  On backtracking the variables are unset and the generator goes on.
* ``@step_predicate(name)``: ``f(machine, step)`` with step ``(f, continuation, *terms)`` returns the next step; see ``engine/machine.py``.

The terms are those of the goal: use `deref` to look at one, `resolve` for plain Lisp data. A handler gets goals with any number of
arguments, and a wrong number is a program-error; the clauses of users are tried only if it gives no solution. With ``group`` the
function stands for facts of that built-in fact group instead: other numbers of arguments just fail, and the clauses of users follow.

Handlers written in Lisp work on binding lists: `define_handler` adapts them.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.conditions import type_error, wrong_argument_count
from cramhy_runtime.lisp_core.data import Cons, list_from, one

from ..engine.database import changed, functor_entry
from ..engine.fact_groups import built_in_group
from cramhy_runtime.utilities.lazy_lists import elements as lazy_elements
from ..engine.machine import fail, retry_iterator
from ..engine.goal_text import show
from ..symbols import sym
from ..terms.terms import UNSET, Var, deref, import_term, raw, resolve, undo, unify

__all__ = ["define_handler", "deref", "predicate", "resolve", "step_predicate", "test"]


def _install(name, call, group, arity):
    functor = sym(name) if isinstance(name, str) else name
    entry = functor_entry(functor)
    if group is None:
        entry.handler = call
    else:
        built_in_group(sym(group), functor)
        entry.native = {**(entry.native or {}), arity: call}
    changed(functor)


def _arity(function, skip=1):
    """(least, most) number of terms that ``function`` takes after ``skip`` others; most is ``None`` for any number."""
    code = function.__code__
    most = code.co_argcount - skip
    return most - len(function.__defaults__ or ()), None if code.co_flags & 0x04 else most


def _declare(name, function, wrap, group):
    least, most = _arity(function)
    call = wrap(function)
    if group is not None:
        for arity in [None] if most is None else range(least, most + 1):
            _install(name, call, group, arity)
        return

    def checked(m, step):
        given = len(step) - 2
        if given < least or (most is not None and given > most):
            return refuse_count(name, given, least, most)
        return call(m, step)

    _install(name, checked, None, None)


def refuse_count(name, given, least, most):
    """Signal the program-error for a handler that is called with ``given`` arguments. A hint says how many it takes."""
    symbol = sym(name) if isinstance(name, str) else name
    count = f"at least {least}" if most is None else f"{least} to {most}" if most != least else f"{least or 'no'}"
    plural = "" if count.split()[-1] == "1" else "s"
    return wrong_argument_count(given, f"A goal with the functor {show(symbol)} has {count} argument{plural}.")


def test(name, group=None, calls_lisp=False):
    """Decorator: a predicate with at most one solution; see the head of this module.

    name: the functor, ``"PACKAGE::NAME"`` or a symbol. group: the name of a built-in fact group. calls_lisp: whether it calls Lisp
    functions; then messages name the clauses that wait for it.
    """

    def wrap(function):
        if calls_lisp:
            return lambda m, step: step[1] if function(_going_on(m, step[1]), *step[2:]) else fail(m)
        return lambda m, step: step[1] if function(m, *step[2:]) else fail(m)

    def define(function):
        _declare(name, function, wrap, group)
        return function

    return define


def _going_on(m, k):
    m.goes_on = k
    return m


def predicate(name, group=None):
    """Decorator: a predicate by a generator that yields once for each solution; see the head of this module."""

    def wrap(function):
        return lambda m, step: retry_iterator(m, step[1], iter(function(m, *step[2:])))

    def define(function):
        _declare(name, function, wrap, group)
        return function

    return define


def step_predicate(name, group=None, arity=None):
    """Decorator: a predicate that works on steps itself; see the head of this module."""

    def define(function):
        _install(name, function, group, arity)
        return function

    return define


# ------------------------------------------------------------------------------------------------- handlers written in Lisp


_WANTED = "\n(A handler returns a list of binding lists, one for each solution: (list bdgs) for one that binds nothing, nil for none.)"


def define_handler(name, function):
    """``def-prolog-handler``: define the functor ``name`` by ``function(bindings, *arguments)``. Returns ``name``.

    The function gets a binding list and the arguments as they are written. It returns a list, lazy or not, of binding lists, one per
    solution, whose new bindings are set; other results are a type error. A handler that exists is replaced. Source: prolog.md section
    11.
    """

    def solutions(m, terms):
        written = [raw(term, m.names) for term in terms]
        given = binding_list(m)
        found = one(function(given, *written))
        if found and not isinstance(found, Cons):
            type_error(found, "LIST", _WANTED)
        for bindings in lazy_elements(found):
            if bindings and not (isinstance(bindings, Cons) and isinstance(bindings.car, Cons)):
                type_error(bindings, "LIST", _WANTED)
            if _adopt(m, bindings, given):
                yield

    def call(m, step):
        return retry_iterator(m, step[1], solutions(m, step[2:]))

    functor_entry(name).handler = call
    changed(name)
    return name


def binding_list(m):
    """An association list of the named variables of a proof that have values."""
    pairs = []
    for symbol, variable in list(m.names.items()):
        if variable.__class__ is Var and variable.ref is not UNSET:
            pairs.append(Cons(symbol, resolve(variable, m.names)))
    return list_from(pairs)


def _adopt(m, bindings, given):
    """Set the variables that a binding list says have values; entries of ``given`` at its end are known already."""
    cell, pairs = bindings, []
    while isinstance(cell, Cons) and cell is not given:
        pairs.append(cell.car)
        cell = cell.cdr
    height = len(m.trail)
    for pair in reversed(pairs):
        variable = import_term(pair.car, m.names)
        if not unify(variable, import_term(pair.cdr, m.names), m.trail):
            undo(m.trail, height)
            return False
    return True
