"""Resolving: from a description to the thing.

``reference`` resolves a designator once and returns the same value from then on. ``next-solution`` returns a new designator for the next
solution, equated to the old one. Prolog grounds actions and motions (``action-grounding``, ``motion-grounding``), generators find
locations (``locations.py``), and perception sets the data of objects and humans. Source: designators.md section 7.

While one task resolves a designator, other tasks that need it wait and get the same value.
"""

from __future__ import annotations

from cramhy_runtime import kernel

from cramhy_runtime.lisp_core import equality
from cramhy_runtime.lisp_core.conditions import error
from cramhy_runtime.lisp_core.data import UNBOUND, UNSUPPLIED, Cons, Symbol, lisp_list
from cramhy_runtime.lisp_core.dynamic import special
from cramhy_runtime.lisp_core.dispatch.generic_functions import generic
from cramhy_runtime.lisp_core.dispatch.generic_errors import NoApplicableMethodError
from ..utilities.lazy_lists import beginning, lazy_car, lazy_cdr, tail
from ..utilities.patterns import is_var
from cramhy_runtime.prolog.engine.database import find_predicate
from cramhy_runtime.prolog.engine.machine import SOLVED, Machine
from cramhy_runtime.prolog.terms.terms import Var, resolve
from ..utilities.small_functions import current_timestamp
from .classes import (
    ActionDesignator,
    Designator,
    DesignatorError,
    HumanDesignator,
    LocationDesignator,
    MotionDesignator,
    ObjectDesignator,
    new,
    setter,
)
from .equating import youngest
from .failure_causes import note_causes
from .locations import location_solutions, why_no_place
from .shared_calls import await_resolver, serve, share_call
from .protocol import designator_solutions_equal, equate, next_solution, reference
from .symbols import sym
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable

    from cramhy_runtime.lisp_core.signatures import GenericOf

DEFAULT_ROLE = special(sym("DESIG::*DEFAULT-ROLE*"))
ACTION_GROUNDING = find_predicate(sym("DESIG::ACTION-GROUNDING"), 2)
MOTION_GROUNDING = find_predicate(sym("DESIG::MOTION-GROUNDING"), 2)

resolve_designator: GenericOf[[Designator, object], Any] = generic(
    "DESIG::RESOLVE-DESIGNATOR",
    "(desig role)",
    documentation="""
Find the object that the designator stands for; ``reference`` calls it. Methods on ``(eql role)`` resolve in their own way.""",
)
designator_pose = generic(
    "DESIG::DESIGNATOR-POSE",
    "(desig)",
    documentation="""
The pose of an effective designator; nil for others. Packages that know poses define methods (cram-tf).""",
)
designator_distance = generic(
    "DESIG::DESIGNATOR-DISTANCE",
    "(desig-1 desig-2)",
    documentation="""
The distance between two effective designators; nil if one is not effective.""",
)


set_resolver, set_effective, set_timestamp = setter("resolver"), setter("effective"), setter("timestamp")
set_solutions, set_data, set_current_solution = setter("solutions"), setter("data"), setter("current_solution")


def unresolved(designator, control, told=None):
    """Signal that ``designator`` cannot be resolved, with the text ``control``. ``told`` is a function that makes the hint."""
    problem = DesignatorError(control, designator)
    problem.about, problem.told = designator, told
    return error(problem)


def known(designator):
    """The value to which the designator was resolved, or ``None``."""
    return designator._found if designator.effective else None


@reference.call_directly
@reference.method(Designator)
def _reference(designator=UNSUPPLIED, role=UNSUPPLIED, *more):
    try:
        found = designator._found
    except AttributeError:
        if isinstance(designator, Designator):
            raise
        return reference.refuse(designator, role, *more)
    if more:
        return reference.refuse(designator, role, *more)
    if found is not None and designator.effective:
        return found
    me = kernel.current()
    while designator.resolver is not None:
        await_resolver(designator, me)
    set_resolver(designator, me)
    try:
        if role is UNSUPPLIED:
            role = DEFAULT_ROLE.value
        result = (_place if isinstance(designator, LocationDesignator) else resolve_designator)(designator, role)
        set_effective(designator, True)
        if designator.timestamp is None:
            set_timestamp(designator, current_timestamp())
        return result
    finally:
        set_resolver(designator, None)
        serve(designator)


