"""Stacks that are greenlets: a switch without the operating system, several times faster than threads.

All tasks run in the thread that called `kernel.start`. A call that blocks therefore goes to a helper thread, while the
other greenlets run on.
"""

import _thread
import sys
from collections import deque

from greenlet import getcurrent, greenlet

from ..clocks import Bell
from .threads import borrow_unless_leaving

KEEP = 16_384  # idle greenlets that one kernel keeps; each holds some 4 KiB, and a new one takes 15 us to get them

_forsaken = []  # greenlets of tasks that never ended: collecting one would run its cleanup, on anybody's stack


class GreenletCarrier(greenlet):
    """A greenlet that carries task after task."""

    __slots__ = ("backend", "job", "ident", "started")
    direct = True  # it gives the baton to a carrier that has started by that one's ``switch``, without `GreenletBackend.transfer`

    def __init__(self, backend, job):
        super().__init__(parent=backend.root.stack)
        self.backend = backend
        self.job = job
        self.ident = backend.ident
        self.started = False

    def run(self):
        self.started = True
        idle = self.backend.idle
        while True:
            job, self.job = self.job, None
            successor = job(self)
            if self.backend.closed or len(idle) >= KEEP:
                self.parent = successor.stack
                return
            idle.append(self)
            successor.switch()
            if self.job is None:
                return

    @property
    def stack(self):
        return self


class RootCarrier:
    """The greenlet that was running when the kernel started."""

    __slots__ = ("stack", "switch", "ident")
    started = True
    direct = False

    def __init__(self):
        self.stack = getcurrent()
        self.switch = self.stack.switch
        self.ident = _thread.get_ident()


class GreenletBackend:
    """See the interface in `backends`."""

    name = "greenlet"
    bell = Bell
    breathe = None
    calls_back = True  # a task that is outside can be called back, for its helper thread goes on without it

    def __init__(self):
        self.idle = deque()
        self.newborn = None
        self.closed = False

    def adopt(self, kernel):
        carrier = RootCarrier()
        self.root = carrier
        self.ident = carrier.ident
        return carrier

    def carrier(self, job):
        if self.idle:
            carrier = self.idle.pop()
            carrier.job = job
            return carrier
        return GreenletCarrier(self, job)

    def transfer(self, mine, other):
        """Give the baton to OTHER.

        A new greenlet begins at the depth of recursion of the greenlet that first switches to it. If tasks started tasks directly, the
        thousandth would begin a thousand frames deep. So the root starts them all.
        """
        if mine is self.root:
            other.switch()
            while (newborn := self.newborn) is not None:
                self.newborn = None
                newborn.switch()
        elif other.started:
            other.switch()
        else:
            self.newborn = other
            self.root.switch()

    def run_blocking(self, kernel, task, call):
        """Run CALL in a helper thread.

        If the main task calls in virtual time and nothing can happen meanwhile (no task is runnable, and no outside source is
        open), CALL runs here instead: the prompt reads its line in the main thread, where Ctrl-C works.
        """
        if task is kernel.main and kernel.nothing_can_happen():
            try:
                kernel.interruptible = True
                if kernel.interrupt_waits():
                    kernel.interruptible = False
                    kernel.end_slice()  # raises it
                return call()
            finally:
                kernel.interruptible = False
        outcome = []

        def outside(carrier):
            try:
                outcome.append(call())
                outcome.append(None)
            except BaseException as exception:
                outcome[:] = None, exception
            kernel.post(lambda: kernel.comes_back(task, visit))

        helper = borrow_unless_leaving(outside)
        if helper is None:
            return call()
        visit = kernel.leave(task)
        helper.lock.release()
        kernel.hand_over(task)
        if not outcome:
            return None  # called back early: the interrupt is raised as soon as we return
        result, exception = outcome
        if exception is not None:
            raise exception
        return result

    def frame(self, carrier):
        return sys._getframe() if carrier.stack is getcurrent() else carrier.stack.gr_frame

    def close(self):
        self.closed = True
        while self.idle:
            self.idle.pop().switch()  # finds no job, and ends

    def forsake(self, carrier):
        _forsaken.append(carrier)
