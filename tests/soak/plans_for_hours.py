"""A process that runs plans for a long time and says what it holds, before and after; started by ``test_plans_for_hours.py``.

    python plans_for_hours.py BACKEND PULSES TASKS

Each round is a plan with branches that succeed, fail, are evaporated and are suspended, with fluents, nets, callbacks, waits that end by a
pulse and waits that end by the clock, and timers. After some rounds, which fill pools and caches, what the process holds is counted, and
again in the end: threads, objects, memory.
"""

from __future__ import annotations

import gc
import json
import sys
import time

from cramhy_runtime import cpl, kernel
from cramhy_runtime.cpl.statuses import EVAPORATED
from cramhy_runtime.cpl.tasks.tasks import Task
from cramhy_runtime.kernel.backends.threads import threads_in_use

WARM_UP = 0.1  # of the run
PULSES_OF_A_ROUND = 200


def holds():
    """Threads in use and in all, objects that the collector knows, kilobytes of memory; what only Linux tells is 0 elsewhere."""
    gc.collect()
    return {
        "threads in use": threads_in_use(),
        "threads": told_by_linux("Threads"),
        "objects": len(gc.get_objects()),
        "kilobytes": told_by_linux("VmRSS"),
    }


def told_by_linux(what):
    try:
        with open("/proc/self/status") as file:
            return next(int(line.split()[1]) for line in file if line.startswith(what + ":"))
    except (OSError, StopIteration):
        return 0


class Rounds:
    """The plans, and what they count."""

    def __init__(self):
        self.pulses = self.started = 0

    def round(self):
        """About twenty tasks and two hundred pulses."""
        pose = cpl.make_fluent(name="pose", value=0)
        near = cpl.fl_funcall(lambda now: now > PULSES_OF_A_ROUND - 20 or None, pose)
        both = cpl.fl_and(near, cpl.fl_not(cpl.fl_funcall(lambda now: now < 0 or None, pose)))
        told = []
        cpl.register_update_callback(pose, "count", lambda now: told.append(now))
        timer = kernel.call_every(0.1, lambda: None)

        def drive():
            for step in range(1, PULSES_OF_A_ROUND // 2 + 1):
                pose.set(2 * step)
                pose.pulse()
                if not step % 10:
                    cpl.sleep(0.01)
            return "there"

        def fails():
            cpl.sleep(0.02)
            cpl.fail("on purpose")

        def tries():
            return cpl.try_in_order(lambda: cpl.par(fails, lambda: cpl.sleep(9)), lambda: cpl.try_all(fails, fails, lambda: "third"))

        def races():
            return cpl.pursue(
                lambda: cpl.wait_for(both, timeout=5), lambda: cpl.sleep(50), lambda: (cpl.wait_for(cpl.fl_not(both)), cpl.sleep(60))
            )

        def pauses():
            child = Task(lambda: (cpl.sleep(0.05), cpl.sleep(0.05)), "paused").execute()
            cpl.sleep(0.01)
            cpl.with_task_suspended(child, lambda: cpl.sleep(0.1))
            return child.join()

        def too_late():
            return cpl.wait_for(cpl.fl_funcall(lambda now: now < 0 or None, pose), timeout=0.07)

        def ended():
            child = Task(lambda: cpl.wait_for(cpl.make_fluent()), "for ever").execute()
            dead = cpl.fl_funcall(lambda now: now is EVAPORATED or None, child.status_fluent)
            cpl.sleep(0.01)
            child.evaporate()
            cpl.wait_for(dead)

        result = cpl.top_level(lambda: cpl.par(drive, tries, races, pauses, too_late, ended))
        assert result == "there" and len(told) == PULSES_OF_A_ROUND, (result, len(told))
        timer.cancel()
        self.pulses += len(told)


def main(backend, pulses, tasks):
    active = kernel.start(backend=backend)
    rounds, before, began = Rounds(), None, time.perf_counter()
    while rounds.pulses < pulses or active._born < tasks:
        rounds.round()
        if before is None and rounds.pulses >= WARM_UP * pulses and active._born >= WARM_UP * tasks:
            before = holds()
    after = holds()
    seconds = time.perf_counter() - began
    alive = len(active.tasks) - 1
    print(
        json.dumps(
            {
                "before": before,
                "after": after,
                "alive": alive,
                "timer": active._timers.next_time(),
                "seconds": round(seconds, 1),
                "pulses": rounds.pulses,
                "tasks": active._born,
                "virtual seconds": round(kernel.now()),
            }
        )
    )
    kernel.stop()


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]), int(sys.argv[3]))
