"""The kernel that tests run plans on: it notes who parks where, what was marked, and what is left in the end.

It behaves as the ordinary one; what it adds is a list of park points, faults that happen at them, a trace of marks, the decisions
who goes next (``schedules.py``), and the fluents that were made. None of it exists outside of tests.
"""

from __future__ import annotations

import sys
from collections import Counter
from weakref import ref

from ..cpl.hooks import on_make_fluent_hook
from ..kernel import Kernel
from ..kernel.backends.threads import threads_in_use
from .labels import born, label
from .park_points import ParkPoint, name_of_wait
from .traces import Trace

HOOK = "cramhy-testing"


class WatchedKernel(Kernel):
    """A kernel that is looked at. ``points``: the park points of tasks of plans so far; ``faults``: what shall happen at them."""

    def __init__(self, clock="virtual", backend="threads", seed=None, time_limit=None):
        super().__init__(clock, backend, seed, time_limit)
        self.points = []
        self.faults = []
        self.trace = Trace()
        self.fluents = []  # weak references
        self.threads_before = threads_in_use()
        if hasattr(seed, "watch"):
            seed.watch(self)

    # ------------------------------------------------------------------------------------------------------- tasks and points

    def spawn(self, fn, *args, name=None, parent=None):
        task = super().spawn(fn, *args, name=name, parent=parent)
        born(task, task.parent)
        return task

    def _bury(self, task):
        label(task)
        super()._bury(task)

    def park(self, why="", until=None):
        self._at_park_point(sys._getframe(1))
        return super().park(why, until)

    def yield_(self):
        self._at_park_point(sys._getframe(1))
        super().yield_()

    def _at_park_point(self, frame):
        me = self.current
        if me.owner is None:
            return
        local = me.local
        name = name_of_wait(frame)
        counts = getattr(local, "point_counts", None)
        if counts is None:
            counts = local.point_counts = Counter()
        counts[name] += 1
        number = counts[None] = counts[None] + 1
        point = ParkPoint(label(me), name, number, counts[name], self.clock.now())
        self.points.append(point)
        for fault in self.faults:
            if fault.meets(point):
                fault.happen(self, me, point)

    # ----------------------------------------------------------------------------------------------------------- what is left

    def watch_fluents(self):
        """Note the fluents that are made from now on, until the kernel stops."""
        on_make_fluent_hook.add(lambda fluent, *_: self.fluents.append(ref(fluent)), HOOK)

    def stop(self):
        try:
            super().stop()
        finally:
            on_make_fluent_hook.remove(HOOK)

    def living_fluents(self):
        """The fluents made since `watch_fluents` that somebody still holds."""
        return [fluent for fluent in (reference() for reference in self.fluents) if fluent is not None]

    def next_timer(self):
        """The time of the next timer or deadline that counts, or None. Those that do not count are swept out."""
        self._timers.sweep()
        return self._timers.next_time()

    def threads_kept(self):
        """How many more threads are in use than when this kernel was made; those of living tasks count."""
        return threads_in_use() - self.threads_before
