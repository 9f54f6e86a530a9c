"""Resolving: from a description to the thing.

``reference`` resolves a designator once and gives the same value ever after; ``next-solution`` gives a new designator, equated to the
old one, that stands for the next possibility. Actions and motions are ground by Prolog (``action-grounding``, ``motion-grounding``),
locations by generators (``locations.py``), objects and humans by perception, which sets their data. Source: designators.md section 7.

While one task resolves a designator, others that want it wait and get the same value.
"""

from __future__ import annotations

from cramhy_runtime import kernel

from ..cpl.fluents import function_of
from ..lisp.conditions import error, make_condition
from ..lisp.data import UNBOUND, UNSUPPLIED, Symbol
from ..prolog.lazy_lists import from_iterator, lazy_car, lazy_cdr
from ..prolog.patterns import is_var
from ..prolog.query import ask
from ..prolog.terms import Var
from ..prolog.utilities import current_timestamp
from .classes import (ActionDesignator, DesignatorError, HumanDesignator, LocationDesignator, MotionDesignator,
                      ObjectDesignator)
from .equating import equate
from .locations import location_solutions
from .symbols import sym

DEFAULT_ROLE = sym("DESIG::*DEFAULT-ROLE*")
DEFAULT_ROLE.special = True
if DEFAULT_ROLE.value is UNBOUND:
    DEFAULT_ROLE.value = None

ACTION_GROUNDING = sym("DESIG::ACTION-GROUNDING")
MOTION_GROUNDING = sym("DESIG::MOTION-GROUNDING")
_resolvers = {}  # role -> [(class, function)], the newest first


def define_resolver(cls, role, function):
    """Resolve designators of ``cls`` by ``function(designator, role)`` when the role is ``role``: a method on ``(eql role)``."""
    _resolvers.setdefault(role, []).insert(0, (cls, function_of(function)))


def unresolved(designator, control):
    """Signal that ``designator`` cannot be resolved, with the text ``control``."""
    problem = make_condition(DesignatorError(control, designator))
    problem.about = designator
    return error(problem)


def reference(designator, role=UNSUPPLIED):
    """What ``designator`` stands for, always the same object; a ``designator-error`` if that cannot be found."""
    if designator.effective and not isinstance(designator, LocationDesignator) and designator.data is not None:
        return designator.data
    me = kernel.current()
    while designator.resolver is not None:
        if designator.resolver is me:
            return error("Recursive lock attempt: designator ~a is needed to resolve itself.", designator)
        other = designator.resolver
        designator.waiting = [*getattr(designator, "waiting", ()), me]
        kernel.park(lambda other=other: f"the designator that {other.name} resolves")
    designator.resolver = me
    try:
        result = resolve_designator(designator, DEFAULT_ROLE.value if role is UNSUPPLIED else role)
        designator.effective = True
        if designator.timestamp is None:
            designator.timestamp = current_timestamp()
        return result
    finally:
        designator.resolver = None
        if "waiting" in designator.__dict__:
            for task in designator.__dict__.pop("waiting"):
                kernel.unpark(task)


def resolve_designator(designator, role=None):
    """Find the solution, by the resolver for ``role`` if there is one, else by the kind of designator."""
    for cls, function in _resolvers.get(role, ()):
        if isinstance(designator, cls):
            return function(designator, role)
    if isinstance(designator, (ActionDesignator, MotionDesignator)):
        return _resolve_by_prolog(designator)
    if isinstance(designator, LocationDesignator):
        return _resolve_location(designator)
    if isinstance(designator, (ObjectDesignator, HumanDesignator)):
        if designator.data is not None:
            return designator.data
        kind = "object" if isinstance(designator, ObjectDesignator) else "human"
        return unresolved(designator, f"Designator `~a' does not reference an {kind}.")
    from ..lisp.generic import no_applicable_method

    return no_applicable_method("CRAM-DESIGNATORS:RESOLVE-DESIGNATOR", (designator, role))


def _groundings(designator, predicate):
    for (value,) in ask(predicate, designator, Var()):
        if not (isinstance(value, Symbol) and is_var(value)):
            yield value


def _resolve_by_prolog(designator):
    # An action or motion without solution stays without, even when facts are added later: a new designator is tried afresh.
    action = isinstance(designator, ActionDesignator)
    if designator.solutions is UNBOUND:
        designator.solutions = from_iterator(_groundings(designator, ACTION_GROUNDING if action else MOTION_GROUNDING))
    value = lazy_car(designator.solutions)
    if value is None:
        return unresolved(designator, f"Cannot resolve {'action' if action else 'motion'} designator ~a.")
    designator.data = value
    return value


def _resolve_location(designator):
    if designator.data is None:
        designator.data = location_solutions(designator)
        if designator.data is None:
            return unresolved(designator, "Unable to resolve designator `~a'")
    if designator.current_solution is None:
        designator.current_solution = lazy_car(designator.data)
    return designator.current_solution


def next_solution(designator):
    """A designator for the next possibility, equated to ``designator``, or nil. For locations always the same object."""
    if isinstance(designator, LocationDesignator):
        if designator.effective is None:
            reference(designator)
        if designator.successor is not None:
            return designator.successor
        rest = lazy_cdr(designator.data)
        if rest is None:
            return None
        successor = designator.__class__(designator.description)
        successor.data = rest
        return equate(designator, successor)
    if isinstance(designator, (ActionDesignator, MotionDesignator)):
        reference(designator)
        rest = lazy_cdr(designator.solutions)
        if rest is None:
            return None
        successor = (ActionDesignator if isinstance(designator, ActionDesignator) else MotionDesignator)(designator.description)
        successor.solutions = rest
        return equate(designator, successor)
    from ..lisp.generic import no_applicable_method

    return no_applicable_method("CRAM-DESIGNATORS:NEXT-SOLUTION", (designator,))


def designator_solutions_equal(first, second):
    """Whether two solutions are the same: strings without case, lists by ``equal``, arrays by ``equalp``, else ``eql``."""
    from ..lisp import equality
    from ..lisp.data import Cons

    if isinstance(first, str) and isinstance(second, str):
        return True if first.lower() == second.lower() else None
    if isinstance(first, Cons) or isinstance(second, Cons):
        return equality.equal(first, second)
    if isinstance(first, list) and isinstance(second, list):
        return equality.equalp(first, second)
    return equality.eql(first, second)


def designator_pose(designator):
    """The pose of an effective designator; nil before. Methods come from packages that know poses (cram-tf)."""
    return None if designator.effective is None else _no_primary_method("DESIGNATOR-POSE", designator)


def designator_distance(first, second):
    """The distance of two effective designators; nil if one is not effective."""
    if first.effective is None or second.effective is None:
        return None
    return _no_primary_method("DESIGNATOR-DISTANCE", first, second)


def _no_primary_method(name, *arguments):
    return error("There is no primary method for the generic function ~a when called with ~s.", name, list(arguments))


def loc_desig_location(designator):
    """The reference of the current designator; nil if it is no location designator."""
    from .equating import current_desig

    return reference(current_desig(designator)) if isinstance(designator, LocationDesignator) else None


