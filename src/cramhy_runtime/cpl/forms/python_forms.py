"""The plan forms as Python calls them: functions over callables, and without branches ``with`` blocks.

    cpl.pursue(drive, watch)                     the form: its value
    with cpl.pursue() as race: race.start(drive)  the same as a block

They are the functions of ``operators.py`` and its neighbours, and add what Python expects: any iterable where Lisp has lists, and
outside the exception that Python code raised (``failures/python_exceptions.py``). A branch is any callable of no arguments; several
Lisp values are a tuple, no values (a branch that somebody evaporated) the empty tuple.
"""

from __future__ import annotations

from contextlib import contextmanager
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any, NoReturn, TypeVar, overload

from cramhy_runtime import kernel

from cramhy_runtime.ground.condition_types import Condition
from cramhy_runtime.ground.conditions import error
from cramhy_runtime.ground.data import Cons, list_from
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
    """All branches at once, until all have ended; the value of the first. One fails: the others are ended, and it is raised.

    Without branches: the beginning of ``with par() as branches:``, see `ParBlock`.
    """
    return operators.par(*branches) if branches else ParBlock()


@overload
def pursue() -> RaceBlock: ...
@overload
def pursue(first: Thunk[T], /, *branches: Thunk[S]) -> T | S: ...
@for_python
def pursue(*branches: Thunk[object]) -> object:
    """All branches at once, until one has ended; its value. The others are evaporated, and dead when this returns.

    Without branches: the beginning of ``with pursue() as race:``, see `RaceBlock`.
    """
    return operators.pursue(*branches) if branches else RaceBlock()


@overload
def try_all() -> TryAllBlock: ...
@overload
def try_all(first: Thunk[T], /, *branches: Thunk[S]) -> T | S: ...
@for_python
def try_all(*branches: Thunk[object]) -> object:
    """All branches at once, until one succeeds; its value. All fail: `CompositeFailure`.

    Without branches: the beginning of ``with try_all() as attempts:``, see `TryAllBlock`.
    """
    return operators.try_all(*branches) if branches else TryAllBlock()


@overload
def try_in_order(first: Thunk[T], /, *branches: Thunk[S]) -> T | S: ...
@overload
def try_in_order(*branches: Thunk[T]) -> T: ...
@for_python
def try_in_order(*branches: Thunk[object]) -> object:
    """One after the other, until one succeeds; its value. All fail: `CompositeFailure`."""
    return operators.try_in_order(*branches)


@for_python
def try_each_in_order(elements: Iterable[S], function: Callable[[S], T]) -> T:
    """``function(element)`` for one element after the other, until one call succeeds; its value. All fail: `CompositeFailure`."""
    return operators.try_each_in_order(_lisp_list(elements), function)


@for_python
def par_loop(elements: Iterable[S], function: Callable[[S], T]) -> T | None:
    """``function(element)`` for all elements at once, as `par`; the value for the first. Nothing is done for an empty iterable."""
    elements = _lisp_list(elements, empty=())
    return operators.par_loop(elements, function) if elements != () else None


def _lisp_list(elements: Any, empty: Any = None) -> Any:
    if elements is None or isinstance(elements, Cons):
        return elements
    return list_from(list(elements)) or empty


@for_python
def partial_order(steps: Sequence[Thunk[T]], orderings: Iterable[Ordering]) -> T:
    """As `par`, with ``after`` starting only when ``before`` is dead, for each (before, after) of ``orderings``: tasks or tags."""

    def task(step: Any) -> Any:
        return step.task if isinstance(step, Tag) else step

    return operators.partial_order(steps, [(task(before), task(after)) for before, after in orderings])


@for_python
def with_task(body: Thunk[T], name: str = "WITH-TASK") -> T:
    """Run ``body`` in a child task called ``name`` and wait for it: what it returns."""
    return operators.with_task(body, name)


@for_python
def join_task(task: AbstractTask[T]) -> T:
    """Wait until ``task`` is dead: what it returned; what it failed with is raised."""
    return task.join()


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
    """``for value in whenever(fluent):`` runs its body each time that the fluent is true; ``break`` is the way out.

    With ``body``, a function, it is called for ever.
    """
    return _values(fluent) if body is None else waiting.whenever(fluent, body)


def _values(fluent: Fluent[object]) -> Iterator[Any]:
    while True:
        yield waiting.wait_for(fluent)
        kernel.checkpoint()


@overload
def without_scheduling() -> AbstractContextManager[None]: ...
@overload
def without_scheduling(body: Thunk[T]) -> T: ...
def without_scheduling(body: Thunk[object] | None = None) -> object:
    """``with without_scheduling():`` requests to suspend or evaporate this task wait until the block is over."""
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
    """``with on_suspension(stop_motors):`` whenever this task is suspended meanwhile, ``handler()`` runs in it first."""
    return suspension.handler_for_suspension(handler) if body is None else suspension.on_suspension(handler, body)


def task_suspended(task: K) -> AbstractContextManager[K]:
    """``with task_suspended(task):`` it stands still while the block runs, and goes on afterwards in any case."""
    return suspension.task_suspended(task)


def policy(policy: policies.Policy, *arguments: object) -> AbstractContextManager[None]:
    """``with cpl.policy(a_policy, argument):`` the block under that policy.

    When the policy's check is met, the block is ended, and the form fails with `PolicyCheckConditionMet`.
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
