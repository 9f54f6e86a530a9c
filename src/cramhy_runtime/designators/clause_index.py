"""An index of clauses by the properties that they ask for.

All rules that ground designators have one form:

    (<- (motion-grounding ?desig (drive ?motion))
      (desig-prop ?desig (:type :driving))
      (desig-prop ?desig (:speed ?speed))
      ...

so they fail at once for a designator without a speed, or of another type. Prolog indexes clauses by their first argument, but that is
the same variable everywhere; here the properties are the index. When the first argument of a goal is a designator, the clauses whose
first goals ask for a key that it lacks, or for another type, are left out before anything is proved. In the other clauses these goals
become arguments: the clause above is proved as if it were

    (<- (motion-grounding ?desig (drive ?motion) :driving ?speed)
      ...

for a goal that has the values as arguments. This is compiled once for each set of keys and type that designators have.

The result is the same, only faster: the index uses only goals ``desig-prop`` with a constant key at the very beginning of a body, which
can do nothing but fail, and the other clauses are tried in their order. Everything is proved as it is written for a designator with two
properties of one key, and also when users have given ``desig-prop`` itself clauses, or trace it.
"""

from __future__ import annotations

from operator import itemgetter

from cramhy_runtime.lisp_core.data import Cons, Keyword, Symbol, list_from
from cramhy_runtime.lisp_core.packages import keyword
from cramhy_runtime.kernel.typing_names import Any
from cramhy_runtime.prolog.compiler.compiler import compile_clauses
from cramhy_runtime.prolog.engine.database import Clause, Predicate, changed, functor_entry, traced
from cramhy_runtime.prolog.builtins.function_calls import BREAK_ON_LISP_ERRORS
from cramhy_runtime.prolog.engine.machine import fail
from cramhy_runtime.prolog.compiler.generated_code import proper
from cramhy_runtime.prolog.terms.terms import Var, deref
from ..utilities.patterns import ANONYMOUS, variable
from .classes import Designator
from .symbols import sym

DESIG_PROP = sym("DESIG::DESIG-PROP")
TYPE = keyword("TYPE")
_SHAPES = 1000
"""An index remembers the clauses for so many shapes of designators."""


def index_by_properties(functor, check=None):
    """Look up the clauses of ``functor`` by the designator that is the first argument of its goals.

    ``check(machine, step)`` is called before each goal while ``*break-on-lisp-errors*`` is true.
    """
    functor_entry(functor).compiler = lambda predicate, clauses: (ClauseIndex(predicate, clauses, check).call, None)
    changed(functor)


class ClauseIndex:
    """The clauses of one predicate, and the code for those combinations of them that designators have needed so far."""

    def __init__(self, predicate, clauses, check):
        self.predicate, self.clauses, self.check = predicate, clauses, check
        self.code, _ = compile_clauses(predicate, clauses) if clauses else (_failing, None)
        self.rules = [_Rule(clause) for clause in clauses]
        self.of_shape = {}  # (type, key...) -> the keys whose values are arguments, and the call function
        self.properties = functor_entry(DESIG_PROP)

    def call(self, m, step):
        """The call function of the predicate."""
        if self.check is not None and BREAK_ON_LISP_ERRORS.value is not None:
            self.check(m, step)
        designator = step[2]
        if designator.__class__ is Var:
            designator = deref(designator)
        if not isinstance(designator, Designator) or self.properties.clauses or (traced and DESIG_PROP in traced):
            return self.code(m, step)
        values, count = {}, 0
        cell = designator.description
        try:
            while cell is not None:
                entry = cell.car
                rest = entry.cdr
                if rest.cdr is not None:
                    break
                values[entry.car] = rest.car
                count += 1
                cell = cell.cdr
        except (AttributeError, TypeError):  # no list of pairs, or a key that is no symbol
            cell = True
        if cell is not None or len(values) != count:
            return self.code(m, step)
        type_ = values.get(TYPE)
        shape = (type_ if type_.__class__ is Keyword else None, *values)
        found = self.of_shape.get(shape)
        if found is None:
            found = self._for_shape(shape)
            if len(self.of_shape) < _SHAPES:
                self.of_shape[shape] = found
        pick, code = found
        return code(m, (code, step[1], designator, *step[3:], *pick(values)))

    def _for_shape(self, shape):
        """(A function that picks the arguments from the dict of values, the call function)."""
        type_, keys = shape[0], frozenset(shape[1:])
        rules = [rule for rule in self.rules if rule.fits(type_, keys)]
        if not rules:
            return _nothing, _failing
        if not all(proper(rule.clause.head) for rule in rules):  # the end of a dotted head would take the values for itself
            return _nothing, self.code
        wanted = list(
            dict.fromkeys(key for rule in rules for key, value in rule.values.items() if key is not TYPE or not isinstance(value, Keyword))
        )
        # The name is one that no goal has: a goal of the predicate itself in a body is to come back to the index.
        part = Predicate(Symbol(self.predicate.functor.name), self.predicate.arity + len(wanted))
        part.call, _ = compile_clauses(part, [rule.with_arguments(wanted) for rule in rules])
        pick = _nothing if not wanted else itemgetter(*wanted) if len(wanted) > 1 else lambda values, key=wanted[0]: (values[key],)
        return pick, part.call


def _nothing(values):
    return ()


def _failing(m, step):
    return fail(m)


class _Rule:
    """A clause. ``values`` are the properties for which its first goals ask: key → pattern."""

    def __init__(self, clause):
        self.clause = clause
        self.values: dict[Keyword, Any] = {}
        self.goals = list(clause.goals or ())
        designator = clause.head.cdr.car if isinstance(clause.head.cdr, Cons) else None
        if variable(designator) and designator is not ANONYMOUS and proper(clause.head):
            while self.goals:
                key, value = _property_of(designator, self.goals[0])
                if key is None or key in self.values:
                    break
                self.values[key] = value
                del self.goals[0]

    def fits(self, type_, keys):
        """Whether a designator of that type, with this set of keys, can satisfy the clause."""
        if not keys.issuperset(self.values):
            return False
        wanted = self.values.get(TYPE)
        return not isinstance(wanted, Keyword) or wanted is type_

    def with_arguments(self, keys):
        """The clause with the values of ``keys`` as further arguments, without the goals that ask for them."""
        head = list_from([*self.clause.head, *(self.values.get(key, ANONYMOUS) for key in keys)])
        return Clause(head, self.goals or None, self.clause.group)


def _property_of(designator, goal):
    """(key, value) if ``goal`` is ``(desig-prop designator (key value))`` with a keyword as key, else two ``None``."""
    if isinstance(goal, Cons) and goal.car is DESIG_PROP and proper(goal) and len(goal) == 3:
        _, of, pair = goal
        if of is designator and isinstance(pair, Cons) and proper(pair) and len(pair) == 2 and isinstance(pair.car, Keyword):
            return pair.car, pair.cdr.car
    return None, None
