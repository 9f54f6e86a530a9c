"""Failing, and handling failures before anything unwinds.

``fail`` offers its condition to the handlers of its task while the failing code's stack is still there. A handler may leave by a
non-local exit, have the body tried again with ``retry``, or decline by returning. If all decline, the task unwinds, and the same
condition object is signalled again in the task that waits for it (`signal_failure`). Source: cpl.md section 4.

An error in a task goes to its parent in an envelope, and ``top-level`` opens the envelope; `debugging` says when the debugger comes
first. Handlers established before a task was evaporated cannot bring it back: they are passed over.
"""

from __future__ import annotations

from cramhy_runtime import kernel
from cramhy_runtime.kernel.active import ACTIVE
from cramhy_runtime.kernel.images import Cell

from cramhy_runtime.lisp_core import condition_types as types
from cramhy_runtime.lisp_core.catching import Cluster, HandlerExit
from cramhy_runtime.lisp_core.conditions import (
    error,
    handled,
    make_condition,
    matches,
    offer_late,
    raised_by_handler,
    signal_condition,
    type_error,
)
from cramhy_runtime.lisp_core.data import lisp_list, list_from
from cramhy_runtime.lisp_core.source_places import locate
from cramhy_runtime.lisp_core.classes import class_name
from cramhy_runtime.lisp_core.packages import is_symbol, symbol_name
from ..current import current_task
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
_new = SimplePlanFailure.__new__
_new_handling = BaseException.__new__


user_fail: Cell[Callable[..., NoReturn] | None] = Cell(None)
"""The generic function ``fail``, when users have defined methods on it (``languages/commonlisp/faces/cpl/user_methods.py``)."""


def fail_through(generic: Callable[..., NoReturn]) -> None:
    """Let `fail` call ``generic`` from now on, a generic function with methods of users."""
    user_fail.value = generic


def plain_fail(*arguments: Any) -> NoReturn:
    """`fail` without the methods of users."""
    fail_with_advice(None, *arguments)


def fail(*arguments: Any) -> NoReturn:
    """``(fail ...)``: fail with a text and its arguments, a condition class with initargs, or a condition object. Never returns.

    Handlers run now, on top of this stack. Without arguments the text is ``Plan failure.`` Source: cpl.md 4.2.
    """
    if user_fail.value is not None:
        return user_fail.value(*arguments)
    if arguments and arguments[0].__class__ is str:
        condition: Any = _new(SimplePlanFailure)
        condition.format_control, condition.format_arguments = arguments[0], arguments[1:]
    else:
        condition = _designated(*arguments)
    running = ACTIVE.value
    owner = None if running is None else running.current.owner
    if active_tags or on_fail.methods or BREAK_ON_PLAN_FAILURES.value or owner is None or not isinstance(condition, PlanFailure):
        _begin_to_fail(condition, arguments)
    exit_ = handled(condition)
    raise condition if exit_ is None else exit_


def fail_with_advice(advice: str | Callable[[], str] | None, *arguments: Any) -> NoReturn:
    """`fail` with a hint for the user: ``advice`` is a text, or a function that makes the text when the failure is shown."""
    condition = _designated(*arguments)
    if advice is not None:
        condition.hint = advice
    _begin_to_fail(condition, arguments)
    signal_failure(condition)


def _begin_to_fail(condition: Any, arguments: tuple[Any, ...]) -> None:
    """What comes before the handlers: the log, the hook, the debugger. Outside of plans, and for other conditions, an error."""
    if active_tags:
        log("FAIL", "~s: ~_~a", condition, condition)
    if on_fail.methods:
        on_fail(arguments[0] if arguments else None)
    if current_task() is None or not isinstance(condition, PlanFailure):
        error(condition)
    if BREAK_ON_PLAN_FAILURES.value:
        break_on(condition)


def _designated(datum: Any = "Plan failure.", *arguments: object) -> Any:
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


class Handling(Cluster, BaseException):
    """One execution of ``with-failure-handling``; its handlers and body get it as their ``retry``.

    ``retry()`` unwinds and tries the body again; ``retry.leave(value)`` unwinds and makes the form return ``value``, which in
    Lisp is written ``(return value)`` and compiled to an exit of its own. It is the exception that unwinds to its form.
    """

    __slots__ = ("clauses", "task", "ending")
    clauses: Sequence[Clause]
    task: kernel.Task[object]
    ending: bool  # whether the task was ending when the form began
    id: object = None  # which the hook of its beginning gave
    left = False
    values: object = None

    def __call__(self) -> NoReturn:
        """Unwind to the form, and try its body again."""
        raise self

    def leave(self, value: object = None) -> NoReturn:
        """Unwind to the form, which returns ``value``."""
        self.values, self.left = value, True
        raise self

    def offer(self, condition: types.Condition, clusters: tuple[object, object]) -> None:
        """Try the clauses of the form in order (cpl.md 4.5, points 4 and 5). Returns if all of them decline."""
        if self.task.cancelled_delivered and not self.ending:
            return
        clauses, task = self.clauses, self.task
        before, task.handlers = task.handlers, clusters[1]
        try:
            if type(condition) is CommonLispErrorEnvelope:
                wrapped = condition.error
                for specifier, handler in clauses:
                    if matches(wrapped, specifier):
                        handler(wrapped, self)
                        break
            for specifier, handler in clauses:
                if matches(condition, specifier):
                    if on_with_failure_handling_handled.methods:
                        on_with_failure_handling_handled(self.id)
                    handler(condition, self)
                    if on_with_failure_handling_rethrown.methods:
                        on_with_failure_handling_rethrown(self.id)
        except (types.Condition, Exception) as raised:
            raised_by_handler(raised)
            raise
        finally:
            task.handlers = before


