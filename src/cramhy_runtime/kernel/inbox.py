"""The world outside of the kernel: messages that come in, and calls that block.

Outside threads (bridges, servers, a helper that waits for a socket) never touch tasks. They put a function into the inbox,
and the thread that looks for the next task calls it, with the baton. A task that must block goes outside itself: it gives the
baton away, blocks, and comes back by a message.

In virtual time the clock stands still as long as a task is outside, since it is unknown how much virtual time its call
takes. It also stands still while a program outside owes an answer (`time_held`). A source that only may send messages
(`outside_source`) does not hold the clock, but waiting for it is not a deadlock.
"""

from __future__ import annotations

from _thread import get_ident
from contextvars import copy_context
from contextlib import contextmanager

from .budget import SLICE, budget, need_headroom
from .tasks import BLOCKED, RUNNING
from .typing_names import TYPE_CHECKING, Literal, Self, TypeVar, TypeVarTuple

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from .signatures import Callback
    from .tasks import Task

T = TypeVar("T")
Arguments = TypeVarTuple("Arguments")


class Outside:
    """The part of the kernel that deals with other threads."""

    __slots__ = ()

    # ------------------------------------------------------------------ messages

    def post(self, fn: Callback) -> None:
        """Call FN in the scheduler, soon. Safe from any thread and from signal handlers. FN must not park."""
        self._inbox.append(fn)
        self._bell.ring()

    def _read_inbox(self) -> None:
        inbox = self._inbox
        for _ in range(len(inbox)):
            self._call(inbox.popleft())

    def outside_source(self) -> OutsideSource:
        """A context manager. While it is open, messages may still come from outside, and waiting is not a deadlock.

        May be entered and left in any thread.
        """
        return OutsideSource(self)

    @property
    def idle_seconds(self) -> float:
        """Seconds of wall time so far for which there was nothing to do. Any thread may ask."""
        return self._bell.waited

    @property
    def hears_outside(self) -> bool:
        """Whether messages may come from outside, so that a task that waits for something else must not keep the baton."""
        return self._outside > 0

    @property
    def stops(self) -> bool:
        """Whether the kernel is about to stop."""
        return self._stopping

    def count_outside(self, difference: int) -> None:
        """Change the number of open sources."""
        self._outside += difference

    def time_held(self) -> TimeHeld:
        """A context manager. While it is open, virtual time stands still, as if a task were outside. Use it only with the baton."""
        return TimeHeld(self)

    def count_blocking(self, difference: int) -> None:
        """Change the number of calls that hold virtual time."""
        self._blocking += difference

    # ------------------------------------------------------------------ calls that block

    def run_blocking(self, fn: Callable[[*Arguments], T], *args: *Arguments) -> T:
        """Run FN(*ARGS) outside of the kernel and return its result. Other tasks run meanwhile.

        In virtual time the clock stands still until FN has returned. A request to end the task is delivered when FN has
        returned. An interrupt of the main task breaks FN off, if it comes from a signal handler or if FN runs in a helper
        thread (whose result is then lost). Inside of `woken_by` it does not: FN is woken, and returns. Exceptions of FN are
        raised here. FN sees the caller's context variables, as in ``asyncio.to_thread``; what it sets is its own.
        """
        me = self.current
        if me.attention:
            me.deliver()
        need_headroom()
        if me.carrier.ident != get_ident():
            self._refuse("start a blocking call")
        me.why = lambda: f"the call {getattr(fn, '__name__', fn)!s} outside of the kernel"
        dynamic = me.dynamic
        if dynamic is not None:
            dynamic.leave()
        try:
            context = copy_context()
            return self.backend.run_blocking(self, me, lambda: context.run(fn, *args))
        finally:
            me.state = RUNNING
            self.current = me
            budget.left = SLICE
            if dynamic is not None:
                dynamic.enter()
            if me.attention:
                me.deliver()

    @contextmanager
    def woken_by(self, wake: Callback) -> Iterator[None]:
        """During the block, an interrupt, or a signal that ends the process, calls WAKE, which ends the wait in the block.

        It is for waits that an exception must not break off, since they hold data, such as a typed line. A signal handler or any thread
        may call WAKE, more than once, so it must be safe for both.
        """
        before = self._wakers
        self._wakers = (*before, wake)
        try:
            yield
        finally:
            self._wakers = before

    def wake(self) -> None:
        """Call the functions of `woken_by`, the innermost one last."""
        for wake in self._wakers:
            wake()

    def leave(self, task: Task[object]) -> int:
        """Note that TASK goes outside. Returns the number of this visit, for `comes_back`."""
        self.current = self._scheduler
        task.state = BLOCKED
        self._blocking += 1
        return task.ticket

    def comes_back(self, task: Task[object], visit: int | None = None) -> None:
        """Note that TASK is back from outside, unless it was called back before (then VISIT is an old number)."""
        if task.state is BLOCKED and (visit is None or visit == task.ticket):
            task.ticket += 1
            self._blocking -= 1
            self._enqueue(task)

    def nothing_can_happen(self) -> bool:
        """True if no task could run and no time could pass while the current task is outside."""
        entries = self._timers.entries
        due = entries and entries[0][0] <= self.clock.now()
        return self.clock.virtual and not (self._queue or self._inbox or self._outside or self._blocking or due)


class OutsideSource:
    """See `Kernel.outside_source`. Counts by messages, since it may be opened and closed in any thread."""

    __slots__ = ("_kernel",)

    def __init__(self, kernel: Outside):
        self._kernel = kernel

    def __enter__(self) -> Self:
        self._kernel.post(lambda: self._kernel.count_outside(1))
        return self

    def __exit__(self, *_: object) -> Literal[False]:
        self._kernel.post(lambda: self._kernel.count_outside(-1))
        return False


class TimeHeld:
    """See `Kernel.time_held`."""

    __slots__ = ("_kernel",)

    def __init__(self, kernel: Outside):
        self._kernel = kernel

    def __enter__(self) -> Self:
        self._kernel.count_blocking(1)
        return self

    def __exit__(self, *_: object) -> Literal[False]:
        self._kernel.count_blocking(-1)
        return False
