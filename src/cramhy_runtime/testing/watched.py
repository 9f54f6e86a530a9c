"""The kernel on which tests run plans: it records where tasks park, the marks, and what is left in the end.

It behaves like the ordinary kernel. It adds a list of park points, faults that happen at them, a trace of marks, the decisions which task
goes next (``schedules.py``), and the fluents that were made. None of this exists outside of tests.
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
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, TypeVar, TypeVarTuple

if TYPE_CHECKING:
    from collections.abc import Callable
    from types import FrameType

    from cramhy_runtime.cpl import Fluent
    from cramhy_runtime.kernel import Task
    from cramhy_runtime.kernel.signatures import Backend, BackendName, Clock, ClockName, Name, Seed, Why
    from .faults import Fault

T = TypeVar("T")
Arguments = TypeVarTuple("Arguments")

HOOK = "cramhy-testing"


class WatchedKernel(Kernel):
    """A kernel that tests look at. ``points`` are the park points of tasks of plans so far; ``faults`` happen at them."""

    def __init__(
        self,
        clock: ClockName | Clock = "virtual",
        backend: BackendName | Backend = "auto",
        seed: Seed | None = None,
        time_limit: float | None = None,
    ):
        super().__init__(clock, backend, seed, time_limit)
        self.points: list[ParkPoint] = []
        self.faults: list[Fault] = []
        self.trace = Trace()
        self.fluents: list[ref[Fluent[object]]] = []  # weak references
        self.threads_before = threads_in_use()
        if hasattr(seed, "watch"):
            seed.watch(self)

    # ------------------------------------------------------------------------------------------------------- tasks and points

    def spawn(
        self, fn: Callable[[*Arguments], T], *args: *Arguments, name: Name | None = None, parent: Task[object] | None = None
    ) -> Task[T]:
        task = super().spawn(fn, *args, name=name, parent=parent)
        born(task, task.parent)
        return task

    def _bury(self, task: Task[object]) -> None:
        label(task)
        super()._bury(task)

    def park(self, why: Why = "", until: float | None = None) -> bool:
        self._at_park_point(sys._getframe(1))
        return super().park(why, until)

    def yield_(self) -> None:
        self._at_park_point(sys._getframe(1))
        super().yield_()

    def _at_park_point(self, frame: FrameType) -> None:
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

    def watch_fluents(self) -> None:
        """Remember the fluents that are made from now on, until the kernel stops."""
        on_make_fluent_hook.add(lambda fluent, *_: self.fluents.append(ref(fluent)), HOOK)

    def stop(self) -> None:
        try:
            super().stop()
        finally:
            on_make_fluent_hook.remove(HOOK)

    def living_fluents(self) -> list[Fluent[object]]:
        """The fluents made since `watch_fluents` that are still in use."""
        return [fluent for fluent in (reference() for reference in self.fluents) if fluent is not None]

    def next_timer(self) -> float | None:
        """The time in seconds of the next timer or deadline that is still in force, or None. Others are removed."""
        self._timers.sweep()
        return self._timers.next_time()

    def threads_kept(self) -> int:
        """How many more threads are in use than when this kernel was made. Threads of living tasks count, too."""
        return threads_in_use() - self.threads_before
