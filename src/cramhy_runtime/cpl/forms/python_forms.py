"""The plan forms for Python: functions that take callables, or, without branches, ``with`` blocks.

    cpl.pursue(drive, watch)                     the form, which returns a value
    with cpl.pursue() as race: race.start(drive)  the same as a block

They call the functions of ``operators.py`` and its neighbours, and add what Python expects: they take any iterable where Lisp has
lists, and they raise the exceptions that Python code raised (``failures/python_exceptions.py``). A branch is any callable of no
arguments. Several Lisp values are a tuple; no values, of a branch that another task evaporated, are the empty tuple.
"""

from __future__ import annotations

import sys
from contextlib import contextmanager
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any, NoReturn, TypeVar, overload
from cramhy_runtime.kernel.unstarted import callable_part

from cramhy_runtime import kernel

from cramhy_runtime.lisp_core.condition_types import Condition
from cramhy_runtime.lisp_core.conditions import error
from cramhy_runtime.lisp_core.source_places import is_user_file
from cramhy_runtime.kernel.reports import of_the_library
from cramhy_runtime.lisp_core.data import TRUE_CLASSES, Cons, list_from, truth
from ..failures import handling as failures
from . import operators, policies
from ..tasks import suspension, waiting
from ..failures.python_exceptions import for_python
from .branch_blocks import BesideBlock, ParBlock, RaceBlock, TryAllBlock
from ..fluents.fluents import Fluent
from .named_steps import Tag

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Sequence
    from contextlib import AbstractContextManager
    from types import FrameType

    from ..signatures import Ordering, Thunk
    from ..tasks.tasks import AbstractTask

T = TypeVar("T")
S = TypeVar("S")
K = TypeVar("K", bound="AbstractTask[object]")


@overload
def par() -> ParBlock: ...
@overload
def par(first: Thunk[T], /, *branches: Thunk[object]) -> T: ...
@for_python
def par(*branches: Thunk[object]) -> object:
    """Run all branches at once until all have ended. Returns the result of the first.

    If a branch fails, the others are evaporated, and its failure is raised. Without branches it returns a `ParBlock`, for
    ``with par() as branches:``. Outside of a plan it is an error. Source: cpl.md 6.2.
    """
    return operators.par(*_functions("par", branches)) if branches else ParBlock()


@overload
def pursue() -> RaceBlock: ...
@overload
def pursue(first: Thunk[T], /, *branches: Thunk[S]) -> T | S: ...
@for_python
def pursue(*branches: Thunk[object]) -> object:
    """Run all branches at once until one has ended. Returns its result, or raises its failure.

    The other branches are evaporated, and dead when this returns. Without branches it returns a `RaceBlock`, for
    ``with pursue() as race:``. Outside of a plan it is an error. Source: cpl.md 6.3.
    """
    return operators.pursue(*_functions("pursue", branches)) if branches else RaceBlock()


@overload
def try_all() -> TryAllBlock: ...
@overload
def try_all(first: Thunk[T], /, *branches: Thunk[S]) -> T | S: ...
@for_python
def try_all(*branches: Thunk[object]) -> object:
    """Run all branches at once until one succeeds. Returns its result; raises `CompositeFailure` if all fail.

    Without branches it returns a `TryAllBlock`, for ``with try_all() as attempts:``. Outside of a plan it is an error. Source: cpl.md 6.4.
    """
    return operators.try_all(*_functions("try_all", branches)) if branches else TryAllBlock()


@overload
def try_in_order(first: Thunk[T], /, *branches: Thunk[S]) -> T | S: ...
@overload
def try_in_order(*branches: Thunk[T]) -> T: ...
@for_python
def try_in_order(*branches: Thunk[object]) -> object:
    """Call one branch after the other until one succeeds. Returns its result; raises `CompositeFailure` if all fail (cpl.md 6.5)."""
    return operators.try_in_order(*_functions("try_in_order", branches))


def _functions(form: str, branches: tuple[Thunk[T], ...]) -> tuple[Thunk[T], ...]:
    for branch in branches:
        if not callable(branch):
            callable_part(branch, form, "a branch")
    return branches


@for_python
def try_each_in_order(elements: Iterable[S], function: Callable[[S], T]) -> T:
    """Call ``function(element)`` for one element after the other until a call succeeds. Returns its result.

    Raises `CompositeFailure` if all calls fail. Source: cpl.md 6.6.
    """
    callable_part(function, "try_each_in_order", "what to try", "elements, drive")
    return operators.try_each_in_order(_lisp_list(elements), function)


