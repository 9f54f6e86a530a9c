"""Barriers: a point that tasks pass together, when so many have come.

A plain barrier is passed once; a cyclic one closes again behind those who passed. A broken barrier lets nobody through any more, and
those who wait at it hear of it. A task that is evaporated while it waits does not count as having come. Source: cpl.md 13.3.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.conditions import Error, error, type_error
from cramhy_runtime.lisp_core.data import truth
from cramhy_runtime.lisp_core.packages import keyword
from cramhy_runtime.lisp_core.printing import define_printer, print_unreadable
from cramhy_runtime.lisp_core.printing import prin1_to_string

from .wait_queue import Line, need

ERROR = keyword("ERROR")
PASSED, BROKEN = "passed", "broken"


class BarrierError(Error):
    """A barrier that does not let a task through, by ``problem``."""

    lisp_name = "CRAM-UTILITIES::BARRIER-ERROR"
    initargs = {"BARRIER": "barrier", "PROBLEM": "problem"}
    barrier = problem = None

    def report(self):
        return self.problem


class Barrier:
    """Opens when ``threshold`` tasks stand before it."""

    lisp_name = "CRAM-UTILITIES::BARRIER"
    kind = "BARRIER"

    def __init__(self, threshold, name=None):
        self.threshold, self.name = threshold, name
        self.line = Line()
        self.broken = self.stale = False

    def enter(self):
        """Wait until enough have come: `PASSED` or `BROKEN`."""
        if len(self.line) + 1 >= self.threshold:
            self.open()
            return PASSED
        return self.line.stand(lambda: f"{self.threshold - len(self.line)} more at the barrier {self.name or ''}".rstrip()).got

    def open(self):
        self.stale = True
        self.line.serve_all(PASSED)

    def break_(self):
        """Nobody passes any more; those who wait hear of it."""
        self.broken = True
        self.line.serve_all(BROKEN)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.break_()  # so that nobody waits at it for ever

    def set_threshold(self, threshold):
        self.threshold = threshold
        if len(self.line) and len(self.line) >= threshold:
            self.open()


class CyclicBarrier(Barrier):
    """One that can be passed again and again."""

    lisp_name = "CRAM-UTILITIES::CYCLIC-BARRIER"
    kind = "CYCLIC-BARRIER"

    def open(self):
        self.line.serve_all(PASSED)


def _barrier(thing):
    return need(thing, Barrier, "CRAM-UTILITIES:BARRIER")


def _count(n):
    return n if isinstance(n, int) and not isinstance(n, bool) and n > 0 else type_error(n, "(INTEGER 1)")


def make_synchronization_barrier(n, *, name=None, recyclable=None):
    """``cut:make-synchronization-barrier``: one for ``n`` tasks; ``recyclable``: it can be used again."""
    return (CyclicBarrier if truth(recyclable) else Barrier)(_count(n), name)


def with_synchronization_barrier(barrier, body):
    """Values of ``body(barrier)``; afterwards the barrier is broken, so that nobody waits at it for ever."""
    with _barrier(barrier):
        return body(barrier)


def enter_barrier(barrier, *, if_broken=ERROR, if_stale=ERROR):
    """``cut:enter-barrier``: wait until so many tasks have entered; T. At a broken barrier, or one that has been passed already:
    the value of the keyword, where ``:error`` is an error."""
    if _barrier(barrier).stale and not barrier.broken:
        return _refused(barrier, if_stale, "has been passed already. A barrier that is to be used again is made with :recyclable t.")
    if barrier.broken or barrier.enter() is BROKEN:
        return _refused(barrier, if_broken, "is broken.")
    return True


def _refused(barrier, otherwise, problem):
    if otherwise is ERROR:
        return error(BarrierError(barrier=barrier, problem=f"The barrier {prin1_to_string(barrier)} {problem}"))
    return otherwise


def break_barrier(barrier):
    """``cut:break-barrier``: nobody passes any more; those who wait hear of it."""
    _barrier(barrier).break_()


def reset_cyclic_barrier(barrier):
    """``cut:reset-cyclic-barrier``: as new; those who wait at it hear that it was broken."""
    need(barrier, CyclicBarrier, "CRAM-UTILITIES:CYCLIC-BARRIER").line.serve_all(BROKEN)
    barrier.broken = False
    return barrier


def increment_barrier_threshold(barrier, n=1):
    """``cut:increment-barrier-threshold``: ``n`` tasks more have to come; the new threshold."""
    _barrier(barrier).set_threshold(barrier.threshold + _count(n))
    return barrier.threshold


def decrement_barrier_threshold(barrier, n=1):
    """``cut:decrement-barrier-threshold``: ``n`` tasks fewer have to come, which may open it; the new threshold."""
    _barrier(barrier).set_threshold(max(1, barrier.threshold - _count(n)))
    return barrier.threshold


define_printer(
    Barrier,
    lambda barrier, stream: print_unreadable(
        barrier,
        stream,
        f"{barrier.kind}{' ' + prin1_to_string(barrier.name) if barrier.name is not None else ''} "
        f"{len(barrier.line)}/{barrier.threshold}{' broken' if barrier.broken else ''}",
        identity=True,
    ),
)
