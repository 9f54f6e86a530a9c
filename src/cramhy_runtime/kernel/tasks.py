"""A task: one thread of control that runs when it holds the baton, and is parked or queued when it does not.

CRAM's `task` object is in the room `cpl`, with its status fluent and its messages. Here is the part under it: a function
that runs on a stack of its own, a place in the tree (every task has one parent), a request to end that is delivered once, and
a result or an exception for the task that joins it.

Laws kept here: a request to end is delivered at a park point or checkpoint. While its exception unwinds the stack, cleanup runs, and
no request disturbs it, however long it waits. If code swallows the exception, the request is delivered again at the next such point, as
trio does it. The same holds for a request to end a part of the stack (`Part`). A task that is cancelled before it ran never runs. An
exception is never lost: if no code handles it, the user is told (`kernel.unhandled`).
"""

from __future__ import annotations

import sys
from contextvars import copy_context
from types import SimpleNamespace

from .budget import budget
from .errors import Abandoned, Cancelled, KernelError, WorkLimit
from .typing_names import TYPE_CHECKING, Any, Generic, NoReturn, Protocol, TypeVar, subscripted

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

HOPELESS = 1000  # times in a row that a task may swallow what ends it, or a part of it, before it is given up

T = TypeVar("T", covariant=True, default=Any)


