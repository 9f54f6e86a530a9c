"""Blocks: pieces of a task that can be ended while the task lives on, written as ``with`` statements.

A form of the plan language gets its body as a function and runs it as a branch, which can be evaporated. The body of a Python
``with`` statement runs in the task that entered it. To end the body, a `BlockEnded` is raised in that task at its next waiting point,
and stops at the block. It evaporates a piece of a task, and keeps the rules of evaporation. It is delivered once. Nothing that ends
later disturbs cleanup in the block; even a request to end the whole task waits until the block is left. A suspension comes first,
and the block ends after the wake-up. Blocks around it that are ended meanwhile end after it.

trio calls this a cancel scope. ``timeout`` and ``move_on_after`` are blocks, and so are the forms with branches in
``forms/branch_blocks.py``.
"""

from __future__ import annotations

from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Self

from cramhy_runtime import kernel

from cramhy_runtime.ground.conditions import error
from ..failures.python_exceptions import raise_in_python
from ..current import inside_plan
from ..failures.failure_types import PlanFailure
from ..failures.handling import fail
from .pausing import obey


if TYPE_CHECKING:
    from .tasks import AbstractTask


class BlockEnded(kernel.Cancelled):
    """Unwinds to the `Block` that was ended. Like an evaporation it is not an `Exception`, and user code need not catch it."""

    def __init__(self, block: Block):
        super().__init__(f"the block {block.form} has ended")
        self.block = block


class Block:
    """A ``with`` block that `end` ends. A block can be entered once only."""

    __slots__ = ("task", "kernel_task", "asked", "delivered", "over", "level")
    form = "BLOCK"

    def __init__(self) -> None:
        self.task: AbstractTask[object] = None  # type: ignore[assignment]  # both are there from when it is entered
        self.kernel_task: kernel.Task[object] = None  # type: ignore[assignment]
        self.asked = self.delivered = self.over = False
        self.level: tuple[bool, int] = (False, 0)  # what was unwinding already when it was entered

    def __enter__(self) -> Self:
        if self.kernel_task is not None:
            error(f"A {self.form} block was entered twice. Make a new one for each `with`.")
        self.task = inside_plan(self.form)
        me = self.kernel_task = kernel.current()
        blocks = getattr(me.local, "blocks", None)
        if blocks is None:
            blocks = me.local.blocks = []
        self.level = level(me)
        blocks.append(self)
        return self

    def end(self) -> None:
        """Ask the block to end. It unwinds from the next waiting point of its body. Any task, and any timer, may ask."""
        if not (self.asked or self.over):
            self.asked = True
            self.remind()

    def remind(self) -> None:
        """Let the block end now if it was asked to end earlier and could not."""
        if self.asked and not self.delivered and not self.over:
            self.kernel_task.interject(self._unwind)

    def _unwind(self) -> None:
        """Called in the block's task, at a waiting point."""
        me = self.kernel_task
        if self.over or self.delivered or level(me) != self.level or getattr(me.local, "obeying", False):
            return
        if self.task.held:
            obey(self.task)
        self.delivered = True
        me.unwinds()
        raise BlockEnded(self)

    def ended_by(self, exception: BaseException | None) -> bool:
        """Note that the block is left with ``exception``, so it cannot be ended any more. Returns whether `end` ended it."""
        self.over = True
        return isinstance(exception, BlockEnded) and exception.block is self

    def leave(self) -> None:
        """Note that the block is left, and that everything in it is dead."""
        me = self.kernel_task
        me.local.blocks.remove(self)
        if self.delivered and not self.level[0]:
            me.unwound()
        for block in me.local.blocks:
            block.remind()


def level(me: kernel.Task[object]) -> tuple[bool, int]:
    """(Whether the whole task ``me`` of the kernel is unwinding, how many of its blocks are)."""
    return me.cancelled_delivered, sum(block.delivered for block in me.local.blocks)


class TimedOut(PlanFailure):
    """The time of a ``with cpl.timeout(seconds):`` block was over. ``seconds`` is its limit."""

    lisp_name = "CRAMHY::TIMED-OUT"
    initargs = {"SECONDS": "seconds"}
    seconds: float | None = None

    def report(self) -> str:
        return f"The time of {self.seconds:g} s was over." if self.seconds is not None else super().report()


class Timeout(Block):
    """The block of `timeout` and `move_on_after`. Afterwards, ``expired`` says whether the time was over."""

    __slots__ = ("seconds", "failing", "expired", "timer")
    form = "TIMEOUT"

    def __init__(self, seconds: float, failing: bool):
        super().__init__()
        self.seconds, self.failing = seconds, failing
        self.expired = False
        self.timer: kernel.Timer | None = None

    def __enter__(self) -> Self:
        super().__enter__()
        if self.seconds < float("inf"):
            self.timer = kernel.call_at(kernel.now() + max(self.seconds, 0), self.end)
        return self

    def __exit__(self, kind: object, exception: BaseException | None, traceback: object) -> bool | None:
        self.expired = self.ended_by(exception)
        if self.timer is not None:
            self.timer.cancel()
        self.leave()
        if self.expired and self.failing:
            try:
                fail(TimedOut(seconds=self.seconds))
            except PlanFailure as failure:
                problem = failure
            raise_in_python(problem)
        return self.expired


if TYPE_CHECKING:

    class MovingOn(Timeout):
        """The block of `move_on_after`. Unlike `timeout` it may leave out the rest of its body without an exception."""

        def __exit__(self, kind: object, exception: BaseException | None, traceback: object) -> bool: ...


def timeout(seconds: float) -> Timeout:
    """``with cpl.timeout(seconds):`` ends its body after ``seconds`` of the kernel's clock and raises `TimedOut`.

    Cleanup in the body runs first. Infinity means no limit. Outside of a plan it is an error.
    """
    return Timeout(seconds, True)


def move_on_after(seconds: float) -> MovingOn:
    """``with cpl.move_on_after(seconds) as limit:`` ends its body after ``seconds`` of the kernel's clock and goes on after the block.

    ``limit.expired`` says whether the time was over. Infinity means no limit. Outside of a plan it is an error.
    """
    return Timeout(seconds, False)  # type: ignore[return-value]
