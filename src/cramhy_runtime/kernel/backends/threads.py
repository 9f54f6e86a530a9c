"""Stacks that are threads of the operating system: the default, because it needs nothing installed.

Every carrier has one lock, and waits on it while it does not have the baton. To give the baton away takes two calls: release
the lock of the other carrier, wait on its own. There is no dispatcher thread in between, so a hand-over costs one wake-up.

Threads come from a pool that all kernels share, and return to it when their task is dead. So a run that starts and
ends tasks all the time starts no threads. The pool keeps `KEEP` idle threads, and `KEEP_AFTERWARDS` when a kernel has stopped; they are
daemons and do not delay the exit. `futexes` says what many waiting threads need.

A task may recurse as deep as the main thread: `depth` says how large a stack is, and why.
"""

import _thread
import sys
import threading
from collections import deque

from .. import signals
from ..clocks import LONGEST_WAIT, Bell
from ..depth import STACK_SIZE
from ..errors import NoStack, Terminated
from ..images import in_forked_child
from .futexes import MANY, Table

KEEP = 16_384  # idle threads in the pool; each holds some 10 KiB, and a new one takes up to 0.6 ms to get its memory
KEEP_AFTERWARDS = 1024

_idle = deque()
_table = Table()
in_forked_child(_idle.clear)  # threads do not come along
in_forked_child(_table.forget)


class ThreadCarrier:
    """A thread with its lock."""

    __slots__ = ("lock", "job", "ident")
    direct = False

    def __init__(self):
        self.lock = _thread.allocate_lock()
        self.lock.acquire()
        self.job = None
        self.ident = None


def borrow(job):
    """A thread from the pool that runs JOB as soon as its lock is released.

    Raises NoStack when the system gives no more threads.
    """
    try:
        carrier = _idle.pop()
    except IndexError:
        carrier = ThreadCarrier()
        carrier.job = job
        before = _thread.stack_size(STACK_SIZE)
        if not _table.wide and _thread._count() >= MANY:
            _table.widen()
        try:
            carrier.ident = _thread.start_new_thread(_carry_on, (carrier,))
        except RuntimeError as refused:
            raise NoStack from refused
        finally:
            _thread.stack_size(before)
    else:
        carrier.job = job
    return carrier


def borrow_unless_leaving(job):
    """As `borrow`, but None if Python starts no more threads because the main program is over. Then the caller makes its blocking call
    with the baton, so that cleanup goes on."""
    try:
        return borrow(job)
    except NoStack:
        if not signals.leaving.is_set():
            raise
        return None


def threads_in_use():
    """The threads of this process beside the main one, without those that are idle in the pool."""
    return _thread._count() - len(_idle)


def _carry_on(carrier):
    """The life of a thread in the pool: wait, do a job, hand the baton on, and again."""
    trace = threading.gettrace()
    if trace is not None:
        sys.settrace(trace)  # debuggers and coverage ask `threading` for this; we don't come by there
    lock = carrier.lock
    lock.acquire()
    while True:
        job, carrier.job = carrier.job, None
        if job is None:
            return  # the pool keeps it no longer
        successor = job(carrier)
        job = None
        keep = len(_idle) < KEEP
        if keep:
            _idle.append(carrier)
        if successor is not None:
            successor.lock.release()
            successor = None
        if not keep:
            return
        lock.acquire()


class ThreadBackend:
    """See the interface in `backends`."""

    name = "threads"
    bell = Bell
    breathe = None
    calls_back = False  # a task that is outside comes back when its call has returned, not before

    def __init__(self):
        self._kernel = self._root = None

    def adopt(self, kernel):
        self._kernel = kernel
        self._root = carrier = ThreadCarrier()
        carrier.ident = _thread.get_ident()
        return carrier

    def carrier(self, job):
        return borrow(job)

    def transfer(self, mine, other):
        other.lock.release()
        self._wait(mine)

    def _wait(self, mine):
        """Wait for the baton. In the main thread Python runs signal handlers meanwhile, and one may raise."""
        if mine is not self._root:
            mine.lock.acquire()
            return
        while True:
            try:
                if mine.lock.acquire(timeout=LONGEST_WAIT):
                    return
            except (KeyboardInterrupt, Terminated) as asked:  # from Python's own handler, or from one that nobody had heard
                kernel = self._kernel
                kernel.terminate(asked.number) if isinstance(asked, Terminated) else kernel.interrupt()
                if kernel.current.carrier is mine:
                    # The baton came at the same moment. Either the lock is ours already, and this times out, or it is
                    # about to be released, and this takes it.
                    mine.lock.acquire(timeout=LONGEST_WAIT)
                    return

    def run_blocking(self, kernel, task, call):
        """Run CALL in this thread, without the baton. A spare thread takes the baton and finds the next task.

        Python delivers signals to the main thread. So while the main task is outside, an interrupt may be raised here and
        end a wait for input or for a socket, which nothing else could end.
        """
        spare = borrow_unless_leaving(kernel.carry)
        if spare is None:
            return call()
        kernel.leave(task)
        try:
            spare.lock.release()
            try:
                if task is kernel.main:
                    kernel.interruptible = True
                    if kernel.interrupt_waits():
                        return None  # and have it raised by the kernel
                return call()
            finally:
                if task is kernel.main:
                    kernel.interruptible = False
        finally:
            kernel.post(lambda: kernel.comes_back(task))
            self._wait(task.carrier)

    def frame(self, carrier):
        return sys._current_frames().get(carrier.ident)

    def close(self):
        """The pool outlives its kernels, but it does not keep the threads of the largest plan for ever."""
        while len(_idle) > KEEP_AFTERWARDS:
            _idle.popleft().lock.release()

    def forsake(self, carrier):
        """Do nothing: a daemon thread that waits for ever does no harm."""