class Task(Generic[T]):
    """A task, made by `spawn`. Read `name`, `parent`, `state`, `dead`, `result`, `exception`; use `cancel` and `join`.

    T is the type of its function's result. `owner` is for the floor above: its own object for which this task runs. If that has a method
    ``given_up``, it is called with the task and a place, a text, on the task's own stack, before the task is left for dead because it
    swallows what ends it. `local` is a namespace for other data of the task.
    """

    __slots__ = (
        "kernel", "id", "_name", "parent", "owner", "_local", "dynamic", "handlers", "result", "cancelled_delivered",
        "state", "why", "carrier", "attention", "woken", "ticket", "timed", "preempted", "shielded", "alarms", "abandoned",
        "fn", "args", "context", "joiners", "cancel_request", "interjections", "delivered",
        "swallowed", "_exception", "claimed", "when_refused", "cleanup", "parts", "slices_left",
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
        self.handlers: object = None  # of conditions, those in force: those of lisp_core
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
        self.slices_left: int | None = None  # in a block of `work_limited`
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
        self.parts: list[Part] | None = None  # of its stack, that unwind at present, the innermost last

    @property
    def name(self) -> str:
        """Its name in reports. A name given as a function is made when it is asked for."""
        return self._name() if callable(self._name) else self._name

    @property
    def local(self) -> SimpleNamespace:
        """A namespace for data of the task, made when it is first asked for."""
        local = self._local
        if local is None:
            local = self._local = SimpleNamespace()
        return local

    @property
    def dead(self) -> bool:
        """True when its function has returned or unwound completely."""
        return self.state is DEAD

    @property
    def exception(self) -> BaseException | None:
        """The exception that ended it, or None. Code that reads it must handle it: it is not reported as unhandled any more."""
        self.claimed = True
        return self._exception

    @property
    def ready(self) -> bool:
        """True if it only waits for its turn."""
        return self.state is RUNNABLE

    @property
    def cancelled(self) -> bool:
        """True as soon as it was asked to end, even if the request is not delivered yet."""
        return self.cancel_request is not None

    def cancel(self, reason: Reason = None) -> None:
        """Ask the task to end: `Cancelled(REASON)` is raised at its next park point or checkpoint.

        While it unwinds the stack, the cleanup is not disturbed. Code that swallows it gets it again at the next such point.

        REASON may also be an exception, or a function of no arguments that returns one; then that is raised instead.
        A parked task is woken. Inside of `shield` the delivery waits. The first request counts: later ones,
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
        """Raise EXCEPTION where the task is parked, in shields too. EXCEPTION may be a function that returns it on the task's stack.

        If the task does not wait, do nothing and return False: a computation is never disturbed.
        """
        if self.state is not PARKED:
            return False
        self.alarms = [*(self.alarms or ()), Alarm(exception, True)]
        self.attention = True
        self.kernel.rouse(self)
        return True

    def use_slice(self) -> None:
        """Count the end of a slice against the limit of `work_limited`, if the task is in such a block."""
        if self.slices_left is not None:
            self.slices_left -= 1
            if self.slices_left < 0:
                budget.renew()
                raise WorkLimit

    def abandon(self) -> None:
        """Abandon its cleanup: `Abandoned` is raised at every park point and checkpoint from now on, in shields too."""
        self.abandoned = self.attention = True
        self.kernel.rouse(self)

    def interject(self, fn: Callback) -> None:
        """Call FN on the task's own stack at its next park point or checkpoint. FN may park. A parked task is woken.

        Inside of `shield` the call waits. CPL suspends branches with this.
        """
        self.interjections = [*(self.interjections or ()), fn]
        self.attention = True
        if not self.shielded:
            self.kernel.rouse(self)
            if self is self.kernel.current:
                budget.end()

    def join(self, why: Why | None = None, until: float | None = None, claim: bool = True) -> T | None:
        """Park until the task is dead, or the clock reaches UNTIL (s). Returns its result, or None if it has none.

        It does not raise the exception that ended the task; read `exception` for that. With CLAIM false, an exception is still
        reported as unhandled if no other code reads it. A task that joins itself gets a KernelError.
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
        """What it waits for, as text. A reason given as a function is called now."""
        try:
            return str(self.why() if callable(self.why) else self.why)
        except Exception as broken:  # a report must not fail because a part of it does
            return f"something that cannot say what it is ({broken!r})"

    def deliver(self) -> bool:
        """Raise the exception that ends this task, if it may be raised now. The task itself calls it.

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
                    exception = alarm.exception() if callable(alarm.exception) else alarm.exception
                    if alarm.stays and self.owner is not None:
                        self._goes_on_until_unwound(exception)
                    raise exception
        if self.parts and not self.shielded:
            self._look_for_swallowed_parts()
        if self.cancel_request is not None and not self.cancelled_delivered and not self.shielded:
            self.delivered = exception = self._cancellation()
            self.cancelled_delivered = self.attention = True  # for code that swallows it
            raise exception
        if self.delivered is not None and not (self.shielded or self.parts or _on_its_way(self.delivered)):
            self.swallowed += 1
            if self.swallowed >= HOPELESS:
                self.kernel.give_up_task(self)
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
        self.attention = bool(waiting or self.parts or self.delivered is not None or self.alarms or self.interjections or self.abandoned)

    def unwinds(self, part: Part) -> None:
        """Protect the cleanup in ``part`` of the task's own stack, until `unwound`. The task itself calls it, then raises the exception.

        A request to end the task that comes meanwhile is delivered after that. ``part.again()`` is called at the next park point or
        checkpoint after the exception was swallowed.
        """
        if self.parts is None:
            self.parts = []
        part.ended_before = self.cancelled_delivered
        self.parts.append(part)
        self.cancelled_delivered = self.attention = True

    def unwound(self, part: Part) -> None:
        """End the protection of `unwinds`: ``part`` is gone, and the task lives on."""
        if self.parts and part in self.parts:
            self.cancelled_delivered = part.ended_before
            del self.parts[self.parts.index(part) :]
            if self.delivered is None:
                self.swallowed = 0
        self._look_again()

    def _look_for_swallowed_parts(self) -> None:
        while self.parts and not _on_its_way(self.parts[-1].exception):
            part = self.parts.pop()
            self.cancelled_delivered = part.ended_before
            self.swallowed += 1
            if self.swallowed >= HOPELESS:
                self.kernel.give_up_part(self)
            part.again()
        self._look_again()

    def _goes_on_until_unwound(self, exception: BaseException) -> None:
        """Deliver EXCEPTION, an alarm, as a request to end the task is delivered: again, if it is swallowed."""
        self.cancel_request = self.cancel_request or (exception,)
        self.delivered = exception
        self.cancelled_delivered = self.attention = True

    def spare(self) -> None:
        """Forget the request to end the task, though it is alive: only the plan that the main task ran has ended."""
        self.cancel_request = self.delivered = self.parts = None
        self.cancelled_delivered = False
        self.swallowed = 0
        self._look_again()

    def _cancellation(self) -> BaseException:
        (reason,) = self.cancel_request
        if callable(reason) and not isinstance(reason, BaseException):
            reason = reason()
        return reason if isinstance(reason, BaseException) else Cancelled(reason)

    def never_runs(self) -> None:
        """End the task, which was asked to end before its first step."""
        self.delivered = self._exception = self._cancellation()
        self.cancelled_delivered = True

    def ended_as_asked(self) -> bool:
        """True if a request ended it, so that the exception need not be reported."""
        exception = self._exception
        return exception is None or exception is self.delivered or isinstance(exception, (Cancelled, Abandoned))

    def __repr__(self) -> str:
        return f"<task {self.id} {self.name}, {self.state}>"


def _on_its_way(exception: BaseException) -> bool:
    """True if EXCEPTION still unwinds the caller's stack: the code that runs is a cleanup, or a handler that has not passed it on."""
    handled = sys.exc_info()[1]
    while handled is not None and handled is not exception:
        handled = handled.__context__
    return handled is not None


class Part(Protocol):
    """A part of a task's stack that unwinds, because its ``exception`` was raised in it. See `Task.unwinds`."""

    exception: BaseException
    ended_before: bool  # whether something around the part was unwinding already

    def again(self) -> None:
        """Called when the exception was swallowed: have the part ended again, by `Task.interject`."""


class Alarm:
    """An exception to raise in a task besides a cancellation: an interrupt, a deadlock, the time limit, the end of a wait.

    stays: in a task with an owner, a plan, it is raised again if it is swallowed, until `Task.spare`.
    """

    __slots__ = ("exception", "pierces_shield", "stays")

    def __init__(self, exception: BaseException | Callable[[], BaseException], pierces_shield: bool, stays: bool = False):
        self.exception = exception
        self.pierces_shield = pierces_shield
        self.stays = stays


class SchedulerTask(Task[object]):
    """Stands in as the current task while timers fire and messages are read. It has no stack of its own, so it cannot park."""

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


class unshielded:  # noqa: N801 (reads as a statement)
    """``with unshielded():`` takes one shield of the task away until the block is left. What it delayed arrives in the block."""

    __slots__ = ("_task",)

    def __init__(self, task: Task[object]):
        self._task = task

    def __enter__(self) -> None:
        task = self._task
        if not task.shielded:
            raise KernelError(f"Task {task.name} has no shield that could be taken away.")
        task.shielded -= 1
        if task.attention and not task.shielded:
            budget.end()

    def __exit__(self, *_: object) -> None:
        self._task.shielded += 1
