"""How a run ends: interrupts, alarms, abandoned cleanup, stopping, and the failures that nobody looked at.

The main task hears of what concerns the run as a whole, by alarms: Ctrl-C, a deadlock, the time limit. An alarm wakes it
ahead of the queue. From there the tree comes down in the ordinary way: the main task unwinds, cancels its children and
joins them, and so on below.

An interrupt must work from a signal handler, at any moment: while the main thread has the baton, waits for it, waits for
the clock, or is outside in a blocking call. So `interrupt` only puts a message into the inbox, ends the current slice and
rings the bell: three operations that a handler may do between any two instructions. The message does the rest.
"""

from _thread import get_ident

from . import reports
from .budget import budget
from .errors import Abandoned, Deadlock, Interrupted, KernelError
from .tasks import BLOCKED, RUNNABLE, Alarm

GRACE = 1.0  # s of kernel time that tasks get for their cleanup when the kernel stops
PATIENCE = 10  # how often a stopping kernel looks whether calls that block have come back, with `LONGEST_WAIT` in between


class Endings:
    """The part of the kernel that ends runs."""

    __slots__ = ()

    # ------------------------------------------------------------------ interrupts

    def interrupt(self):
        """Raise `Interrupted` in the main task. Safe from signal handlers and from any thread.

        A second call before the first is over (`interrupt_over`, `settle`) gives up cleanup: `Abandoned` is raised at
        every park point and checkpoint of all tasks that are cleaning up, in shields too, and in the main task.
        """
        main = self.main
        if self.interruptible and get_ident() == main.carrier.ident and (self._unwinding or not main.shielded):
            # We are a signal handler in the main thread, on top of a call that blocks: break it off.
            self.interruptible = False
            if self._unwinding:
                self.post(self._abandon_tasks)
                raise Abandoned
            self._unwinding = True
            raise Interrupted
        self._interrupts += 1
        self._inbox.append(self._read_interrupt)
        budget.end()
        self._bell.ring()

    def interrupt_over(self):
        """Whoever caught `Interrupted` says that it is dealt with: the next interrupt is a first one again."""
        self._unwinding = False

    def interrupt_waits(self):
        """True if the main task, about to go outside, would only hear when it is back that it was interrupted before."""
        waiting = self._interrupts  # asked before the alarms, see `_read_interrupt`
        alarms = list(self.main.alarms or ())
        if self.main.shielded:
            return bool(waiting and self._unwinding) or any(alarm.pierces_shield for alarm in alarms)
        return bool(waiting or alarms)

    def _read_interrupt(self):
        if not self._unwinding:
            self._unwinding = True
            self._alarm(Interrupted(), False)
        else:
            self._abandon_tasks()
            if self.main.alarms:
                self.main.alarms.clear()
            self._alarm(Abandoned(), True)
        self._interrupts -= 1  # last, so that `interrupt_waits` sees it either here or among the alarms

    def _abandon_tasks(self):
        """Give up the cleanup of all tasks that were asked to end, and the tasks below them: a request to end would not reach one
        that is in a shield, and nobody waits for it any more."""
        main = self.main
        cleaning = {task for task in self.tasks if task is not main and task.cancel_request is not None}
        for task in self.tasks:  # oldest first, so a parent comes before its children
            below = task.parent in cleaning
            if task in cleaning or below and task.shielded:
                task.abandon()
            elif below:
                task.cancel("the cleanup of its parent was abandoned")
            if below:
                cleaning.add(task)

    def _alarm(self, exception, pierces_shield):
        """Have EXCEPTION raised in the main task, before anything else runs."""
        main = self.main
        if main.alarms is None:
            main.alarms = []
        main.alarms.append(Alarm(exception, pierces_shield))
        main.attention = True
        if main.shielded and not pierces_shield:
            return
        if main.state is BLOCKED and self.backend.calls_back:
            self.comes_back(main)
        self.rouse(main)
        if main.state is RUNNABLE and self._urgent is None:
            self._queue.remove(main)
            self._urgent = main

    def leave_for_dead(self, task):
        """TASK swallows every request to end. Count it as dead, and never give it the baton again."""
        carrier = task.carrier
        task._exception = Abandoned()
        self._bury(task)
        self.backend.forsake(carrier)
        task.carrier = carrier
        while True:
            self.hand_over(task)

    # ------------------------------------------------------------------ stopping

    def stop(self):
        """Cancel all tasks, let them unwind, and end the kernel. Called by the main task.

        Tasks get `GRACE` seconds of the kernel's clock; then what serves them is closed (`at_stop`), and their cleanup is
        abandoned; for calls that block it waits half a second. A task that is still there after that stays parked for ever.
        """
        if self.stopped:
            return
        main = self.main
        if self.current is not main or main.carrier.ident != get_ident():
            raise KernelError("Only the main task can stop the kernel, or start another one in its place.")
        self._stopping = True
        self._limit = main.cancel_request = main.alarms = None
        main.attention = False
        for task in self.tasks[1:]:
            task.cancel("the kernel stops")
        self._let_unwind()
        while self._at_stop:
            self._call(self._at_stop.popitem()[0])
        for task in self.tasks[1:]:
            task.cancel("the kernel stops")
            task.abandon()
        self._let_unwind()
        for task in self.tasks[1:]:
            if task.carrier is not None:
                self.backend.forsake(task.carrier)
        self._report_unclaimed()
        self.stopped = True
        self.backend.close()
        self.when_stopped()

    def at_stop(self, fn):
        """Have FN called when the kernel stops and the tasks had their time to clean up; what was registered last comes first."""
        self._at_stop[fn] = None

    def not_at_stop(self, fn):
        """FN need not be called any more; harmless when it was not registered, or is being called."""
        self._at_stop.pop(fn, None)

    def _let_unwind(self):
        until = self.now() + GRACE
        try:
            while len(self._tasks) > 1 and self.now() < until:
                self.park("the other tasks to end", until)
        except (Deadlock, Interrupted, Abandoned):
            pass  # they cannot, or the user does not want to wait: on to the next step

    # ------------------------------------------------------------------ failures that nobody looked at

    def _report_unclaimed(self, parent=None):
        """Tell of the tasks that died of an exception nobody looked at: those whose PARENT is dead now, or all.

        All of them when the instant is over in which they died: whoever waits for them has had the baton since.
        """
        dead, self._unclaimed = self._unclaimed, []
        for task in dead:
            if task.claimed:
                continue
            if parent is None or task.parent is parent:
                self._report(task, task._exception)
            else:
                self._unclaimed.append(task)

    def _report(self, task, exception):
        try:
            reports.hooks().unhandled(task, exception)
        except BaseException as broken:  # the hook is somebody else's, and the scheduler must go on
            reports.unhandled(task, exception)
            reports.unhandled(task, broken)

    def frame_of(self, task):
        """The innermost Python frame of a task that waits, or None."""
        return None if task.carrier is None else self.backend.frame(task.carrier)
