"""A task: one thread of control that runs when it holds the baton, and is parked or queued when it does not.

What CRAM calls a `task` object sits one floor up, with its status fluent and its messages; this is the ground under it:
a function that runs on a stack of its own, a place in the tree (every task has one parent), a request to end that is
delivered once, a result or an exception that the joiner decides about.

Laws kept here: a request to end is delivered exactly once, at a park point or checkpoint, and cleanup that runs after
that is not disturbed by another one; a task that is cancelled before it ran never runs; an exception is never lost,
for whoever does not look at it is told about it (`kernel.unhandled`).
"""

from __future__ import annotations

import sys
from contextvars import copy_context
from types import SimpleNamespace

from .budget import budget
from .errors import Abandoned, Cancelled, KernelError
from .typing_names import TYPE_CHECKING, Any, Generic, NoReturn, TypeVar, subscripted

if TYPE_CHECKING:
    from collections.abc import Callable
    from contextvars import Context

    from .cleanup import cleanup
    from .scheduler import Kernel
    from .signatures import Callback, Carrier, Dynamic, Name, Reason, Why

RUNNABLE = "runnable"
RUNNING = "running"
PARKED = "parked"
SETTLING = "settling"
BLOCKED = "blocked"  # outside of the kernel, in `run_blocking`
DEAD = "dead"

HOPELESS = 100  # times that a task may swallow what ends it before it gets no more; after as many `Abandoned` it is left for dead

T = TypeVar("T", covariant=True, default=Any)


