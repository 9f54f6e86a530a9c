"""Control: conjunction, disjunction, negation, conditions, cut, and calls of goals that are data.

The compiler of clauses compiles these constructs in place (``compiler/clause_bodies.py``). This module proves goals that are data: the
goals of queries, and the arguments of ``call``.

Each construct is a function of the machine, the list of its argument terms, its continuation and the *barrier*: the height of
the choice point stack at which the enclosing clause or query was entered, and to which ``(cut)`` cuts. ``and`` and the branches of
``->`` and ``*->`` pass the barrier on; ``or`` and all others are barriers of their own. In the original, a cut inside ``not``, ``once``,
``call``, ``findall`` and the like destroys the whole construct; here it stops at the barrier (prolog.md section 10).
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.conditions import type_error
from cramhy_runtime.lisp_core.data import FLOATS, Cons, Keyword, Symbol, list_from

from ..engine import database
from ..engine.database import arguments_of, find_predicate, handled, undefined_step, valid_functor
from ..engine.machine import FAIL, SOLVED, Machine, call_again, fail, proceed, settle
from ..engine.services import SERVICES
from .native_predicates import refuse_count
from ..symbols import sym
from ..terms.terms import UNSET, Restore, TermTail, Var, copy_term, deref, raw, undo, unify, unset_variables

_PLAIN = frozenset([Symbol, Keyword, int, str, *FLOATS])

CONTROL: dict = {}
"""Functor → control function. `extend` replaces it while users have facts for the functor."""
_BASE: dict = {}


def _control(name, least=0, most=None):
    """Decorator: define the control construct ``name`` by a function of the arguments, whose number is checked."""

    def define(function):
        def call(m, terms, k, b):
            arguments = arguments_of(Cons(None, terms))
            if len(arguments) < least or (most is not None and len(arguments) > most):
                return refuse_count(name, len(arguments), least, most)
            return function(m, k, b, *arguments)

        symbol = sym(name)
        CONTROL[symbol] = _BASE[symbol] = call
        return function

    return define


def extend(name, entry):
    """Let the control construct ``name`` try the clauses of users, in ``entry``, when it has no solution."""
    base = _BASE.get(name)
    if base is None:
        return
    if database.traced and name in database.traced:
        base = SERVICES.watch_construct(name, base)
    if entry is None or not entry.clauses:
        CONTROL[name] = base
        return

    def with_fallback(m, terms, k, b):
        height = len(m.choices)
        arguments = arguments_of(Cons(name, terms))
        m.choices.append((call_again, k, len(m.trail), find_predicate(name, len(arguments)).call, *arguments))
        return base(m, terms, (handled, k, height), b if b <= height else height)

    CONTROL[name] = with_fallback


database.watchers.append(extend)


# ------------------------------------------------------------------------------------------------------------ solving goals


def solve(m, goal, k, b):
    """The step that proves a goal term. The functor is looked up now, so a goal can be data."""
    if goal.__class__ is not Cons:
        goal = deref(goal)
        if goal is None:
            return undefined_step(m, None, k)
        if goal.__class__ is not Cons:
            return type_error(raw(goal, m.names), "LIST")
    functor = goal.car
    construct = CONTROL.get(functor)
    if construct is not None:
        return construct(m, goal.cdr, k, b)
    if functor.__class__ is Var or not valid_functor(functor):
        return undefined_step(m, goal, k)
    arguments, cell = [], goal.cdr
    while cell.__class__ is Cons:
        arguments.append(cell.car)
        cell = cell.cdr
    if cell is not None:
        arguments = arguments_of(goal)
        end = deref(goal.cdr)
        while end.__class__ is Cons:
            end = deref(end.cdr)
        lengths = database.lengths_of_heads(functor, len(arguments)) if end.__class__ is Var else ()
        if lengths:
            return _with_end(m, k, functor, arguments, end, lengths)
    predicate = find_predicate(functor, len(arguments))
    return (predicate.call, k, *arguments)


def _with_end(m: Machine, k: object, functor: Symbol, arguments: list[object], end: Var, lengths: list[int]) -> tuple[object, ...]:
    """The step that proves a goal whose ``arguments`` end in an unset variable, for heads of the first of ``lengths``, then the others."""
    if len(lengths) > 1:
        m.choices.append((_with_next_end, k, len(m.trail), functor, arguments, end, lengths[1:]))
    others = [Var() for _ in range(lengths[0] - len(arguments))]
    unify(end, list_from(others), m.trail)
    return (find_predicate(functor, lengths[0]).call, k, *arguments, *others)


def _with_next_end(m: Machine, step: tuple[object, object, int, Symbol, list[object], Var, list[int]]) -> tuple[object, ...]:
    m.choices.pop()
    return _with_end(m, step[1], *step[3:])


Machine.solve = solve  # a method, so that a machine which explains its proof sees the goals inside of constructs, too


def _solve_rest(m, step):
    _, k, goals, b = step
    return solve_all(m, goals, k, b)


def solve_all(m, goals, k, b):
    """The step that proves a list of goals one after the other."""
    goals = goals if goals.__class__ is Cons else deref(goals)
    if goals is None:
        return k
    if goals.__class__ is not Cons:
        return type_error(raw(goals, m.names), "LIST")
    rest = goals.cdr if goals.cdr.__class__ is Cons else deref(goals.cdr)
    return m.solve(goals.car, k if rest is None else (_solve_rest, k, rest, b), b)


def _and(m, terms, k, b):
    return solve_all(m, terms, k, b)


CONTROL[sym("AND")] = _BASE[sym("AND")] = _and


def _or(m, terms, k, b):
    """Prove one branch after the other. It is a barrier: a cut in a branch drops the other alternatives of it and the later branches."""
    terms = deref(terms)
    if terms is not None and terms.__class__ is not Cons:
        return type_error(raw(terms, m.names), "LIST")
    return FAIL if terms is None else _branch(m, k, terms)


def _branch(m, k, terms):
    rest = deref(terms.cdr)
    if rest.__class__ is not Cons:
        rest = None
    height = len(m.choices)
    if rest is not None:
        m.choices.append((_next_branch, k, len(m.trail), rest))
    return m.solve(terms.car, k, height)


def _next_branch(m, step):
    m.choices.pop()
    return _branch(m, step[1], step[3])


CONTROL[sym("OR")] = _BASE[sym("OR")] = _or


@_control("CRAM-PROLOG::CUT", 0, 0)
def _cut(m, k, b):
    del m.choices[b:]
    return k


@_control("CRAM-PROLOG::TRUE", 0, 0)
def _true(m, k, b):
    return k


@_control("CRAM-PROLOG::FAIL", 0, 0)
def _fail(m, k, b):
    return fail(m)


@_control("NOT", 1, 1)
def _not(m, k, b, goal):
    height = len(m.choices)
    m.choices.append((proceed, k, len(m.trail)))
    return m.solve(goal, (refute, k, height), height + 1)


def refute(m, step):
    """The continuation of a goal that must not succeed: fail, and drop its choice points and the one below them."""
    del m.choices[step[2] :]
    return fail(m)


@_control("CRAM-PROLOG::ONCE")
def _once(m, k, b, *goals):
    height = len(m.choices)
    return solve_all(m, list_from(goals), (commit, k, height), height)


def commit(m, step):
    """The continuation of a goal that needs one solution only: drop its choice points."""
    _, k, height = step
    del m.choices[height:]
    return k


@_control("CRAM-PROLOG::CALL", 1, 1)
def _call(m, k, b, goal):
    return m.solve(goal, k, len(m.choices))


_FAIL_GOAL = Cons(sym("CRAM-PROLOG::FAIL"), None)


@_control("CRAM-PROLOG::->", 2, 3)
def _if(m, k, b, condition, then, otherwise=_FAIL_GOAL):
    height = len(m.choices)
    m.choices.append((_otherwise, k, len(m.trail), otherwise, b))
    return m.solve(condition, (_then, k, then, b, height), height + 1)


def _otherwise(m, step):
    m.choices.pop()
    return m.solve(step[3], step[1], step[4])


def _then(m, step):
    _, k, goal, b, height = step
    del m.choices[height:]
    return m.solve(goal, k, b)


@_control("CRAM-PROLOG::*->", 2, 3)
def _soft_if(m, k, b, condition, then, otherwise=_FAIL_GOAL):
    height = len(m.choices)
    m.choices.append((_otherwise, k, len(m.trail), otherwise, b))
    return m.solve(condition, (_soft_then, k, then, b, height), height + 1)


def _soft_then(m, step):
    _, k, goal, b, height = step
    settle(m, height)
    return m.solve(goal, k, b)


_NOT, _AND = sym("NOT"), sym("AND")


@_control("CRAM-PROLOG::FORALL", 2, 2)
def _forall(m, k, b, condition, action):
    unmet = list_from([_AND, Cons(sym("CRAM-PROLOG::CALL"), Cons(condition)), list_from([_NOT, action])])
    return _not(m, k, b, unmet)


# ------------------------------------------------------------------------------------------------------ collecting solutions


class Instances:
    """The instances of ``template`` for all solutions of a goal, proved in a machine of its own.

    The goal is copied, so the instances do not change when this proof backtracks, and can be computed later. A variable that a
    solution leaves unset is the variable of this proof, or a new one.
    """

    __slots__ = ("proof", "template", "originals")

    def __init__(self, m, template, copies, step):
        """``copies`` maps the variables of this proof to those of ``template`` and of ``step``, which proves the goal."""
        self.template = template
        self.originals = {copy: variable for variable, copy in copies.items()}
        self.proof = m.nested({copy.name: copy for copy in self.originals if copy.name is not None})
        self.proof.prove(step)

    def remaining(self):
        """All instances that are left, as a Python list."""
        found, template, originals = [], self.template, self.originals
        append = found.append

        def collect():
            value = template.ref
            append(value if value.__class__ in _PLAIN else copy_term(template, originals.copy()))

        self.proof.drain(collect if template.__class__ is Var else lambda: append(copy_term(template, originals.copy())))
        return found

    def lazy_list(self):
        """The instances as a lazy list, whose first element is computed now."""
        if not self.proof.next_solution():
            return None
        return Cons(copy_term(self.template, self.originals.copy()), TermTail(self.lazy_list, self.remaining))


def _instances(m, template, goal):
    """The `Instances` for a goal that is data."""
    copies = {}
    goal, template = copy_term(goal, copies), copy_term(template, copies)
    return Instances(m, template, copies, (_solve_goal, SOLVED, goal))


def _compiled_instances(m, function, terms, position):
    """The `Instances` for a goal that is code: ``function`` gets copies of ``terms``.

    The template is the term at ``position``; if that is ``None``, a variable that the function gets before them.
    """
    copies, template = {}, Var() if position is None else None
    terms = [copy_term(term, copies) for term in terms]
    return Instances(m, template if position is None else terms[position], copies, (function, SOLVED, template, *terms))


def _solve_goal(m, step):
    return m.solve(step[2], step[1], 0)


def findall(m, function, terms, position):
    """The list for ``findall`` in compiled code (see `_compiled_instances`). Also for `bagof`, which fails on ``None``, no solution."""
    return _compiled_instances(m, function, terms, position).lazy_list()


bagof = findall


def setof(m, function, terms, position):
    """As `findall`, for ``setof``: a list without repetitions, or ``None``."""
    return list_from(_distinct(_compiled_instances(m, function, terms, position).remaining()))


@_control("CRAM-PROLOG::FINDALL", 3, 3)
def _findall(m, k, b, template, goal, result):
    return k if m.unify(result, _instances(m, template, goal).lazy_list()) else fail(m)


@_control("CRAM-PROLOG::BAGOF", 3, 3)
def _bagof(m, k, b, template, goal, result):
    found = _instances(m, template, goal).lazy_list()
    return k if found is not None and m.unify(result, found) else fail(m)


@_control("CRAM-PROLOG::SETOF", 3, 3)
def _setof(m, k, b, template, goal, result):
    found = _distinct(_instances(m, template, goal).remaining())
    return k if found and m.unify(result, list_from(found)) else fail(m)


def _distinct(items):
    """``items`` without repetitions: of equal items the last one stays."""
    return [item for i, item in enumerate(items) if not any(_same(item, other) for other in items[i + 1 :])]


def _same(a, b):
    """``equal`` for terms: whether they are the same without setting a variable."""
    trail = []
    if a is b:
        return True
    same = unify(a, b, trail) and not trail
    undo(trail, 0)
    return same


@_control("EVERY", 2, 2)
def _every(m, k, b, generator, pattern):
    """Prove ``pattern`` for all solutions of ``generator`` together: its other variables have one value throughout."""
    goals = _instances(m, pattern, generator).remaining()
    return solve_all(m, list_from(goals), k, len(m.choices))


# ------------------------------------------------------------------------------------------------------------ filter-bindings


def _filter_bindings(names_of_query):
    def filter_bindings(m, k, b, variables=None, *goals):
        goals = list_from(goals)
        return solve_all(m, goals, (_keep_only, k, variables, goals, names_of_query), len(m.choices))

    return filter_bindings


def _keep_only(m, step):
    """Unset every variable in reach except the listed ones, which keep their present values."""
    _, k, variables, goals, names_of_query = step
    kept, dropped = _written_variables(variables), _written_variables(goals)
    if names_of_query:
        for variable in m.names.values():
            if variable.__class__ is Var:
                dropped.setdefault(variable)
    values = [(variable, copy_term(variable, {v: v for v in unset_variables(variable, {})})) for variable in kept]
    for variable in dropped:
        if variable not in kept and variable.ref is not UNSET:
            m.trail.append(Restore(variable))
            variable.ref = UNSET
    for variable, value in values:
        if variable.ref is not UNSET:
            m.trail.append(Restore(variable))
            variable.ref = value
    return k


def _written_variables(term):
    found, stack = {}, [term]
    while stack:
        item = stack.pop()
        while item.__class__ is Cons:
            stack.append(item.cdr)
            item = item.car
        if item.__class__ is Var:
            found.setdefault(item)
    return found


_FILTER = sym("CRAM-PROLOG::FILTER-BINDINGS")
_control("CRAM-PROLOG::FILTER-BINDINGS")(_filter_bindings(True))
_FILTER_IN_QUERY = CONTROL[_FILTER]
_control("CRAM-PROLOG::FILTER-BINDINGS")(_filter_bindings(False))
_FILTER_IN_CLAUSE = CONTROL[_FILTER]
CONTROL[_FILTER] = _BASE[_FILTER] = _FILTER_IN_QUERY


database.in_place.update(CONTROL)
database.traced.constructs.update(CONTROL)


def in_clause(functor):
    """The control function for a goal that stands in a clause."""
    if functor is not _FILTER or database.extended(functor):
        return CONTROL[functor]
    return SERVICES.watch_construct(functor, _FILTER_IN_CLAUSE) if functor in database.traced else _FILTER_IN_CLAUSE
