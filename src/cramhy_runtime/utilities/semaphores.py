"""Semaphores: a count that never falls below zero; who would take more than there is waits in line.

Names, values and defaults are those of SB-THREAD, which CRAM-UTILITIES re-exports (cpl.md 13.3). Waiting is the kernel's, so it can be
evaporated, suspended and timed, and a semaphore that nobody signals is a deadlock with a report.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.conditions import type_error
from cramhy_runtime.lisp_core.printing import define_printer, print_unreadable
from cramhy_runtime.lisp_core.printing import prin1_to_string

from .wait_queue import Line, need, time_limit


class Semaphore:
    """``count`` units to take."""

    lisp_name = "CRAM-UTILITIES::SEMAPHORE"

    def __init__(self, name=None, count=0):
        self.name, self.count = name, count
        self.line = Line(give_back=lambda place: self.add(place.wants))

    def add(self, units):
        """``units`` more; those in front of the line who now find enough get theirs."""
        self.count += units
        while len(self.line) and self.line.first.wants <= self.count:
            self.count -= self.line.serve().wants


def _units(n):
    return n if isinstance(n, int) and not isinstance(n, bool) and n > 0 else type_error(n, "(INTEGER 1)")


def _semaphore(thing):
    return need(thing, Semaphore, "CRAM-UTILITIES:SEMAPHORE")


def make_semaphore(*, name=None, count=0):
    """``cut:make-semaphore``: a semaphore with ``count`` units."""
    if not isinstance(count, int) or count < 0:
        type_error(count, "UNSIGNED-BYTE")
    return Semaphore(name, count)


def wait_on_semaphore(semaphore, *, n=1, timeout=None):
    """``cut:wait-on-semaphore``: take ``n`` units, waiting until there are so many; the units left, nil after ``timeout`` seconds."""
    units, until = _units(n), time_limit(timeout)
    if len(_semaphore(semaphore).line) or semaphore.count < units:
        try:
            served = semaphore.line.stand(lambda: f"{units} of the semaphore {semaphore.name or ''}".rstrip(), until, units)
        finally:
            semaphore.add(0)  # who leaves the front unserved may have wanted more than there is for those behind
        return semaphore.count if served is not None else None
    semaphore.count -= units
    return semaphore.count


def try_semaphore(semaphore, n=1):
    """``cut:try-semaphore``: as `wait_on_semaphore`, but nil at once when there is not enough, or others are in line."""
    units = _units(n)
    if len(_semaphore(semaphore).line) or semaphore.count < units:
        return None
    semaphore.count -= units
    return semaphore.count


def signal_semaphore(semaphore, n=1):
    """``cut:signal-semaphore``: add ``n`` units."""
    _semaphore(semaphore).add(_units(n))


def semaphore_count(semaphore):
    return _semaphore(semaphore).count


def semaphore_name(semaphore):
    return _semaphore(semaphore).name


def _print(semaphore, stream):
    name = f"{prin1_to_string(semaphore.name)} " if semaphore.name is not None else ""
    print_unreadable(semaphore, stream, f"SEMAPHORE {name}count: {semaphore.count}", identity=True)


define_printer(Semaphore, _print)