class Task(Generic[T]):
    """Made by `spawn`. Read `name`, `parent`, `state`, `dead`, `result`, `exception`; use `cancel` and `join`. Its function gives a T.

    `owner` is for the floor above: its own object that this task runs for. `local` is a place for whatever else it keeps with it.
    """

    __slots__ = (
        "kernel", "id", "_name", "parent", "owner", "_local", "dynamic", "result", "cancelled_delivered",
        "state", "why", "carrier", "attention", "woken", "ticket", "timed", "preempted", "shielded", "alarms", "abandoned",
        "fn", "args", "context", "joiners", "cancel_request", "interjections", "delivered",
        "swallowed", "_exception", "claimed", "when_refused", "cleanup",
        "__weakref__",
    )  # fmt: skip
    __class_getitem__ = subscripted

    def __init__(
        self, kernel: Kernel, number: int, fn: Callable[..., T] | None, args: tuple[object, ...], name: Name, parent: Task[object] | None
    ):
        self.kernel = kernel
        self.id = number
        self._name = name
        self.parent = parent
        self.owner: Any = None
        self._local: SimpleNamespace | None = None
        self.dynamic: Dynamic | None = None
        self.result: T | None = None
        self.cancelled_delivered = False
        self.state = RUNNABLE
        self.why: Why = ""
        self.carrier: Carrier | None = None  # the stack it runs on, from its first step to its death
        self.attention = False  # something may have to be raised in it: the one test that park points make
        self.woken = False
        self.ticket = 0  # counts the wake-ups, so that a deadline knows whether it still counts
        self.timed = False
        self.preempted = False
        self.shielded = 0
        self.cleanup: cleanup | None = None  # the innermost `cleanup` block it is in
        self.alarms: list[Alarm] | None = None
        self.abandoned = False
        self.fn = fn
        self.args: tuple[object, ...] | None = args
        self.context: Context | None = copy_context()
        self.joiners: list[Task[object]] | None = None
        self.cancel_request: tuple[Reason] | None = None
        self.interjections: list[Callback] | None = None  # functions to be called on its own stack
        self.delivered: BaseException | None = None
        self.swallowed = 0
        self._exception: BaseException | None = None
        self.claimed = False
        # called with the exception, in the scheduler, if the system gives no stack for it
        self.when_refused: Callable[[BaseException], object] | None = None

    @property
    def name(self) -> str:
        """Its name in reports; one given as a function is made when somebody asks."""
        return self._name() if callable(self._name) else self._name

    @property
    def local(self) -> SimpleNamespace:
        """A namespace, made when somebody asks."""
        local = self._local
        if local is None:
            local = self._local = SimpleNamespace()
        return local

    @property
    def dead(self) -> bool:
        """True when its function has returned or unwound, and not a moment before."""
        return self.state is DEAD

    @property
    def exception(self) -> BaseException | None:
        """What ended it, or None. Whoever reads this takes care of it: it is not reported as unhandled any more."""
        self.claimed = True
        return self._exception

    @property
    def ready(self) -> bool:
        """True when it waits for nothing but its turn."""
        return self.state is RUNNABLE

    @property
    def cancelled(self) -> bool:
        """True as soon as it was asked to end, delivered or not."""
        return self.cancel_request is not None

    def cancel(self, reason: Reason = None) -> None:
        """Ask the task to end: `Cancelled(REASON)` is raised at its next park point or checkpoint.

        While it unwinds the stack nothing disturbs the cleanup. Code that swallows it gets it again at the next such point.

        REASON may also be an exception, or a function of no arguments that returns one; that is raised instead.
        Wakes the task if it is parked. Inside of `shield` the delivery waits. The first request counts: later ones,
        and requests to a dead task, do nothing.
        """
        if self.cancel_request is not None or self.state is DEAD:
            return
        self.cancel_request = (reason,)
        self.attention = True
        if not self.shielded:
            self.kernel.rouse(self)
            if self is self.kernel.current:
                budget.end()

    def end_wait(self, exception: BaseException | Callable[[], BaseException]) -> bool:
        """Have EXCEPTION, or what the function EXCEPTION returns on the task's stack, raised where it is parked, in shields too.

        Does nothing, and returns False, if the task does not wait: what it computes is never disturbed.
        """
        if self.state is not PARKED:
            return False
        self.alarms = [*(self.alarms or ()), Alarm(exception, True)]
        self.attention = True
        self.kernel.rouse(self)
        return True

    def abandon(self) -> None:
        """Give up its cleanup: `Abandoned` is raised at every park point and checkpoint from now on, in shields too."""
        self.abandoned = self.attention = True
        self.kernel.rouse(self)

    def interject(self, fn: Callback) -> None:
        """Have FN called on the task's own stack at its next park point or checkpoint; FN may park. Wakes it if it is parked.

        Inside of `shield` the call waits. Suspension of branches (CPL) is made of this.
        """
        self.interjections = [*(self.interjections or ()), fn]
        self.attention = True
        if not self.shielded:
            self.kernel.rouse(self)
            if self is self.kernel.current:
                budget.end()

    def join(self, why: Why | None = None, until: float | None = None, claim: bool = True) -> T | None:
        """Park until the task is dead, or the clock reaches UNTIL; returns its result, or None if it has none.

        Does not raise what ended it: that is in `exception`, for the joiner to decide. With CLAIM false the joiner only
        waits, and an exception that nobody looks at is reported as if it had not.
        """
        kernel = self.kernel
        me = kernel.current
        if me is self:
            raise KernelError(f"Task {self.name} would wait for its own end. Join it from another task.")
        while self.state is not DEAD:
            if self.joiners is None:
                self.joiners = []
            self.joiners.append(me)
            try:
                kernel.park(why or self._why_joined, until)
            finally:
                if self.state is not DEAD:
                    self.joiners.remove(me)
            if until is not None and self.state is not DEAD and kernel.now() >= until:
                return None
        self.claimed = self.claimed or claim
        return self.result

    def _why_joined(self) -> str:
        return f"the end of task {self.name}"

    def describe_why(self) -> str:
        """What it waits for, as text; a reason given as a function is asked only now, when somebody reads it."""
        try:
            return str(self.why() if callable(self.why) else self.why)
        except Exception as broken:  # a report must not fail because a part of it does
            return f"something that cannot say what it is ({broken!r})"

    def deliver(self) -> bool:
        """Raise what this task was asked to end with, if it may be raised now. Called by the task itself.

        Returns True if functions were called (`interject`), which may have taken time.
        """
        if self.abandoned:
            self.swallowed += 1
            if self.swallowed > 2 * HOPELESS:
                self.kernel.leave_for_dead(self)
            raise Abandoned
        if self.alarms:
            for alarm in self.alarms:
                if alarm.pierces_shield or not self.shielded:
                    self.alarms.remove(alarm)
                    self._look_again()
                    raise alarm.exception() if callable(alarm.exception) else alarm.exception
        if self.cancel_request is not None and not self.cancelled_delivered and not self.shielded:
            self.delivered = exception = self._cancellation()
            self.cancelled_delivered = True
            self._look_again()
            raise exception
        if self.delivered is not None and not self.shielded and self.swallowed < HOPELESS and not _on_its_way(self.delivered):
            self.swallowed += 1
            raise self.delivered
        if self.interjections and not self.shielded:
            functions, self.interjections = self.interjections, None
            self._look_again()
            while functions:
                function, *functions = functions
                try:
                    function()
                except BaseException:  # it unwinds a part of the stack; what else was to be called comes after that
                    self.interjections = [*functions, *(self.interjections or ())]
                    self._look_again()
                    raise
            self.woken = True  # whoever parked looks again whether what it waits for has come
            return True
        return False

    def _look_again(self) -> None:
        waiting = self.cancel_request is not None and not self.cancelled_delivered
        self.attention = waiting or self.delivered is not None or bool(self.alarms) or bool(self.interjections) or self.abandoned

    def unwinds(self) -> None:
        """Called by the task itself, which ends a part of its own stack: until `unwound` nobody disturbs the cleanup in it.

        A request to end the task that comes meanwhile is delivered after that.
        """
        self.cancelled_delivered = True

    def unwound(self) -> None:
        """The part of the stack that ended is gone, and the task lives on."""
        self.cancelled_delivered = False
        self._look_again()

    def spare(self) -> None:
        """The request to end it is dealt with, though it is alive: only what the main task ran as a plan has ended."""
        self.cancel_request = self.delivered = None
        self.unwound()

    def _cancellation(self) -> BaseException:
        (reason,) = self.cancel_request
        if callable(reason) and not isinstance(reason, BaseException):
            reason = reason()
        return reason if isinstance(reason, BaseException) else Cancelled(reason)

    def never_runs(self) -> None:
        """It was asked to end before its first step: that is its end."""
        self.delivered = self._exception = self._cancellation()
        self.cancelled_delivered = True

    def ended_as_asked(self) -> bool:
        """True if what ended it is what somebody asked for, so that nobody has to be told."""
        exception = self._exception
        return exception is None or exception is self.delivered or isinstance(exception, (Cancelled, Abandoned))

    def __repr__(self) -> str:
        return f"<task {self.id} {self.name}, {self.state}>"


