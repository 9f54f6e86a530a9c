"""Generators and validators: how location designators find places.

A generator takes a designator and returns a lazy, possibly endless list of candidates. The lists of all generators are joined in the
order of their priorities, and the validators judge each candidate. Everything happens on demand: the search for a solution makes no more
candidates than it needs. It ends when the validators refuse ``*location-generator-max-retries*`` candidates and one more in a row.
Source: designators.md section 8.
"""

from __future__ import annotations

from cramhy_runtime.kernel.images import per_image
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING
from cramhy_runtime import kernel

from ..cpl.task_variables import inherit
from cramhy_runtime.lisp_core.condition_types import SimpleTypeError
from cramhy_runtime.lisp_core.conditions import as_name, error, restart_case, type_error
from cramhy_runtime.lisp_core.data import Cons, UndefinedFunction, list_from, one, plain_truth, truth
from cramhy_runtime.lisp_core.dynamic import binding, special
from cramhy_runtime.lisp_core.source_places import circumstance
from cramhy_runtime.lisp_core.packages import is_symbol, keyword
from cramhy_runtime.lisp_core.printing import attempt_to_print, prin1_to_string, princ_to_string
from cramhy_runtime.lisp_core.ports import PORTS
from cramhy_runtime.prolog.engine.database import extended
from ..prolog.query import ask
from cramhy_runtime.prolog.terms.terms import Var
from ..utilities.lazy_lists import beginning, from_iterator, lazy_cdr, tail
from .classes import LocationDesignator, attached
from .failure_causes import because, note_causes
from .protocol import designator_solutions_equal, next_solution
from .symbols import sym

if TYPE_CHECKING:
    from collections.abc import Iterator

ACCEPT, UNKNOWN, MAYBE_REJECT = keyword("ACCEPT"), keyword("UNKNOWN"), keyword("MAYBE-REJECT")
PRINT_VERDICTS = special(sym("DESIG::*PRINT-LOCATION-VALIDATION-FUNCTION-RESULTS*"), None)
MAX_RETRIES = special(sym("DESIG::*LOCATION-GENERATOR-MAX-RETRIES*"), 30)
LOCATION_GROUNDING = sym("DESIG::LOCATION-GROUNDING")
FILTERS = inherit(sym("DESIG::*LOCATION-SOLUTION-FILTERS*"), None)


class Registry:
    """Functions by name, with a priority. The name is a symbol, whose function is looked up at each call."""

    def __init__(self):
        self.entries = []  # (priority, name), sorted; of equal priorities the newest first
        self.disabled = set()

    def register(self, priority, name):
        """Enter ``name`` with ``priority``, an integer. A name that is entered already moves. Returns the name."""
        if not is_symbol(name) or name is None:
            _refuse(
                "The name of a function is wanted, not ~s.",
                [name],
                name,
                "SYMBOL",
                "Write the bare name of the function, without #': what it names is looked up at each use.",
            )
        if priority.__class__ is not int:
            _refuse(
                "The priority of ~a is not an integer: ~s.",
                [name, priority],
                priority,
                "INTEGER",
                "The priority comes first, then the name of the function. Lower priorities are asked earlier.",
            )
        self.delete(name, forget=False)
        at = next((index for index, entry in enumerate(self.entries) if entry[0] >= priority), len(self.entries))
        self.entries.insert(at, (priority, name))
        return name

    def delete(self, name, forget=True):
        """Remove ``name``. With ``forget``, forget too that it is disabled."""
        self.entries = [entry for entry in self.entries if entry[1] is not name]
        if forget:
            self.disabled.discard(as_name(name))

    def all(self):
        """All functions by ascending priority, disabled ones too, as a Lisp list. A name without a function stands for itself."""
        return list_from([name if name.function.__class__ is UndefinedFunction else name.function for _, name in self.entries])

    def active(self):
        """The names that are not disabled, by ascending priority."""
        if not self.disabled:
            return [name for _, name in self.entries]
        return [name for _, name in self.entries if name not in self.disabled]


def _refuse(control, arguments, datum, expected, hint):
    error(SimpleTypeError(control, *arguments, datum=datum, expected_type=expected), hint=hint)


generators = per_image(Registry())
validators = per_image(Registry())


def register_location_generator(priority, name, documentation=None):
    """Ask the function named ``name`` for candidates from now on; it is called with the designator. Returns ``name``.

    priority: an integer; lower priorities come first. Another priority or name is a type error. Source: designators.md 8.1.
    """
    return generators.register(priority, name)


def register_location_validation_function(priority, name, documentation=None):
    """Let the function named ``name`` judge candidates; it is called with the designator and the candidate. Returns ``name``.

    priority: an integer; lower priorities come first. Another priority or name is a type error. Source: designators.md 8.1.
    """
    return validators.register(priority, name)


def list_location_generators():
    """All generators, a Lisp list of functions, by ascending priority."""
    return generators.all()


