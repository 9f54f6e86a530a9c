"""Why a designator could not be resolved, in words for a student.

A motion or action is resolved by the clauses of ``motion-grounding`` or ``action-grounding``. Most ask for properties of the designator,
``(desig-prop ?designator (:speed ?speed))``; the hint compares what each clause asks for with what the designator has. It is a
reading of the clauses, not a trace of the proof, and computed only when somebody asks for it.
"""

from __future__ import annotations

from ..lisp.data import Cons, Symbol
from ..lisp.printer.printer import princ_to_string
from ..prolog.database import functors
from ..utilities.patterns import is_var
from .classes import ActionDesignator, DesignatorError, MotionDesignator, ObjectDesignator, desig_prop_value
from .symbols import sym

DESIG_PROP = sym("DESIG::DESIG-PROP")


def hint(designator):
    """A text of one or more lines, or ``None`` when there is nothing to say."""
    if isinstance(designator, (MotionDesignator, ActionDesignator)):
        motion = isinstance(designator, MotionDesignator)
        return _groundings_tried(designator, "motion-grounding" if motion else "action-grounding")
    if isinstance(designator, ObjectDesignator):
        return "An object designator stands for something only after perception has found the object and set its data."
    return None


def _groundings_tried(designator, predicate):
    entry = functors.get(sym("DESIG::" + predicate.upper()))
    clauses = [clause for clause in entry.clauses if _asks(clause)] if entry is not None else []
    if not clauses:
        return (f"There is no clause of {predicate} that could resolve it. Define one in a fact group that lists "
                f"desig:{predicate}, and load the file.")
    # A clause for another type is of interest only if there is none for this one.
    clauses = [clause for clause in clauses if not _contradictions(designator, clause)] or clauses
    lines = [_compare(designator, clause) for clause in clauses]
    return f"Tried {len(lines)} clause{'s' if len(lines) > 1 else ''} of {predicate}:\n" + "\n".join(lines)


def _asks(clause):
    """The (key, value) pairs that a clause asks of its designator, in order."""
    found = []
    for goal in clause.goals or ():
        if isinstance(goal, Cons) and goal.car is DESIG_PROP and isinstance(goal.cdr, Cons) and goal.cdr.cdr is not None:
            pair = goal.cdr.cdr.car
            if goal.cdr.car is clause.head.cdr.car and isinstance(pair, Cons) and isinstance(pair.cdr, Cons):
                found.append((pair.car, pair.cdr.car))
    return found


def _contradictions(designator, clause):
    """The (key, value) pairs with constant values for which the designator has other values."""
    present = {pair.car for pair in designator.description or ()}
    return [(key, wanted) for key, wanted in _asks(clause)
            if key in present and not isinstance(wanted, Cons) and not (isinstance(wanted, Symbol) and is_var(wanted))
            and desig_prop_value(designator, key) is not wanted and desig_prop_value(designator, key) != wanted]


def _compare(designator, clause):
    present = {pair.car for pair in designator.description or ()}
    problems = [f"{princ_to_string(key)} is {princ_to_string(desig_prop_value(designator, key))}, not {princ_to_string(wanted)}"
                for key, wanted in _contradictions(designator, clause)]
    problems += [f"property {princ_to_string(key)} is missing" for key, _ in _asks(clause) if key not in present]
    return f"  {princ_to_string(clause.head)}: {'; '.join(problems) or 'all properties are there, another goal fails'}".lower()


DesignatorError.explain = staticmethod(hint)
