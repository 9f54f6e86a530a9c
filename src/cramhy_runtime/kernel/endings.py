"""How a run ends: interrupts, termination, alarms, abandoned cleanup, stopping, and unhandled failures.

Alarms tell the main task of events that concern the whole run: Ctrl-C, a signal that ends the process, a deadlock, the time
limit. An alarm wakes it ahead of the queue. Then the tree of tasks ends in the ordinary way: the main task unwinds, cancels its
children and joins them, and so on below.

An interrupt must work from a signal handler, at any moment: while the main thread has the baton, waits for it, waits for
the clock, or is outside in a blocking call. So `interrupt` only puts a message into the inbox, ends the current slice and
rings the bell: three operations that a handler may do between any two instructions. The message does the rest.
"""

from __future__ import annotations

import sys
import time
from _thread import get_ident

from . import reports, signals
from .budget import budget
from .errors import Abandoned, Deadlock, Interrupted, KernelError, Terminated, TerminatedAtOnce
from .tasks import BLOCKED, HOPELESS, RUNNABLE, Alarm
from .typing_names import TYPE_CHECKING, NoReturn

if TYPE_CHECKING:
    from collections.abc import Callable
    from types import FrameType

    from .signatures import Callback
    from .tasks import Task

CLEANUP_LIMIT = 5.0  # s that plans get for their cleanup when the kernel stops, or the process is asked to end
GRACE = 1.0  # s of kernel time that tasks get to come down when their cleanup was given up
INFINITY = float("inf")
PATIENCE = 10  # how often a stopping kernel looks whether calls that block have come back, with `LONGEST_WAIT` in between


class Request:
    """A message in the inbox that asks the main task to end its work. ``void`` says that it is dealt with already."""

    __slots__ = ("_read", "void")

    def __init__(self, read: Callback):
        self._read, self.void = read, False

    def __call__(self) -> None:
        if not self.void:
            self._read()


