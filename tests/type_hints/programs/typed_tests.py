"""What a type checker knows of tests of plans: `cramhy_runtime.testing`, with pytest."""

from typing import Any, assert_type

import pytest

from cramhy_runtime import cpl, testing
from cramhy_runtime.testing import Outcome, assert_order, faults, mark


def plan() -> float:
    mark("begin")
    cpl.sleep(1)
    mark("end", cpl.now())
    return cpl.now()


def dropped() -> list[str]:
    return []


def test_a_run() -> None:
    outcome = testing.run(plan, backend="greenlet", seed=3, time_limit=60)
    assert_type(outcome, Outcome[float])
    assert_type(outcome.value, float)
    assert_type(outcome.time, float)
    assert_type(outcome.trace.names, list[str])
    assert_order(outcome.trace, ("begin", "end"))
    testing.assert_before(outcome.trace, "begin", "end")
    testing.assert_times(outcome.trace, "end", 1)
    testing.assert_never(outcome.trace, "fall")
    assert [event.time for event in outcome.trace] == [0, 1]
    assert [point.name for point in outcome.points] == ["sleep"]
    assert outcome.same(testing.run(plan, schedule=[0, 1]))
    assert_type(testing.run("(top-level (sleep 1))").value, Any)


def test_whoever_goes_first() -> None:
    exploration = testing.explore(plan, schedules=20)
    assert_type(exploration.outcome.value, float)
    testing.explore(dropped, check=lambda things: not things)
    with pytest.raises(testing.DependsOnLuck) as problem:
        testing.explore(plan, check=lambda seconds: seconds < 1, replay=[1])
    assert_type(problem.value.schedule, list[int])
    assert_type(problem.value.seed, int | None)


@pytest.mark.parametrize("action", ["evaporate", "fail"])
def test_faults(action: faults.Action) -> None:
    fault = faults.at(task="*PAR-CHILD-#1/2", park="sleep", nth=2, action=action, entering=True)
    testing.run(plan, faults=[fault, faults.at(action=lambda: print("here"))])


def test_a_block() -> None:
    with testing.virtual_time(seed=3) as clock:
        plan()
        assert_type(clock.now(), float)
        testing.assert_nothing_left(clock)
    assert_type(testing.leftovers(clock), list[str])
    with cpl.plan() as root:
        pass
    if root.tree is not None:
        testing.assert_tree(root.tree, {"*/tagged-grasp": "succeeded"})
        testing.assert_all_dead(root.tree)
    testing.assert_all_dead([root])
