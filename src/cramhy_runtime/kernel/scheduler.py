"""The scheduler: one baton, a queue, timers, an inbox.

At most one task runs at any moment, the one with the baton (law 4). It gives the baton away at named points: it parks,
yields, ends, or has used up its slice. There is no scheduler thread. The task that gives the baton away looks for the next
task on its own stack (`_next`), and jumps to it, or goes on if it is the next itself. `_next` handles, in this order:

1. messages from outside (the inbox),
2. timers that are due, the one created first before others of the same time,
3. the first task in the queue (or, with a seed, any of them, by lot; or the one that a given function chooses),
4. if no task is runnable, this instant is over: the clock goes to the next timer,
5. if there is none either, and no source outside may send a message: a deadlock, which is raised in the main task.

So a run is a function of the program, the seed and the order of messages (law 5).

CRAM leaves all this to the threads of SBCL and gets data races. Structured concurrency, parking and the clock that
jumps come from trio and SimPy.
"""

from __future__ import annotations

from _thread import get_ident
from collections import deque

from . import images, reports
from .backends import make_backend
from .budget import SLICE, budget, need_few_steps, need_headroom, need_steps
from .clocks import VirtualClock, make_clock
from .endings import CLEANUP_LIMIT, PATIENCE, Endings
from .errors import Cancelled, Deadlock, Interrupted, KernelError, NoStack, Terminated, TimeLimit
from .inbox import Outside
from .tasks import BLOCKED, DEAD, PARKED, RUNNABLE, RUNNING, SETTLING, SchedulerTask, Task, shield, unshielded
from .timers import TimerHeap, Timing, seconds
from .typing_names import TYPE_CHECKING, NoReturn, TypeVar, TypeVarTuple

if TYPE_CHECKING:
    from collections.abc import Callable

    from .signatures import Backend, BackendName, Callback, Carrier, Clock, ClockName, Name, Seed, Why

ROUND = 0.005  # s of virtual time that pass when every runnable task used up its slice
STEPS_PER_INSTANT = 100_000  # hand-overs at one instant, after which time passes all the same
INFINITY = float("inf")

T = TypeVar("T")
Arguments = TypeVarTuple("Arguments")


def lots(seed: int | float | str) -> Callable[[deque[Task[object]]], int]:
    """A choice by lot: the place in the queue of the task that goes next."""
    import random  # only who shuffles has to pay for it

    draw = random.Random(seed).random
    return lambda queue: int(draw() * len(queue))