def _place(designator: LocationDesignator, role: object) -> object:
    """The place of a location designator: the first of the list that ``resolve-designator`` gives, which may be the one of a user."""
    if designator.current_solution is None:
        if designator.data is None:  # a designator that follows another one has the places that are left
            places = resolve_designator(designator, role)
            if places is None:
                return unresolved(designator, "Unable to resolve designator `~a'")
            set_data(designator, places if isinstance(places, Cons) else Cons(places, None))
        set_current_solution(designator, lazy_car(designator.data))
    return designator.current_solution


@reference.enclose
def _shared(effective: Callable[..., Any]) -> Callable[..., Any]:
    """A method of a user is called once for all tasks that need the designator meanwhile, too: they get its values."""

    def call(designator: object, *role: object) -> Any:
        if not isinstance(designator, Designator):
            return effective(designator, *role)
        return share_call(designator, role[0] if role else DEFAULT_ROLE.value, lambda: effective(designator, *role))

    return call


class Groundings(Machine):
    """The proof of a goal ``(predicate designator value)``, and the lazy list of the values."""

    __slots__ = ("value",)

    def __init__(self, predicate, designator):
        Machine.__init__(self)
        self.value = Var()
        self.start = predicate.call, SOLVED, designator, self.value

    def rest(self):
        """The lazy list of the values that are left, the first one computed now. Unset variables are left out."""
        while self.next_solution():
            value = resolve(self.value)
            if value.__class__ is not Symbol or not is_var(value):
                return Cons(value, tail(self.rest))
        return None


@resolve_designator.method(ActionDesignator, None)
@resolve_designator.method(MotionDesignator, None)
def _resolve_by_prolog(designator, role=None):
    # An action or motion without solution stays without, even when facts are added later: a new designator is tried afresh.
    solutions = designator.solutions
    if solutions is UNBOUND:
        predicate = MOTION_GROUNDING if isinstance(designator, MotionDesignator) else ACTION_GROUNDING
        proof = Groundings(predicate, designator)
        solutions = beginning(proof.rest)
        set_solutions(designator, solutions)
        if solutions is None and proof.warned is not None:
            note_causes(designator, proof.warned.causes)
    value = solutions.car if solutions is not None else None
    if value is None:
        kind = "motion" if isinstance(designator, MotionDesignator) else "action"
        return unresolved(designator, f"Cannot resolve {kind} designator ~a.")
    set_data(designator, value)
    return value


@resolve_designator.method(LocationDesignator, None)
def _resolve_location(designator, role=None):
    if designator.data is None:
        set_data(designator, location_solutions(designator))
        if designator.data is None:
            return unresolved(designator, "Unable to resolve designator `~a'", told=why_no_place(designator))
    return designator.data


@resolve_designator.method(ObjectDesignator, None)
def _resolve_object(designator, role=None):
    return designator.data if designator.data is not None else unresolved(designator, "Designator `~a' does not reference an object.")


@resolve_designator.method(HumanDesignator, None)
def _resolve_human(designator, role=None):
    return designator.data if designator.data is not None else unresolved(designator, "Designator `~a' does not reference an human.")


@next_solution.method(LocationDesignator)
def _next_location(designator):
    if designator.effective is None:
        reference(designator)
    if designator.successor is not None:
        return designator.successor
    rest = lazy_cdr(designator.data)
    if rest is None:
        return None
    successor = new(designator.__class__, designator.description)
    set_data(successor, rest)
    return equate(designator, successor)


@next_solution.method(Designator)
def _no_solutions(designator):
    return error(
        NoApplicableMethodError(next_solution, lisp_list(designator)),
        hint="Only actions, motions and locations have further solutions. An object or a human stands for what perception put "
        "into its data; perceive again for another one.",
    )


@next_solution.method(ActionDesignator)
@next_solution.method(MotionDesignator)
def _next_grounding(designator):
    reference(designator)
    rest = lazy_cdr(designator.solutions) if designator.solutions is not UNBOUND else None  # made effective by hand: no more is known
    if rest is None:
        return None
    successor = new(ActionDesignator if isinstance(designator, ActionDesignator) else MotionDesignator, designator.description)
    set_solutions(successor, rest)
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


def loc_desig_location(loc_desig):
    """The reference of the youngest designator in the chain of ``loc_desig``; nil if that is not a location designator."""
    return reference(youngest(loc_desig)) if isinstance(loc_desig, LocationDesignator) else None
