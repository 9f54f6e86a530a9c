"""Grounding written in Python: decorators for functions that resolve designators.

    @motion_grounding(Driving)
    def drive_command(motion):
        return ["drive", motion.speed]              # one solution; yield several, or return None for none

    @action_grounding(Fetching)
    def fetch(action):
        return fetch_it, action.object              # the plan function and its arguments

    @location_generator(On, priority=5)
    def on_the_table(place):
        yield from grid(place.table)                # candidates, as many as are asked for

    @location_validator(priority=5)
    def reachable(place, candidate):
        return distance(candidate) < 1.2            # True accepts, False refuses, None leaves it to others

The class says for which designators the function is called. It is called for those of derived classes too, after the functions for the
derived class itself. Without a class it is called for all of the kind. A motion or action grounding is a rule of a fact group of its own,
so it works together with rules of Lisp, in order, and hints in errors show it.
Generators and validators are registered with their priority. A second definition of the same name in the same module replaces the first
one; two lambdas have no name, and are two. `forget` removes a function again. The decorators return the functions unchanged. Source:
designators.md 7.1 and 8.
"""

from __future__ import annotations

from functools import partial
from itertools import count
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any, TypeVar, overload

from cramhy_runtime.kernel.images import per_image
from types import CoroutineType

from cramhy_runtime.kernel.unstarted import plain_function, ran
from cramhy_runtime.lisp_core.data import Keyword, Symbol, list_from
from cramhy_runtime.lisp_core.packages import sym
from cramhy_runtime.lisp_core.printing import define_printer, print_unreadable
from cramhy_runtime.prolog.builtins import native_predicates as natives
from cramhy_runtime.prolog.python.ground import reasoning
from cramhy_runtime.prolog.python.rules import fact_group, remove_fact_group
from cramhy_runtime.prolog.python.spelling import lisp_name
from cramhy_runtime.prolog.python.terms import USER, Goal, Name, P, V, import_predicates, kw, to_lisp, to_python
from cramhy_runtime.prolog.explanations.failure_reasons import explains
from cramhy_runtime.prolog.terms.terms import deref, import_term
from ..utilities.lazy_lists import from_iterator
from . import locations
from .classes import ActionDesignator, LocationDesignator, MotionDesignator
from .locations import ACCEPT, MAYBE_REJECT, UNKNOWN
from .python_kinds import TYPE, Kind, forget_for_derived, hold_for_derived, type_name

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from .signatures import Generates, Grounds, Judges

F = TypeVar("F", bound="Callable[..., object]")
M = TypeVar("M", bound=MotionDesignator)
A = TypeVar("A", bound=ActionDesignator)
L = TypeVar("L", bound=LocationDesignator)
PYTHON_GROUNDING = sym("CRAMHY::PYTHON-GROUNDING")
REJECT = kw.reject
VERDICTS = (ACCEPT, UNKNOWN, MAYBE_REJECT, REJECT)
_forgetting: dict[Callable[..., object], dict[Kind | None, Callable[[], None]]] = per_image({})
"""Function → the kind for which it was defined → what undoes that."""

import_predicates(
    PYTHON_GROUNDING,
    *(
        sym(f"DESIG::{name}")
        for name in """ACTION-GROUNDING MOTION-GROUNDING LOCATION-GROUNDING DESIG-PROP
    DESIG-REFERENCE DESIG-DESCRIPTION DESIG-LOCATION-PROP DESIGNATOR-GROUNDINGS CURRENT-DESIGNATOR EFFECTIVE-DESIGNATOR EQUATED-DESIGS
    ACTION-DESIG? MOTION-DESIG? LOC-DESIG? OBJ-DESIG?""".split()
    ),
)


class Grounding:
    """A Python function that grounds designators, as an object in its rule."""

    def __init__(self, function: Callable[..., Any], what: str):
        self.function, self.what = plain_function(function, f"the {what}", yields=True), what
        self.name: str = getattr(function, "__name__", "function")

    @property
    def place(self) -> str:
        """The place of the function in its file, in parentheses."""
        code = getattr(self.function, "__code__", None)
        return f" ({code.co_filename}:{code.co_firstlineno})" if code is not None else ""

    @property
    def where(self) -> str:
        """Its kind, name and place, for messages."""
        return f"the {self.what} {self.name}{self.place}"

    def __repr__(self) -> str:
        return f"<{self.where}>"

    def called(self, designator: Any, step: Callable[[], Any]) -> Any:
        """The result of ``step()``. Its exceptions get a note that names the designator."""
        try:
            return step()
        except Exception as problem:
            note = f"This happened in {self.where}, for {one_line(designator)}."
            if note not in getattr(problem, "__notes__", ()):
                problem.add_note(note)
            raise

    def solutions(self, designator: Any) -> Iterator[Any]:
        """Iterate over the solutions of the function for ``designator``, as Lisp data."""
        result = self.called(designator, lambda: self.function(designator))
        if result.__class__ is CoroutineType:
            ran(result, f"the {self.what}")
        if result is None:
            return
        if not hasattr(result, "__next__"):
            yield self.called(designator, lambda: self.lisp_solution(result))
            return
        while True:
            value = self.called(designator, lambda: next(result, _END))
            if value is _END:
                return
            if value is not None:
                yield self.called(designator, partial(self.lisp_solution, value))

    def lisp_solution(self, value: Any) -> Any:
        """``value`` as Lisp data. The command for an action becomes a list; without a plan function it is a TypeError."""
        if self.what != "action grounding":
            return to_lisp(value)
        command = value if isinstance(value, (tuple, list)) and value else [value]
        if not (callable(command[0]) or isinstance(command[0], (Symbol, Name))):
            raise TypeError(f"An action grounding gives a plan function and its arguments, (pick_up, cup), not {value!r}.")
        if isinstance(command[0], (Symbol, Name)):
            return to_lisp(list(command))
        # A plan function of Python gets what the grounding gave it: False and empty lists are not NIL, which would be None.
        return list_from([to_lisp(command[0]), *map(_kept, command[1:])])


