"""The predicates of designators, for Prolog (designators.md section 9).

``desig-prop`` is the one that plans use; the others look at slots, at the chain of equated designators, and at solutions. Repaired:
``effective-designator`` tests the designator it is given; ``desig-prop`` with a time gives each solution once.
"""

from __future__ import annotations

from ..lisp.conditions import handler_case, warn
from ..lisp.data import Cons, Symbol
from ..prolog.facts import built_in_group
from ..prolog.natives import deref, predicate, resolve, test
from ..prolog.terms import Var
from .classes import (
    ActionDesignator,
    Designator,
    DesignatorError,
    LocationDesignator,
    MotionDesignator,
    ObjectDesignator,
    check_key,
    living,
    make_designator,
    type_keyword,
)
from .equating import chain, desig_equal, designator_solutions, get_equal_designators, newest_effective_designator, youngest
from .resolution import reference
from .symbols import sym


def _designator(m, term):
    found = deref(term)
    return found if isinstance(found, Designator) else None


def _properties(m, desig, pair):
    designator = _designator(m, desig)
    if designator is None:
        return
    pair = deref(pair)
    if isinstance(pair, Cons):
        key = deref(pair.car)
        if isinstance(key, Symbol):
            check_key(key)
    for entry in designator.description or ():
        if isinstance(entry, Cons) and isinstance(entry.cdr, Cons) and entry.cdr.cdr is None and m.unify(pair, entry):
            yield


@predicate("DESIG::DESIG-PROP", group="DESIG::DESIGNATOR-ACCESSORS")
def desig_prop(m, desig, pair, *time):
    """``(desig-prop d (key value))``: the matching properties, in order; with a time, of the designator of that time."""
    if time:
        designator = _designator(m, desig)
        if designator is None or designator.timestamp is None or not m.unify(time[0], designator.timestamp):
            return
    yield from _properties(m, desig, pair)


def _type_test(name, cls):
    test(f"DESIG::{name}", group="DESIG::DESIGNATORS")(lambda m, desig: isinstance(deref(desig), cls))


_type_test("LOC-DESIG?", LocationDesignator)
_type_test("OBJ-DESIG?", ObjectDesignator)
_type_test("ACTION-DESIG?", ActionDesignator)
_type_test("MOTION-DESIG?", MotionDesignator)


def _slot(name, attribute):
    @test(f"DESIG::{name}", group="DESIG::DESIGNATOR-ACCESSORS")
    def slot(m, desig, value):
        designator = _designator(m, desig)
        return designator is not None and m.unify(value, getattr(designator, attribute))


_slot("DESIG-DESCRIPTION", "description")
_slot("DESIG-TIMESTAMP", "timestamp")
_slot("DESIG-EFFECTIVE", "effective")
_slot("DESIG-VALUE", "data")


@test("DESIG::EFFECTIVE-DESIGNATOR", group="DESIG::DESIGNATORS")
def effective_designator(m, desig):
    designator = _designator(m, desig)
    return designator is not None and designator.effective is not None


@test("DESIG::DESIG-REFERENCE", group="DESIG::DESIGNATORS")
def desig_reference(m, desig, value):
    """``(desig-reference d ref)``: one that cannot be resolved gives a warning and fails."""
    designator = _designator(m, desig)
    if designator is None:
        return False

    def refused(problem):
        warn("Unable to reference designator: ~a", problem)
        return _FAILED

    result = handler_case([(DesignatorError, refused)], lambda: reference(designator))
    return result is not _FAILED and m.unify(value, result)


_FAILED = object()


@test("DESIG::DESIGNATOR-GROUNDINGS", group="DESIG::DESIGNATORS")
def designator_groundings(m, desig, solutions):
    designator = _designator(m, desig)
    found = designator_solutions(designator) if designator is not None else None
    return found is not None and m.unify(solutions, found)


@test("DESIG::EQUATED-DESIGS", group="DESIG::DESIGNATORS")
def equated_desigs(m, desig, others):
    designator = _designator(m, desig)
    return designator is not None and m.unify(others, get_equal_designators(designator))


@predicate("DESIG::DESIG-EQUAL", group="DESIG::DESIGNATORS")
def equal_designators(m, first, second):
    """``(desig-equal d1 d2)``: unbound arguments range over all living designators."""
    for one in _candidates(first):
        for other in chain(one) if deref(second).__class__ is Var else _candidates(second):
            if desig_equal(one, other) and m.unify(first, one, second, other):
                yield


def _candidates(term):
    found = deref(term)
    if found.__class__ is Var:
        return living()
    return [found] if isinstance(found, Designator) else []


@test("DESIG::DESIG-CLASS", group="DESIG::DESIGNATORS")
def desig_class(m, desig, type_):
    designator = _designator(m, desig)
    return designator is not None and type_keyword(designator) is not None and m.unify(type_, type_keyword(designator))


@predicate("DESIG::DESIGNATOR", group="DESIG::DESIGNATORS")
def designator(m, first, *rest):
    """``(designator d)``: a type test or all living ones; ``(designator class description d)``: makes one or takes it apart."""
    if not rest:
        for found in _candidates(first):
            if m.unify(first, found):
                yield
    elif len(rest) == 2:
        description, desig = rest
        known = deref(desig)
        if isinstance(known, Designator):
            if m.unify(first, type_keyword(known), description, known.description):
                yield
        elif known.__class__ is Var and m.unify(desig, make_designator(resolve(first), resolve(description))):
            yield


@test("DESIG::CURRENT-DESIGNATOR", group="DESIG::DESIGNATORS")
def current_designator(m, desig, current):
    found = _designator(m, desig)
    return found is not None and m.unify(current, youngest(found))


@test("DESIG::NEWEST-EFFECTIVE-DESIGNATOR", group="DESIG::DESIGNATORS")
def newest_effective(m, desig, effective):
    found = _designator(m, desig)
    return found is not None and m.unify(effective, newest_effective_designator(found))


@predicate("DESIG::DESIG-LOCATION-PROP", group="DESIG::LOCATION-DESIGNATORS")
def desig_location_prop(m, desig, pose):
    """``(desig-location-prop d pose)``: the pose that a location names by ``:pose``, or by the location in ``:location``."""
    found = _designator(m, desig)
    if not isinstance(found, LocationDesignator):
        return
    for entry in found.description or ():
        if entry.car is sym(":LOCATION") and isinstance(entry.cdr.car, LocationDesignator):
            value = reference(youngest(entry.cdr.car))
        elif entry.car is sym(":POSE"):
            value = entry.cdr.car
        else:
            continue
        if m.unify(pose, value):
            yield


for _group, _functor in (("DEFAULT-ACTION-GROUNDING", "ACTION-GROUNDING"), ("DEFAULT-MOTION-SOLUTION", "MOTION-GROUNDING"),
                         ("LOCATION-DESIGNATOR-GENERATORS", "LOCATION-GROUNDING"), ("LOCATION-DESIGNATORS", "DESIG-LOC")):
    built_in_group(sym(f"DESIG::{_group}"), sym(f"DESIG::{_functor}"))