def list_location_validation_functions():
    """All validators, a Lisp list of functions, by ascending priority."""
    return validators.all()


def delete_location_generator_function(function_name):
    """Remove a generator."""
    generators.delete(function_name)


def delete_location_validation_function(function_name):
    """Remove a validator."""
    validators.delete(function_name)


def disable_location_generator_function(function_name):
    """Do not ask a generator until it is enabled."""
    generators.disabled.add(as_name(function_name))


def enable_location_generator_function(function_name):
    """Ask a disabled generator again."""
    generators.disabled.discard(as_name(function_name))


def disable_location_validation_function(function_name):
    """Do not ask a validator until it is enabled."""
    validators.disabled.add(as_name(function_name))


def enable_location_validation_function(function_name):
    """Ask a disabled validator again."""
    validators.disabled.discard(as_name(function_name))


def location_solutions(designator):
    """The lazy list of valid candidates for ``designator``, or nil. The first is searched for now."""
    search = Search(designator)
    solutions = beginning(search.rest)
    if solutions is None:
        attached(designator)["search"] = search
    return solutions


def resolve_location_designator_through_generators_and_validators(desig: object) -> Cons | None:
    """The lazy list of the places that the generators give for a location designator and the validators let pass; nil without any."""
    if not isinstance(desig, LocationDesignator):
        type_error(desig, "LOCATION-DESIGNATOR")
    places: Cons | None = location_solutions(desig)
    return places


def why_no_place(designator):
    """A function that makes a text: why the last search for ``designator`` found no place."""
    search = attached(designator).pop("search")
    return lambda: because(designator, search.account())


class Search:
    """The search for the places of a designator, and of those that follow it in its chain.

    It remembers its state. So when a generator or validator fails, or its task is evaporated, the next search goes on with the same
    candidate.
    """

    def __init__(self, designator):
        self.designator = designator
        self.names = generators.active()  # those that are to be asked yet; the first one gave ``cell``
        self.cell = None  # the candidates of that generator, beginning with the one at hand
        self.judged = False  # whether the one at hand has been judged
        self.most = self.left = MAX_RETRIES.value
        self.drawn, self.refusal, self.over = {}, None, False

    def rest(self):
        """The lazy list of the valid candidates that are left, or nil. The first is searched for now."""
        while not self.over and self._to_next_candidate():
            candidate = self.cell.car
            valid, *by = _judge(self.designator, candidate)
            self.judged = True
            if valid:
                self.left = self.most
                return Cons(candidate, tail(self.rest))
            self.refusal = candidate, *by
            if self.left <= 0:
                self.over = True
            else:
                self.left -= 1
                kernel.checkpoint()
        self.over = True
        return None

    def _to_next_candidate(self):
        """Go on to the next candidate, unless the present one is not judged yet. Returns False if there is none."""
        while True:
            if self.cell is None:
                if not self.names:
                    return False
                self.cell = self._candidates(_generate(self.names[0], self.designator))
                self.judged = False
            elif self.judged:
                self.cell = self._candidates(_generate_more(self.names[0], self.designator, self.cell))
                self.judged = False
            else:
                return True
            if self.cell is None:
                del self.names[0]
            else:
                self.drawn[self.names[0]] = self.drawn.get(self.names[0], 0) + 1

    def _candidates(self, given):
        if type(given) is list:  # of a generator in Python or Hy
            return list_from(given)
        if given is not None and given is not False and not isinstance(given, Cons):
            _refuse(
                "The location generator ~a gave ~s, which is not a list.",
                [self.names[0], given],
                given,
                "LIST",
                "A generator returns a list of candidates, lazy or not: (list candidate) for a single one, nil for none.",
            )
        return given or None

    def account(self):
        """A text about the search: which generators gave candidates, and why these were refused."""
        asked = [name for _, name in generators.entries if name not in generators.disabled]
        if not self.drawn:
            return (
                "No location generator is registered."
                if not asked
                else f"None of the location generators gave a candidate: {', '.join(_shown(name) for name in asked)}."
            )
        drawn = sum(self.drawn.values())
        candidate, validator, verdict = self.refusal
        text = (
            f"{drawn} candidate{'s were' if drawn > 1 else ' was'} refused, from "
            f"{', '.join(f'{_shown(name)} ({count})' for name, count in self.drawn.items())}. "
        )
        text += f"The last one, {_shown(candidate)}, {_reason(validator, verdict)}."
        if drawn > self.most:
            text += f" The search ends after {drawn}, since *location-generator-max-retries* is {self.most}."
        return text


def _reason(validator, verdict):
    if validator is None:
        return "was refused by a restart" if verdict is None else "was accepted by no validator, and :maybe-reject came from one"
    if verdict is True:
        return f"was refused by {_shown(validator)}: t is not a verdict, :accept is one"
    return f"was refused by {_shown(validator)}, which returned {_shown(verdict)}"


