"""Generators and validators: how location designators find places.

A generator takes a designator and gives a lazy, possibly endless list of candidates; the lists of all generators are joined in the
order of their priorities. Each candidate is shown to the validators. Everything happens on demand: the first solution costs as many
candidates as it takes, no more. After ``*location-generator-max-retries*`` candidates refused in a row, and one more, the search
ends. Source: designators.md section 8.
"""

from __future__ import annotations

from cramhy_runtime import kernel

from ..cpl.task_variables import inherit
from ..lisp.conditions import restart_case, type_error
from ..lisp.data import Cons, list_from, one, truth
from ..lisp.dynamic import binding, special
from ..lisp.packages import keyword
from ..utilities.lazy_lists import elements, from_iterator
from ..prolog.query import ask
from ..prolog.terms import Var
from .classes import LocationDesignator
from .protocol import designator_solutions_equal, next_solution
from .symbols import sym

ACCEPT, UNKNOWN, MAYBE_REJECT = keyword("ACCEPT"), keyword("UNKNOWN"), keyword("MAYBE-REJECT")
MAX_RETRIES = special(sym("DESIG::*LOCATION-GENERATOR-MAX-RETRIES*"), 30)
LOCATION_GROUNDING = sym("DESIG::LOCATION-GROUNDING")
FILTERS = inherit(sym("DESIG::*LOCATION-SOLUTION-FILTERS*"), None)


class Registry:
    """Functions by name with a priority; the name is a symbol and means the function that it has when it is called."""

    def __init__(self):
        self.entries = []  # (priority, name), sorted; of equal priorities the newest first
        self.disabled = set()

    def register(self, priority, name):
        self.delete(name, forget=False)
        at = next((index for index, entry in enumerate(self.entries) if entry[0] >= priority), len(self.entries))
        self.entries.insert(at, (priority, name))
        return name

    def delete(self, name, forget=True):
        self.entries = [entry for entry in self.entries if entry[1] is not name]
        if forget:
            self.disabled.discard(name)

    def all(self):
        """All functions by ascending priority, disabled ones too, as a Lisp list."""
        return list_from([name.function for _, name in self.entries])

    def active(self):
        return [name.function for _, name in self.entries if name not in self.disabled]


generators = Registry()
validators = Registry()


def register_location_generator(priority, name, documentation=None):
    """Call the function named ``name`` for candidates; lower priorities come first."""
    return generators.register(priority, name)


def register_location_validation_function(priority, name, documentation=None):
    """Show candidates to the function named ``name``, called with the designator and the candidate."""
    return validators.register(priority, name)


def list_location_generators():
    return generators.all()


def list_location_validation_functions():
    return validators.all()


def delete_location_generator_function(name):
    generators.delete(name)


def delete_location_validation_function(name):
    validators.delete(name)


def disable_location_generator_function(name):
    generators.disabled.add(name)


def enable_location_generator_function(name):
    generators.disabled.discard(name)


def disable_location_validation_function(name):
    validators.disabled.add(name)


def enable_location_validation_function(name):
    validators.disabled.discard(name)


def location_solutions(designator):
    """The lazy list of valid candidates for ``designator``; the first is searched for now. Nil if there is none."""
    return from_iterator(_valid_candidates(designator))


def _valid_candidates(designator):
    most = left = MAX_RETRIES.value
    for generator in generators.active():
        for candidate in elements(one(generator(designator))):
            if truth(validate_location_designator_solution(designator, candidate)):
                left = most
                yield candidate
            elif left <= 0:
                return
            else:
                left -= 1
                kernel.checkpoint()


def validate_location_designator_solution(designator, solution):
    """Whether the validators let ``solution`` pass: somebody accepts it or nobody minds (designators.md 8.3).

    Verdicts are keywords. Anything but ``:accept``, ``:unknown`` and ``:maybe-reject`` refuses at once, ``t`` included.
    """
    if not isinstance(designator, LocationDesignator):
        return type_error(designator, "LOCATION-DESIGNATOR")
    functions = validators.active()
    if not functions:
        return True

    def ask_all():
        verdict = UNKNOWN
        for validator in functions:
            answer = one(validator(designator, solution))
            if answer is ACCEPT:
                verdict = ACCEPT
            elif answer is MAYBE_REJECT:
                verdict = verdict if verdict is ACCEPT else MAYBE_REJECT
            elif answer is not UNKNOWN:
                return None
        return None if verdict is MAYBE_REJECT else True

    return restart_case([(sym("DESIG::ACCEPT-SOLUTION"), lambda: True, "Accept this designator solution"),
                         (sym("DESIG::REJECT-SOLUTION"), lambda: None, "Refuse this designator solution")], ask_all)


# ------------------------------------------------------------------------------------------------------- what comes with CRAM


def location_prolog_generator(designator):
    """All ``?solution`` of ``(location-grounding designator ?solution)``."""
    return from_iterator(value for (value,) in ask(LOCATION_GROUNDING, designator, Var()))


def location_prolog_validator(designator, solution):
    """If Prolog knows places for the designator, these are accepted and others are not wanted."""
    known = False
    for (value,) in ask(LOCATION_GROUNDING, designator, Var()):
        known = True
        if truth(designator_solutions_equal(value, solution)):
            return ACCEPT
    return MAYBE_REJECT if known else UNKNOWN


def filter_solution(designator, solution):
    """The validator behind `with_designator_solution_filter`: all filters in force must be true."""
    filters = FILTERS.value
    if filters is None:
        return UNKNOWN
    return ACCEPT if all(truth(predicate(solution)) for predicate in filters) else keyword("REJECT")


def with_designator_solution_filter(predicate, body):
    """Values of ``body()`` while only solutions that satisfy ``predicate`` are accepted. What was examined stays decided."""
    with binding(FILTERS, Cons(predicate, FILTERS.value)):
        return body()


def next_filtered_designator_solution(designator, predicate):
    """`next_solution` with the filter ``predicate``."""
    return with_designator_solution_filter(predicate, lambda: next_solution(designator))


def register_defaults():
    """Register CRAM's own generator and validators under their symbols, which must have their functions."""
    register_location_generator(10, sym("DESIG::LOCATION-PROLOG-GENERATOR"))
    register_location_validation_function(1, sym("DESIG::FILTER-SOLUTION"))
    register_location_validation_function(10, sym("DESIG::LOCATION-PROLOG-VALIDATOR"))


