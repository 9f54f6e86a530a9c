"""Resolving: from a description to the thing.

``reference`` resolves a designator once and gives the same value ever after; ``next-solution`` gives a new designator, equated to the
old one, that stands for the next possibility. Actions and motions are ground by Prolog (``action-grounding``, ``motion-grounding``),
locations by generators (``locations.py``), objects and humans by perception, which sets their data. Source: designators.md section 7.

While one task resolves a designator, others that want it wait and get the same value.
"""

from __future__ import annotations

from cramhy_runtime import kernel

from ..lisp import equality
from ..lisp.conditions import error
from ..lisp.data import UNBOUND, UNSUPPLIED, Cons, Symbol
from ..lisp.dynamic import special
from ..lisp.objects.generic import generic
from ..utilities.lazy_lists import from_iterator, lazy_car, lazy_cdr
from ..utilities.patterns import is_var
from ..prolog.query import ask
from ..prolog.terms import Var
from ..utilities.small_functions import current_timestamp
from .classes import ActionDesignator, Designator, DesignatorError, HumanDesignator, LocationDesignator, MotionDesignator, ObjectDesignator
from .equating import youngest
from .locations import location_solutions
from .protocol import designator_solutions_equal, equate, next_solution, reference
from .symbols import sym

DEFAULT_ROLE = special(sym("DESIG::*DEFAULT-ROLE*"))
ACTION_GROUNDING = sym("DESIG::ACTION-GROUNDING")
MOTION_GROUNDING = sym("DESIG::MOTION-GROUNDING")

resolve_designator = generic("DESIG::RESOLVE-DESIGNATOR", "(desig role)", documentation="""
Find what the designator stands for; called by reference. Methods on ``(eql role)`` resolve in their own way.""")
designator_pose = generic("DESIG::DESIGNATOR-POSE", "(desig)", documentation="""
The pose of an effective designator; nil before. Methods come from packages that know poses (cram-tf).""")
designator_distance = generic("DESIG::DESIGNATOR-DISTANCE", "(desig-1 desig-2)", documentation="""
The distance of two effective designators; nil if one is not effective.""")


def unresolved(designator, control):
    """Signal that ``designator`` cannot be resolved, with the text ``control``."""
    problem = DesignatorError(control, designator)
    problem.about = designator
    return error(problem)


@reference.method(Designator)
def _reference(designator, role=UNSUPPLIED):
    if designator.effective and not isinstance(designator, LocationDesignator) and designator.data is not None:
        return designator.data
    me = kernel.current()
    while designator.resolver is not None:
        if designator.resolver is me:
            return error("Recursive lock attempt: designator ~a is needed to resolve itself.", designator)
        other = designator.resolver
        designator.__dict__.setdefault("waiting", []).append(me)
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
        for task in designator.__dict__.pop("waiting", ()):
            kernel.unpark(task)


def _groundings(designator, predicate):
    for (value,) in ask(predicate, designator, Var()):
        if not (isinstance(value, Symbol) and is_var(value)):
            yield value


@resolve_designator.method(ActionDesignator, None)
@resolve_designator.method(MotionDesignator, None)
def _resolve_by_prolog(designator, role=None):
    # An action or motion without solution stays without, even when facts are added later: a new designator is tried afresh.
    action = isinstance(designator, ActionDesignator)
    if designator.solutions is UNBOUND:
        designator.solutions = from_iterator(_groundings(designator, ACTION_GROUNDING if action else MOTION_GROUNDING))
    value = lazy_car(designator.solutions)
    if value is None:
        return unresolved(designator, f"Cannot resolve {'action' if action else 'motion'} designator ~a.")
    designator.data = value
    return value


@resolve_designator.method(LocationDesignator, None)
def _resolve_location(designator, role=None):
    if designator.data is None:
        designator.data = location_solutions(designator)
        if designator.data is None:
            return unresolved(designator, "Unable to resolve designator `~a'")
    if designator.current_solution is None:
        designator.current_solution = lazy_car(designator.data)
    return designator.current_solution


@resolve_designator.method(ObjectDesignator, None)
def _resolve_object(designator, role=None):
    return designator.data if designator.data is not None else unresolved(
        designator, "Designator `~a' does not reference an object.")


@resolve_designator.method(HumanDesignator, None)
def _resolve_human(designator, role=None):
    return designator.data if designator.data is not None else unresolved(
        designator, "Designator `~a' does not reference an human.")


@next_solution.method(LocationDesignator)
def _next_location(designator):
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


@next_solution.method(ActionDesignator)
@next_solution.method(MotionDesignator)
def _next_grounding(designator):
    reference(designator)
    rest = lazy_cdr(designator.solutions)
    if rest is None:
        return None
    successor = (ActionDesignator if isinstance(designator, ActionDesignator) else MotionDesignator)(designator.description)
    successor.solutions = rest
    return equate(designator, successor)


@designator_solutions_equal.method(None, None)
def _equal_solutions(first, second):
    if isinstance(first, str) and isinstance(second, str):
        return True if first.lower() == second.lower() else None
    if isinstance(first, Cons) or isinstance(second, Cons):
        return equality.equal(first, second)
    if isinstance(first, list) and isinstance(second, list):
        return equality.equalp(first, second)
    return equality.eql(first, second)


@designator_pose.method(Designator, qualifier="around", uses_next=True)
def _pose_if_effective(next_method, designator):
    return next_method() if designator.effective is not None else None


@designator_distance.method(Designator, Designator, qualifier="around", uses_next=True)
def _distance_if_effective(next_method, first, second):
    return next_method() if first.effective is not None and second.effective is not None else None


def loc_desig_location(designator):
    """The reference of the current designator; nil if it is no location designator."""
    return reference(youngest(designator)) if isinstance(designator, LocationDesignator) else None


