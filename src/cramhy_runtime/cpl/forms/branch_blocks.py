"""``par``, ``pursue`` and ``try-all`` as ``with`` blocks, whose branches are started one by one.

    with cpl.par() as branches:
        left = branches.start(turn_wheel, "left", speed=2.0)
        branches.start(watch_bumper)

The body runs in the task that entered the block, beside the branches; it is not a branch itself. At the end of the body the block waits
until the form is decided, as the form of that name does, with the same code (``tasks/branches.py``). If a failure of a branch of
``par``, or the first end of a branch of ``pursue``, decides the form earlier, the body ends at its next waiting point. If the body
leaves by an exception or is evaporated, the branches end first. In all cases the branches are dead when the block is left.

trio calls this a nursery. Different from trio, a failure is raised as itself and not in a group: only one failure can be the reason
why a form failed, and its siblings were evaporated for it.
"""

from __future__ import annotations

import sys
from functools import partial
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any, ParamSpec, Self, TypeVar

from cramhy_runtime import kernel
from cramhy_runtime.kernel.unstarted import callable_part

from cramhy_runtime.lisp_core.condition_types import Condition
from cramhy_runtime.lisp_core.conditions import error
from ..tasks.block_order import is_left_in_order
from ..tasks.timeouts import Block
from ..failures.python_exceptions import raise_in_python
from ..tasks.branches import Branches
from .operators import any_dead, any_done_or_all_dead, any_failed_or_all_dead, first_success, first_values, winner
from ..tasks.tasks import Task

if TYPE_CHECKING:
    from collections.abc import Callable

P = ParamSpec("P")
T = TypeVar("T")


class _Watched(Branches):
    """The branches of a block, which hears of each death."""

    __slots__ = ("block",)

    def __init__(self, block: BranchBlock):
        self.block = block
        super().__init__(block.form, [])

    def ended(self, task: Task) -> None:
        super().ended(task)
        if self.block.decided(self):
            self.block.end()


class BranchBlock(Block):
    """A ``with`` block with branches. After the block, ``result`` is the result of the form."""

    __slots__ = ("branches", "result")
    late_failures_count = True

    def __init__(self) -> None:
        super().__init__()
        self.branches: Branches = None  # type: ignore[assignment]  # before it is entered
        self.result: Any = None

    def decided(self, branches: Branches) -> object:
        """Whether the form is decided while the body may still start branches."""
        raise NotImplementedError

    def ready(self, branches: Branches) -> object:
        """Whether the form is decided when no more branches come."""
        raise NotImplementedError

    def choose(self, branches: Branches) -> tuple[Any, Any]:
        """The result and the failure of the form; the failure is ``None`` on success."""
        raise NotImplementedError

    @property
    def tasks(self) -> list[Task[object]]:
        """The tasks of the branches, in the order in which they were started."""
        return list(self.branches.tasks)

    def __bool__(self) -> bool:
        """False before ``with`` has entered the block: ``par(*[])`` gives one as well, and has started nothing."""
        return self.branches is not None

    def __enter__(self) -> Self:
        self.begin(sys._getframe(1))
        self.branches = _Watched(self)
        return self

    def discard(self) -> None:
        self.branches.end()
        super().discard()

    def start(self, function: Callable[P, T], /, *arguments: P.args, **keywords: P.kwargs) -> Task[T]:
        """Start ``function(*arguments, **keywords)`` as a branch and return its task. The branch runs when the current task waits.

        Only the task that entered the block may start branches, and only within the block; anything else is an error. A branch that
        starts branches opens a block of its own.
        """
        if self.branches is None or self.over:
            error(
                f"A branch was started {'after the end of' if self.over else 'before entering'} a {self.form} block. "
                f"Start it in the block: with cpl.{self.form.lower().replace('-', '_')}() as branches: branches.start(...)."
            )
        if kernel.current() is not self.kernel_task:
            error(
                f"A branch was started in a {self.form} block of another task. Start it in the task that entered the block, or open "
                "a block in this one: every task has one parent, which waits for it."
            )
        if self.asked:
            kernel.yield_()  # the body ends here, if nothing forbids that
        callable_part(function, f"{self.form.lower().replace('-', '_')}() as branches: branches.start", "a branch")
        body = partial(function, *arguments, **keywords) if arguments or keywords else function
        number = len(self.branches.tasks) + 1
        task: Task[T] = Task(body, lambda: f"[{_name(function) or f'{self.form}-CHILD-#{number}'}]")
        self.branches.add(task)
        return task

    def __exit__(self, kind: object, exception: BaseException | None, traceback: object) -> bool | None:
        if not is_left_in_order(self, exception):
            return False
        ended = self.ended_by(exception)
        branches = self.branches
        problem: BaseException | None = None
        try:
            if exception is not None and not ended:
                branches.abort(exception)
            try:
                if not ended:
                    branches.wait(self.ready)
                values, failure = self.choose(branches)
            except BaseException as raised:
                branches.abort(raised)
            self.result = branches.finish(values, failure, self.late_failures_count)
        except Condition as condition:
            problem = condition
        except BaseException as raised:
            if raised is not exception:
                raise
            problem = raised
        finally:
            self.leave()
        if problem is None:
            return True
        if problem is exception:
            return False
        raise_in_python(problem)


