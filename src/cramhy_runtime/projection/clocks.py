"""Clocks of imagined worlds: their time passes when code says how long an action would have taken.

A `LinearClock` adds up all waits. A `PartiallyOrderedClock` is for plans whose branches act side by side: their waits overlap, as the
motions of two arms do. It moves in steps from one awaited moment to the next. Between two steps there is a short delay of the kernel's
clock, so that branches which begin to wait together are counted together; in virtual time the result is always the same. Law: after a
wait the clock shows at least the time before it plus the duration. Source: projection-and-events.md A2.

Repaired: a clock is disabled as long as any form disables it; in the original a form that is active twice enables it when its inner
activation ends. A duration that is not a real number from 0 on is an error, where the original sets a linear clock back.
"""

from __future__ import annotations

from bisect import insort

from cramhy_runtime import kernel

from cramhy_runtime.cpl.tasks.pausing import pause
from cramhy_runtime.cpl.tasks.waiting import sleep
from cramhy_runtime.lisp_core.conditions import type_error
from cramhy_runtime.lisp_core.data import lisp_list
from cramhy_runtime.lisp_core.numbers import need_real
from cramhy_runtime.lisp_core.numbers import is_real
from cramhy_runtime.lisp_core.dispatch.generic_functions import generic
from . import symbols  # noqa: F401  the package must exist
from .symbols import sym

clock_time = generic("CRAM-PROJECTION::CLOCK-TIME", "(clock)", documentation="The time that ``clock`` shows.")
clock_wait = generic(
    "CRAM-PROJECTION::CLOCK-WAIT",
    "(clock duration)",
    documentation="""
Let ``duration`` pass on ``clock``. When this returns, the clock shows at least its old time plus the duration.""",
)
partially_ordered_clock_enabled = generic(
    "CRAM-PROJECTION::PARTIALLY-ORDERED-CLOCK-ENABLED",
    "(clock)",
    documentation="""
True unless a form disables ``clock`` now.""",
)

_DURATION = lisp_list(sym("REAL"), 0)


def _check(duration):
    if isinstance(duration, bool) or not is_real(duration) or not duration >= 0:
        type_error(duration, _DURATION, "\n(A clock waits for a duration: a real number, not below 0.)")


class LinearClock:
    """A clock that every wait moves at once, by its whole duration. initial_time: a real number."""

    lisp_name = "CRAM-PROJECTION::LINEAR-CLOCK"
    initargs = {"INITIAL-TIME": "time"}

    def __init__(self, initial_time=0):
        self.time = initial_time


class PartiallyOrderedClock:
    """A clock on which parallel waits overlap.

    initial_time: a real number. increment_delay: the time between two steps, in seconds of the kernel's clock; waits that begin within it
    count as begun together.
    """

    lisp_name = "CRAM-PROJECTION::PARTIALLY-ORDERED-CLOCK"
    initargs = {"INITIAL-TIME": "time", "INCREMENT-DELAY": "increment_delay"}

    def __init__(self, initial_time=0, increment_delay=0.05):
        self.time = initial_time
        self.increment_delay = increment_delay
        self.ends = []  # the moments that are waited for, in order
        self.disabled = 0  # how many forms disable it now
        self.held_up = []  # tasks of the kernel that wait for it to be enabled

    def await_enabled(self):
        """Wait until no form disables the clock."""
        me = kernel.current()
        while self.disabled:
            self.held_up.append(me)
            try:
                pause(lambda: "a projection clock that is disabled")
            finally:
                self.held_up.remove(me)

    def step(self):
        """Go on to the next awaited moment."""
        for end in self.ends:
            if end > self.time:
                self.time = end
                return


@clock_time.method(LinearClock)
@clock_time.method(PartiallyOrderedClock)
def _time(clock):
    return clock.time


@clock_wait.method(LinearClock, None)
def _wait_linear(clock, duration):
    _check(duration)
    clock.time = need_real(clock.time) + need_real(duration)
    return clock.time


@clock_wait.method(PartiallyOrderedClock, None)
def _wait_partially_ordered(clock, duration):
    _check(duration)
    end = need_real(clock.time) + need_real(duration)
    insort(clock.ends, end)
    try:
        while clock.time < end:
            clock.await_enabled()
            sleep(clock.increment_delay)
            clock.await_enabled()
            if clock.time < end:
                clock.step()
    finally:
        clock.ends.remove(end)


@partially_ordered_clock_enabled.method(PartiallyOrderedClock)
def _enabled(clock):
    return None if clock.disabled else True


def with_partially_ordered_clock_disabled(clock, body):
    """Call ``body()`` and return its values. The time of ``clock`` stands still until all such forms have been left.

    A clock of another class is a type error. Source: projection-and-events.md A2.
    """
    if not isinstance(clock, PartiallyOrderedClock):
        return type_error(clock, sym("CRAM-PROJECTION::PARTIALLY-ORDERED-CLOCK"))
    clock.disabled += 1
    try:
        return body()
    finally:
        clock.disabled -= 1
        if not clock.disabled:
            for task in clock.held_up:
                task.kernel.unpark(task)