def with_failure_handling(clauses: Sequence[Clause], body: Callable[[Handling], T]) -> T:
    """``(with-failure-handling clauses body...)``: the values of ``body(retry)``, with ``clauses`` in force.

    ``clauses`` is a list of (type specifier, handler), and each handler is called as ``handler(condition, retry)``. An ``(or ...)``
    clause comes as one pair per type. Handlers run before unwinding. A handler that returns declines, and the next matching clause
    or outer form is asked. ``retry()`` tries the body again, and ``retry.leave(value)`` returns from the form. In Lisp, ``(return value)``
    leaves the compiler's block named nil. Source: cpl.md 4.5.
    """
    return handling_failures(body, *(part for clause in clauses for part in clause))


def handling_failures(body: Callable[[Handling], T], *given: Any) -> T:
    """As `with_failure_handling`, in the form that compiled code calls: ``given`` are the types and handlers in turn.

    All is done in this one function, since each call of Python on the way makes a failure take longer.
    """
    running = ACTIVE.value
    handling = _new_handling(Handling)
    handling.clauses = (given,) if len(given) == 2 else [given[index : index + 2] for index in range(0, len(given), 2)]
    handling.task = task = kernel.current() if running is None else running.current
    handling.ending = task.cancelled_delivered
    is_observed = on_with_failure_handling_begin.methods or on_with_failure_handling_end.methods
    if is_observed:
        handling.id = on_with_failure_handling_begin.first(list_from([_type_name(specifier) for specifier, _ in handling.clauses]))
    outer = task.handlers
    try:
        while True:
            task.handlers = handling, outer
            try:
                try:
                    return body(handling)
                except (types.Condition, Exception) as exception:
                    offer_late(exception)
                    raise
                finally:
                    task.handlers = outer
            except Handling as again:
                if again is not handling:
                    raise
                handling.__traceback__ = handling.__context__ = None  # a circle with the frames that it passed
                if handling.left:
                    return handling.values  # type: ignore[return-value]  # what the handler says is what the form returns
            kernel.checkpoint()
    finally:
        if is_observed:
            on_with_failure_handling_end(handling.id)


def observed(types: list[str], thunk: Callable[[], T]) -> T:
    """Call ``thunk`` between the hooks of a failure-handling form, and return its values. ``types`` is a list of names of conditions.

    In the original, ``top-level`` calls these hooks too.
    """
    run_id = on_with_failure_handling_begin.first(list_from(types))
    try:
        return thunk()
    finally:
        on_with_failure_handling_end(run_id)


def _type_name(specifier: Any) -> str:
    name = class_name(specifier) if isinstance(specifier, type) else specifier
    return symbol_name(name) if is_symbol(name) else types.shown(name)


def attempt(thunk: Callable[[], T]) -> tuple[T | None, PlanFailure | None]:
    """Call ``thunk``. Returns (its values, ``None``), or (``None``, the plan failure that ended it), which outer handlers do not see."""
    return Attempt().run(thunk)


class Attempt(HandlerExit, Cluster):
    """The handler of an `attempt`, and the exit that unwinds to it. It may `run` one thunk after the other."""

    def __init__(self) -> None:
        self.task = kernel.current()
        self.token = None  # it is no `handler-case` that this unwinds to

    def run(self, thunk: Callable[[], T]) -> tuple[T | None, PlanFailure | None]:
        """As `attempt`."""
        task = self.task
        ending, outer = task.cancelled_delivered, task.handlers
        task.handlers = self, outer
        try:
            try:
                return thunk(), None
            except (types.Condition, Exception) as exception:
                offer_late(exception)
                raise
            finally:
                task.handlers = outer
        except Attempt as caught:
            if caught is not self:
                raise
            failure = self.condition
            locate(failure, self)
            self.__traceback__ = self.__context__ = self.condition = None  # no circle of the failure and the frames that it passed
        if task.cancelled_delivered and not ending:
            raise failure
        return None, failure

    def offer(self, condition: Any, clusters: tuple[object, object]) -> None:
        """Leave the attempt if ``condition`` is a plan failure."""
        if isinstance(condition, PlanFailure):
            self.condition = condition
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


def composite_failures(failure: Any) -> Any:
    """The failures in a ``composite-failure``, a Lisp list."""
    return failure.failures if isinstance(failure, CompositeFailure) else type_error(failure, "COMPOSITE-FAILURE")


def envelop_error(failure: Any) -> Any:
    """The error in the envelope ``failure``."""
    return failure.error if isinstance(failure, CommonLispErrorEnvelope) else type_error(failure, "COMMON-LISP-ERROR-ENVELOPE")
