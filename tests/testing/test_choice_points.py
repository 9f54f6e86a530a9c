"""A task that hands a request to a process module is a choice point: which of two requests comes first is for seeds and schedules to say."""

import pytest

from cramhy_runtime import testing
from cramhy_runtime.testing import DependsOnLuck, explore

MODULES = {
    "synchronous": "(cpm:def-process-module asked (d) (push (desig:desig-prop-value d :number) *asked*))",
    "asynchronous": """(cpm:def-asynchronous-process-module belt ()) (defmethod cpm:synchronization-fluent ((m belt) d) (declare (ignore d)) t)
      (defmethod cpm:on-input ((m belt) d)
        (push (desig:desig-prop-value d :number) *asked*) (cpm:finish-process-module m :designator d))""",
}
PLAN = """
(in-package :cl-user)
(defvar *asked*)
{module}
(defun motion (n) (desig:make-designator :motion `((:type :x) (:number ,n))))
(progn
  (setf *asked* nil)
  (cpm:with-process-modules-running ({name})
    (cpl:top-level
      (cpl:par {requests})
      (cpm:monitor-process-module '{name})))
  (reverse *asked*))
"""
TWO = "(cpm:pm-execute '{name} (motion 1)) (cpm:pm-execute '{name} (motion 2))"


def plan(kind="synchronous", requests=TWO):
    name = {"synchronous": "asked", "asynchronous": "belt"}[kind]
    text = PLAN.replace("{requests}", requests).replace("{module}", MODULES[kind]).replace("{name}", name)
    return text if kind == "asynchronous" else text.replace("(cpm:monitor-process-module 'asked)", "")


@pytest.mark.soak(all_but=2)
@pytest.mark.parametrize("backend", ["threads", "greenlet"])
@pytest.mark.parametrize("kind", MODULES)
def test_the_order_of_two_requests_is_explored(kind, backend):
    with pytest.raises(DependsOnLuck) as problem:
        explore(plan(kind), schedules=50, backend=backend)
    assert (str(problem.value.expected), str(problem.value.outcome)) == ("(1 2)", "(2 1)")
    assert "goes on after waiting for its turn to ask process module" in str(problem.value)
    again = testing.run(plan(kind), schedule=problem.value.schedule, backend=backend)
    assert str(again) == "(2 1)"


def test_seeds_find_every_order_of_three_requests():
    found = {str(testing.run(plan(requests=TWO + "(cpm:pm-execute '{name} (motion 3))"), seed=seed)) for seed in range(60)}
    assert found == {"(1 2 3)", "(1 3 2)", "(2 1 3)", "(2 3 1)", "(3 1 2)", "(3 2 1)"}


def test_first_come_first_served_and_the_empty_schedule_are_the_ordinary_run():
    ordinary = testing.run(plan())
    assert str(ordinary) == "(1 2)" and ordinary.same(testing.run(plan(), schedule=[]))
    assert [str(point) for point in ordinary.points] == [str(point) for point in testing.run(plan(), schedule=[]).points]


def test_a_request_alone_is_no_choice():
    schedule = testing.Schedule(seed=1, noting=True)
    testing.run("(cpl:top-level (cpl:sleep 1))", schedule=schedule)
    assert schedule.choices == []
