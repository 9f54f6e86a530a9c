"""Failing, and handling failures before anything unwinds.

``fail`` offers its condition to the handlers of its task while the failing code's stack is still there. A handler may leave by a
non-local exit, have the body tried again with ``retry``, or decline by returning. If all decline, the task unwinds, and the same
condition object is signalled again in the task that waits for it (`signal_failure`). Source: cpl.md section 4.

An error in a task goes to its parent in an envelope, and ``top-level`` opens the envelope; `debugging` says when the debugger comes
first. Handlers established before a task was evaporated cannot bring it back: they are passed over.
"""

from __future__ import annotations

from cramhy_runtime import kernel

from cramhy_runtime.ground import condition_types as types
from cramhy_runtime.ground.conditions import HandlerExit, error, handler_bind, make_condition, matches, signal_condition, type_error
from cramhy_runtime.ground.data import lisp_list, list_from
from cramhy_runtime.ground.source_places import locate
from cramhy_runtime.ground.classes import class_name
from cramhy_runtime.ground.packages import is_symbol, symbol_name
from .debugging import BREAK_ON_PLAN_FAILURES, break_on
from .failure_types import CommonLispErrorEnvelope, CompositeFailure, PlanFailure, SimplePlanFailure
from ..hooks import (
    on_fail,
    on_with_failure_handling_begin,
    on_with_failure_handling_end,
    on_with_failure_handling_handled,
    on_with_failure_handling_rethrown,
)
from ..logging import active_tags, log
from ..symbols import sym
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any, NoReturn, TypeVar

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    Clause = tuple[object, Callable[[Any, "Handling"], object]]  # (type specifier, handler)

T = TypeVar("T")


def fail(*arguments: Any) -> NoReturn:
    """``(fail ...)``: fail with a text and its arguments, a condition class with initargs, or a condition object. Never returns.

    Handlers run now, on top of this stack. Without arguments the text is ``Plan failure.`` Source: cpl.md 4.2.
    """
    fail_with_advice(None, *arguments)


def fail_with_advice(advice: str | Callable[[], str] | None, *arguments: Any) -> NoReturn:
    """`fail` with a hint for the user: ``advice`` is a text, or a function that makes the text when the failure is shown."""
    condition = _designated(*arguments) if arguments else SimplePlanFailure("Plan failure.")
    if advice is not None:
        condition.hint = advice
    if active_tags:
        log("FAIL", "~s: ~_~a", condition, condition)
    if on_fail:
        on_fail(arguments[0] if arguments else None)
    if kernel.current().owner is None or not isinstance(condition, PlanFailure):
        error(condition)
    if BREAK_ON_PLAN_FAILURES.value:
        break_on(condition)
    signal_failure(condition)


def _designated(datum: Any, *arguments: object) -> Any:
    """The condition that the arguments of ``fail`` stand for (cpl.md 4.2); Python code may give a class instead of its name."""
    if isinstance(datum, types.Condition):
        if arguments:
            rest = sym("REST")
            return error(
                types.SimpleError("The assertion ~S failed with ~S = ~S.", lisp_list(sym("NULL"), rest), rest, list_from(arguments)),
                hint="FAIL signals a condition object as it is. Give its slots to MAKE-CONDITION, or to FAIL with a class.",
            )
        return datum
    if isinstance(datum, (str, type)) or is_symbol(datum) or datum.__class__.__name__ == "LispString":
        return make_condition(datum, arguments, SimplePlanFailure)
    return error(types.CaseFailure(datum, "ETYPECASE", lisp_list(sym("CONDITION"), sym("SYMBOL"), sym("STRING"))))


def signal_failure(condition: BaseException) -> NoReturn:
    """Offer ``condition`` to the handlers of this task; when all decline, unwind with it. Never returns."""
    if isinstance(condition, types.Condition):
        signal_condition(condition)
    raise condition


class _Again(BaseException):
    """Unwinds to a ``with-failure-handling`` form, which tries its body again or, with ``leave``, returns ``values``."""

    def __init__(self, form: Handling, values: Any = None, leave: bool = False):
        self.form, self.values, self.leave = form, values, leave


class Handling:
    """One execution of ``with-failure-handling``; its handlers and body get it as their ``retry``.

    ``retry()`` unwinds and tries the body again; ``retry.leave(value)`` unwinds and makes the form return ``value``, which in
    Lisp is written ``(return value)`` and compiled to an exit of its own.
    """

    __slots__ = ("clauses", "task", "ending", "id")

    def __init__(self, clauses: Sequence[Clause]):
        self.clauses = clauses
        self.task = kernel.current()
        self.ending = self.task.cancelled_delivered
        self.id: object = None

    def __call__(self) -> NoReturn:
        """Unwind to the form, and try its body again."""
        raise _Again(self)

    def leave(self, value: object = None) -> NoReturn:
        """Unwind to the form, which returns ``value``."""
        raise _Again(self, value, True)

    def handle(self, condition: types.Condition) -> None:
        """The handler of the form: try its clauses in order (cpl.md 4.5, points 4 and 5). Returns if all of them decline."""
        if self.task.cancelled_delivered and not self.ending:
            return
        clauses = self.clauses
        if condition.__class__ is CommonLispErrorEnvelope:
            wrapped = condition.error
            for specifier, handler in clauses:
                if matches(wrapped, specifier):
                    handler(wrapped, self)
                    break
        for specifier, handler in clauses:
            if matches(condition, specifier):
                if on_with_failure_handling_handled:
                    on_with_failure_handling_handled(self.id)
                handler(condition, self)
                if on_with_failure_handling_rethrown:
                    on_with_failure_handling_rethrown(self.id)


