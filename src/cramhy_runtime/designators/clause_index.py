"""An index of clauses by the properties that they ask for.

The rules by which designators are ground all have one form:

    (<- (motion-grounding ?desig (drive ?motion))
      (desig-prop ?desig (:type :driving))
      (desig-prop ?desig (:speed ?speed))
      ...

so a designator without a speed, or of another type, fails them at once. Prolog indexes clauses by their first argument, and that is
the same variable everywhere; here the properties are the index. When the first argument of a goal is a designator, the clauses whose
first goals ask for a key that it lacks, or for another type, are left out before anything is proved. What is left is compiled as a
predicate of its own, once for each combination of clauses.

Nobody can tell the difference but by the clock: only goals ``desig-prop`` with a constant key at the very beginning of a body count,
which do nothing but fail, and the clauses that are left are tried in their order. If users have given ``desig-prop`` itself clauses,
nothing is left out.
"""

from __future__ import annotations

from ..lisp.data import Cons, Keyword, Symbol
from ..lisp.packages import keyword
from ..prolog.compiler import compile_clauses
from ..prolog.database import Predicate, changed, functor_entry
from ..prolog.terms import deref
from ..utilities.patterns import variable
from .classes import Designator
from .symbols import sym

DESIG_PROP = sym("DESIG::DESIG-PROP")
TYPE = keyword("TYPE")
_SHAPES = 1000
"""Shapes of designators that an index remembers the clauses for."""


def index_by_properties(functor, check=None):
    """Let the clauses of ``functor`` be looked up by the designator that is the first argument of its goals.

    ``check(machine, step)`` is called before each goal.
    """
    functor_entry(functor).compiler = lambda predicate, clauses: (ClauseIndex(predicate, clauses, check).call, None)
    changed(functor)


class ClauseIndex:
    """The clauses of one predicate, and the code for those combinations of them that designators have needed so far."""

    def __init__(self, predicate, clauses, check):
        self.predicate, self.clauses, self.check = predicate, clauses, check
        self.demands = [_demands(clause) for clause in clauses]
        self.of_shape = {}  # type and keys of a designator -> call function
        self.of_clauses = {}  # numbers of clauses -> call function
        self.everything = self._code(range(len(clauses)))
        self.properties = functor_entry(DESIG_PROP)

    def call(self, m, step):
        """The call function of the predicate."""
        if self.check is not None:
            self.check(m, step)
        designator = deref(step[2])
        if not isinstance(designator, Designator) or self.properties.clauses:
            return self.everything(m, step)
        shape = []
        type_ = None
        cell = designator.description
        while cell.__class__ is Cons:
            entry = cell.car
            if entry.__class__ is Cons:
                key = entry.car
                if key is TYPE:
                    if type_ is not None:  # of two types: either could be meant
                        return self.everything(m, step)
                    type_ = entry.cdr.car if entry.cdr.__class__ is Cons else None
                    if type_.__class__ is not Keyword:
                        return self.everything(m, step)
                elif key.__class__ is Keyword:
                    shape.append(key)
            cell = cell.cdr
        shape.append(type_)
        shape = tuple(shape)
        code = self.of_shape.get(shape)
        if code is None:
            code = self._for_shape(type_, shape[:-1])
            if len(self.of_shape) < _SHAPES:
                self.of_shape[shape] = code
        return code(m, step)

    def _for_shape(self, type_, keys):
        present = {*keys, TYPE} if type_ is not None else set(keys)
        return self._code([number for number, demands in enumerate(self.demands)
                           if all(key in present and (key is not TYPE or value is None or value is type_) for key, value in demands)])

    def _code(self, numbers):
        numbers = tuple(numbers)
        found = self.of_clauses.get(numbers)
        if found is None:
            # The name is one that no goal has: a goal of the predicate itself in a body is to come back to the index.
            part = Predicate(Symbol(self.predicate.functor.name), self.predicate.arity)
            part.call, part.relation = compile_clauses(part, [self.clauses[number] for number in numbers])
            found = self.of_clauses[numbers] = part.call
        return found


def _demands(clause):
    """The properties without which ``clause`` fails at once: pairs of a key and, for the type, the value, or ``None`` for any."""
    first = clause.head.cdr.car if isinstance(clause.head.cdr, Cons) else None
    if not variable(first):
        return []
    found = []
    for goal in clause.goals or ():
        asked = _property_of(first, goal)
        if asked is None:
            break
        key, value = asked
        found.append((key, value if key is TYPE and isinstance(value, Keyword) else None))
    return found


def _property_of(first, goal):
    """(key, value) if ``goal`` is ``(desig-prop first (key value))`` with a keyword as key, else ``None``."""
    if isinstance(goal, Cons) and goal.car is DESIG_PROP and len(goal) == 3:
        _, designator, pair = goal
        if designator is first and isinstance(pair, Cons) and len(pair) == 2 and pair.cdr.cdr is None and isinstance(pair.car, Keyword):
            return pair.car, pair.cdr.car
    return None
