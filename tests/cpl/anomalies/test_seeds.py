"""No plan of the anomaly loop depends on luck: many seeds, the same result up to what the plan declares as ``free``, nothing left.

``make soak`` (CRAMHY_SOAK=1) takes 1,000 seeds of each plan, the ordinary suite 20.
"""

from __future__ import annotations


import pytest
from systems import SOAK

from cramhy_runtime.testing import Schedule

from .acting_plans import ACTING_PLANS
from .harness import check_run
from .plans import PLANS
from .python_plans import PYTHON_PLANS

SEEDS = 1000 if SOAK else 20


@pytest.mark.soak(all_but=2)
@pytest.mark.parametrize("plan", [*PLANS, *ACTING_PLANS, *PYTHON_PLANS], ids=lambda plan: plan.name)
def test_a_plan_gives_the_same_with_every_seed(plan, record_property):
    different = set()
    for seed in range(1, SEEDS + 1):
        schedule = Schedule(seed=seed)
        outcome, wrong = check_run(plan, schedule=schedule, backend="greenlet" if seed % 2 else "threads")
        assert not wrong, f"{plan.name}, seed {seed}, schedule {schedule.choices}:\n  " + "\n  ".join(wrong)
        different.add((tuple(schedule.choices), str(outcome)))
    record_property("schedules", len(different))


@pytest.mark.soak(all_but=15)
@pytest.mark.parametrize("plan", [*PLANS, *ACTING_PLANS, *PYTHON_PLANS], ids=lambda plan: plan.name)
def test_both_back_ends_take_the_same_way_with_a_seed(plan):
    ways = []
    for backend in ("threads", "greenlet"):
        outcome, _ = check_run(plan, seed=7, backend=backend)
        ways.append((str(outcome), [str(point) for point in outcome.points]))
    assert ways[0] == ways[1]
