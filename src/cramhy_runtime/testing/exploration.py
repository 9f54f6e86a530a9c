"""Exploring a plan: does its result depend on who happens to go first?

    testing.explore(plan, schedules=1000)

runs it with first come, first served, and then with 999 seeds, and compares what comes of it. When a run differs, its schedule is
shrunk, as property-based testing shrinks an input: to the shortest prefix of decisions that still makes the difference, and of these
to the fewest that are not those of first come, first served. The message says, decision by decision, who could go on and who went,
and how to see it again. The idea of exploring schedules under a seed is that of systematic concurrency testing (CHESS, loom);
one baton makes it cheap here.
"""

from __future__ import annotations

from .plans import plan_of, with_lisp
from .runs import TIME_LIMIT, observe
from .schedules import Schedule, without_defaults
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any, Generic, NoReturn, TypeVar, subscripted

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from cramhy_runtime.kernel.signatures import Backend, BackendName
    from .plans import Plan
    from .runs import Outcome
    from .schedules import Decision

T = TypeVar("T", default=Any)
if TYPE_CHECKING:
    Check = Callable[[T], object] | Callable[[Outcome[T]], object] | str  # Lisp, as a text, gives a function

MOST_RUNS_TO_SHRINK = 2000


class DependsOnLuck(AssertionError):
    """A plan whose result is not the same, or not right, under every schedule.

    ``schedule``: the shortest that shows it; ``seed``: the one it was found with, None for first come, first served; ``outcome``:
    what came of it; ``expected``: what came of first come, first served; ``decisions``: those of the schedule.
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
    """What `explore` saw: how many ``runs``, the ``different`` schedules among them, and the common ``outcome``."""

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
    backend: BackendName | Backend = "threads",
    replay: Sequence[int] | None = None,
    time_limit: float | None = TIME_LIMIT,
) -> Exploration[T]:
    """Run ``plan`` under so many schedules and see that nothing depends on luck; returns an `Exploration`.

    The first run is first come, first served, the next use the seeds 1, 2, ...; each has a fresh kernel. Without ``check`` all runs
    must end alike (`Outcome.same`). ``check(value)`` says of the plan's first value whether it is right: by raising an AssertionError
    or by returning false (a Python function may return None for right); an error that leaves the plan is wrong then. A check that takes an
    `Outcome` is marked so by ``check.of_outcome = True``. ``replay``: a schedule, to run that one only. Raises `DependsOnLuck`.
    """
    function = plan_of(plan)
    if isinstance(check, str):
        check = _lisp_check(check)
    explorer = _Explorer(function, check, backend, time_limit)
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
        result = predicate(value)
        return result is not None and result is not False

    return check


class _Explorer(Generic[T]):
    """The runs of one exploration."""

    def __init__(
        self, function: Callable[[], T], check: Callable[[Any], object] | None, backend: BackendName | Backend, time_limit: float | None
    ):
        self.function, self.check, self.backend, self.time_limit = function, check, backend, time_limit
        self.expected: Outcome[T] | None = None
        self.runs = 0

    def run(self, prefix: Sequence[int] = (), seed: int | None = None, noting: bool = False) -> tuple[Outcome[T], Schedule]:
        schedule = Schedule(prefix, seed, noting)
        outcome = observe(self.function, self.backend, schedule=schedule, time_limit=self.time_limit)
        self.runs += 1
        if self.expected is None:
            self.expected = outcome if not prefix and seed is None else self.run()[0]
        return outcome, schedule

    def wrong(self, outcome: Outcome[T]) -> str | None:
        """What is wrong with OUTCOME, as text; None if nothing is."""
        if self.check is None:
            return None if outcome.same(self.expected) else "the result is another one"
        if getattr(self.check, "of_outcome", False):
            return self._checked(outcome)
        return self._checked(outcome.value) if outcome.error is None else f"it ended with {outcome}"

    def _checked(self, value: object) -> str | None:
        try:
            return "the check says no" if self.check(value) is False else None
        except AssertionError as problem:
            return f"the check says: {problem or 'no'}"

    def breaks(self, choices: Sequence[int]) -> bool:
        outcome, schedule = self.run(choices)
        return schedule.misfit is None and self.wrong(outcome) is not None

    def shrink(self, choices: Sequence[int]) -> list[int]:
        """The shortest prefix of CHOICES that breaks the plan, with as many zeros as possible."""
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
