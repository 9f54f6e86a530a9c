"""The database: functors, their clauses, and the code that each compiles to.

All clauses of a functor form one predicate, whatever their number of arguments; since goals with other numbers of arguments
cannot unify, code is kept per functor and number of arguments, and made when a goal first needs it. A functor may have a
*handler*, which is tried first; if it gives no solution the clauses are tried (prolog.md 5.1). Or it may have *native facts*: Python code
that stands for the clauses of a built-in fact group, and the clauses of users follow it.

The compiler of clauses and the constructs of control stand above this module. They install the functions that it needs in
``services.py``, and enter here the functors that are compiled `in_place` and the functions to call after changes, `watchers`.
"""

from __future__ import annotations

import itertools
from weakref import WeakSet

from cramhy_runtime.lisp_core.data import Cons, Symbol, list_from
from cramhy_runtime.lisp_core.packages import common, is_symbol
from cramhy_runtime.kernel.images import Cell, part

from ..terms import origins
from .machine import call_again, fail, settle
from .services import SERVICES
from cramhy_runtime.utilities.patterns import variable
from ..terms.terms import deref


in_place: set = set()
"""Functors whose goals are compiled in place. When users give one of them clauses, all code is made anew."""
watchers: list = []
"""Functions that are called with the name of a functor and its entry, or ``None``, after its clauses have changed."""


class Traced(dict):
    """Functors whose goals are watched, in the order in which they were named.

    All of their calls go through `Predicate.call`; no loop and no code in place replaces them.

    With ``everything`` all predicates are watched. The constructs of control, the set ``constructs``, are watched only if they are named.
    """

    everything = False
    constructs: set = set()

    def __contains__(self, functor):
        return dict.__contains__(self, functor) or (self.everything and functor not in self.constructs)

    def __bool__(self):
        return self.everything or len(self) > 0


traced = Traced()
"""The functors that are watched now. Call `forget_all` after a change of it."""


class Predicate:
    """The code for goals with ``functor`` and ``arity`` arguments: ``call(machine, (call, continuation, *arguments))``."""

    __slots__ = ("functor", "arity", "call", "_relation", "variants", "__weakref__")

    def __init__(self, functor, arity):
        self.functor, self.arity = functor, arity
        self.variants = WeakSet()
        self.forget()

    def forget(self):
        """Make the code anew at the next call, and that of its variants (``compiler/variants.py``)."""
        self.call, self._relation = self.compile_and_call, False
        for variant in self.variants:
            variant.forget()

    def compile(self):
        """Make the code now. Code that is running meanwhile does not change."""
        entry = functors.get(self.functor)
        if traced and self.functor in traced:
            self.call, self._relation = SERVICES.watch_predicate(self, entry if entry is not None and entry.defined else None), None
        elif entry is not None and entry.defined:
            self.call, self._relation = entry.code(self.arity)
        else:
            self.call, self._relation = _undefined(self.functor), None

    def as_relation(self):
        """The `Relation` whose rows are all solutions of such goals; ``None`` if there are others."""
        if self._relation is False:
            self.compile()
        return self._relation

    def compile_and_call(self, m, step):
        """The first call: make the code, then call it. A change of the database brings this function back."""
        self.compile()
        return self.call(m, (self.call, *step[1:]))

    def __repr__(self):
        return f"<{self.functor!r}/{self.arity}>"


class Clause:
    """A fact or rule: the ``head`` and the list of ``goals`` as Lisp data, and the name of its fact ``group``.

    ``origin`` is the user's code that made it, see ``terms/origins.py``.
    """

    __slots__ = ("head", "goals", "group", "origin")

    def __init__(self, head, goals, group, origin=None):
        self.head, self.goals, self.group, self.origin = head, goals, group, origin

    @property
    def position(self):
        """(file, line, column) of the form that made the clause, or ``None``."""
        return origins.position_of_origin(self.origin)


class Functor:
    """A functor, with its handler and clauses.

    ``handler`` is a call function. ``native`` maps numbers of arguments (``None``: any) to call functions that stand for the
    clauses of the built-in fact group ``native_group``. ``clauses`` are those of users, in order. A functor of a built-in group
    without native facts is there to be extended: its goals just fail until users add clauses. ``compiler`` makes the call function
    of the clauses, if a room knows a better way than ``compile_clauses``.
    """

    __slots__ = ("name", "handler", "native", "native_group", "clauses", "compiler")

    def __init__(self, name):
        self.name = name
        self.handler = self.native = self.native_group = self.compiler = None
        self.clauses = []

    @property
    def defined(self):
        """Whether it has clauses or a handler, or belongs to a built-in group."""
        return bool(self.clauses or self.handler) or self.native_group is not None

    def groups(self):
        """The names of the fact groups with clauses of this functor, oldest first."""
        found = {} if self.native_group is None else {self.native_group: None}
        for clause in self.clauses:
            found.setdefault(clause.group)
        return list(found)

    def code(self, arity):
        """The call function for goals with ``arity`` arguments, and the `Relation` if the clauses are rows of one."""
        native = self.native and (self.native.get(arity) or self.native.get(None) or _failing)
        predicate = find_predicate(self.name, arity)
        if self.compiler is not None:
            from_clauses, relation = self.compiler(predicate, self.clauses)
        else:
            from_clauses, relation = SERVICES.compile_clauses(predicate, self.clauses) if self.clauses else (None, None)
        if self.handler is not None:
            return (_with_fallback(self.handler, from_clauses) if from_clauses else self.handler), None
        if native:
            return (_one_after_other(native, from_clauses) if from_clauses else native), None
        return from_clauses or _failing, relation


