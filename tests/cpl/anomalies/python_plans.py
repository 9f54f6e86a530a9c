"""The blocks of plans in Python, for the anomaly loop: branches, time limits, attempts, waits (docs/plans-in-python.md)."""

from __future__ import annotations

from cramhy_runtime import cpl

from .guards import guarded
from .plans import Plan


def wait(name, seconds, value=None):
    with guarded(name):
        cpl.sleep(seconds)
        return value


def branches():
    with guarded("outer"):
        with cpl.par() as together:
            together.start(wait, "one", 0.1, 1)
            together.start(wait, "two", 0.2, 2)
            wait("body", 0.1)
            with cpl.pursue() as race:
                race.start(wait, "slow", 5, "slow")
                race.start(wait, "fast", 0.1, "fast")
                wait("runner", 7)
            wait("after", 0.1)
        return together.results[1]


def limits():
    with guarded("outer"):
        try:
            with cpl.timeout(0.3):
                with guarded("limited"):
                    with cpl.par() as together:
                        together.start(wait, "one", 5)
                        wait("body", 5)
        except cpl.PlanFailure:
            return wait("late", 0.1, "late")


def attempts():
    tries = []
    with guarded("outer"):
        for attempt in cpl.attempts(3, pause=0.1):
            with attempt, guarded("attempt"):
                tries.append(len(tries))
                with cpl.par() as together:
                    together.start(wait, "one", 0.2)
                    wait("body", 0.1)
                    if len(tries) < 3:
                        cpl.fail("again")
        return len(tries) >= 3


def fluents():
    bumper = cpl.make_fluent(name="bumper", value=False)
    distance = cpl.make_fluent(name="distance", value=3)
    with guarded("outer"), cpl.pursue() as race:

        def approach():
            while distance.value > 0:
                wait("step", 0.1)
                distance.value -= 1
            wait("rest", 0.1)
            bumper.value = True
            wait("stay", 5)

        race.start(approach)
        with guarded("watch"):
            cpl.wait_for(distance < 2, timeout=3)
            cpl.wait_for((distance < 1) & bumper, timeout=3)
    return "bumped"


def plan(function, value, **others):
    return Plan(f"python-{function.__name__}", lambda: cpl.top_level(function), value, **others)


PYTHON_PLANS = [plan(branches, "2", evaporated=("no values",)), plan(limits, '"late"'), plan(attempts, "T"), plan(fluents, '"bumped"')]
