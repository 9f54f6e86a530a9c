"""The database: functors, their clauses, and the code that each compiles to.

All clauses of a functor form one predicate, whatever their number of arguments; since goals with other numbers of arguments
cannot unify, code is kept per functor and number of arguments, and made when a goal first needs it. A functor may have a
*handler*, tried first: when it gives no solution the clauses are tried (prolog.md 5.1); or *native facts*, Python code that
stands for the clauses of a built-in fact group and is followed by those that users add.

The compiler of clauses and the constructs of control stand above this module. They enter here what it needs of them:
`compile_clauses`, `warn_undefined`, the functors that are compiled `in_place`, and who wants to know of changes, `watchers`.
"""

from __future__ import annotations

from cramhy_runtime.lisp.data import Cons, list_from
from cramhy_runtime.lisp.packages import is_symbol

from . import origins
from .machine import call_again, fail, settle
from cramhy_runtime.utilities.patterns import variable
from .terms import deref


compile_clauses = None
"""``compile_clauses(predicate, clauses)``: a call function and the `Relation`, or ``None``; of the module ``compiler``."""
in_place: set = set()
"""Functors whose goals are compiled in place: when users give one clauses, all code is made anew."""
warn_undefined = None
"""``warn_undefined(machine, goal)`` warns of a goal whose functor nobody has defined; of the module ``undefined``."""
watchers: list = []
"""Functions that are called with the name of a functor and its entry, or ``None``, after its clauses have changed."""


class Traced(dict):
    """Functors whose goals are watched, in the order in which they were named.

    All of their calls go through `Predicate.call`, and no code repeats or replaces them.

    With ``everything`` all predicates are, but the constructs of control, the set ``constructs``, only if they are named.
    """

    everything = False
    constructs: set = set()

    def __contains__(self, functor):
        return dict.__contains__(self, functor) or (self.everything and functor not in self.constructs)

    def __bool__(self):
        return self.everything or len(self) > 0


traced = Traced()
"""The functors that are watched now. After a change of it call `forget_all`."""
watch = None
"""``watch(predicate, entry)``: the call function of a traced predicate, whose `Functor` may be ``None``; of the module ``tracing``."""


class Predicate:
    """The code for goals with ``functor`` and ``arity`` arguments: ``call(machine, (call, continuation, *arguments))``.

    """

    __slots__ = ("functor", "arity", "call", "_relation")

    def __init__(self, functor, arity):
        self.functor, self.arity = functor, arity
        self.forget()

    def forget(self):
        """Make the code anew at the next call."""
        self.call, self._relation = self.compile_and_call, False

    def compile(self):
        """Make the code now. Code that runs meanwhile goes on with what it has."""
        entry = functors.get(self.functor)
        if traced and self.functor in traced:
            self.call, self._relation = watch(self, entry if entry is not None and entry.defined else None), None
        elif entry is not None and entry.defined:
            self.call, self._relation = entry.code(self.arity)
        else:
            self.call, self._relation = _undefined(self.functor), None

    def as_relation(self):
        """The `Relation` whose rows are all that goals can be; ``None`` if there is more to them."""
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
    """A fact or rule: Lisp data of the ``head`` and of the list of ``goals``, and the group that it belongs to.

    ``origin``: the user's code that made it, see ``origins.py``.
    """

    __slots__ = ("head", "goals", "group", "origin")

    def __init__(self, head, goals, group, origin=None):
        self.head, self.goals, self.group, self.origin = head, goals, group, origin

    @property
    def position(self):
        """(file, line, column) of the form that made it, or ``None``."""
        return origins.position_of_origin(self.origin)


class Functor:
    """What is known of a functor.

    ``handler`` is a call function; ``native`` maps numbers of arguments (``None``: any) to call functions that stand for the
    clauses of the built-in fact group ``native_group``; ``clauses`` are those of users, in order. A functor of a built-in group
    without native facts is there to be extended: its goals just fail until users add clauses. ``compiler`` makes the call function
    of the clauses, where a room knows a better way than `compile_clauses`.
    """

    __slots__ = ("name", "handler", "native", "native_group", "clauses", "compiler")

    def __init__(self, name):
        self.name = name
        self.handler = self.native = self.native_group = self.compiler = None
        self.clauses = []

    @property
    def defined(self):
        return bool(self.clauses or self.handler) or self.native_group is not None

    def groups(self):
        """The names of the fact groups with clauses of this functor, oldest first."""
        found = {} if self.native_group is None else {self.native_group: None}
        for clause in self.clauses:
            found.setdefault(clause.group)
        return list(found)

    def code(self, arity):
        """The call function for goals with ``arity`` arguments, and the `Relation` if they are rows of one."""
        native = self.native and (self.native.get(arity) or self.native.get(None) or _failing)
        predicate = find_predicate(self.name, arity)
        if self.compiler is not None:
            from_clauses, relation = self.compiler(predicate, self.clauses)
        else:
            from_clauses, relation = compile_clauses(predicate, self.clauses) if self.clauses else (None, None)
        if self.handler is not None:
            return (_with_fallback(self.handler, from_clauses) if from_clauses else self.handler), None
        if native:
            return (_one_after_other(native, from_clauses) if from_clauses else native), None
        return from_clauses or _failing, relation


functors: dict[object, Functor] = {}
_predicates: dict[tuple, Predicate] = {}


def find_predicate(functor, arity):
    """The `Predicate` for a functor and a number of arguments; there is one whether it is defined or not."""
    found = _predicates.get((functor, arity))
    if found is None:
        found = _predicates[functor, arity] = Predicate(functor, arity)
    return found


def functor_entry(name):
    """The `Functor` of that name, made if need be."""
    found = functors.get(name)
    if found is None:
        found = functors[name] = Functor(name)
    return found


def changed(name):
    """Forget the compiled code of a functor. If its goals may be compiled into other predicates, forget all code."""
    global version
    version += 1
    for watcher in watchers:
        watcher(name, functors.get(name))
    for predicate in list(_predicates.values()):
        if predicate.functor is name or name in in_place:
            predicate.forget()


def forget_all():
    """Forget the compiled code of all functors, because other ones are traced now."""
    global version
    version += 1
    for name in traced.constructs:
        for watcher in watchers:
            watcher(name, functors.get(name))
    for predicate in list(_predicates.values()):
        predicate.forget()


version = 0
"""Counts the changes."""


def valid_functor(name):
    """A functor is a symbol, but neither ``nil`` nor a variable."""
    return name is not None and is_symbol(name) and not variable(name)


def extended(name):
    """Whether users have added clauses to a built-in."""
    entry = functors.get(name)
    return entry is not None and bool(entry.clauses)


def looked_up(name):
    """Whether goals of a built-in that could be compiled in place must be looked up: users have clauses for it, or it is traced."""
    return extended(name) or name in traced


# ------------------------------------------------------------------------------------------------------------------- calling


def arguments_of(goal):
    """The argument terms of a goal; its end may be a variable that stands for a list."""
    arguments, cell = [], deref(goal.cdr)
    while cell.__class__ is Cons:
        arguments.append(cell.car)
        cell = deref(cell.cdr)
    return arguments


def _undefined(functor):
    def call(m, step):
        return undefined_step(m, Cons(functor, list_from(step[2:])))

    return call


def undefined_step(m, goal):
    """Warn about the undefined functor of ``goal``, and fail."""
    warn_undefined(m, goal)
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
    """The continuation of a goal with a fallback, whose choice point is at the height in ``step``: there is a solution, drop it."""
    settle(m, step[2])
    return step[1]
