"""Handling failures in Python: ``handling``, whose handlers run before anything unwinds, and ``attempts``, a loop with an end.

Python's ``except`` runs when the stack of the failing code is gone. A handler of the plan language runs on top of that stack, and can
look at things that cleanup would destroy. It tries again (``retry()``), leaves with a value (``retry.leave(value)``), or returns, which
declines: then the next handler further out is asked. A failure that all decline unwinds, and is then an ordinary exception.

A ``with`` body cannot run twice, so trying again is either a decorated function or a loop over ``attempts``.
"""

from __future__ import annotations

from functools import wraps
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any, ParamSpec, TypeVar, overload

from cramhy_runtime import kernel

from cramhy_runtime.lisp_core.condition_types import Condition
from cramhy_runtime.lisp_core.conditions import error
from cramhy_runtime.lisp_core.python_exceptions import condition_class
from ..failures.failure_types import PlanFailure, python_exception
from ..failures.handling import Handling, with_failure_handling
from .waiting import sleep

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

    Handler = Callable[[Any, Handling], object]  # its first parameter is of the class that it stands for in the mapping

P = ParamSpec("P")
T = TypeVar("T")
K = TypeVar("K", bound="Kinds")
Kinds = type[BaseException] | tuple[type[BaseException], ...]


@overload
def handling(handlers: Mapping[Kinds, Handler]) -> Callable[[Callable[P, T]], Callable[P, T]]: ...
@overload
def handling(handlers: Mapping[K, Handler]) -> Callable[[Callable[P, T]], Callable[P, T]]: ...
def handling(handlers: Mapping[Any, Handler]) -> Callable[[Callable[P, T]], Callable[P, T]]:
    """A decorator: ``handlers``, a mapping from failure classes to ``handler(failure, retry)``, handle failures of the function's calls.

    A key is a class of plan failures or of ordinary exceptions, or a tuple of them; other classes are an error. Handlers of `PlanFailure`
    get an exception of a branch in an envelope, whose ``error`` it is; handlers of its own class get the exception itself, and come
    first. Otherwise the handlers are asked in the order of the mapping. Source: cpl.md 4.5.
    """
    clauses = [
        (_specifier(cls), _handler(cls, handler))
        for kinds, handler in handlers.items()
        for cls in (kinds if isinstance(kinds, tuple) else (kinds,))
    ]

    def decorate(function: Callable[P, T]) -> Callable[P, T]:
        @wraps(function)
        def call(*arguments: P.args, **keywords: P.kwargs) -> T:
            return with_failure_handling(clauses, lambda retry: function(*arguments, **keywords))

        return call

    return decorate


def _specifier(cls: type[BaseException]) -> type:
    if issubclass(cls, Condition):
        return cls
    if issubclass(cls, Exception):
        return condition_class(cls)
    return error(
        f"There can be no handler for {cls.__name__}: handlers are for plan failures and for exceptions under Exception. "
        "Use `finally` for what must happen when a task or a program ends."
    )


def _handler(cls: type[BaseException], handler: Handler) -> Handler:
    if issubclass(cls, Condition):
        return handler
    return lambda condition, retry: handler(python_exception(condition), retry)


class Attempt:
    """One turn of `attempts`. ``number`` counts from 1; ``failure`` is the failure of this turn, or ``None``."""

    def __init__(self, number: int, last: bool, kinds: Kinds):
        self.number, self.last, self.kinds = number, last, kinds
        self.failure: BaseException | None = None
        self.entered = False
        self.ending = False

    def __enter__(self) -> Attempt:
        self.entered = True
        self.ending = kernel.current().cancelled_delivered
        return self

    def __exit__(self, kind: object, exception: BaseException | None, traceback: object) -> bool:
        if isinstance(exception, self.kinds):
            self.failure = exception
            # While the task ends, a failure of its cleanup must not bring it back to try again.
            return not self.last and kernel.current().cancelled_delivered == self.ending
        return False


def attempts(count: int, *, on: Kinds = PlanFailure, pause: float = 0) -> Iterator[Attempt]:
    """``for attempt in cpl.attempts(3): with attempt: ...`` runs the block until it does not fail, ``count`` times at most.

    on: the failures after which it tries again, by default plan failures. pause: the time between two attempts, in seconds.
    The failure of the last attempt is raised. A ``count`` below 1 is an error.
    """
    if count < 1:
        error(f"attempts({count}) would try nothing. Ask for one attempt at least.")
    for number in range(1, count + 1):
        attempt = Attempt(number, number == count, on)
        yield attempt
        if not attempt.entered:
            error("The body of a loop over attempts has to be a with block: for attempt in cpl.attempts(3): with attempt: ...")
        if attempt.failure is None:
            return
        if pause:
            sleep(pause)
        else:
            kernel.checkpoint()