functors: dict[object, Functor] = {}
_predicates: dict[tuple, Predicate] = {}


def find_predicate(functor, arity):
    """The `Predicate` for a functor and a number of arguments, whether the functor is defined or not."""
    found = _predicates.get((functor, arity))
    if found is None:
        found = _predicates[functor, arity] = Predicate(functor, arity)
    return found


def functor_entry(name):
    """The `Functor` of that name. It is made if there is none."""
    found = functors.get(name)
    if found is None:
        found = functors[name] = Functor(name)
    return found


def changed(name):
    """Forget the compiled code of a functor. If its goals may be compiled into other predicates, forget all code."""
    version.value = next(_versions)
    for watcher in watchers:
        watcher(name, functors.get(name))
    for predicate in list(_predicates.values()):
        if predicate.functor is name or name in in_place:
            predicate.forget()


def forget_all():
    """Forget the compiled code of all functors, because other functors are traced now."""
    version.value = next(_versions)
    for name in traced.constructs:
        for watcher in watchers:
            watcher(name, functors.get(name))
    for predicate in list(_predicates.values()):
        predicate.forget()


_versions = itertools.count(1)
version = Cell(0)
"""A number for the state of the database: a new one after each change, and another one in each image."""


def valid_functor(name):
    """Whether ``name`` can be a functor: a symbol, but neither ``nil`` nor a variable."""
    return name is not None and is_symbol(name) and not variable(name)


def extended(name):
    """Whether users have added clauses to a built-in."""
    entry = functors.get(name)
    return entry is not None and bool(entry.clauses)


def looked_up(name):
    """Whether goals of a built-in must be looked up, not compiled in place, because users have clauses for it or it is traced."""
    return extended(name) or name in traced


# ------------------------------------------------------------------------------------------------------------------- calling


def arguments_of(goal):
    """The argument terms of a goal. The end of the goal may be a variable whose value is a list."""
    arguments, cell = [], deref(goal.cdr)
    while cell.__class__ is Cons:
        arguments.append(cell.car)
        cell = deref(cell.cdr)
    return arguments


def lengths_of_heads(functor: Symbol, least: int) -> list[int]:
    """The numbers of arguments, ``least`` or more, that clauses of ``functor`` have, in the order of the clauses.

    A head that ends in a variable has no length of its own. Of a functor with a handler, or a built-in, nothing is known.
    """
    entry = functors.get(functor)
    if entry is None or entry.handler is not None or entry.native:
        return []
    lengths: list[int] = []
    for clause in entry.clauses:
        length, cell = 0, clause.head.cdr
        while isinstance(cell, Cons):
            length, cell = length + 1, cell.cdr
        if cell is None and length >= least and length not in lengths:
            lengths.append(length)
    return lengths


def _undefined(functor):
    def call(m, step):
        return undefined_step(m, Cons(functor, list_from(step[2:])), step[1])

    return call


def undefined_step(m, goal, k):
    """Warn about the undefined functor of ``goal``, after which ``k`` would go on, and fail."""
    m.goes_on = k
    SERVICES.warn_undefined(m, goal)
    return fail(m)


def _failing(m, step):
    return fail(m)


def _one_after_other(first, second):
    def call(m, step):
        m.choices.append((call_again, step[1], len(m.trail), second, *step[2:]))
        return first(m, step)

    return call


def _with_fallback(handler, clauses):
    """Try the clauses only when the handler gives no solution at all."""

    def call(m, step):
        height = len(m.choices)
        m.choices.append((call_again, step[1], len(m.trail), clauses, *step[2:]))
        return handler(m, (handler, (handled, step[1], height), *step[2:]))

    return call


def handled(m, step):
    """The continuation of a goal with a fallback: there is a solution, so drop the choice point at the height in ``step``."""
    settle(m, step[2])
    return step[1]


# --------------------------------------------------------------------------------------------------------------------- images


@part
class _Traced:
    """The traced functors. Each proof asks `Traced`, so it has plain attributes."""

    @staticmethod
    def take():
        return dict(traced), traced.everything

    @staticmethod
    def put(state):
        traced.clear()
        named, traced.everything = state
        traced.update(named)

    @staticmethod
    def copy(state):
        named, everything = state
        return dict(named), everything


@part
class _Functors:
    """The functors. Modules refer to a `Functor`, so it is the same object in all images."""

    @staticmethod
    def take():
        return {
            name: (entry, entry.handler, entry.native, entry.native_group, entry.clauses, entry.compiler)
            for name, entry in functors.items()
        }

    @staticmethod
    def put(state):
        functors.clear()
        for name, (entry, *known) in state.items():
            entry.handler, entry.native, entry.native_group, entry.clauses, entry.compiler = known
            functors[name] = entry
        for name in traced.constructs:
            for watcher in watchers:
                watcher(name, functors.get(name))

    @staticmethod
    def copy(state):
        return {name: (entry, *known[:3], list(known[3]), known[4]) for name, (entry, *known) in state.items()}


@part
class _Code:
    """The compiled code of clauses. The code of other clauses refers to a `Predicate`, so that is the same object in all images, too."""

    @staticmethod
    def take():
        return {key: (predicate, predicate.call, predicate._relation) for key, predicate in _predicates.items()}

    @staticmethod
    def put(state):
        for key in [key for key, predicate in _predicates.items() if key not in state and not common(key[0])]:
            del _predicates[key]
        for predicate in _predicates.values():
            predicate.forget()
        for key, (predicate, predicate.call, predicate._relation) in state.items():
            _predicates[key] = predicate

    @staticmethod
    def copy(state):
        return {}
