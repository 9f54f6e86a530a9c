"""Testing plans: virtual time, seeds, all schedules, faults, and leftovers. With pytest or without.

    from cramhy_runtime import cpl, testing

    def plan():
        door = cpl.make_fluent()
        return cpl.top_level(lambda: cpl.par(lambda: cpl.wait_for(door, timeout=5), lambda: door.set(True)))

    testing.explore(plan)                                                     # the same result under all schedules
    testing.run(plan, faults=[testing.faults.at(task="*#1/2", action="fail")])    # and when a branch fails

A plan is a Python function or Lisp, as a text or a form. Each run has a kernel of its own, in virtual time, on either back end, so
tests take milliseconds and do not disturb the session. docs/testing.md has a whole example.

Where the parts are: ``runs`` (a run and its outcome), ``plans`` (functions and Lisp as plans) · ``schedules``, ``exploration`` (the order
of tasks) · ``traces`` (marks and their order) · ``park_points``, ``faults`` (faults at waiting points) · ``leftovers`` (tasks, observers,
timers) · ``watched`` (the kernel that records all this), ``labels`` (names of tasks that are the same in every run) · ``package`` (the
Lisp packages).
"""

from . import faults
from .exploration import DependsOnLuck, Exploration, explore
from .leftovers import assert_all_dead, assert_nothing_left, assert_tree, leftovers
from .runs import Outcome, run, virtual_time
from .schedules import Schedule
from .traces import assert_after, assert_before, assert_concurrent, assert_never, assert_order, assert_times, mark
from .watched import WatchedKernel

__all__ = [
    "assert_after", "assert_all_dead", "assert_before", "assert_concurrent", "assert_never", "assert_nothing_left", "assert_order",
    "assert_times", "assert_tree", "DependsOnLuck", "Exploration", "explore", "faults", "leftovers", "mark", "Outcome", "run",
    "Schedule", "virtual_time", "WatchedKernel",
]  # fmt: skip
