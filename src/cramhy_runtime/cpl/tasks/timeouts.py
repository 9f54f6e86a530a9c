"""Blocks: pieces of a task that can be ended while the task lives on, written as ``with`` statements.

A form of the plan language gets its body as a function and runs it as a branch, which can be evaporated. The body of a Python
``with`` statement runs in the task that entered it. To end the body, a `BlockEnded` is raised in that task at its next waiting point,
and stops at the block. It evaporates a piece of a task, and keeps the rules of evaporation. While it unwinds the stack, nothing that
ends later disturbs cleanup in the block; even a request to end the whole task waits until the block is left. If code swallows it, it is
raised again at the next waiting point, and so on until the block is left. A suspension comes first, and the block ends after the wake-up.
Blocks around it that are ended meanwhile end after it.

trio calls this a cancel scope. ``timeout`` and ``move_on_after`` are blocks, and so are the forms with branches in
``forms/branch_blocks.py``. Blocks are left in the reverse order in which they were entered, in the task that entered them. Anything else,
which a generator that waits inside of a block can bring about, is an error with both places (``block_order.py``).
"""

from __future__ import annotations

import sys

from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Self

from cramhy_runtime import kernel
from cramhy_runtime.kernel.timers import seconds as in_seconds

from cramhy_runtime.lisp_core.conditions import error
from ..failures.python_exceptions import raise_in_python
from ..current import inside_plan
from ..failures.failure_types import PlanFailure
from ..failures.handling import fail
from . import block_order
from .pausing import obey


if TYPE_CHECKING:
    from types import CodeType, FrameType

    from .tasks import AbstractTask


class BlockEnded(kernel.Cancelled):
    """Unwinds to the `Block` that was ended. Like an evaporation it is not an `Exception`, and user code need not catch it."""

    def __init__(self, block: Block):
        super().__init__(f"the block {block.form} has ended")
        self.block = block


class Block:
    """A ``with`` block that `end` ends. A block can be entered once only. It is a `kernel.tasks.Part` of its task while it unwinds."""

    __slots__ = ("task", "kernel_task", "asked", "delivered", "struck", "over", "level", "exception", "ended_before", "place", "generator")
    form = "BLOCK"

    def __init__(self) -> None:
        self.task: AbstractTask[object] = None  # type: ignore[assignment]  # both are there from when it is entered
        self.kernel_task: kernel.Task[object] = None  # type: ignore[assignment]
        self.asked = self.delivered = self.struck = self.over = self.ended_before = False
        self.exception: BaseException  # while it unwinds
        self.place: tuple[CodeType, int]  # where it was entered: the code, the instruction
        self.level: tuple[bool, int] = (False, 0)  # what was unwinding already when it was entered
        self.generator: FrameType | None = None

    def __enter__(self) -> Self:
        self.begin(sys._getframe(1))
        return self

    def begin(self, frame: FrameType | None) -> None:
        """Enter the block, in ``frame``; ``None``: where no generator can stand between its beginning and its end."""
        if self.kernel_task is not None:
            error(f"A {self.form} block was entered twice. Make a new one for each `with`.")
        self.task = inside_plan(self.form)
        self.kernel_task = me = kernel.current()
        local = me.local
        try:
            blocks = local.blocks
        except AttributeError:
            blocks = local.blocks = []
        self.level = level(me)
        if frame is not None:
            code = frame.f_code
            if code.co_flags & block_order.GENERATOR or code.co_name in block_order.PASSED:
                frame = block_order.who_enters(frame)
                if frame.f_code.co_flags & block_order.GENERATOR:
                    self.generator = frame
            self.place = frame.f_code, frame.f_lasti
        blocks.append(self)

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
        if self.generator is not None:
            block_order.check_runs(self)
        if self.task.held:
            obey(self.task)
        self.strike()

    def strike(self) -> None:
        """Raise the end of the block, and protect its cleanup from then on."""
        self.delivered = self.struck = True
        self.exception = BlockEnded(self)
        self.kernel_task.unwinds(self)
        raise self.exception

    def again(self) -> None:
        """Note that the body swallowed the end, and end it again at this waiting point, or a block around it that waits for its end."""
        self.delivered = False
        for block in self.kernel_task.local.blocks:
            block.remind()

    def ended_by(self, exception: BaseException | None) -> bool:
        """Note that the block is left with ``exception``, so it cannot be ended any more. Returns whether `end` ended it."""
        self.over = True
        return isinstance(exception, BlockEnded) and exception.block is self

    def leave(self) -> None:
        """Note that the block is left, and that everything in it is dead."""
        me = self.kernel_task
        blocks = me.local.blocks
        blocks.remove(self)
        self.generator = None
        if self.struck:
            me.unwound(self)
            del self.exception
        for block in blocks:
            if block.asked:
                block.remind()

    def discard(self) -> None:
        """Close the block without its ``with`` statement, which cannot do that any more."""
        self.over = True
        self.leave()


def level(me: kernel.Task[object]) -> tuple[bool, int]:
    """(Whether the whole task ``me`` of the kernel is unwinding, how many parts of it are)."""
    return me.cancelled_delivered, len(me.parts) if me.parts else 0


INFINITY = float("inf")


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
        self.begin(sys._getframe(1))
        seconds = self.seconds
        if seconds < INFINITY:
            running = self.kernel_task.kernel
            self.timer = running.call_at(running.clock.now() + (seconds if seconds > 0 else 0), self.end)
        return self

    def __exit__(self, kind: object, exception: BaseException | None, traceback: object) -> bool | None:
        if not block_order.is_left_in_order(self, exception):
            return False
        ended = self.ended_by(exception)
        timer = self.timer
        if timer is not None:
            # A body that swallowed the end, or computed all the time, or was shielded, is late as well.
            late = exception is None and (self.asked or timer.time <= self.kernel_task.kernel.clock.now())
            timer.cancel()
            self.expired = ended or late or self.struck
        self.leave()
        if not (ended or timer is not None and late):
            return False
        if self.failing:
            try:
                fail(TimedOut(seconds=self.seconds))
            except PlanFailure as failure:
                problem = failure
            raise_in_python(problem)
        return ended

    def discard(self) -> None:
        if self.timer is not None:
            self.timer.cancel()
        super().discard()


if TYPE_CHECKING:

    class MovingOn(Timeout):
        """The block of `move_on_after`. Unlike `timeout` it may leave out the rest of its body without an exception."""

        def __exit__(self, kind: object, exception: BaseException | None, traceback: object) -> bool: ...


def timeout(seconds: float) -> Timeout:
    """``with cpl.timeout(seconds):`` ends its body after ``seconds`` of the kernel's clock and raises `TimedOut`.

    Cleanup in the body runs first. A body that goes on all the same, because it swallows its end, is ended again and again. Infinity
    means no limit, and zero and less that the body ends where it first waits. NaN is a ValueError, and what is not a number a TypeError.
    Outside of a plan it is an error.
    """
    return Timeout(in_seconds(seconds, "cpl.timeout({})"), True)


def move_on_after(seconds: float) -> MovingOn:
    """``with cpl.move_on_after(seconds) as limit:`` ends its body after ``seconds`` of the kernel's clock and goes on after the block.

    ``limit.expired`` says whether the time was over. As for `timeout`, infinity means no limit, zero and less an end at the first wait.
    NaN is a ValueError, and what is not a number a TypeError. Outside of a plan it is an error.
    """
    return Timeout(in_seconds(seconds, "cpl.move_on_after({})"), False)  # type: ignore[return-value]