class Kernel(Endings, Outside, Timing):
    """A set of tasks with their clock. `kernel.start` makes it; the functions of `active` act on the active one."""

    # Slots, since Python finds attributes of an object that has thirty or more of them in a slower way.
    __slots__ = (
        "clock", "backend", "time_limit", "_limit", "seed", "_choose", "_queue", "_timers", "_inbox", "_bell", "_breathe", "_tasks",
        "_born", "_streak", "_steps", "_urgent", "_settlers", "_watchers", "_unclaimed", "_blocking", "_outside", "_interrupts",
        "_asked_at", "_unwinding", "_stopping", "_stops_since", "_patience", "_at_stop", "_wakers", "cleanup_limit", "ended_by",
        "stopped", "when_stopped", "interruptible", "_scheduler", "main", "current", "__weakref__",
    )  # fmt: skip

    def __init__(
        self,
        clock: ClockName | Clock = "virtual",
        backend: BackendName | Backend = "auto",
        seed: Seed | None = None,
        time_limit: float | None = None,
    ):
        self.clock = make_clock(clock)
        self.backend = make_backend(backend)
        self.time_limit = self._limit = None if time_limit is None else seconds(time_limit, "time_limit={}")
        self.seed: Seed | None = seed
        self._choose = None if seed is None else seed if callable(seed) else lots(seed)
        self._queue: deque[Task[object]] = deque()
        self._timers = TimerHeap()
        self._inbox: deque[Callback] = deque()
        self._bell = self.backend.bell()
        self._breathe = self.backend.breathe
        self._tasks: dict[int, Task[object]] = {}
        self._born = 1  # the main task
        self._streak = 0  # slices that ended since a task was last made runnable
        self._steps = 0  # hand-overs at this instant
        self._urgent: Task[object] | None = None  # the main task, when an alarm wakes it ahead of the queue
        self._settlers: list[Task[object]] = []
        self._watchers: tuple[Callback, ...] = ()  # functions that are called whenever an instant is over
        self._unclaimed: list[Task[object]] = []  # tasks dead of an exception that nobody has looked at yet
        self._blocking = 0
        self._outside = 0
        self._interrupts = 0  # sent, but not yet read from the inbox
        self._asked_at: float | None = None  # when the first of these was sent, by the wall's clock
        self._unwinding = False  # one was raised in the main task and is not over
        self._stopping = False
        self._stops_since: float | None = None
        self._patience = PATIENCE
        self._at_stop: dict[Callback, None] = {}  # its keys: see `at_stop`
        self._wakers: tuple[Callback, ...] = ()  # functions that end what the main thread waits for outside of the kernel: see `woken_by`
        self.cleanup_limit: float | None = CLEANUP_LIMIT
        self.ended_by: int | None = None  # the number of the signal that asked the process to end
        self.stopped = False
        self.when_stopped: Callback = lambda: None  # for `active`, which keeps track of the kernels
        self.interruptible = False  # the main task is in a blocking call that a signal handler may break off
        self._scheduler = SchedulerTask(self)
        self.main: Task[object] = self._tasks.setdefault(0, Task(self, 0, None, (), "main", None))
        main = self.main
        main.carrier = self.backend.adopt(self)
        main.state = RUNNING
        self.current: Task[object] = main
        budget.renew()

    # ------------------------------------------------------------------ tasks

    @property
    def tasks(self) -> list[Task[object]]:
        """The tasks that are alive, oldest first; the main task is the first."""
        return list(self._tasks.values())

    @property
    def untouched(self) -> bool:
        """Whether it is unchanged since its start: no task but the main one, no timer, no message, and no time has passed."""
        return (
            len(self._tasks) == 1
            and self.current is self.main
            and not self.now()
            and not (self.stopped or self._at_stop or self._timers.entries or self._inbox or self._unclaimed)
        )

    def now(self) -> float:
        """Seconds since the kernel was started."""
        return self.clock.now()

    @property
    def epoch(self) -> float:
        """The moment at which the kernel's time began, in seconds since 1970."""
        return self.clock.epoch

    def spawn(
        self, fn: Callable[[*Arguments], T], *args: *Arguments, name: Name | None = None, parent: Task[object] | None = None
    ) -> Task[T]:
        """A new task at the end of the queue, which will run FN(*ARGS). PARENT is by default the current task."""
        me = self.current
        carrier = me.carrier
        if carrier is not None and carrier.ident != get_ident():
            self._refuse("spawn a task")
        if parent is None:
            parent = self.main if me is self._scheduler else me
        number = self._born
        self._born = number + 1
        task: Task[T] = Task(self, number, fn, args, name or str(getattr(fn, "__name__", "task")), parent)
        self._tasks[number] = task
        self._queue.append(task)
        self._streak = 0
        return task

    def _enqueue(self, task: Task[object]) -> None:
        task.state = RUNNABLE
        task.preempted = False
        self._queue.append(task)
        self._streak = 0

    # ------------------------------------------------------------------ park points

    def park(self, why: Why = "", until: float | None = None) -> bool:
        """Give the baton away until `unpark` (True) or until the clock reaches UNTIL, in seconds (False).

        WHY, a text or a function that makes one, says in reports what the task waits for. A request to end the task is raised
        here, before or after the wait. If functions are called on this stack first (`Task.interject`), the wake-up may come
        meanwhile: then the result is True at once, and the caller looks again.
        """
        me = self.current
        if me.attention and me.deliver():
            return True
        entries, clock, queue = self._timers.entries, self.clock, self._queue
        next_waits = len(queue) > self._streak and type(clock) is VirtualClock and not (entries and entries[0][0] <= clock.time)
        next_carrier = None  # as `hand_over` and `_next` would find out, if nothing comes before the first task and it has a stack
        if (
            next_waits
            and not (self._inbox or self._urgent or self._choose)
            and self._steps < STEPS_PER_INSTANT
            and (until is None or until > clock.now())
        ):
            next_carrier = queue[0].carrier
        if next_carrier is not None:
            need_few_steps()
        elif self._inbox or self._unclaimed or entries and not next_waits:
            need_headroom()
        else:  # no timer fires before the next task runs
            need_steps()
        carrier = me.carrier
        if carrier is None or carrier.ident != get_ident():
            self._refuse("wait")
        me.why = why
        if until is not None and until != INFINITY:
            if until != until:
                raise ValueError("The time to park until is not a number.")
            me.timed = True
            self._timers.add_deadline(until, me)
        me.state = PARKED
        dynamic = me.dynamic
        if dynamic is not None:
            dynamic.leave()
        if next_carrier is None:
            self.hand_over(me)
        else:
            self._steps += 1
            self.current = queue.popleft()
            if carrier.direct:
                next_carrier.switch()
            else:
                self.backend.transfer(carrier, next_carrier)
            me.state = RUNNING
            budget.left = SLICE
        if dynamic is not None:
            dynamic.enter()
        if me.attention:
            me.deliver()
        return me.woken

    def unpark(self, task: Task[object]) -> bool:
        """Make a parked task runnable. Returns True if it was parked; otherwise does nothing and returns False."""
        carrier = self.current.carrier
        if carrier is not None and carrier.ident != get_ident():
            self._refuse("wake a task")
        if task.state is not PARKED:
            return False
        task.ticket += 1  # as `_wake` does
        task.woken = True
        if task.timed:
            task.timed = False
            self._timers.went_stale()
        task.state = RUNNABLE
        task.preempted = False
        self._queue.append(task)
        self._streak = 0
        return True

    def _wake(self, task: Task[object], woken: bool) -> None:
        task.ticket += 1
        task.woken = woken
        if task.timed:
            task.timed = False
            if woken:
                self._timers.went_stale()
        task.state = RUNNABLE
        task.preempted = False
        self._queue.append(task)
        self._streak = 0

    def rouse(self, task: Task[object]) -> None:
        """Wake TASK, wherever it waits inside of the kernel, because an exception is to be raised in it."""
        if task.state is PARKED:
            self._wake(task, True)
        elif task.state is SETTLING:
            self._settlers.remove(task)
            self._enqueue(task)

    def sleep(self, seconds: float) -> None:
        """Park for SECONDS of the kernel's clock. Zero and less yields. Wake-ups do not shorten it. NaN is a ValueError."""
        if not seconds > 0:
            if seconds != seconds:
                raise ValueError("The time to sleep is not a number.")
            self.yield_()
            return
        until = self.clock.now() + seconds
        while self.park(lambda: f"the time {until:g} s (sleep {seconds:g})", until):
            pass

    def yield_(self) -> None:
        """Go to the end of the queue. It counts as a checkpoint: a task that only yields uses up its slice too."""
        left = budget.left - 1
        if left < 0:
            self.end_slice()
            return
        me = self.current
        if me.attention:
            me.deliver()
        need_headroom()
        if me.carrier.ident != get_ident():
            self._refuse("yield")
        self._enqueue(me)
        self.rest(me)
        budget.left = min(left, budget.left)
        if me.attention:
            me.deliver()

    def choice_point(self, why: Why) -> None:
        """Let a seed or a schedule decide whether a task that could run goes first. First come, first served: this one goes on.

        It is for what a task does without waiting, though the order of the tasks that do it matters. WHY as in `park`.
        """
        if self._choose is None or not self._queue:
            return
        left = budget.left
        me = self.current
        if me.attention:
            me.deliver()
        need_headroom()
        me.why, me.state, me.preempted = why, RUNNABLE, False
        self._queue.appendleft(me)
        self._streak = 0
        self.rest(me)
        budget.left = min(left, budget.left)
        if me.attention:
            me.deliver()

    def end_slice(self) -> None:
        """End the slice, at a checkpoint: others get a turn, and requests to end are delivered."""
        me = self.current
        if self._breathe is not None:
            self._breathe()
        if me is self._scheduler:
            budget.renew()
            me.use_slice()
            if self._interrupts:
                raise Interrupted  # a signal gets the user out of a callback that loops for ever, too
            return
        if me.carrier.ident != get_ident():
            budget.end()  # an outside thread came by; the task whose slice it is shall find it over
            return
        me.use_slice()
        if me.attention and me.deliver():
            budget.renew()  # the slice was ended for this, and not because the task is busy: no time passes
            return
        need_headroom()
        if images.waiting:
            images.breathe()
        me.state = RUNNABLE
        me.preempted = True
        self._queue.append(me)
        self._streak += 1
        self.rest(me)
        if me.attention:
            me.deliver()

    def settle(self) -> None:
        """Let the other tasks run until none is runnable at this instant. The clock does not move.

        Tasks that are busy all the time count as done for this instant once each has used up a slice. The REPL calls
        this after each form, so it also ends an interrupt (`interrupt_over`) and reports unhandled exceptions.
        """
        me = self.current
        if me.attention:
            me.deliver()
        need_headroom()
        if me.carrier.ident != get_ident():
            self._refuse("settle")
        me.state = SETTLING
        me.why = "the others, to settle"
        self._settlers.append(me)
        self.rest(me)
        if me.attention:
            me.deliver()
        self.interrupt_over()
        self._report_unclaimed()

    def shield(self) -> shield:
        """``with kernel.shield():`` delays requests to end the current task until the block is left."""
        return shield(self.current)

    def unshielded(self) -> unshielded:
        """``with kernel.unshielded():`` takes one `shield` around the block away until it is left."""
        return unshielded(self.current)

    def _refuse(self, what: str) -> NoReturn:
        raise KernelError(f"A thread that does not have the baton tried to {what}. Outside threads reach tasks by `kernel.post` only.")

    # ------------------------------------------------------------------ the baton

    def rest(self, me: Task[object]) -> None:
        """Give the baton away. Returns when ME, which is queued or parked already, has it again."""
        dynamic = me.dynamic
        if dynamic is not None:
            dynamic.leave()
        self.hand_over(me)
        if dynamic is not None:
            dynamic.enter()

    def hand_over(self, me: Task[object]) -> None:
        """As `rest`, for a task whose dynamic state is put away already."""
        task = self._next()
        while task.carrier is None:
            try:
                task.carrier = self.backend.carrier(self.carry)
            except NoStack as refused:
                task._exception = refused.__cause__
                if task.when_refused is not None:
                    task.claimed = True
                    self._call(lambda task=task: task.when_refused(task._exception))
                self._bury(task)
                task = self._next()
        self.current = task
        if task is not me:
            self.backend.transfer(me.carrier, task.carrier)
        me.state = RUNNING
        budget.left = SLICE

    def carry(self, carrier: Carrier) -> Carrier:
        """The job of every carrier: run the current task, and new tasks that come next.

        Returns the carrier that gets the baton. A carrier that was taken as a spare, to hold the baton while a task is
        outside, finds no current task and begins with the search.
        """
        task = self.current
        while True:
            if task is not self._scheduler:
                task.state = RUNNING
                budget.left = SLICE
                try:
                    task.result = task.context.run(task.fn, *task.args)
                except BaseException as exception:
                    # Without the frame of this function the traceback begins in the user's code.
                    task._exception = exception.with_traceback(exception.__traceback__.tb_next)
                self._bury(task)
            task = self._next()
            self.current = task
            if task.carrier is not None:
                return task.carrier
            task.carrier = carrier

    def _bury(self, task: Task[object]) -> None:
        """Mark TASK as dead, and wake the tasks that wait for it."""
        self.current = self._scheduler
        task.state = DEAD
        # What a dead task holds makes no circles, so that it goes without the garbage collector.
        task.carrier = task.fn = task.args = task.context = task.alarms = task.owner = task.when_refused = None
        task.why = ""
        if task._name.__class__ is not str:
            task._name = "a task that has ended" if task._exception is None else str(task.name)
        if task.delivered.__class__ is Cancelled:
            task.delivered.__traceback__ = None  # which holds the whole stack
        if task.cancel_request is not None:
            task.cancel_request = (None,)  # without the function that made the reason, which may know whose task this is
        del self._tasks[task.id]
        if task.dynamic is not None:
            task.dynamic.leave()
        if task.joiners:
            for joiner in task.joiners:
                self.unpark(joiner)
            task.joiners = None
        if task._exception is not None and not task.ended_as_asked():
            self._unclaimed.append(task)
        if self._unclaimed:
            self._report_unclaimed(task)
        if self._stopping:
            self.unpark(self.main)

    def _next(self) -> Task[object]:
        """Find the task that gets the baton, as the top of this file says."""
        self.current = self._scheduler
        queue, entries, clock = self._queue, self._timers.entries, self.clock
        while True:
            if self._inbox:
                self._read_inbox()
            if entries and entries[0][0] <= (clock.time if type(clock) is VirtualClock else clock.now()):
                self._fire(clock.now())
            if self._urgent is not None:
                task, self._urgent = self._urgent, None
                return task
            if queue:
                self._steps += 1
                if (self._streak >= len(queue) and self._all_busy()) or self._steps > STEPS_PER_INSTANT:
                    if self._settlers:
                        return self._settlers.pop()
                    self._time_passes()
                    continue
                if self._choose is None:
                    task = queue.popleft()
                else:
                    task = self._chosen()
                if task.carrier is None and task.cancel_request is not None:
                    task.never_runs()
                    self._bury(task)
                    continue
                return task
            if self._settlers:
                return self._settlers.pop()
            if not self._inbox:
                self._end_of_instant()

    def _all_busy(self) -> bool:
        return self._choose is None or all(task.preempted for task in self._queue)

    def _chosen(self) -> Task[object]:
        # A task that has not begun never overtakes one spawned before it: branches begin in the order in which they stand.
        queue = self._queue
        number = self._choose(queue)
        task = queue[number]
        if task.carrier is None:
            number, task = next((index, other) for index, other in enumerate(queue) if other.carrier is None)
        del queue[number]
        return task

    def _time_passes(self) -> None:
        """Let some time pass, since busy tasks have used up this instant, and the timers of others must not wait for ever."""
        self._streak = self._steps = 0
        if self._watchers:
            self._tell_watchers()
        if not self._blocking:
            now, when = self.clock.now(), self._timers.next_time()
            soon = now + ROUND
            try:
                # Not past the next timer: it fires at its time, to the last digit.
                self.clock.nudge(soon if when is None or when > soon else when)
            except KeyboardInterrupt:  # as in `_wait`: with a pace, a nudge waits, too
                self.interrupt()
        if self._limit is not None and self.clock.now() > self._limit:
            self._reach_limit()

    def _end_of_instant(self) -> None:
        """Go to the next timer, or wait for a message, or raise a deadlock or the time limit in the main task. No task is runnable."""
        if self._unclaimed:
            self._report_unclaimed()
            return
        if self._watchers and self._tell_watchers():
            return
        self._steps = 0
        when, limit, clock = self._timers.next_time(), self._limit, self.clock
        blocking = self._blocking and self._patience
        if when is None and not blocking and not self._outside:
            self._alarm(Deadlock("" if self._stopping else reports.deadlock_text(self)), True)
        elif clock.virtual and (when is None or blocking and not self._time_is_wanted()):
            self._wait(None)
            if self._stopping and not self._inbox:
                self._patience -= 1
        elif limit is not None and limit <= clock.now():
            self._reach_limit()
        else:
            if when is None:
                when = INFINITY
            self._wait(when if limit is None or when < limit else limit)

    def _wait(self, when: float | None) -> None:
        try:
            clock = self.clock
            if when is not None and clock.virtual and (clock.pace is None or not clock.pace.waits):
                if images.waiting:
                    images.breathe()
                if self._breathe is not None:
                    self._breathe()
                clock.go_to(when, self._bell)
                return
            with images.outside():
                if when is None:
                    self._bell.wait()
                else:
                    clock.go_to(when, self._bell)
        except KeyboardInterrupt:  # without a handler of ours Python raises it right here, in the main thread
            self.interrupt()

    def _time_is_wanted(self) -> bool:
        """Whether time passes though a task is outside: only the main task is, at the prompt, and a `TimeWanted` is open."""
        if self._blocking != 1 or self.main.state is not BLOCKED:
            return False
        clock = self.clock
        return clock.wanted > 0 if clock.pace is None else clock.pace.time_is_wanted

    def wait_for_message(self, seconds: float) -> None:
        """Wait until a message comes into the inbox, at most SECONDS. It may return early. No task runs meanwhile."""
        if not self._inbox:
            self._bell.wait(seconds)

    def watch_instants(self, fn: Callback) -> None:
        """Call FN in the scheduler whenever nothing is left to do at this instant, before time goes on. It must not park.

        At that moment every task is where it stays until something new happens. If nothing happens, as at the prompt, FN is
        called from time to time.
        """
        self._watchers = (*self._watchers, fn)

    def unwatch_instants(self, fn: Callback) -> None:
        """Stop calling FN."""
        self._watchers = tuple(watcher for watcher in self._watchers if watcher != fn)

    def _tell_watchers(self) -> bool:
        """Call the watchers. Returns whether there is something to do now."""
        for watcher in self._watchers:
            self._call(watcher)
        return bool(self._queue or self._inbox)

    def _reach_limit(self) -> None:
        self._alarm(TimeLimit(reports.time_limit_text(self, self.time_limit)), True, stays=True)
        self._limit = self.clock.now() + self.time_limit  # what is left to do in cleanup gets as long again

    def _call(self, fn: Callback) -> None:
        try:
            fn()
        except (Interrupted, Terminated):
            pass  # meant for the main task, which gets its own
        except KeyboardInterrupt:
            self.interrupt()
        except BaseException as exception:
            self._report(self._scheduler, exception)