@for_python
def par_loop(elements: Iterable[S], function: Callable[[S], T]) -> T | None:
    """Call ``function(element)`` for all elements at once, as `par` does. Returns the result for the first element.

    An empty iterable gives ``None``. Source: cpl.md 6.8.
    """
    callable_part(function, "par_loop", "its body", "elements, drive")
    elements = _lisp_list(elements, empty=())
    return operators.par_loop(elements, function) if elements != () else None


def _lisp_list(elements: Any, empty: Any = None) -> Any:
    if elements is None or isinstance(elements, Cons):
        return elements
    return list_from(list(elements)) or empty


@for_python
def partial_order(steps: Sequence[Thunk[T]], orderings: Iterable[Ordering]) -> T:
    """As `par`, but for each (before, after) of ``orderings``, ``after`` starts only when ``before`` is dead.

    Both are tasks or tags; ``before`` may be a value fluent, which must be pulsed. A ring of orderings is an error. Source: cpl.md 6.7.
    """

    def task(step: Any) -> Any:
        return step.task if isinstance(step, Tag) else step

    return operators.partial_order(steps, [(task(before), task(after)) for before, after in orderings])


@for_python
def with_task(body: Thunk[T], name: str = "WITH-TASK") -> T:
    """Run ``body`` in a child task called ``name``, wait for it and return its result. Source: cpl.md 6.10."""
    return operators.with_task(callable_part(body, "with_task", "its body"), name)


@for_python
def join_task(task: AbstractTask[T]) -> T:
    """Wait until ``task`` is dead. Returns its result or raises its failure; the result of an evaporated task is ``()`` (cpl.md 3.8)."""
    return task.join()


@overload
def wait_for(fluent: Fluent[T | None], *, timeout: None = None) -> T: ...
@overload
def wait_for(fluent: Fluent[T | None], *, timeout: float | None) -> T | None: ...
def wait_for(fluent: Any, *, timeout: float | None = None) -> Any:
    """Wait until the value of ``fluent`` is true and return it. After ``timeout`` seconds of the kernel's clock return ``None``.

    A timeout of 0 only tests. All that is not a fluent is a TypeError: in Lisp an object is its own value, and such a wait is over at
    once. True is each value but ``None`` and ``False``; numpy's truth values count as Python's. Source: cpl.md 2.10.
    """
    if not isinstance(fluent, Fluent):
        _refuse(fluent, "wait_for")
    if waiting.user_wait.value is None:
        value = fluent.read()
        if value is not None and value is not False and (value.__class__ in TRUE_CLASSES or truth(value)):
            return value
        return waiting.wait(fluent, timeout)
    return waiting.wait_for(fluent, timeout=timeout)


def _refuse(thing: object, form: str) -> NoReturn:
    """Tell why ``thing``, which is not a fluent, was given to ``form``, as far as one can guess, in the language of the caller."""
    if _called_in_hy():
        _refuse_in_hy(thing, form.replace("_", "-"))
    if isinstance(thing, bool):
        advice = (
            f"A comparison of a fluent's value gives {thing} once, and so do `f == x` and `f != x`, which ask whether two fluents are the "
            f"same one. Write cpl.{form}(f < x), cpl.{form}(cpl.fl_eql(f, x)) or cpl.{form}(~cpl.fl_eql(f, x)) with the fluent f itself."
        )
    elif callable(thing):
        advice = (
            "Nobody would tell the plan when to call a function again. Keep what it looks at in a fluent, "
            f"f = cpl.make_fluent(value=...), and write cpl.{form}(cpl.fl_funcall(function, f)) or cpl.{form}(f < 1)."
        )
    else:
        advice = f"Write cpl.{form}(f) with a fluent f, not with f.value, and cpl.make_fluent(value=...) to make one."
    raise TypeError(f"cpl.{form} takes a fluent, but was given {_short(thing)}, which never changes. {advice}")


def _refuse_in_hy(thing: object, form: str) -> NoReturn:
    if isinstance(thing, bool):
        advice = (
            f"{thing} is what a comparison of a fluent's value gives, and what = gives for the fluent itself. "
            f"Write ({form} (< f x)) or ({form} (fl-eql f x)) with the fluent f itself."
        )
    elif callable(thing):
        advice = (
            "Nobody would tell the plan when to call a function again. Keep what it looks at in a fluent f, "
            f"and write ({form} (fl-funcall function f)) or ({form} (< f 1))."
        )
    else:
        advice = f"Write ({form} f) with a fluent f, not with f.value, and (make-fluent :value ...) to make one."
    raise TypeError(f"{form} takes a fluent, but was given {_short(thing)}, which never changes. {advice}")


