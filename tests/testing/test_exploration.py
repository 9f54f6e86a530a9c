"""Exploring schedules: what depends on luck is found, made small, and can be seen again."""

import pytest

from cramhy_runtime import cpl, testing
from cramhy_runtime.testing import DependsOnLuck, Schedule, explore

BACKENDS = ["threads", "greenlet"]

HARMLESS = "(top-level (let ((n 0)) (par-loop (m '(1 2 3)) (sleep 1) (setf n (+ n m))) n))"

LOST_UPDATE = """
(top-level
  (let ((account 0))
    (flet ((pay-in (sum)
             (let ((before account))
               (sleep 0)
               (setf account (+ before sum)))))
      (par (pay-in 1) (progn (sleep 0) (sleep 0) (sleep 0) (pay-in 2))))
    account))
"""
"""Reads, lets others run, and writes: on the way through CRAM a student writes this within the first week."""


@pytest.mark.parametrize("backend", BACKENDS)
def test_a_plan_that_does_not_depend_on_luck(backend):
    exploration = explore(HARMLESS, schedules=50, backend=backend)
    assert exploration.runs == 50 and exploration.different > 3 and str(exploration.outcome) == "6"


@pytest.mark.parametrize("backend", BACKENDS)
def test_a_lost_update_is_found_and_made_small(backend):
    with pytest.raises(DependsOnLuck) as problem:
        explore(LOST_UPDATE, schedules=500, backend=backend)
    found = problem.value
    assert str(found.expected) == "3" and str(found.outcome) in ("1", "2")
    assert len(found.schedule) <= 6 and found.schedule[-1] != 0 and found.seed is not None
    again = testing.run(LOST_UPDATE, schedule=found.schedule, backend=backend)
    assert again.same(found.outcome)
    for shorter in range(len(found.schedule)):
        assert str(testing.run(LOST_UPDATE, schedule=found.schedule[:shorter], backend=backend)) == "3"


def test_the_report_says_who_could_go_and_who_went():
    def plan():
        order = []
        cpl.top_level(lambda: cpl.par(lambda: (cpl.sleep(1), order.append("one")), lambda: (cpl.sleep(1), order.append("two"))))
        return order[-1]

    with pytest.raises(DependsOnLuck) as problem:
        explore(plan, schedules=100)
    found = problem.value
    assert found.schedule == [1]
    assert (
        str(found)
        == f"""\
The plan depends on who goes first: the result is another one with this schedule.
  expected (first come, first served): "two"
  got: "one"
Found with seed {found.seed}. The shortest schedule that shows it: [1], then first come, first served.
  decision 1, at 1 s:
       0 TOP-LEVEL/PAR-CHILD-#1/2 (goes on after waiting for the time 1 s (sleep 1))
    -> 1 TOP-LEVEL/PAR-CHILD-#2/2 (goes on after waiting for the time 1 s (sleep 1))   (first come, first served would have taken the first)
See it again: testing.run(plan, schedule=[1]), or explore(..., replay=[1])."""
    )


def test_a_check_says_what_is_right():
    def at_most_three(value):
        return value <= 3

    def exactly(value):
        assert value == 3, "a payment was lost"

    assert explore(LOST_UPDATE, schedules=300, check=at_most_three).runs == 300
    with pytest.raises(DependsOnLuck, match="the check says: a payment was lost"):
        explore(LOST_UPDATE, schedules=500, check=exactly)
    with pytest.raises(DependsOnLuck, match="the check says no"):
        explore(LOST_UPDATE, schedules=500, check="#'(lambda (sum) (= sum 3))")


def test_a_check_that_fails_at_once_needs_no_schedule():
    with pytest.raises(DependsOnLuck) as problem:
        explore(HARMLESS, check=lambda value: value == 5)
    assert problem.value.schedule == [] and problem.value.seed is None


def test_a_check_of_the_outcome_sees_errors_and_traces():
    def handled(outcome):
        assert "SimplePlanFailure" in str(outcome)

    handled.of_outcome = True
    explore('(top-level (par (sleep 1) (fail "always")))', schedules=5, check=handled)
    with pytest.raises(DependsOnLuck, match="it ended with SimplePlanFailure: always"):
        explore('(top-level (par (sleep 1) (fail "always")))', schedules=5, check=lambda value: True)


def test_a_schedule_can_be_replayed_and_one_that_does_not_fit_is_refused():
    with pytest.raises(DependsOnLuck) as problem:
        explore(LOST_UPDATE, schedules=500)
    with pytest.raises(DependsOnLuck) as again:
        explore(LOST_UPDATE, replay=problem.value.schedule)
    assert again.value.schedule == problem.value.schedule
    with pytest.raises(ValueError, match="The schedule does not fit the plan: at decision 1 there is no candidate 9."):
        explore(LOST_UPDATE, replay=[9])


def test_a_run_notes_its_choices():
    schedule = Schedule(seed=5, noting=True)
    first = testing.run(LOST_UPDATE, schedule=schedule)
    assert len(schedule.choices) == len(schedule.decisions) > 0
    second = testing.run(LOST_UPDATE, schedule=schedule.choices)
    assert first.same(second)
