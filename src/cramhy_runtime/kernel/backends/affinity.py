"""Waking a thread where we are: on the processor that the waker is about to leave.

Only one task runs at a time, so the processor of the one that gives the baton away is free a moment later, and its
caches are warm. Linux does not know that: it wakes the other thread on another, idle processor, which first has to wake up
itself. In a virtual machine a round trip takes 50 us that way, and 20 us in the same place (measured, 2 cores).

So the waker limits the wakee to its own processor, and the wakee lifts the limit as soon as it runs. Code of tasks never
runs under a limit; threads and processes that it starts inherit none. Where the system has no such call, or forbids it,
or has one processor, nothing is done.
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
        os.sched_setaffinity(tid, (self._processor(),))

    def let_go(self):
        os.sched_setaffinity(0, self._everywhere)


def affinity():
    """How to keep threads on one processor, or None where that is not possible or of no use."""
    try:
        if len(os.sched_getaffinity(0)) < 2:
            return None
        made = Affinity()
        made.bring(0)
        made.let_go()
        return made
    except (AttributeError, OSError, ImportError):
        return None
