"""Resolving designators from Python: the functions of ``protocol.py`` and ``equating.py``, with Python's data and exceptions.

Lists in solutions are Python lists, and a plan function in a solution is the function itself. `reference` raises the same exception that
Python code raised in a grounding, a generator or a validator. None of this needs a plan. Source: designators.md 6, 7.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import wraps
from cramhy_runtime.kernel.typing_names import Any, ParamSpec, TypeVar

from .. import kernel
from cramhy_runtime.cpl.failures.python_exceptions import for_python, raise_in_python
from cramhy_runtime.lisp_core.condition_types import Condition
from cramhy_runtime.lisp_core.data import UNSUPPLIED, Cons
from cramhy_runtime.prolog.python.ground import reasoning
from cramhy_runtime.prolog.python.terms import in_python_names, to_lisp, to_python
from . import equating, protocol
from .classes import attached, Designator, DesignatorError
from .resolution import known

P = ParamSpec("P")
T = TypeVar("T")
D = TypeVar("D", bound=Designator)


def for_reasoning(function: Callable[P, T]) -> Callable[P, T]:
    """A decorator: ``function`` can be called outside of plans, and raises the exceptions that Python code raised."""
    inside = for_python(function)

    @wraps(function)
    def call(*arguments: P.args, **keywords: P.kwargs) -> T:
        with reasoning():
            return inside(*arguments, **keywords)

    return call


def reference(designator: Designator, role: object = UNSUPPLIED) -> Any:
    """The object that the designator stands for: a pose, a command, an object. It is always the same for the same designator.

    For a motion it is the result of ``motion-grounding``; for an action the list of its plan function and arguments. role: chooses a
    method of ``resolve-designator``. Errors: DesignatorError if it cannot be resolved, with a note that says why; TypeError for anything
    but a designator. Source: designators.md 7.
    """
    if isinstance(designator, Designator) and designator.effective:
        found = known(designator)
        if found is not None:
            return _as_python(designator, found)
    if kernel.active() is None:
        with reasoning():
            return reference(designator, role)
    try:
        found = protocol.reference(_designator(designator), *(() if role is UNSUPPLIED else (to_lisp(role),)))
    except Condition as condition:
        problem = condition
    else:
        return _as_python(designator, found)
    raise_in_python(problem)


def _as_python(designator: Designator, found: Any) -> Any:
    """A solution as Python sees it; a list is the same Python list each time."""
    if found.__class__ is not Cons:
        return to_python(found)
    known_as = attached(designator).get("in_python")
    if known_as is None or known_as[0] is not found:
        known_as = attached(designator)["in_python"] = (found, to_python(found))
    return known_as[1]


def _notes(self: DesignatorError) -> list[str]:
    """The note below a traceback that says why the designator could not be resolved. It is computed when it is first read."""
    notes: list[str] | None = self.__dict__.get("notes")
    if notes is None:
        notes = self.__dict__["notes"] = []
        try:
            with in_python_names():
                hint = self.hint
            if hint:
                hint = hint.replace("(explain)", "explain(designator)")
        except Exception:  # a traceback is no place for errors
            hint = None
        if hint:
            notes.append(hint)
    return notes


setattr(DesignatorError, "__notes__", property(_notes))


@for_reasoning
def next_solution(designator: D) -> D | None:
    """A designator for the next solution, equated to this one, or ``None``. A designator that cannot be resolved is a DesignatorError.

    An object or a human has no further solutions, which is an error. Source: designators.md 7.
    """
    found: D | None = protocol.next_solution(_designator(designator))  # type: ignore[assignment]  # of the same kind
    return found


@for_reasoning
def equate(parent: Designator, successor: D) -> D:
    """Say that both describe the same thing. Returns the successor, which is the youngest of the chain now.

    If they are in one chain already, it is an error. Source: designators.md 6.
    """
    protocol.equate(_designator(parent), _designator(successor))
    return successor


@contextmanager
def equate_callback(designator: Designator, callback: Callable[[Designator], object]) -> Iterator[None]:
    """``with equate_callback(cup, found.append):`` ``callback(other)`` is called with what is equated to the cup meanwhile."""
    with equating.told_of_equating(_designator(designator), callback):
        yield


def solutions(designator: Designator) -> Iterator[Any]:
    """Iterate over all solutions of the designator. Each is searched for on demand. A designator that cannot be resolved has none."""
    member: Any = _designator(designator)
    while member is not None:
        try:
            value = reference(member)
        except DesignatorError:
            return
        yield value
        member = next_solution(member)


def _designator(thing: Any) -> Designator:
    if not isinstance(thing, Designator):
        raise TypeError(f"{thing!r} is no designator. Make one: Motion(type=kw.driving), Driving(speed=1.0).")
    return thing