def _kept(part: Any) -> Any:
    if part is False:
        return False
    if part.__class__ not in (list, tuple):
        return to_lisp(part)
    return list_from([_kept(each) for each in part]) if part else part


define_printer(Grounding, lambda grounding, stream: print_unreadable(grounding, stream, f"{grounding.name}{grounding.place}"))

_END = object()


def one_line(designator: Any) -> str:
    """A designator as text in one line."""
    return " ".join(repr(designator).split())


@natives.predicate("CRAMHY::PYTHON-GROUNDING")
def python_grounding(m: Any, grounding: Any, designator: Any, solution: Any) -> Iterator[None]:
    """``(python-grounding function designator ?solution)``: the solutions of the function of a `Grounding`."""
    for value in deref(grounding).solutions(deref(designator)):
        if m.unify(solution, import_term(value, {})):
            yield


@explains("CRAMHY::PYTHON-GROUNDING")
def _no_solution(m: Any, grounding: Any, designator: Any, solution: Any) -> str:
    return f"{deref(grounding).name} gave no solution"


@overload
def motion_grounding(kind: type[M], /) -> Grounds[M]: ...
@overload
def motion_grounding(function: F, /) -> F: ...
def motion_grounding(given: Any) -> Any:
    """Decorator: ``function(motion)`` gives the solutions of a motion, mostly a command for a process module.

    given: the class of the motions, or the function itself. See the head of this module. A class that is not one of motions is a
    TypeError. Source: designators.md 7.1.
    """
    return _decorated(given, MotionDesignator, lambda function, kind: _define_rule(function, kind, "motion"))


@overload
def action_grounding(kind: type[A], /) -> Grounds[A]: ...
@overload
def action_grounding(function: F, /) -> F: ...
def action_grounding(given: Any) -> Any:
    """Decorator: ``function(action)`` gives the plan function for an action and its arguments.

    given: the class of the actions, or the function itself. See the head of this module. A class that is not one of actions is a
    TypeError. Source: designators.md 7.1.
    """
    return _decorated(given, ActionDesignator, lambda function, kind: _define_rule(function, kind, "action"))


@overload
def location_generator(kind: type[L], /, *, priority: int = 10) -> Generates[L]: ...
@overload
def location_generator(*, priority: int = 10) -> Generates[Any]: ...
@overload
def location_generator(function: F, /) -> F: ...
def location_generator(given: Any = None, /, *, priority: int = 10) -> Any:
    """Decorator: ``function(location)`` gives candidates for a place, the best first.

    given: the class of the locations, or the function itself. priority: generators of lower priority are asked first. See the head of
    this module. Source: designators.md 8.1, 8.2.
    """
    return _decorated(given, LocationDesignator, lambda function, kind: _define_generator(function, kind, priority))


@overload
def location_validator(kind: type[L], /, *, priority: int = 10) -> Judges[L]: ...
@overload
def location_validator(*, priority: int = 10) -> Judges[Any]: ...
@overload
def location_validator(function: F, /) -> F: ...
def location_validator(given: Any = None, /, *, priority: int = 10) -> Any:
    """Decorator: ``function(location, candidate)`` judges a candidate.

    True accepts it, False refuses it, and ``None`` leaves it to the other validators. ``kw.maybe_reject`` refuses it unless another
    validator accepts it; other answers are a TypeError. given: the class of the locations, or the function itself. priority: validators
    of lower priority are asked first. Source: designators.md 8.1, 8.3.
    """
    return _decorated(given, LocationDesignator, lambda function, kind: _define_validator(function, kind, priority))


def _decorated(given: Any, cls: type, define: Callable[[Any, Kind | None], None]) -> Any:
    if isinstance(given, type) or given is None:
        if given is not None and not issubclass(given, cls):
            raise TypeError(f"{given.__name__} does not describe {type_name(cls(None))}s, which this decorator is for.")
        if given is not None and not isinstance(given, Kind):
            raise TypeError(f"{given.__name__} is the class of all {type_name(cls(None))}s. Leave it out, or name a declared type.")

        def decorate(function: Any) -> Any:
            define(function, given)
            return function

        return decorate
    define(given, None)
    return given