class Endings:
    """The part of the kernel that ends runs."""

    __slots__ = ()

    # ------------------------------------------------------------------ interrupts, and signals that end the process

    def interrupt(self) -> None:
        """Raise `Interrupted` in the main task. Safe from signal handlers and from any thread.

        A second call before the first is over (`interrupt_over`, `settle`) abandons cleanup: `Abandoned` is raised at
        every park point and checkpoint of all tasks that are cleaning up, in shields too, and in the main task.
        """
        self._ask_main_task(Interrupted, Abandoned)

    def terminate(self, number: int) -> None:
        """Raise `Terminated` in the main task, because of the signal NUMBER. Safe from signal handlers and from any thread.

        Plans get `cleanup_limit` seconds for their cleanup. A second call, or a call after an interrupt, abandons cleanup as a second
        interrupt does. If the process still does not end, it is ended by force (`signals`).
        """
        self.will_end(number)
        self._ask_main_task(lambda: Terminated(number), lambda: TerminatedAtOnce(number))

    def will_end(self, number: int) -> None:
        """Note that the signal NUMBER has asked the process to end, and watch from now on whether it does."""
        if self.ended_by is None:
            self.ended_by = number
            signals.watch(self, number)

    def _ask_main_task(self, first: Callable[[], BaseException], second: Callable[[], BaseException]) -> None:
        """Raise an exception in the main task: the result of FIRST, or of SECOND if the task unwinds already."""
        main = self.main
        if self.interruptible and not self._wakers and get_ident() == main.carrier.ident and (self._unwinding or not main.shielded):
            # We are a signal handler in the main thread, on top of a call that blocks: break it off.
            self.interruptible = False
            if self._unwinding:
                self.post(self._abandon_tasks)
                raise second()
            self._unwinding = True
            self._limit_cleanup()
            raise first()
        if not self._interrupts:
            self._asked_at = time.monotonic()
        self._interrupts += 1
        self._inbox.append(Request(lambda: self._read_interrupt(first, second)))
        budget.end()
        self._bell.ring()
        self.wake()

    def interrupt_over(self) -> None:
        """Note that `Interrupted` was caught and dealt with: the next interrupt is a first one again. A process that was asked to end
        still ends."""
        self._unwinding = self.ended_by is not None

    def interrupt_waits(self) -> bool:
        """True if an interrupt waits that the main task, about to go outside, would otherwise get only when it is back."""
        waiting = self._interrupts  # asked before the alarms, see `_read_interrupt`
        alarms = list(self.main.alarms or ())
        if self.main.shielded:
            return bool(waiting and self._unwinding) or any(alarm.pierces_shield for alarm in alarms)
        return bool(waiting or alarms)

    @property
    def interrupted(self) -> bool:
        """Whether an interrupt, or a signal that ends the process, was sent and is not over yet."""
        return bool(self._interrupts) or self._unwinding

    def cleanup_began(self) -> float | None:
        """The time of the wall clock (s) at which the present cleanup began to count; ``None`` before the kernel stops.

        First the plan of the main task cleans up, then the tasks beside it, which the plan may need for that. Each has the whole limit.
        """
        return self._stops_since

    def deaf_for(self) -> float:
        """For how many seconds an interrupt has been waiting, because the task with the baton passes no checkpoint."""
        since = self._asked_at
        return 0.0 if since is None or not self._interrupts else time.monotonic() - since

    def take_back(self) -> None:
        """Take back the requests in the inbox, because the signal handler raises an exception itself."""
        for message in list(self._inbox):
            if isinstance(message, Request) and not message.void:
                message.void = True
                self._interrupts -= 1
        self._asked_at = None
        self._unwinding = True
        self._limit_cleanup()

    def _read_interrupt(self, first: Callable[[], BaseException], second: Callable[[], BaseException]) -> None:
        if not self._unwinding:
            self._unwinding = True
            self._limit_cleanup()
            self._alarm(first(), False)
        else:
            self._abandon_tasks()
            if self.main.alarms:
                self.main.alarms.clear()
            self._alarm(second(), True)
        self._interrupts -= 1  # last, so that `interrupt_waits` sees it either here or among the alarms
        self._asked_at = time.monotonic() if self._interrupts else None

    def _limit_cleanup(self) -> None:
        """If the process was asked to end, abandon cleanup after `cleanup_limit` seconds of the kernel's clock."""
        if self.ended_by is not None and self.cleanup_limit is not None:
            self.post(lambda: self._timers.add(self.now() + self.cleanup_limit, self.give_up))

    def give_up(self) -> None:
        """Abandon cleanup, because its limit is reached. The scheduler calls it."""
        if not (self._stopping or self.stopped):
            self._abandon_tasks(f"It took longer than {self.cleanup_limit:g} s.")
            if self.ended_by is not None:
                self._alarm(TerminatedAtOnce(self.ended_by), True)

    def _abandon_tasks(self, why: str = "") -> None:
        """Abandon the cleanup of all tasks that were asked to end, and the tasks below them: a request to end would not reach a task
        in a shield, and no task waits for it any more. The user is told whose cleanup it is, and WHY."""
        main = self.main
        asked = [task for task in self.tasks if task is not main and task.cancel_request is not None]
        if told := [task for task in asked if not task.abandoned]:
            reports.tell(reports.abandoned_text(self, told, why))
        cleaning = set(asked)
        for task in self.tasks:  # oldest first, so a parent comes before its children
            below = task.parent in cleaning
            if task in cleaning or below and task.shielded:
                task.abandon()
            elif below:
                task.cancel("the cleanup of its parent was abandoned")
            if below:
                cleaning.add(task)

    def _alarm(self, exception: BaseException, pierces_shield: bool, stays: bool = False) -> None:
        """Raise EXCEPTION in the main task, before other tasks run. STAYS as in `Alarm`."""
        main = self.main
        if main.alarms is None:
            main.alarms = []
        main.alarms.append(Alarm(exception, pierces_shield, stays))
        main.attention = True
        if main.shielded and not pierces_shield:
            return
        self.wake()
        if main.state is BLOCKED and self.backend.calls_back and not self._wakers:
            self.comes_back(main)
        self.rouse(main)
        if main.state is RUNNABLE and self._urgent is None:
            self._queue.remove(main)
            self._urgent = main

    def give_up_task(self, task: Task[object]) -> None:
        """Abandon TASK, which swallows every request to end it. The task itself calls it, at a park point."""
        if task.swallowed == HOPELESS:
            reports.tell(reports.swallowing_text(task, reports.place(sys._getframe())))
        if task is not self.main:
            task.abandon()

    def give_up_part(self, task: Task[object]) -> None:
        """Leave TASK for dead, because a part of it swallows every request to end that part. The main task is only told of."""
        if task is not self.main:
            self.leave_for_dead(task)
        elif task.swallowed == HOPELESS:
            reports.tell(reports.swallowing_text(task, reports.place(sys._getframe())))

    def leave_for_dead(self, task: Task[object]) -> NoReturn:
        """Count TASK, which swallows every request to end, as dead, and never give it the baton again. The task itself calls it.

        First the owner's ``given_up`` is called, which may wait, and is not disturbed.
        """
        given_up = getattr(task.owner, "given_up", None)
        if given_up is not None and not self._stopping:
            task.abandoned = task.attention = False
            task.shielded += 1
            try:
                given_up(task, reports.place(sys._getframe()))
            except BaseException as broken:  # no code of this task hears of it
                self._report(task, broken)
        carrier = task.carrier
        task._exception = Abandoned()
        self._bury(task)
        self.backend.forsake(carrier)
        task.carrier = carrier
        while True:
            self.hand_over(task)

    # ------------------------------------------------------------------ stopping

    def stop(self) -> None:
        """Cancel all tasks, let them unwind, and end the kernel. The main task calls it; in other tasks it is a KernelError.

        Tasks get `cleanup_limit` seconds of the kernel's clock. Then their services are closed (`at_stop`) and their cleanup is
        abandoned, with a message to the user. For calls that block it waits half a second. A task that is still there after that
        stays parked for ever. Raises `Terminated` if a signal asked for the end of the process meanwhile.
        """
        if self.stopped:
            return
        main = self.main
        if self.current is not main or main.carrier.ident != get_ident():
            raise KernelError("Only the main task can stop the kernel, or start another one in its place.")
        self._stopping = True
        self._stops_since = time.monotonic()
        self._limit = main.cancel_request = main.alarms = None
        main.attention = False
        for task in self.tasks[1:]:
            task.cancel("the kernel stops")
        self._let_unwind(INFINITY if self.cleanup_limit is None else self.cleanup_limit)
        if late := [task for task in self.tasks[1:] if task.carrier is not None and task.state is not BLOCKED]:
            reports.tell(reports.abandoned_text(self, late))
        self.close_what_serves()
        for task in self.tasks[1:]:
            task.cancel("the kernel stops")
            task.abandon()
        self._let_unwind(GRACE)
        for task in self.tasks[1:]:
            if task.carrier is not None:
                self.backend.forsake(task.carrier)
        self._report_unclaimed()
        self.stopped = True
        self.backend.close()
        self.when_stopped()
        if self.ended_by is not None and not isinstance(sys.exc_info()[1], Terminated):
            raise Terminated(self.ended_by)  # the signal came while it stopped

    def close_what_serves(self) -> None:
        """Call the functions registered with `at_stop`, the last one first."""
        while self._at_stop:
            self._call(self._at_stop.popitem()[0])

    def at_stop(self, fn: Callback) -> None:
        """Call FN when the kernel stops, after the tasks had their time to clean up. The function registered last comes first."""
        self._at_stop[fn] = None

    def not_at_stop(self, fn: Callback) -> None:
        """Undo `at_stop`. It is harmless if FN was not registered, or is being called."""
        self._at_stop.pop(fn, None)

    def _let_unwind(self, seconds: float) -> None:
        until = self.now() + seconds
        try:
            while len(self._tasks) > 1 and self.now() < until:
                self.park("the other tasks to end", until)
        except (Deadlock, Interrupted, Terminated, Abandoned):
            pass  # they cannot, or the user does not want to wait: on to the next step

    # ------------------------------------------------------------------ failures that nobody looked at

    def _report_unclaimed(self, parent: Task[object] | None = None) -> None:
        """Report the unhandled exceptions of dead tasks: of those whose PARENT is dead now, or of all.

        At the end of the instant in which they died all are reported: tasks that wait for them have had the baton since.
        """
        dead, self._unclaimed = self._unclaimed, []
        for task in dead:
            if task.claimed:
                continue
            if parent is None or task.parent is parent:
                self._report(task, task._exception)
            else:
                self._unclaimed.append(task)

    def _report(self, task: Task[object], exception: BaseException) -> None:
        if isinstance(exception, SystemExit):  # a task that nobody joins asks for the end of the program
            self._alarm(exception, False)
            return
        try:
            reports.unhandled(task, exception)
        except BaseException as broken:  # the reporter is somebody else's, and the scheduler must go on
            reports.PLAIN.unhandled(task, exception)
            reports.PLAIN.unhandled(task, broken)

    def frame_of(self, task: Task[object]) -> FrameType | None:
        """The innermost Python frame of a task that waits, or None."""
        return None if task.carrier is None else self.backend.frame(task.carrier)
