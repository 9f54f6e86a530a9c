"""The branches of one parallel form, and the task that waits for them.

``par``, ``pursue``, ``try-all`` and the rest start one task per branch. They differ only in when the form is decided (`ready`) and in
its result (`choose`). The branches are counted as they end, so the waiting task is woken once, when the form is decided, and not at
the end of each of a thousand branches.

`run` keeps law 1 for all of them: when the wait ends, by a decision, a failure, an evaporation or an interrupt, it evaporates the living
branches and waits for their death before anything else happens. A failure of a branch *while* it is being evaporated is not lost: it
takes the place of the evaporation (cpl.md 3.7). The original has a wrapper task and a watcher around this (6, 6.9), and does not wait
when the form fails.
"""

from __future__ import annotations

from functools import partial

from cramhy_runtime import kernel

from cramhy_runtime.lisp_core import condition_types as types
from cramhy_runtime.lisp_core.conditions import SimpleWarning, error, warn
from ..failures.failure_types import PlanFailure, is_mistake, opened
from ..failures.handling import signal_failure
from ..current import inside_plan
from .ending import end_tasks
from ..logging import active_tags, log
from ..statuses import CREATED, DEAD, FAILED
from .tasks import AbstractTask, Task
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any, NoReturn

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from ..signatures import Thunk

    Ready = Callable[["Branches"], object]  # whether it is decided
    Choice = Callable[["Branches"], tuple[Any, Any]]  # what comes of it: (values, failure), failure None on success


class Branches:
    """A set of tasks started together. ``living``, ``failed`` and ``done`` are numbers of tasks.

    ``mistake`` is the first failure that says that the program is wrong (`is_mistake`), if there was one.
    """

    __slots__ = ("form", "tasks", "living", "failed", "done", "mistake", "waiter", "ready")

    def __init__(self, form: str, tasks: list[Task[object]]):
        self.form = form
        self.tasks = tasks
        self.living = len(tasks)
        self.failed = self.done = 0
        self.mistake: Any = None
        self.waiter: kernel.Task[object] | None = None
        self.ready: Ready | None = None
        try:
            for task in tasks:
                task.ended = self.ended
                task.execute()
        except BaseException:
            self.end()
            raise

    def add(self, task: Task[object]) -> None:
        """Start one more branch."""
        self.tasks.append(task)
        self.living += 1
        task.ended = self.ended
        task.execute()

    def ended(self, task: Task[object]) -> None:
        """Count ``task``, a branch that is dead now. Wakes the waiting task if that decides the form."""
        self.living -= 1
        if task.status is FAILED:
            self.failed += 1
            if self.mistake is None and is_mistake(task.result):
                self.mistake = task.result
        else:
            self.done += 1
        if self.waiter is not None and self.ready(self):
            self.waiter.kernel.unpark(self.waiter)

    def wait(self, ready: Ready) -> None:
        """Wait until ``ready(self)``, and until all branches have started, however early one of them decides the form (invariant 97)."""
        self.waiter = kernel.current()
        self.ready = ready
        while not ready(self):
            self.waiter.kernel.park(self._why)
        if self.living:
            for task in self.tasks:
                while task.status is CREATED:  # only where a seed shuffles who runs next
                    kernel.yield_()

    def _why(self) -> str:
        return f"the branches of {self.form.upper()}: " + ", ".join(task.name for task in self.tasks if task.alive)

    def end(self) -> Sequence[Task[object]]:
        """Evaporate the living branches and wait until they are dead. Returns those that failed meanwhile."""
        if not self.living:
            return ()
        self.waiter = None
        living = [task for task in self.tasks if task.status not in DEAD]
        end_tasks(living)
        return [task for task in living if task.status is FAILED]

    def abort(self, exception: BaseException) -> NoReturn:
        """End the branches because the waiting task leaves with ``exception``. Raises it, or the failure of a branch meanwhile."""
        late = self.end()
        if late and isinstance(exception, kernel.Cancelled):
            raise self.last_failure() from None
        _warn_of_lost(late)
        raise exception

    def finish(self, values: Any, failure: Any, late_failures_count: bool = True) -> Any:
        """End the branches that are left when the form is decided, and return ``values`` or signal ``failure``.

        ``late_failures_count``: a branch that fails while it is ended makes the form fail.
        """
        if self.living:
            late = self.end()
            if failure is None and late and late_failures_count:
                failure = self.last_failure()
            elif failure is None:
                _warn_of_lost(late)
        if failure is not None:
            if self.failed > 1 and isinstance(failure, PlanFailure):
                _note_beside(failure, self.tasks)
            signal_failure(failure)
        return values

    def last_failure(self) -> Any:
        """The failure of the failed branch with the highest position, or ``None``."""
        for task in reversed(self.tasks):
            if task.status is FAILED:
                return task.result
        return None


