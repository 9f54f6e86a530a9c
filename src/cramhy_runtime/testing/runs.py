"""Running a plan once, in a kernel of its own: in virtual time, with a seed, a schedule, or faults.

`virtual_time` gives a block its own kernel. `run` does that for one plan and returns an `Outcome`. Neither disturbs the kernel that was
active before, which is put aside meanwhile. A plan is a Python function, or Lisp: a text or a form.
"""

from __future__ import annotations

from contextlib import contextmanager

from .. import kernel
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any, Generic, TypeVar, subscripted
from cramhy_runtime.cpl.failures.failure_types import CommonLispErrorEnvelope, CompositeFailure, opened
from cramhy_runtime.lisp_core.data import Cons, all_values
from cramhy_runtime.lisp_core.equality import equalp
from .faults import InjectedError, InjectedFailure
from .leftovers import complain, leftovers
from .plans import plan_of
from .schedules import Schedule
from .watched import WatchedKernel

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence
    from types import TracebackType

    from cramhy_runtime.kernel.signatures import Backend, BackendName
    from .faults import Fault
    from .park_points import ParkPoint
    from .plans import Plan
    from .traces import Trace

    Expected = type[BaseException] | tuple[type[BaseException], ...] | None

T = TypeVar("T", default=Any)
TIME_LIMIT = 3600.0  # s of virtual time after which a plan has lost its end


@contextmanager
def virtual_time(
    backend: BackendName | Backend = "auto",
    seed: int | None = None,
    *,
    schedule: Sequence[int] | Schedule | None = None,
    faults: Sequence[Fault] = (),
    time_limit: float | None = TIME_LIMIT,
) -> Iterator[WatchedKernel]:
    """``with virtual_time() as clock: ...; clock.now()`` gives the block a kernel of its own, in virtual time.

    backend: as for `kernel.start`. seed: a number that shuffles which of the runnable tasks goes on, as ``--seed`` does.
    schedule: instead, a list of choices, or a `Schedule`; with both it is a ValueError. faults: see `faults.at`. time_limit: seconds of
    virtual time. The value is the kernel. Tasks that are left when the block ends are ended.
    """
    chooser: int | Schedule | None
    if schedule is None:
        chooser = seed
    elif seed is not None:
        raise ValueError("A seed or a schedule, not both: each decides which task goes next.")
    else:
        chooser = schedule if isinstance(schedule, Schedule) else Schedule(schedule)
    with kernel.aside():
        watched = kernel.start("virtual", backend, chooser, time_limit, kind=WatchedKernel)
        watched.faults.extend(faults)
        _same_random_numbers()
        yield watched


def _same_random_numbers() -> None:
    from cramhy_runtime.languages.commonlisp.numbers.random_state import seed_random

    seed_random()


class Outcome(Generic[T]):
    """The outcome of a run.

    ``values`` is a list, or ``error`` the error that left the plan, with the places in its traceback in ``stack``. ``trace`` has the marks,
    ``points`` the park points, and ``time`` the time at the end, in seconds. ``left`` are texts about leftovers, as in `leftovers`.
    """

    __class_getitem__ = subscripted

    def __init__(self, values: Sequence[Any] | None, error: BaseException | None, watched: WatchedKernel):
        self.values, self.error = values, error
        self.left: list[str] = []
        self.stack: Sequence[str] = ()
        self.trace: Trace = watched.trace
        self.points: list[ParkPoint] = watched.points
        self.time = watched.now()

    @property
    def value(self) -> T:
        """The first value. If there was an error, it is raised."""
        if self.error is not None:
            raise self.error
        return self.values[0] if self.values else None  # type: ignore[return-value]  # no values are nil

    def same(self, other: Outcome[object]) -> bool:
        """True if both ended alike: with equal values (``equalp``), or with errors of the same type and text."""
        if (self.error is None) != (other.error is None):
            return False
        if self.error is not None:
            return str(self) == str(other)
        mine, others = self.values or (), other.values or ()
        return len(mine) == len(others) and all(map(_equal, mine, others))

    def __str__(self) -> str:
        if self.error is not None:
            return describe(self.error)
        return ", ".join(map(shown, self.values)) if self.values else "no values"

    __repr__ = __str__


def describe(error: BaseException) -> str:
    """An error as text, with the errors in a composite failure or an envelope."""
    error = opened(error) if isinstance(error, CommonLispErrorEnvelope) else error
    if isinstance(error, CompositeFailure):
        return f"{type(error).__name__} of [{'; '.join(describe(failure) for failure in error.failures or ())}]"
    text = str(error).partition("\n")[0]
    return f"{type(error).__name__}: {text}" if text else type(error).__name__


def _equal(one: object, other: object) -> bool:
    try:
        return bool(one == other or equalp(one, other) or shown(one) == shown(other))
    except Exception:
        return shown(one) == shown(other)


