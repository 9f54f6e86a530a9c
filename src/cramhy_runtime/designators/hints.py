"""Hints for a student: why a designator could not be resolved.

The clauses of ``motion-grounding`` or ``action-grounding`` resolve a motion or action. The hint explains the failed proof as
``(explain designator)`` does: it shows the clause that came furthest, and the property that it misses. It is computed only when the error
is shown. It proves no goals that might change something a second time: goals that call Lisp are left out.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.condition_types import Warning_
from cramhy_runtime.lisp_core.conditions import handler_bind, muffle_warning
from cramhy_runtime.lisp_core.data import Cons, Symbol, lisp_list, python_list
from cramhy_runtime.prolog.explanations import explanations
from cramhy_runtime.prolog.engine.database import extended
from cramhy_runtime.prolog.python.ground import reasoning
from cramhy_runtime.prolog.explanations.failure_reasons import declare_harmless, explains, spelled_like
from cramhy_runtime.prolog.engine.goal_text import show
from cramhy_runtime.prolog.terms.terms import Var, deref
from .classes import (
    ActionDesignator,
    Designator,
    DesignatorError,
    HumanDesignator,
    LocationDesignator,
    MotionDesignator,
    ObjectDesignator,
    type_keyword,
)
from .failure_causes import because
from .symbols import sym

_SOLUTION = Symbol("?SOLUTION")
_MOST_GOALS = 2000
_BY_PERCEPTION = "{} designator stands for something only after perception has found {} and set its data."


def hint(designator):
    """A text of one or more lines that says why ``designator`` cannot be resolved, or ``None``."""
    if isinstance(designator, ObjectDesignator):
        return _BY_PERCEPTION.format("An object", "the object")
    if isinstance(designator, HumanDesignator):
        return _BY_PERCEPTION.format("A human", "the human")
    if not isinstance(designator, (MotionDesignator, ActionDesignator)):
        return None
    with reasoning():  # an error may be looked at when its kernel has stopped
        return because(designator, _why_not_grounded(designator))


def _why_not_grounded(designator):
    predicate = _predicate(designator)
    told = handler_bind([(Warning_, muffle_warning)], lambda: explanations.explain(designator, _MOST_GOALS, dry=True))
    if told.outcome == "fails" and not told.root.attempts:
        return (
            f"There is no clause of {show(predicate).rpartition(':')[2]} that could resolve it. Define one in a fact group that lists "
            f"desig:{show(predicate).rpartition(':')[2]}, and load the file."
        )
    if told.outcome == "given up":
        return f"{told}\n{explanations.offer(designator)} goes on longer."
    if told.holds:
        return "There is a solution now. This designator was tried before there was, and keeps to that: make a new one."
    return f"{told.hint()}\n{explanations.offer(designator)} tries it again and tells all of it."


def _predicate(designator):
    return sym(
        "DESIG::MOTION-GROUNDING"
        if isinstance(designator, MotionDesignator)
        else "DESIG::LOCATION-GROUNDING"
        if isinstance(designator, LocationDesignator)
        else "DESIG::ACTION-GROUNDING"
    )


for _class in (ActionDesignator, MotionDesignator, LocationDesignator):
    explanations.explained_by(_class, lambda designator: lisp_list(_predicate(designator), designator, _SOLUTION))

explanations.explained_by((ObjectDesignator, HumanDesignator), hint)
DesignatorError.explain = staticmethod(hint)


# --------------------------------------------------------------------------------------------------- why predicates fail

declare_harmless(
    *(
        f"DESIG::{name}"
        for name in """DESIG-PROP LOC-DESIG? OBJ-DESIG? ACTION-DESIG? MOTION-DESIG? DESIG-DESCRIPTION
    DESIG-TIMESTAMP DESIG-EFFECTIVE DESIG-VALUE EFFECTIVE-DESIGNATOR EQUATED-DESIGS DESIG-EQUAL DESIG-CLASS CURRENT-DESIGNATOR
    NEWEST-EFFECTIVE-DESIGNATOR MOTION-GROUNDING ACTION-GROUNDING LOCATION-GROUNDING""".split()
    )
)


def _no_clauses(functor):
    def reason(m, desig, solution):
        return None if extended(functor) else "there are no clauses for it"

    return reason


for _name in ("DESIG::MOTION-GROUNDING", "DESIG::ACTION-GROUNDING", "DESIG::LOCATION-GROUNDING"):
    explains(_name)(_no_clauses(sym(_name)))


def _no_designator(term):
    """A reason why ``term`` has no properties, or ``None`` if it is a designator."""
    found = deref(term)
    if isinstance(found, Designator):
        return None
    return f"{show(term)} has no value" if found.__class__ is Var else f"{show(term)} is not a designator"


@explains("DESIG::DESIG-PROP")
def _property_missing(m, desig, pair, *time):
    problem, pair = _no_designator(desig), deref(pair)
    if problem or pair.__class__ is not Cons:
        return problem
    key = deref(pair.car)
    entries = [entry for entry in deref(desig).description or () if isinstance(entry, Cons)]
    same = [entry for entry in entries if entry.car is key]
    if not same:
        near = spelled_like(key, [entry.car for entry in entries if isinstance(entry.car, Symbol)]) if isinstance(key, Symbol) else ()
        if near:
            return f"there is no property {show(key)}, but {show(near[0])}; is that misspelled?", 0.9
        return f"there is no property {show(key)}"
    values = [entry.cdr.car for entry in same if isinstance(entry.cdr, Cons) and entry.cdr.cdr is None]
    if not values:  # the entries have another shape, and fit nothing
        given = same[0].cdr
        if given is None:
            return f"{show(key)} is without a value"
        return f"{show(key)} has {len(python_list(given))} values, and a property has one: {show(lisp_list(key, given))}"
    wanted = deref(pair.cdr)
    wanted = deref(wanted.car) if wanted.__class__ is Cons else wanted
    text = f"{show(key)} is {' and '.join(map(show, values))}, not {show(wanted)}"
    if isinstance(wanted, Symbol) and any(isinstance(value, Symbol) and value and spelled_like(value, [wanted]) for value in values):
        return f"{text}; is that misspelled?", 0.8
    return text


@explains("DESIG::DESIG-CLASS")
def _other_class(m, desig, type_):
    problem = _no_designator(desig)
    return problem or f"it is of the class {show(type_keyword(deref(desig)))}, not {show(type_)}"


def _define_type_test(name, kind):
    @explains(f"DESIG::{name}")
    def test(m, desig):
        problem = _no_designator(desig)
        return problem or f"{show(desig)} is not {kind} designator"


for _name, _kind in (
    ("LOC-DESIG?", "a location"),
    ("OBJ-DESIG?", "an object"),
    ("ACTION-DESIG?", "an action"),
    ("MOTION-DESIG?", "a motion"),
):
    _define_type_test(_name, _kind)


@explains("DESIG::EFFECTIVE-DESIGNATOR")
def _not_effective(m, desig):
    return _no_designator(desig) or "it has not been resolved yet"