def _on_its_way(exception: BaseException) -> bool:
    """True if EXCEPTION still unwinds the stack that asks: what runs is a cleanup on its way, or a handler that has not passed it on."""
    handled = sys.exc_info()[1]
    while handled is not None and handled is not exception:
        handled = handled.__context__
    return handled is not None


class Alarm:
    """Something to be raised besides a cancellation: an interrupt, a deadlock, the time limit, the end of a wait."""

    __slots__ = ("exception", "pierces_shield")

    def __init__(self, exception: BaseException | Callable[[], BaseException], pierces_shield: bool):
        self.exception = exception
        self.pierces_shield = pierces_shield


class SchedulerTask(Task[object]):
    """Stands in as the current task while timers fire and messages are read: nobody's stack, so it cannot park."""

    __slots__ = ()

    def __init__(self, kernel: Kernel):
        super().__init__(kernel, -1, None, (), "scheduler", None)
        self.attention = True

    def deliver(self) -> NoReturn:
        raise KernelError(
            "A timer or a posted function tried to wait. It runs inside of the scheduler, where nothing can wait: "
            "spawn a task that waits, or wake one."
        )


class shield:  # noqa: N801 (reads as a statement: `with shield():`)
    """`with shield():` delays a request to end until the block is left. Blocks may nest."""

    __slots__ = ("_task",)

    def __init__(self, task: Task[object]):
        self._task = task

    def __enter__(self) -> None:
        self._task.shielded += 1

    def __exit__(self, *_: object) -> bool | None:
        task = self._task
        task.shielded -= 1
        if task.attention and not task.shielded:
            budget.end()
        return False
