"""Exploring a plan: does its result depend on the order in which its tasks run?

    testing.explore(plan, schedules=1000)

runs it first come, first served, then with 999 seeds, and compares the outcomes. If a run differs, its schedule is shrunk, as
property-based testing shrinks an input: to the shortest prefix of decisions that still makes the difference, and then to the fewest
decisions that differ from first come, first served. The message shows for each decision which tasks could go on and which one did, and
how to repeat it. Exploring schedules under a seed is the idea of systematic concurrency testing (CHESS, loom); with one baton it is cheap.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import one, truth
from cramhy_runtime.kernel.unstarted import ran
from .plans import plan_of, with_lisp
from .runs import TIME_LIMIT, check_expected, is_expected, names, observe
from .schedules import Schedule, without_defaults
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any, Generic, NoReturn, TypeVar, subscripted

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from cramhy_runtime.kernel.signatures import Backend, BackendName
    from .plans import Plan
    from .runs import Expected, Outcome
    from .schedules import Decision

T = TypeVar("T", default=Any)
if TYPE_CHECKING:
    Check = Callable[[T], object] | Callable[[Outcome[T]], object] | str  # Lisp, as a text, gives a function

MOST_RUNS_TO_SHRINK = 2000


class DependsOnLuck(AssertionError):
    """The result of a plan is not the same, or not right, under every schedule.

    ``schedule`` is the shortest that shows it, and ``decisions`` are its decisions. ``seed`` is the seed with which it was found, None for
    first come, first served. ``outcome`` is the outcome of the schedule, ``expected`` that of first come, first served.
    """

    def __init__(
        self,
        text: str,
        schedule: list[int],
        seed: int | None,
        outcome: Outcome[object],
        expected: Outcome[object] | None,
        decisions: list[Decision],
    ):
        super().__init__(text)
        self.schedule, self.seed, self.outcome, self.expected, self.decisions = schedule, seed, outcome, expected, decisions


class Exploration(Generic[T]):
    """The result of `explore`: the number of ``runs``, of ``different`` schedules among them, and the common ``outcome``."""

    __class_getitem__ = subscripted

    def __init__(self, runs: int, different: int, outcome: Outcome[T]):
        self.runs, self.different, self.outcome = runs, different, outcome

    def __repr__(self) -> str:
        return f"<exploration: {self.runs} runs, {self.different} different schedules, each time {self.outcome}>"


def explore(
    plan: Plan[T],
    schedules: int = 1000,
    check: Check[T] | None = None,
    *,
    backend: BackendName | Backend = "auto",
    replay: Sequence[int] | None = None,
    time_limit: float | None = TIME_LIMIT,
    expect: Expected = None,
) -> Exploration[T]:
    """Run ``plan`` under many schedules and check that the result does not depend on the order of tasks. Returns an `Exploration`.

    schedules: the number of runs, each in a fresh kernel. The first is first come, first served; the others use the seeds 1, 2, ...
    check: without it all runs must end alike (`Outcome.same`), and well. ``check(value)`` gets the plan's first value; if the value is
    wrong, it raises an AssertionError or returns what Python or numpy takes for false. A function that only asserts may return None; that
    of a lambda is a no. An error that leaves the plan counts as wrong. A check with the attribute ``of_outcome = True`` gets the `Outcome`
    instead. expect: the class of the error with which the plan has to end each time, or a tuple of classes; without it such an error
    is raised.
    backend: as for `kernel.start`. replay: a schedule, to
    run only that one. time_limit: seconds of virtual time for each run. Raises `DependsOnLuck`, and ValueError if ``replay`` does not fit.
    """
    function = plan_of(plan)
    if isinstance(check, str):
        check = _lisp_check(check)
    check_expected(expect)
    explorer = _Explorer(function, check, backend, time_limit, expect)
    if replay is not None:
        outcome, schedule = explorer.run(replay)
        if schedule.misfit is not None:
            raise ValueError(
                f"The schedule does not fit the plan: at decision {schedule.misfit + 1} there is no candidate "
                f"{schedule.prefix[schedule.misfit]}. Was it recorded with this plan, and this version of it?"
            )
        if explorer.wrong(outcome):
            explorer.report(list(replay), None)
        return Exploration(1, 1, outcome)
    seen = set()
    for seed in range(schedules):
        outcome, schedule = explorer.run((), seed or None)
        seen.add(tuple(without_defaults(schedule.choices)))
        if explorer.wrong(outcome):
            explorer.report(explorer.shrink(schedule.choices), seed or None)
    return Exploration(schedules, len(seen), explorer.expected)


def _lisp_check(text: str) -> Callable[[object], bool]:
    predicate = with_lisp(lambda: plan_of(text)())

    def check(value):
        return truth(one(predicate(value)))

    return check


def _may_return_nothing(check: Any) -> bool:
    """Whether ``None`` from ``check`` can mean that all its assertions held: it is a `def`, or a method, or a part of one."""
    while hasattr(check, "func"):  # functools.partial
        check = check.func
    return hasattr(check, "__code__") and check.__name__ != "<lambda>"


class _Explorer(Generic[T]):
    """The runs of one exploration."""

    def __init__(
        self,
        function: Callable[[], T],
        check: Callable[[Any], object] | None,
        backend: BackendName | Backend,
        time_limit: float | None,
        expect: Expected,
    ):
        self.function, self.check, self.backend, self.time_limit, self.expect = function, check, backend, time_limit, expect
        self.expected: Outcome[T] | None = None
        self.runs = 0

    def run(self, prefix: Sequence[int] = (), seed: int | None = None, noting: bool = False) -> tuple[Outcome[T], Schedule]:
        """Run the plan once. Returns the outcome and the schedule."""
        schedule = Schedule(prefix, seed, noting)
        outcome = observe(self.function, self.backend, schedule=schedule, time_limit=self.time_limit)
        self.runs += 1
        if self.expected is None:
            self.expected = outcome if not prefix and seed is None else self.run()[0]
        return outcome, schedule

    def wrong(self, outcome: Outcome[T]) -> str | None:
        """A text that says what is wrong with ``outcome``, or ``None``."""
        if self.check is None:
            return self._unexpected(outcome) if outcome.same(self.expected) else "the result is another one"
        if getattr(self.check, "of_outcome", False):
            return self._checked(outcome)
        return self._checked(outcome.value) if outcome.error is None else f"it ended with {outcome}"

    def _unexpected(self, outcome: Outcome[T]) -> str | None:
        """Raise the error of a plan that fails whoever goes first, unless that is expected; or tell that it does not come."""
        if outcome.error is not None and not is_expected(outcome.error, self.expect):
            raise outcome.error
        if outcome.error is None and self.expect is not None:
            raise AssertionError(f"The plan was to end with {names(self.expect)}, but it ended well, with {outcome}.")
        return None

    def _checked(self, value: object) -> str | None:
        try:
            answer = ran(self.check(value), "a check")
            return None if answer or answer is None and _may_return_nothing(self.check) else "the check says no"
        except AssertionError as problem:
            return f"the check says: {problem or 'no'}"

    def breaks(self, choices: Sequence[int]) -> bool:
        """Whether the schedule ``choices`` fits the plan and gives a wrong outcome."""
        outcome, schedule = self.run(choices)
        return schedule.misfit is None and self.wrong(outcome) is not None

    def shrink(self, choices: Sequence[int]) -> list[int]:
        """The shortest prefix of ``choices`` that breaks the plan, with as many zeros as possible."""
        choices = without_defaults(choices)
        limit = self.runs + MOST_RUNS_TO_SHRINK
        for length in range(len(choices)):
            if (length == 0 or choices[length - 1]) and self.breaks(choices[:length]):
                choices = choices[:length]
                break
            if self.runs > limit:
                break
        for index, choice in enumerate(choices):
            if choice and self.runs <= limit:
                other = [*choices[:index], 0, *choices[index + 1 :]]
                if self.breaks(without_defaults(other)):
                    choices = other
        return without_defaults(choices)

    def report(self, choices: list[int], seed: int | None) -> NoReturn:
        """Raise `DependsOnLuck` for the schedule ``choices``."""
        outcome, schedule = self.run(choices, noting=True)
        decisions = schedule.decisions[: len(choices)]
        found = "first come, first served" if seed is None else f"seed {seed}"
        lines = [
            f"The plan depends on who goes first: {self.wrong(outcome)} with this schedule.",
            f"  expected (first come, first served): {self.expected}" if self.check is None else "",
            f"  got: {outcome}",
            f"Found with {found}. The shortest schedule that shows it: {choices}, then first come, first served.",
        ]
        for number, decision in enumerate(decisions, 1):
            lines.append(f"  decision {number}, at {decision.time:g} s:")
            for index, candidate in enumerate(decision.candidates):
                chosen = "->" if index == decision.choice else "  "
                note = "   (first come, first served would have taken the first)" if index == decision.choice and index else ""
                lines.append(f"    {chosen} {index} {candidate}{note}")
        lines.append(f"See it again: testing.run(plan, schedule={choices}), or explore(..., replay={choices}).")
        raise DependsOnLuck("\n".join(line for line in lines if line), choices, seed, outcome, self.expected, decisions)