def _shown(thing):
    text = " ".join(attempt_to_print(prin1_to_string, thing).split())
    return text.lower() if is_symbol(thing) else text


def _about(what):
    return circumstance(lambda here: f"in the location {what} {_shown(here['name'])}, for {_shown(here['designator'])}")


@_about("generator")
def _generate(name, designator):
    return one(name.function(designator))


@_about("generator")
def _generate_more(name, designator, cell):
    return lazy_cdr(cell)


@_about("validator")
def _verdict(name, designator, solution):
    return one(name.function(designator, solution))


def validate_location_designator_solution(designator, solution):
    """Whether the validators let ``solution`` pass: one accepts it, or all answer ``:unknown`` (designators.md 8.3).

    Anything but ``:accept``, ``:unknown`` and ``:maybe-reject`` refuses at once, also ``t``. If ``designator`` is not a location
    designator, it is a type error.
    """
    if not isinstance(designator, LocationDesignator):
        return type_error(designator, "LOCATION-DESIGNATOR")
    return _judge(designator, solution)[0]


def _judge(designator, solution):
    """(whether ``solution`` is valid, the validator that refused it, its verdict)"""
    names = [name for name in validators.active() if not (name in _IDLE and _IDLE[name](name.function))]
    if not names:
        return _VALID

    def ask_all():
        verdict = UNKNOWN
        for name in names:
            answer = plain_truth(_verdict(name, designator, solution))  # a keyword of Hy is Lisp's
            if truth(PRINT_VERDICTS.value):
                PORTS.output.stream("standard-output").write(f"validator {princ_to_string(name)} says: {princ_to_string(answer)}\n")
            if answer is ACCEPT:
                verdict = ACCEPT
            elif answer is MAYBE_REJECT:
                verdict = verdict if verdict is ACCEPT else MAYBE_REJECT
            elif answer is not UNKNOWN:
                return None, name, answer
        return (None, None, verdict) if verdict is MAYBE_REJECT else _VALID

    return restart_case(_RESTARTS, ask_all)


_VALID = True, None, None
_RESTARTS = [
    (sym("DESIG::ACCEPT-SOLUTION"), lambda: _VALID, "Accept this designator solution"),
    (sym("DESIG::REJECT-SOLUTION"), lambda: (None, None, None), "Refuse this designator solution"),
]


# ------------------------------------------------------------------------------------------------------- what comes with CRAM


def location_prolog_generator(designator):
    """All ``?solution`` of ``(location-grounding designator ?solution)``."""
    return from_iterator(_places_by_prolog(designator))


def _places_by_prolog(designator: LocationDesignator) -> Iterator[object]:
    causes: dict[object, object] = {}
    for (value,) in ask(LOCATION_GROUNDING, designator, Var(), causes=causes):
        yield value
    if causes and isinstance(designator, LocationDesignator):
        note_causes(designator, causes)


def location_prolog_validator(designator, solution):
    """Accept the places that Prolog knows for the designator. If it knows some, answer ``:maybe-reject`` for others."""
    known = False
    for (value,) in ask(LOCATION_GROUNDING, designator, Var()):
        known = True
        if truth(designator_solutions_equal(value, solution)):
            return ACCEPT
    return MAYBE_REJECT if known else UNKNOWN


def filter_solution(designator, solution):
    """The validator of `with_designator_solution_filter`: all filters in force must be true."""
    filters = FILTERS.value
    if filters is None:
        return UNKNOWN
    return ACCEPT if all(truth(predicate(solution)) for predicate in filters) else keyword("REJECT")


_IDLE = {
    sym("DESIG::FILTER-SOLUTION"): lambda function: function is filter_solution and FILTERS.value is None,
    sym("DESIG::LOCATION-PROLOG-VALIDATOR"): lambda function: function is location_prolog_validator and not extended(LOCATION_GROUNDING),
}
"""Validators of CRAM → a test whether the function would answer ``:unknown`` now, so that it need not be called."""


def with_designator_solution_filter(predicate, body):
    """Call ``body()`` and return its values. Meanwhile only solutions that satisfy ``predicate`` are accepted.

    Candidates that were judged before are not judged again. Source: designators.md 8.4.
    """
    with binding(FILTERS, Cons(predicate, FILTERS.value)):
        return body()


def next_filtered_designator_solution(designator, filter):
    """`next_solution` with the filter ``filter``."""
    return with_designator_solution_filter(filter, lambda: next_solution(designator))


def register_defaults():
    """Register CRAM's own generator and validators under their symbols. The symbols get their functions elsewhere."""
    register_location_generator(10, sym("DESIG::LOCATION-PROLOG-GENERATOR"))
    register_location_validation_function(1, sym("DESIG::FILTER-SOLUTION"))
    register_location_validation_function(10, sym("DESIG::LOCATION-PROLOG-VALIDATOR"))
