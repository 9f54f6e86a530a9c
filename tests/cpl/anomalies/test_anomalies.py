"""Whatever happens to a branch, wherever it waits: the laws hold.

For each plan of ``plans.py``, each of its tasks, each park point until the plan ends by itself: the task is evaporated there, fails,
raises an error, or is suspended for a while. Cleanup runs once and in order, no task lives on, nothing observes, no timer and no
thread is left, and the outcome is one that the plan allows. ``make soak`` (CRAMHY_SOAK=1) takes every point, at both moments, on both
back ends, and several faults at once; the ordinary suite a part of them.
"""

from __future__ import annotations

import random

import pytest
from systems import SOAK

from cramhy_runtime import kernel
from cramhy_runtime.testing import faults

from .acting_plans import ACTING_PLANS
from .harness import check_run, faults_of
from .plans import PLANS
from .python_plans import PYTHON_PLANS

RANDOM = 200 if SOAK else 3
BACKENDS = ["threads", "greenlet"]


@pytest.fixture(autouse=True)
def unheard(monkeypatch):
    """What the kernel reports as lost: nothing may be."""
    heard = []
    monkeypatch.setattr(kernel.reports.installed.reporter, "unhandled", lambda task, exception: heard.append((str(task.name), exception)))
    yield heard
    assert not heard


def every_plan(test):
    return pytest.mark.parametrize("plan", [*PLANS, *ACTING_PLANS, *PYTHON_PLANS], ids=lambda plan: plan.name)(test)


@pytest.mark.soak(all_but=6)
@every_plan
@pytest.mark.parametrize("backend", BACKENDS)
def test_without_a_fault_a_plan_gives_its_value_and_leaves_nothing(plan, backend):
    outcome, wrong = check_run(plan, backend=backend)
    assert str(outcome) in (plan.value, *plan.free) and not wrong


@pytest.mark.soak(all_but=2)
@every_plan
@pytest.mark.parametrize("backend", BACKENDS)
@pytest.mark.parametrize("action", faults.ACTIONS)
def test_a_fault_at_any_park_point(plan, backend, action, record_property):
    entering = (False, True) if SOAK else (False,) if backend == "threads" else (True,)
    count = -1  # the first is the run without a fault
    for fault, _, wrong in faults_of(plan, backend, [action], entering, every=1 if SOAK else 2):
        count += 1
        assert not wrong, f"{plan.name}, {fault}, {backend}:\n  " + "\n  ".join(wrong)
    record_property("faults", count)
    print(f"{count} runs")


@pytest.mark.soak(all_but=6)
@every_plan
@pytest.mark.parametrize("backend", BACKENDS)
def test_several_faults_in_one_run(plan, backend, record_property):
    """A later one may hit the cleanup after an earlier one, and a seed shuffles who goes first. Which outcomes are right then is not asked,
    but a deadlock is not, and nothing may be left."""
    lots = random.Random(plan.name)
    points = check_run(plan, backend=backend)[0].points
    happened = 0
    for seed in range(RANDOM):
        several = [
            faults.at(
                point.task,
                nth=point.number + lots.choice((0, 0, 1, 2)),
                action=lots.choice(faults.ACTIONS),
                seconds=lots.choice((0, 0.1, 0.25)),
                entering=lots.random() < 0.5,
            )
            for point in lots.choices(points, k=lots.choice((2, 2, 3, 4)))
        ]
        _, wrong = check_run(plan, faults=several, backend=backend, seed=seed or None)
        assert not wrong, f"{plan.name}, {several}, seed {seed or None}, {backend}:\n  " + "\n  ".join(wrong)
        happened += sum(fault.happened is not None for fault in several)
    record_property("faults", happened)