def _name(function: Any) -> str | None:
    while isinstance(function, partial):
        function = function.func
    name = getattr(function, "__name__", "<")
    return None if "<" in name else name


class ParBlock(BranchBlock):
    """``with par() as branches:`` ends when all branches have ended. If one fails, it ends the others and raises that failure."""

    __slots__ = ()
    form = "PAR"

    def decided(self, branches: Branches) -> object:
        return branches.failed

    def ready(self, branches: Branches) -> object:
        return any_failed_or_all_dead(branches)

    def choose(self, branches: Branches) -> tuple[Any, Any]:
        return first_values(branches) if branches.tasks else (None, None)

    @property
    def results(self) -> list[Any]:
        """The results of all branches, in the order in which they were started."""
        return [task.result for task in self.branches.tasks]


class RaceBlock(BranchBlock):
    """``with pursue() as race:`` ends when one branch has ended. ``race.result`` is its result. The other branches are evaporated."""

    __slots__ = ()
    form = "PURSUE"

    if TYPE_CHECKING:  # a bool: it may leave out the rest of its body without an exception; `ParBlock` does not

        def __exit__(self, kind: object, exception: BaseException | None, traceback: object) -> bool: ...

    def decided(self, branches: Branches) -> object:
        return any_dead(branches)

    def ready(self, branches: Branches) -> object:
        return any_dead(branches) or self._nobody()

    def choose(self, branches: Branches) -> tuple[Any, Any]:
        return winner(branches)

    def _nobody(self) -> bool:
        if not self.branches.tasks:
            error(f"A {self.form} block has no branches, so nobody can decide it. Start at least one in it.")
        return False


class TryAllBlock(RaceBlock):
    """``with try_all() as attempts:`` ends when one branch succeeds; ``attempts.result`` is its result. If all fail, it raises a
    `CompositeFailure`."""

    __slots__ = ()
    form = "TRY-ALL"
    late_failures_count = False

    def decided(self, branches: Branches) -> object:
        return branches.done

    def ready(self, branches: Branches) -> object:
        return self._nobody() or any_done_or_all_dead(branches)

    def choose(self, branches: Branches) -> tuple[Any, Any]:
        return first_success(branches)


class BesideBlock(RaceBlock):
    """Branches that watch the body. The end of a branch ends the body, and the end of the body ends the branches. Policies use it."""

    __slots__ = ()

    def ready(self, branches: Branches) -> object:
        return True

    def choose(self, branches: Branches) -> tuple[Any, Any]:
        return winner(branches) if branches.failed or branches.done else (None, None)