def _define_rule(function: Callable[..., Any], kind: Kind | None, what: str) -> None:
    grounding = Grounding(function, f"{what} grounding")
    name, head = Name(_symbol(function, kind)), sym(f"DESIG::{what.upper()}-GROUNDING")
    inherited = Name(USER.intern(f"{name.symbol.name} FOR DERIVED TYPES"))

    def define(group_name: Name, kinds: Iterable[Kind | None]) -> None:
        with fact_group(group_name, extends=[head]) as group:
            for each in kinds:
                group.rule(
                    Goal(to_lisp([Name(head), V.designator, V.solution])),
                    *(kind_goals(each) if each is not None else []),
                    Goal(to_lisp([Name(PYTHON_GROUNDING), grounding, V.designator, V.solution])),
                )

    define(name, [kind])
    remove_fact_group(inherited)
    if kind is not None:
        hold_for_derived(inherited.symbol, kind, lambda kinds: define(inherited, kinds))

    def forget_it() -> None:
        forget_for_derived(inherited.symbol)
        remove_fact_group(name)
        remove_fact_group(inherited)

    _forgetting.setdefault(function, {})[kind] = forget_it


def kind_goals(kind: Kind) -> list[Goal]:
    """The goals that test whether the designator in ``V.designator`` is a ``kind``: it has the type, and all required properties."""
    goals = [P.desig_prop(V.designator, [TYPE, kind.type_])] if kind.type_ is not None else []
    return goals + [P.once(P.desig_prop(V.designator, [kw[lisp_name(field)], V._])) for field in kind.required]


_anonymous = count(1)


def _symbol(function: Callable[..., Any], kind: Kind | None = None) -> Symbol:
    """The name of ``function`` in Lisp, made of the names of its module and itself.

    A lambda and a partial have none, and a function may be there for several kinds: then a number, or the kind, tells them apart.
    """
    named = getattr(function, "func", function)
    name = getattr(named, "__qualname__", type(named).__qualname__)
    module = getattr(named, "__module__", None) or ""
    if named is not function or "<lambda>" in name:
        name = f"{name}-{next(_anonymous)}"
    elif kind is not None and next(iter(_forgetting.get(function, (kind,)))) is not kind:
        name = f"{name} FOR {kind.__qualname__}"
    prefix = "" if module in ("", "__main__") else f"{module}."
    found: Symbol = USER.intern(f"{prefix}{name}".replace(".<locals>", "").replace("_", "-").upper())
    return found


def _define_generator(function: Callable[..., Any], kind: Kind | None, priority: int) -> None:
    grounding, name = Grounding(function, "location generator"), _symbol(function, kind)

    def candidates(location: Any) -> Any:
        if kind is not None and not isinstance(location, kind):
            return None
        found = grounding.called(location, lambda: _iterated(function(location)))
        return from_iterator(_lisp_candidates(grounding, location, found))

    name.function = candidates
    with reasoning():
        locations.register_location_generator(priority, name)
    _forgetting.setdefault(function, {})[kind] = lambda: locations.delete_location_generator_function(name)


def _iterated(result: Any) -> Iterator[Any]:
    if result is None:
        return iter(())
    if isinstance(result, (str, bytes, dict)) or not hasattr(result, "__iter__"):
        raise TypeError(f"A location generator yields candidates, or returns a list of them, not {result!r}.")
    return iter(result)


def _lisp_candidates(grounding: Grounding, location: Any, found: Iterator[Any]) -> Iterator[Any]:
    while True:
        candidate = grounding.called(location, lambda: next(found, _END))
        if candidate is _END:
            return
        yield to_lisp(candidate)


def _define_validator(function: Callable[..., Any], kind: Kind | None, priority: int) -> None:
    grounding, name = Grounding(function, "location validator"), _symbol(function, kind)

    def verdict(location: Any, candidate: Any) -> Any:
        if kind is not None and not isinstance(location, kind):
            return UNKNOWN
        return grounding.called(location, lambda: _verdict(function(location, to_python(candidate))))

    name.function = verdict
    with reasoning():
        locations.register_location_validation_function(priority, name)
    _forgetting.setdefault(function, {})[kind] = lambda: locations.delete_location_validation_function(name)


def _verdict(answer: Any) -> Keyword:
    if answer.__class__.__module__ == "numpy":
        answer = answer.item()
    if answer is True:
        return ACCEPT
    if answer is False:
        return REJECT
    if answer is None:
        return UNKNOWN
    found = to_lisp(answer)  # a keyword of Hy is Lisp's
    if isinstance(found, Keyword) and found in VERDICTS:
        return found
    raise TypeError(f"A validator returns True, False, None or kw.maybe_reject, not {answer!r}.")


def forget(function: Callable[..., object]) -> None:
    """Undo the decorator of this module on ``function``. For other functions this does nothing."""
    for taking_out in _forgetting.pop(function, {}).values():
        taking_out()
