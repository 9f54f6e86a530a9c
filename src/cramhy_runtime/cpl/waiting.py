"""Waiting: for a fluent to become true, again and again, or for time to pass.

A value that is true on the first look is returned at once. Otherwise the task parks at the fluent; a pulse that leaves the value
false does not even wake it. On suspension it waits on afterwards and looks again, so a value that was true only meanwhile is
missed, and one that is true at wake-up is seen. Source: cpl.md 2.10, 2.11, 3.9. Repaired: the timed wait keeps its time however
often the fluent pulses, and can be evaporated and suspended like the untimed one.
"""

from __future__ import annotations

from cramhy_runtime import kernel

from ..lisp.conditions import error
from ..lisp.data import truth
from .fluents import Fluent
from .pausing import pause


def wait_for(fluent, *, timeout=None, **ignored):
    """Wait until the value of ``fluent`` is true and return it; after ``timeout`` seconds give up and return nil.

    Any other object is returned if it is true; nil is an error. A timeout of 0 only tests.
    """
    if not isinstance(fluent, Fluent):
        return fluent if truth(fluent) else error("wait-for called with nil argument.")
    value = fluent.read()
    if value is not None and value is not False:
        return value
    until = None if timeout is None else kernel.now() + timeout
    if until is not None and timeout <= 0:
        return None
    me = kernel.current()

    def why():
        from ..lisp.printer.printer import prin1_to_string

        return f"the fluent {prin1_to_string(fluent)}"

    if not fluent.waiters:
        fluent.waiters = []
    fluent.waiters.append(me)
    try:
        while True:
            in_time = pause(why, until)
            value = fluent.read()
            if value is not None and value is not False:
                return value
            if not in_time and until is not None and kernel.now() >= until:
                return None
    finally:
        fluent.waiters.remove(me)


def whenever(fluent, body):
    """Wait for ``fluent``, call ``body``, and so on for ever; ``(return ...)``, the compiler's block, is the way out."""
    while True:
        wait_for(fluent)
        body()
        kernel.checkpoint()


def sleep_star(seconds):
    """Sleep for ``seconds`` of the kernel's clock; returns nil. Time spent suspended counts as slept."""
    if not seconds > 0:
        kernel.yield_()
        return
    until = kernel.now() + float(seconds)
    while pause(lambda: f"the time {until:g} s (sleep {seconds})", until) or kernel.now() < until:
        pass


sleep = sleep_star
