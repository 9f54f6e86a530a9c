"""Variants: predicates with arguments that are known where they are called, and stay the same.

``(mem (house ?n dog red ?p ?q) ?houses)`` goes along a list and unifies each element with one and the same house. In a variant of
``mem`` for this call the house stands in the clauses:

    ((mem-of-house ?n ((house ?n dog red ?_ ?_) . ?_)))        ((mem-of-house ?n (?_ . ?t)) (mem-of-house ?n ?t))

The compiler writes the tests for such a head one by one. No house is built in order to be compared, and variables that occur nowhere else
in the caller, as ``?p`` and ``?q`` here, are neither made nor bound. The law: the answers are the same as without this.

An argument can be known if each clause has a variable there which it passes on to its own predicate, and which occurs once besides: two
occurrences would have to be the same house. A variant is written when it has been called some times. When the clauses change, so does it,
and if it cannot be written any more, it calls the predicate itself.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import Cons, Symbol, list_from, list_parts
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any
from cramhy_runtime.utilities.patterns import ANONYMOUS, variable

from ..engine.database import Clause, Predicate, find_predicate, functors, traced
from ..engine.services import SERVICES
from ..symbols import sym
from ..terms.terms import Var

if TYPE_CHECKING:
    from collections.abc import Callable, Container

    from ..engine.database import Functor
    from ..engine.machine import Machine

_LEAST, _MOST = 3, 24
"""The number of conses of an argument that is worth a variant."""
_CLAUSES = 8
_CALLS = 60
"""So often a variant calls the predicate itself before it is written."""
_UNIFIES, _FILTER = sym("CRAM-PROLOG::=="), sym("CRAM-PROLOG::FILTER-BINDINGS")


def variant_of_call(goal: Any, here: Container[object], later: Container[object]) -> tuple[Variant, list[object]] | tuple[None, None]:
    """A `Variant` for ``goal``, a call in a clause, and the list of its arguments there; ``(None, None)`` if none is worth it.

    ``here``: the variables of the clause that have occurred; ``later``: those of the goals after this one.
    """
    arguments = list(goal.cdr or ())
    positions = {i for i, argument in enumerate(arguments) if argument.__class__ is Cons and _LEAST <= _conses(argument) <= _MOST}
    if not positions or traced or not (positions := _staying(goal.car, len(arguments), positions)):
        return None, None
    counts = _occurrences(goal.cdr, {})
    patterns: list[object] = [None] * len(arguments)
    live: dict[object, Symbol] = {}

    def known(item: Any) -> object:
        if not variable(item) or item is ANONYMOUS:
            return item
        if counts[item] == 1 and item not in here and item not in later:
            return ANONYMOUS
        return live.setdefault(item, Symbol(item.name))

    for i in positions:
        patterns[i] = _replaced(arguments[i], known)
    given = [argument for i, argument in enumerate(arguments) if i not in positions]
    return Variant(find_predicate(goal.car, len(arguments)), patterns, list(live.values())), [*given, *live]


class Variant(Predicate):
    """The code of a predicate for calls with ``patterns``: Lisp data, or ``None`` for an argument that is not known.

    It is called with the arguments that are not known, and the values of ``live``, the variables of the patterns.
    """

    __slots__ = ("general", "patterns", "live", "calls")

    def __init__(self, general: Any, patterns: list[object], live: list[Symbol]):
        self.general, self.patterns, self.live = general, patterns, live
        self.calls = 0
        super().__init__(general.functor, patterns.count(None) + len(live))
        general.variants.add(self)

    def compile_and_call(self, m: Machine, step: tuple[Any, ...]) -> Any:
        """The first calls go to the predicate itself."""
        self.calls += 1
        if self.calls <= _CALLS:
            return self.call_general(m, step)
        self.compile()
        return self.call(m, (self.call, *step[1:]))

    def compile(self) -> None:
        """Make the code now, if the clauses allow for it."""
        general, positions = self.general, {i for i, pattern in enumerate(self.patterns) if pattern is not None}
        if (traced and self.functor in traced) or _staying(self.functor, general.arity, positions) != positions:
            self.call, self._relation = self.call_general, None
            return
        clauses = [self._clause(clause) for clause in functors[self.functor].clauses if len(clause.head.cdr or ()) == general.arity]
        self.call, self._relation = SERVICES.compile_clauses(self, clauses)

    def call_general(self, m: Machine, step: tuple[Any, ...]) -> tuple[Any, ...]:
        """The call function that calls the predicate itself."""
        given = iter(step[2:])
        arguments = [None if pattern is not None else next(given) for pattern in self.patterns]
        values = dict(zip(self.live, given, strict=True))
        for i, pattern in enumerate(self.patterns):
            if pattern is not None:
                arguments[i] = _replaced(pattern, lambda item: values.get(item) if item in values else Var() if variable(item) else item)
        return (self.general.call, step[1], *arguments)

    def _clause(self, clause: Clause) -> VariantClause:
        head = list(clause.head.cdr)
        known = {head[i]: pattern for i, pattern in enumerate(self.patterns) if pattern is not None}

        def goal(form: Any) -> Any:
            if form.__class__ is Cons and form.car is self.functor:
                given = [item for item, pattern in zip(form.cdr, self.patterns, strict=True) if pattern is None]
                return Cons(form.car, list_from([*given, *self.live]))
            return form

        arguments = [argument for argument, pattern in zip(head, self.patterns, strict=True) if pattern is None]
        form = list_from([list_from([*arguments, *self.live]), *map(goal, clause.goals or ())])
        form = _replaced(form, lambda item: known.get(item, item) if item.__class__ is Symbol and item is not ANONYMOUS else item)
        return VariantClause(Cons(self.functor, form.car), list(form.cdr or ()) or None, clause)


class VariantClause(Clause):
    """A clause of a variant, made of the clause ``original``."""

    __slots__ = ("original",)

    def __init__(self, head: Any, goals: list[Any] | None, original: Clause):
        super().__init__(head, goals, original.group, original.origin)
        self.original = original


def _staying(functor: Any, arity: int, positions: set[int]) -> set[int]:
    """Those of ``positions`` whose arguments stay the same and are used once, in all clauses of a predicate."""
    entry = functors.get(functor)
    if entry is None or not _plain(entry) or len(entry.clauses) > _CLAUSES or functor in traced:
        return set()
    left = set(positions)
    for clause in entry.clauses:
        head, end = list_parts(clause.head.cdr)
        if end is not None:
            return set()
        if len(head) == arity:
            left = {i for i in left if variable(head[i])}
            if left and not _uses(clause, functor, arity, head, left):
                return set()
    return left


def _plain(entry: Functor | None) -> bool:
    """Whether a functor has clauses of users and nothing else."""
    return entry is not None and bool(entry.clauses) and not (entry.native or entry.handler or entry.native_group or entry.compiler)


def _uses(clause: Clause, functor: Any, arity: int, head: list[Any], left: set[int]) -> bool:
    """Take from the set ``left`` the positions whose variables a clause uses otherwise. Returns False if none can be known."""
    others, own = [head], []
    for goal in clause.goals or ():
        if goal.__class__ is Cons and goal.car is functor:
            given, end = list_parts(goal.cdr)
            if end is not None or len(given) != arity:
                return False
            own.append(given)
        else:
            others.append(goal)
    for i in [*left]:
        if any(given[i] is not head[i] or head[i] is ANONYMOUS for given in own):
            left.discard(i)
    counts = _occurrences(list_from([list_from(head), *(clause.goals or ())]), {})
    if counts.get(functor, 0) > len(own) or _FILTER in counts:
        return False
    for i in [*left]:
        if head[i] is not ANONYMOUS and counts[head[i]] - 1 - len(own) > 1:
            left.discard(i)
    for goal in others[1:]:
        used = {i for i in left if goal.__class__ is not Cons or head[i] in _occurrences(goal, {})}
        if used and not (goal.__class__ is Cons and (goal.car is _UNIFIES or _plain(functors.get(goal.car)))):
            left -= used
    return True


def _occurrences(item: Any, counts: dict[object, int]) -> dict[object, int]:
    """Symbol → how often it stands in Lisp data."""
    waiting = [item]
    while waiting:
        item = waiting.pop()
        while item.__class__ is Cons:
            waiting.append(item.cdr)
            item = item.car
        if isinstance(item, Symbol):
            counts[item] = counts.get(item, 0) + 1
    return counts


def _conses(item: Any) -> int:
    """The number of conses of Lisp data with variables, or 0 if it has none."""
    waiting: list[Any] = [item]
    count, open_ = 0, False
    while waiting and count <= _MOST:
        item = waiting.pop()
        while item.__class__ is Cons and count <= _MOST:
            count += 1
            waiting.append(item.cdr)
            item = item.car
        open_ = open_ or variable(item)
    return count if open_ or count > _MOST else 0


def _replaced(item: Any, leaf: Callable[[Any], Any]) -> Any:
    """Lisp data with ``leaf(part)`` for each part that is not a cons."""
    if item.__class__ is not Cons:
        return leaf(item)
    return Cons(_replaced(item.car, leaf), _replaced(item.cdr, leaf))
