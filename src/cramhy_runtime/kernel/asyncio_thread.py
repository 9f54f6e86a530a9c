"""A thread beside the kernel that runs an asyncio loop, for servers and bridges. Its share of the processor is limited.

Python runs one thread at a time, so while such a thread computes, the plan does not. A server cannot choose how many requests it gets:
a flood of requests would halve the pace of a plan. So the loop has a `Share` of the processor. While the kernel has nothing to do, the
share is not limited. While the kernel computes, the loop gets `SHARE` of the time. If it has used more, it sleeps before it looks at its
sockets again; then the system's buffers fill, and the clients wait. Work of the kernel for the loop (`Share.charge`) counts too.

Such a thread never touches tasks. It reaches them with `kernel.post`, and any thread reaches it with `Company.call`.
"""

import asyncio
import selectors
import threading
import time
from collections import deque

thread_time = getattr(time, "thread_time", time.process_time)  # a system without it has one thread

SHARE = 0.03  # of the processor, while the kernel computes
IDLE = 0.4  # of the wall: a kernel that waits less than that computes
SAVINGS = 0.01  # s of the processor that may be spent at once
NAP = 0.05  # s; a longer sleep is cut, to see whether the kernel still computes
LAST = 1.0  # s that what still runs in the loop gets to end
WINDOW = 0.1  # s; how often it is asked whether the kernel computes


class Share:
    """The processor time that a loop has used, and how long it must sleep for that.

    ``spent`` is the processor time so far, ``slept`` the wall time, both in seconds. idle: a function that returns for how many seconds of
    wall time the kernel has waited so far. Debts are counted in processor time, so other load on the machine makes no difference.
    """

    def __init__(self, idle, share=SHARE, wall=time.monotonic, own=thread_time, everybody=time.process_time):
        self.share = share
        self._clocks = wall, own, everybody, idle
        self._charged = deque()
        self._balance = SAVINGS
        self._marks = self._window = None
        self.spent = self.slept = 0.0
        self.busy = self.forgiven = False  # forgiven: nothing is owed any more, since the loop shall end

    def charge(self, seconds):
        """Note that the kernel has used SECONDS of processor time for the loop. Safe from any thread."""
        self._charged.append(seconds)

    def debt(self):
        """How many seconds the loop must sleep now, 0 for none. Call it often, in the loop's thread."""
        marks = wall, own, everybody, idle = [clock() for clock in self._clocks]
        before, self._marks = self._marks or marks, marks
        if self._window is None:
            self._window = marks
        charged = 0.0
        while self._charged:
            charged += self._charged.popleft()
        used = own - before[1] + charged
        self.spent += used
        since = wall - self._window[0]
        if since >= WINDOW:
            self.busy = idle - self._window[3] < IDLE * since
            self._window = marks
        if not self.busy or self.forgiven:
            self._balance = min(SAVINGS, self._balance + wall - before[0])
            return 0.0
        plan = max(0.0, everybody - before[2] - used)
        self._balance = min(SAVINGS, self._balance + self.share * plan - used)
        return min(NAP, -self._balance / self.share) if self._balance < 0 else 0.0


class _PatientSelector(selectors.DefaultSelector):
    """Looks at the sockets only when the loop need not sleep."""

    def __init__(self, share):
        super().__init__()
        self._share = share

    def select(self, timeout=None):
        while (debt := self._share.debt()) > 0:
            time.sleep(debt)
            self._share.slept += debt
        return super().select(timeout)


class Company:
    """A thread beside KERNEL that runs MAIN, a coroutine function of no arguments, and then ends. It does not delay the exit."""

    def __init__(self, main, name, kernel):
        self.share = Share(lambda: kernel.idle_seconds)
        self.loop = asyncio.SelectorEventLoop(_PatientSelector(self.share))
        self.failure = None
        self._main = main
        self._thread = threading.Thread(target=self._run, name=name, daemon=True)
        self._thread.start()

    @property
    def alive(self):
        """Whether the thread runs."""
        return self._thread.is_alive()

    def _run(self):
        asyncio.set_event_loop(self.loop)
        try:
            self.loop.run_until_complete(self._main())
        except BaseException as failure:
            self.failure = failure
        finally:
            try:
                left = asyncio.all_tasks(self.loop)
                for task in left:
                    task.cancel()
                if left:
                    self.loop.run_until_complete(asyncio.wait(left, timeout=LAST))
                self.loop.run_until_complete(self.loop.shutdown_asyncgens())
            finally:
                asyncio.set_event_loop(None)
                self.loop.close()

    def call(self, fn, *arguments):
        """Call FN(*ARGUMENTS) in the loop, soon. Returns false if the thread has ended. Safe from any thread."""
        try:
            self.loop.call_soon_threadsafe(fn, *arguments)
        except RuntimeError:  # the loop is closed
            return False
        return True

    def join(self, seconds):
        """Wait until the thread has ended, at most SECONDS. Returns whether it has."""
        self._thread.join(seconds)
        return not self.alive