def _called_in_hy() -> bool:
    """Whether the innermost text that is not of this library is one of Hy, or was typed at its prompt."""
    frame: FrameType | None = sys._getframe(1)
    while frame is not None and of_the_library(frame.f_code.co_filename):
        frame = frame.f_back
    return frame is not None and is_user_file(frame.f_code.co_filename)


def _short(thing: object) -> str:
    text = repr(thing)
    return f"{text if len(text) <= 60 else text[:57] + '...'} (of the type {type(thing).__name__})"


@overload
def fail(failure: Condition, /) -> NoReturn: ...
@overload
def fail(kind: type[Condition], /, **slots: object) -> NoReturn: ...
@overload
def fail(text: str = ..., /, *arguments: object) -> NoReturn: ...
def fail(*arguments: Any, **slots: object) -> NoReturn:
    """Fail with a `PlanFailure` (``fail(DoorStuck("no handle"))``), a class of them with slots, or a text. Handlers run at once.

    A text with arguments is a format control of Lisp (``~a`` stands for an argument); a text alone is taken as it is.
    """
    first = arguments[0] if arguments else None
    if isinstance(first, str) and len(arguments) == 1:
        arguments = (first.replace("~", "~~"),)
    elif isinstance(first, type) and issubclass(first, Condition) and (slots or len(arguments) == 1):
        arguments = (first(**slots),)
    elif (
        isinstance(first, BaseException)
        and not isinstance(first, Condition)
        or isinstance(first, type)
        and not issubclass(first, Condition)
    ):
        error(
            f"fail was given {first!r}, which is no plan failure. Write `raise` for an exception of Python; for fail, "
            "derive the class from cpl.PlanFailure."
        )
    failures.fail(*arguments)
    raise AssertionError("fail never returns")


@overload
def whenever(fluent: Fluent[T | None]) -> Iterator[T]: ...
@overload
def whenever(fluent: Fluent[object], body: Thunk[object]) -> NoReturn: ...
def whenever(fluent: Fluent[object], body: Thunk[object] | None = None) -> Iterator[Any]:
    """``for value in whenever(fluent):`` runs its body each time that the fluent is true; ``break`` ends it. Source: cpl.md 2.11.

    With ``body``, a function of no arguments, `whenever` calls it each time, and never returns.
    """
    if not isinstance(fluent, Fluent):
        _refuse(fluent, "whenever")
    return _values(fluent) if body is None else waiting.whenever(fluent, body)


def _values(fluent: Fluent[object]) -> Iterator[Any]:
    while True:
        yield wait_for(fluent)
        kernel.checkpoint()


@overload
def without_scheduling() -> AbstractContextManager[None]: ...
@overload
def without_scheduling(body: Thunk[T]) -> T: ...
def without_scheduling(body: Thunk[object] | None = None) -> object:
    """``with without_scheduling():`` delays requests to suspend or evaporate this task until the block is over. Source: cpl.md 3.6."""
    return suspension.undisturbed() if body is None else suspension.without_scheduling(body)


@overload
def with_scheduling() -> AbstractContextManager[None]: ...
@overload
def with_scheduling(body: Thunk[T]) -> T: ...
def with_scheduling(body: Thunk[object] | None = None) -> object:
    """``with with_scheduling():`` in a `without_scheduling` block, a place where requests are obeyed. Elsewhere it changes nothing."""
    return suspension.disturbable() if body is None else suspension.with_scheduling(body)


@overload
def on_suspension(handler: Thunk[object]) -> AbstractContextManager[None]: ...
@overload
def on_suspension(handler: Thunk[object], body: Thunk[T]) -> T: ...
def on_suspension(handler: Thunk[object], body: Thunk[object] | None = None) -> object:
    """``with on_suspension(stop_motors):`` calls the function in this task before each suspension within the block (cpl.md 3.10)."""
    return suspension.handler_for_suspension(handler) if body is None else suspension.on_suspension(handler, body)


def task_suspended(task: K) -> AbstractContextManager[K]:
    """``with task_suspended(task):`` suspends ``task`` while the block runs, and wakes it on every exit. Source: cpl.md 3.12."""
    return suspension.task_suspended(task)


def policy(policy: policies.Policy, *arguments: object) -> AbstractContextManager[None]:
    """``with cpl.policy(a_policy, argument):`` runs the block under that policy.

    When the policy's check is met, the block ends and raises `PolicyCheckConditionMet`. If its init clause does not return true, the
    block does not run: `PolicyInitFailed`. Source: cpl.md 9.2.
    """
    return _under(policy, arguments)


@contextmanager
def _under(policy: policies.Policy, arguments: tuple[object, ...]) -> Iterator[None]:
    with policies.in_force(policy, lambda: arguments) as check:
        if check is None:
            yield
        else:
            with BesideBlock() as race:
                race.start(check)
                yield
