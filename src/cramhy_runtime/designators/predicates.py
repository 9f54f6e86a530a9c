"""The predicates of designators, for Prolog (designators.md section 9).

Plans use ``desig-prop``; the others look at slots, at the chain of equated designators, and at solutions. Repaired:
``effective-designator`` tests the designator that it is given. The forms with a time, ``(desig-prop d (key value) time)`` and
``(desig-value d value time)``, give the facts about each designator of the chain once.

``action-grounding``, ``motion-grounding`` and ``location-grounding`` are defined here, so a goal of one without clauses causes no warning.
Their default clauses only check, with ``*break-on-lisp-errors*``, the class of the designator.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.conditions import error
from cramhy_runtime.lisp_core.data import Cons, Keyword, Symbol
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any
from cramhy_runtime.prolog.engine.fact_groups import built_in_group
from cramhy_runtime.prolog.builtins.function_calls import call_lisp
from cramhy_runtime.prolog.engine.machine import fail, retry_iterator
from cramhy_runtime.prolog.builtins.native_predicates import deref, predicate, resolve, step_predicate, test
from cramhy_runtime.prolog.terms.terms import Var, ground, unify
from .classes import ActionDesignator, Designator, LocationDesignator, MotionDesignator, ObjectDesignator, check_key, living, type_keyword
from .clause_index import index_by_properties
from .equating import chain, desig_equal, designator_solutions, get_equal_designators, newest_effective_designator, youngest
from .symbols import sym

if TYPE_CHECKING:
    from collections.abc import Callable


def _designator(m, term):
    found = deref(term)
    return found if isinstance(found, Designator) else None


def _members(m, desig):
    """The designator in the term ``desig``, then the others of its chain."""
    designator = _designator(m, desig)
    return [] if designator is None else [designator, *(other for other in chain(designator) if other is not designator)]


def _call(name, *arguments):
    """(True, value) of a Lisp function; (False, None) and a warning when it signals an error, as with ``lisp-fun``."""
    return call_lisp(sym(f"DESIG::{name}"), arguments, "function", sym(f"DESIG::{name}"))


@step_predicate("DESIG::DESIG-PROP", group="DESIG::DESIGNATOR-ACCESSORS", arity=2)
def desig_prop(m, step):
    """``(desig-prop d (key value))``: the matching properties, in order. Nearly always the key is written as a keyword."""
    designator, pair = step[2], step[3]
    if designator.__class__ is Var:
        designator = deref(designator)
    if not isinstance(designator, Designator):
        return fail(m)
    if pair.__class__ is Cons:
        key, rest = pair.car, pair.cdr
        if key.__class__ is Keyword and rest.__class__ is Cons and rest.cdr is None:
            return _values(m, step[1], key, rest.car, designator.description)
    return retry_iterator(m, step[1], _properties(m, designator, pair))


def _values(m, k, key, value, cell):
    """Unify ``value`` with the value of the first property with ``key`` from ``cell`` on; a choice point only if there are more."""
    while cell.__class__ is Cons:
        entry = cell.car
        cell = cell.cdr
        if entry.__class__ is Cons and entry.car is key:
            rest = entry.cdr
            if rest.__class__ is Cons and rest.cdr is None:
                while cell.__class__ is Cons and (cell.car.__class__ is not Cons or cell.car.car is not key):
                    cell = cell.cdr
                found = rest.car
                if cell is not None:
                    m.choices.append((_further_values, k, len(m.trail), key, value, cell))
                if value is found or unify(value, found, m.trail):
                    return k
                break
    return fail(m)


def _further_values(m, step):
    m.choices.pop()
    _, k, _, key, value, cell = step
    return _values(m, k, key, value, cell)


def _properties(m, designator, pair, *also):
    """Unify ``pair`` with each property of the designator that has a value, and the terms ``also`` with one another."""
    pair = deref(pair)
    if isinstance(pair, Cons):
        key = deref(pair.car)
        if key.__class__ is Var:
            key = key.name  # of one that is written in the query; those of clauses have no name that anybody could declare
        if isinstance(key, Symbol) and key.__class__ is not Keyword:
            check_key(key)
    for entry in _pairs(designator):
        if m.unify(pair, entry, *also):
            yield


def _pairs(designator):
    """The entries of the description that are lists of two; a description may be anything."""
    cell = designator.description
    while isinstance(cell, Cons):
        entry, cell = cell.car, cell.cdr
        if isinstance(entry, Cons) and isinstance(entry.cdr, Cons) and entry.cdr.cdr is None:
            yield entry


@predicate("DESIG::DESIG-PROP", group="DESIG::DESIGNATOR-ACCESSORS")
def desig_prop_at(m, desig, pair, time):
    """``(desig-prop d (key value) time)``: the properties of the designator, then of the others of its chain, each with its time."""
    for member in _members(m, desig):
        yield from _properties(m, member, pair, time, member.timestamp)


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


@predicate("DESIG::DESIG-VALUE", group="DESIG::DESIGNATOR-ACCESSORS")
def desig_value_at(m, desig, value, time):
    """``(desig-value d value time)``: the data of the designator, then of the others of its chain, each with its time."""
    for member in _members(m, desig):
        if m.unify(value, member.data, time, member.timestamp):
            yield


@test("DESIG::EFFECTIVE-DESIGNATOR", group="DESIG::DESIGNATORS")
def effective_designator(m, desig):
    """``(effective-designator d)``: whether the designator has been resolved."""
    designator = _designator(m, desig)
    return designator is not None and designator.effective is not None


@test("DESIG::DESIG-REFERENCE", group="DESIG::DESIGNATORS")
def desig_reference(m, desig, value):
    """``(desig-reference d ref)``: the reference. A designator that cannot be resolved causes a warning, and the goal fails."""
    designator = _designator(m, desig)
    if designator is None:
        return False
    done, result = _call("REFERENCE", designator)
    return done and m.unify(value, result)


@test("DESIG::DESIGNATOR-GROUNDINGS", group="DESIG::DESIGNATORS")
def designator_groundings(m, desig, solutions):
    """``(designator-groundings d list)``: the lazy list of its references."""
    designator = _designator(m, desig)
    found = designator_solutions(designator) if designator is not None else None
    return found is not None and m.unify(solutions, found)


@test("DESIG::EQUATED-DESIGS", group="DESIG::DESIGNATORS")
def equated_desigs(m, desig, others):
    """``(equated-desigs d list)``: the other designators of its chain."""
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
    """``(desig-class d class)``: the keyword of its class."""
    designator = _designator(m, desig)
    return designator is not None and type_keyword(designator) is not None and m.unify(type_, type_keyword(designator))


@predicate("DESIG::DESIGNATOR", group="DESIG::DESIGNATORS")
def designator(m, first, *rest):
    """``(designator d)``: a type test, or all living designators. ``(designator class description d)`` makes one or takes it apart."""
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
        elif known.__class__ is Var and ground(first) and ground(description):
            done, made = _call("MAKE-DESIGNATOR", resolve(first), resolve(description))
            if done and m.unify(desig, made):
                yield


def _unify_found(m: Any, desig: object, result: object, function: Callable[[Any], object]) -> bool:
    """Whether ``result`` unifies with what ``function`` finds for a designator; plans pass nil where an action has no such part."""
    found = deref(desig)
    if found is None:
        return bool(m.unify(result, None))
    return isinstance(found, Designator) and bool(m.unify(result, function(found)))


@test("DESIG::CURRENT-DESIGNATOR", group="DESIG::DESIGNATORS")
def current_designator(m, desig, current):
    """``(current-designator d current)``: the youngest designator of its chain; of nil it is nil."""
    return _unify_found(m, desig, current, youngest)


@test("DESIG::NEWEST-EFFECTIVE-DESIGNATOR", group="DESIG::DESIGNATORS")
def newest_effective(m, desig, effective):
    """``(newest-effective-designator d effective)``: the youngest effective designator of its chain, or nil; of nil it is nil."""
    return _unify_found(m, desig, effective, newest_effective_designator)


@predicate("DESIG::DESIG-LOCATION-PROP", group="DESIG::LOCATION-DESIGNATORS")
def desig_location_prop(m, desig, pose):
    """``(desig-location-prop d pose)``: the pose that a location names by ``:pose``, or by the location in ``:location``."""
    found = _designator(m, desig)
    if not isinstance(found, LocationDesignator):
        return
    for key in (sym(":LOCATION"), sym(":POSE")):
        for entry in _pairs(found):
            if entry.car is key:
                done, value = True, entry.cdr.car
                if key is sym(":LOCATION"):
                    done, value = _call("LOC-DESIG-LOCATION", value) if isinstance(value, LocationDesignator) else (False, None)
                if done and m.unify(pose, value):
                    yield


built_in_group(sym("DESIG::LOCATION-DESIGNATORS"), sym("DESIG::DESIG-LOC"))


def _grounding(group, functor, cls):
    """Define a grounding predicate with only the default clause, which checks the class of the designator on demand, and fails."""
    functor = sym(f"DESIG::{functor}")
    built_in_group(sym(f"DESIG::{group}"), functor)

    def check(m, step):
        asked = resolve(step[2], m.names)
        if not isinstance(asked, cls) and len(step) == 4:
            error("[~a]: ~a had to be of type ~a", f"default {functor.name.lower()}", asked, sym(cls.lisp_name))

    index_by_properties(functor, check)


_grounding("DEFAULT-ACTION-GROUNDING", "ACTION-GROUNDING", ActionDesignator)
_grounding("DEFAULT-MOTION-SOLUTION", "MOTION-GROUNDING", MotionDesignator)
_grounding("LOCATION-DESIGNATOR-GENERATORS", "LOCATION-GROUNDING", LocationDesignator)