def shown(value: object) -> str:
    """A value as Lisp prints it."""
    from cramhy_runtime.lisp_core.printing import prin1_to_string

    return prin1_to_string(value)


def run(
    plan: Plan[T],
    *,
    backend: BackendName | Backend = "auto",
    seed: int | None = None,
    schedule: Sequence[int] | Schedule | None = None,
    faults: Sequence[Fault] = (),
    time_limit: float | None = TIME_LIMIT,
    expect: Expected = None,
) -> Outcome[T]:
    """Run ``plan`` once in a fresh kernel and return its `Outcome`. An error of the plan is raised, but not one that a fault brought about.

    expect: the class of the error with which the plan has to end, or a tuple of classes. Then that error is in the outcome, and a plan
    that ends well is an AssertionError. The other arguments are those of `virtual_time`. A fault that did not happen is an
    AssertionError, since such a test would test nothing. Leftovers (see `assert_nothing_left`) are an AssertionError, too.
    """
    check_expected(expect)
    outcome = observe(plan_of(plan), backend, seed, schedule=schedule, faults=faults, time_limit=time_limit)
    missed = [fault for fault in faults if fault.happened is None]
    if missed:
        points = "\n".join(f"  {point}" for point in outcome.points) or "  (none)"
        raise AssertionError(f"Did not happen: {'; '.join(map(str, missed))}. The park points of the run:\n{points}")
    complain(outcome.left)
    if outcome.error is not None and not is_expected(outcome.error, expect) and not (faults and brought_about(outcome.error)):
        raise outcome.error
    if outcome.error is None and expect is not None:
        raise AssertionError(f"The plan was to end with {names(expect)}, but it ended well, with {outcome}.")
    return outcome


def check_expected(expect: object) -> None:
    """Raise TypeError unless ``expect`` is ``None``, a class of exceptions, or a tuple of such classes."""
    classes = expect if isinstance(expect, tuple) else (expect,)
    if expect is not None and not (classes and all(isinstance(each, type) and issubclass(each, BaseException) for each in classes)):
        raise TypeError(
            f"expect= takes a class of exceptions, or a tuple of classes, as in expect=cpl.PlanFailure; it was given {expect!r}."
        )


def is_expected(problem: BaseException, expect: Expected) -> bool:
    """Whether an error that left a plan is one of ``expect``, itself or in the envelope that CRAM puts around errors of Lisp."""
    if expect is None:
        return False
    return isinstance(problem, expect) or isinstance(problem, CommonLispErrorEnvelope) and isinstance(opened(problem), expect)


def brought_about(problem: BaseException) -> bool:
    """Whether an error that left a plan is that of a fault, or a composite failure in which there is one."""
    problem = opened(problem) if isinstance(problem, CommonLispErrorEnvelope) else problem
    if isinstance(problem, CompositeFailure):
        return any(map(brought_about, problem.failures or ()))
    return isinstance(problem, (InjectedFailure, InjectedError)) or isinstance(problem.__cause__, InjectedError)


def names(expect: Expected) -> str:
    """The names of the expected classes, for a sentence."""
    return " or ".join(each.__name__ for each in (expect if isinstance(expect, tuple) else (expect,)) if each is not None)


def observe(function: Callable[[], T], *arguments: Any, **options: Any) -> Outcome[T]:
    """The `Outcome` of ``function()`` in a `virtual_time` with the given arguments, without the checks of `run`."""
    with virtual_time(*arguments, **options) as watched:
        watched.watch_fluents()
        values: Sequence[Any] | None = None
        error: BaseException | None = None
        stack: Sequence[str] = ()
        try:
            values = all_values(function())
        except (KeyboardInterrupt, SystemExit):
            raise
        except BaseException as problem:
            error = problem
            stack = _places(error.__traceback__)
            _let_go_of_stacks(error, set())
        outcome: Outcome[T] = Outcome(values, error, watched)
        outcome.stack = stack
        for fault in watched.faults:
            fault.over()
        outcome.left = leftovers(watched)
    return outcome


def _let_go_of_stacks(error: object, known: set[int]) -> None:
    """Remove the tracebacks from an error, and from the errors in it: objects in them are not leftovers of the plan."""
    if isinstance(error, list | tuple | Cons):
        for other in error:
            _let_go_of_stacks(other, known)
    elif isinstance(error, BaseException) and id(error) not in known:
        known.add(id(error))
        error.__traceback__ = None
        for other in (error.__cause__, error.__context__, *vars(error).values()):
            _let_go_of_stacks(other, known)


def _places(stack: TracebackType | None) -> list[str]:
    """The functions and lines of a traceback, the innermost last."""
    places = []
    while stack is not None:
        places.append(f"{stack.tb_frame.f_code.co_filename}:{stack.tb_lineno} in {stack.tb_frame.f_code.co_name}")
        stack = stack.tb_next
    return places