def with_failure_handling(clauses: Sequence[Clause], body: Callable[[Handling], T]) -> T:
    """``(with-failure-handling clauses body...)``: the values of ``body(retry)``, with ``clauses`` in force.

    ``clauses`` is a list of (type specifier, handler), and each handler is called as ``handler(condition, retry)``. An ``(or ...)``
    clause comes as one pair per type. Handlers run before unwinding. A handler that returns declines, and the next matching clause
    or outer form is asked. ``retry()`` tries the body again, and ``retry.leave(value)`` returns from the form. In Lisp, ``(return value)``
    leaves the compiler's block named nil. Source: cpl.md 4.5.
    """
    handling = Handling(clauses)
    if on_with_failure_handling_begin.methods or on_with_failure_handling_end.methods:
        return observed([_type_name(specifier) for specifier, _ in clauses], lambda: _attempts(handling, body), handling)
    return _attempts(handling, body)


def _attempts(handling: Handling, body: Callable[[Handling], T]) -> T:
    bound = [(True, handling.handle)]
    while True:
        try:
            return handler_bind(bound, lambda: body(handling))
        except _Again as again:
            if again.form is not handling:
                raise
            if again.leave:
                return again.values
        kernel.checkpoint()


def observed(types: list[str], thunk: Callable[[], T], handling: Handling | None = None) -> T:
    """Call ``thunk`` between the hooks of a failure-handling form, and return its values. ``types`` is a list of names of conditions.

    ``handling``, if given, keeps the id that the first hook returned. In the original, ``top-level`` calls these hooks too.
    """
    run_id = on_with_failure_handling_begin.first(list_from(types))
    if handling is not None:
        handling.id = run_id
    try:
        return thunk()
    finally:
        on_with_failure_handling_end(run_id)


def _type_name(specifier: Any) -> str:
    name = class_name(specifier) if isinstance(specifier, type) else specifier
    return symbol_name(name) if is_symbol(name) else types.shown(name)


def attempt(thunk: Callable[[], T]) -> tuple[T | None, PlanFailure | None]:
    """Call ``thunk``. Returns (its values, ``None``), or (``None``, the plan failure that ended it), which outer handlers do not see."""
    me = kernel.current()
    ending = me.cancelled_delivered
    failed = _Failed()
    try:
        return handler_bind([(PlanFailure, failed.take)], thunk), None
    except _Failed as caught:
        if caught is not failed:
            raise
        failure = failed.failure
        locate(failure, failed)
        failed.__traceback__ = failed.failure = None  # no circle of the failure and the frames that it passed
    if me.cancelled_delivered and not ending:
        raise failure
    return None, failure


class _Failed(HandlerExit):
    """Unwinds to the `attempt` that made it."""

    def __init__(self) -> None:
        super().__init__(None, 0, None)
        self.failure: Any = None

    def take(self, failure: PlanFailure) -> NoReturn:
        self.failure = failure
        raise self


def composite_failure(failures: Iterable[object]) -> NoReturn:
    """Fail with a ``composite-failure`` of the conditions ``failures``, a Python list in order."""
    fail(CompositeFailure(failures=list_from(failures)))


def assert_no_returning(forms, thunk):
    """Call ``thunk``. If it returns, signal an error that shows ``forms`` (cpl.md 4.8)."""
    thunk()
    return error("Asserted~%  ~@<~A~:>~%not to return. But we did return.", forms)


def assert_no_nlx(forms, thunk):
    """Call ``thunk`` and return its values. If it leaves by a non-local exit, signal an error that shows ``forms`` (cpl.md 4.8)."""
    try:
        return thunk()
    except (types.Condition, Exception, kernel.Cancelled, kernel.Abandoned, kernel.Interrupted):
        raise
    except BaseException:
        return error("Asserted~%  ~@<~A~:>~%not to perform a non-local exit. Caught attempt to do so.", forms)


def composite_failures(failure):
    """The failures in a ``composite-failure``, a Lisp list."""
    return failure.failures if isinstance(failure, CompositeFailure) else type_error(failure, "COMPOSITE-FAILURE")


def envelop_error(failure):
    """The error in the envelope ``failure``."""
    return failure.error if isinstance(failure, CommonLispErrorEnvelope) else type_error(failure, "COMMON-LISP-ERROR-ENVELOPE")