def run(form: str, tasks: list[Task[object]], ready: Ready, choose: Choice, late_failures_count: bool = True) -> Any:
    """Start ``tasks`` as children of the current task, wait until ``ready(branches)``, and end the rest.

    Then ``choose(branches)`` gives (values, failure), with failure ``None`` on success: returns the values or signals the failure.
    """
    if active_tags:
        log(form, "branches: ~d", len(tasks))
    branches = Branches(form, tasks)
    try:
        branches.wait(ready)
        if active_tags:
            log(form, "decided: ~d running, ~d done, ~d failed", branches.living, branches.done, branches.failed)
        values, failure = choose(branches)
    except BaseException as exception:
        branches.abort(exception)
    return branches.finish(values, failure, late_failures_count)


def _note_beside(failure: PlanFailure, tasks: Sequence[Task[object]]) -> None:
    """Keep the failures of the other ``tasks`` with ``failure``, with which the form fails, so that the user hears of them (law 3)."""
    known = [*getattr(failure, "beside", ())]
    seen = {id(opened(failure)), *(id(other) for _, other in known)}
    known += [
        (f"{task.name} failed too", opened(task.result)) for task in tasks if task.status is FAILED and id(opened(task.result)) not in seen
    ]
    failure.beside = opened(failure).beside = known


def _warn_of_lost(tasks: Sequence[Task[object]]) -> None:
    """Warn of the failures of ``tasks`` that no form can take any more: they failed while they were ended for another reason."""
    for task in tasks:
        if isinstance(task.result, PlanFailure):
            warning = SimpleWarning("~a failed while it was ended: ~a", task.name, opened(task.result))
            warning.position = getattr(opened(task.result), "position", None)
            warn(warning)


def branch_tasks(form: str, thunks: Sequence[Thunk[Any]]) -> list[Task[object]]:
    """A new task for each thunk, named after its position: ``[PAR-CHILD-#1/2]-7``."""
    count = len(thunks)
    return [Task(thunk, partial(_branch_name, form, index, count)) for index, thunk in enumerate(thunks, 1)]


def _branch_name(form: str, index: int, count: int) -> str:
    return f"[{form}-CHILD-#{index}/{count}]"


def run_forms(form: str, thunks: Sequence[Thunk[Any]], ready: Ready, choose: Choice, late_failures_count: bool = True) -> Any:
    """`run` for a plan form with one branch per thunk. Outside of a plan (cpl.md 5.3) and without branches it is an error."""
    inside_plan(form)
    if not thunks:
        error(
            types.SimpleError("wait-for called with nil argument."), hint=f"There is no branch to wait for: {form} needs one form at least."
        )
    tasks = branch_tasks(form, thunks)
    return run(form, tasks, ready, choose, late_failures_count)


def run_one(task: AbstractTask[object], form: str | None = None) -> Any:
    """Start ``task`` as a child of the current task and wait for it. Returns its values or signals its failure."""
    return run(form or str(task.name), [task], nobody_lives, only_values)


def nobody_lives(branches: Branches) -> bool:
    """Whether all branches are dead."""
    return not branches.living


def only_values(branches):
    """The values and the failure of the only branch."""
    task = branches.tasks[0]
    return (None, task.result) if task.status is FAILED else (task.result, None)
