"""Waking a thread on the processor of the waking thread, which is about to leave it.

Only one task runs at a time, so the processor of the task that gives the baton away is free a moment later, and its
caches are warm. Linux does not know that: it wakes the other thread on another, idle processor, which first has to wake up
itself. In a virtual machine a round trip takes 50 us that way, and 20 us on the same processor (measured, 2 cores).

So the waking thread limits the other one to its own processor, and the other thread lifts the limit as soon as it runs. Code of
tasks never runs under a limit, and threads and processes that it starts do not inherit one. If the system has no such call,
forbids it, or has one processor, nothing is done.
"""

import os


class Affinity:
    """`bring(tid)` before a thread is woken, `let_go()` when it runs."""

    __slots__ = ("_everywhere", "_processor")

    def __init__(self):
        import ctypes  # takes 5 ms, and only who hands over between threads has to pay

        self._everywhere = os.sched_getaffinity(0)
        self._processor = ctypes.PyDLL(None).sched_getcpu

    def bring(self, tid):
        """Limit the thread TID to the processor of the current one."""
        os.sched_setaffinity(tid, (self._processor(),))

    def let_go(self):
        """Lift the limit of the current thread."""
        os.sched_setaffinity(0, self._everywhere)


def affinity():
    """An `Affinity`, or None if that is impossible or useless here."""
    try:
        if len(os.sched_getaffinity(0)) < 2:
            return None
        made = Affinity()
        made.bring(0)
        made.let_go()
        return made
    except (AttributeError, OSError, ImportError):
        return None
