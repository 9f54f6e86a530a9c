"""Faults at park points."""

import pytest

from cramhy_runtime import cpl, testing
from cramhy_runtime.testing import faults
from cramhy_runtime.testing.park_points import NAMES, ORDER

BACKENDS = ["threads", "greenlet"]
PLAN = """
(top-level
  (par (progn (sleep 1) (mark :first) 1)
       (unwind-protect (progn (sleep 1) (sleep 1) (mark :second) 2) (mark :cleanup))))
"""


def run(action, backend="threads", **where):
    return testing.run(PLAN, backend=backend, faults=[faults.at("*#2/2", action=action, **where)])


@pytest.mark.parametrize("backend", BACKENDS)
@pytest.mark.parametrize("entering", [False, True])
def test_what_may_happen_to_a_branch(backend, entering):
    outcome = run("evaporate", backend, nth=2, entering=entering)
    assert outcome.value == 1 and outcome.trace.names == ["first", "cleanup"] and outcome.time == 1
    outcome = run("fail", backend, park="sleep", nth=2, entering=entering)
    assert isinstance(outcome.error, faults.InjectedFailure) and outcome.trace.names == ["first", "cleanup"]
    outcome = run("raise", backend, entering=entering)
    assert str(outcome) == "InjectedError: A fault at TOP-LEVEL/PAR-CHILD-#2/2, point 1 (sleep 1), at 0 s."
    assert outcome.trace.names == ["cleanup"]
    outcome = run("suspend-and-resume", backend, nth=2, entering=entering, seconds=5)
    assert outcome.value == 1 and outcome.time == 6 and outcome.trace.names == ["first", "second", "cleanup"]
    outcome = run(lambda: testing.mark("here"), backend, nth=2, entering=entering)
    assert outcome.value == 1 and outcome.trace.names == ["first", "here", "second", "cleanup"]


def test_a_fault_that_does_not_happen_is_an_error_with_the_points_that_were():
    with pytest.raises(AssertionError) as problem:
        run("fail", nth=7)
    assert (
        str(problem.value)
        == """\
Did not happen: fail *#2/2 at park point 7. The park points of the run:
  TOP-LEVEL, point 1 (branches 1), at 0 s
  TOP-LEVEL/PAR-CHILD-#1/2, point 1 (sleep 1), at 0 s
  TOP-LEVEL/PAR-CHILD-#2/2, point 1 (sleep 1), at 0 s
  TOP-LEVEL/PAR-CHILD-#2/2, point 2 (sleep 2), at 1 s"""
    )


def test_wrong_faults_are_refused():
    with pytest.raises(ValueError, match='There is no action "explode". Choose one of evaporate, fail, raise, suspend-and-resume'):
        faults.at(action="explode")
    with pytest.raises(ValueError, match="Park points count from 1, not from 0."):
        faults.at(nth=0)


def test_the_plan_can_handle_an_injected_failure():
    text = """(top-level (with-failure-handling ((cramhy-testing:injected-failure (e) (declare (ignore e)) (return :handled)))
                           (par (sleep 1) (sleep 2))))"""
    assert str(testing.run(text, faults=[faults.at("*#1/2", action="fail")])) == ":HANDLED"


@pytest.mark.parametrize("backend", BACKENDS)
def test_every_named_wait_is_met_under_its_name(backend):
    """So that a function that is renamed does not make its park points anonymous."""
    met = set()
    for text in WAITS:
        met |= {point.name for point in testing.run(text, backend=backend).points}
    assert met == {*NAMES.values(), "order", "park"} - {"top-level"}
    assert ORDER not in NAMES


WAITS = [
    "(top-level (par (wait-for (make-fluent) :timeout 1) (sleep 1)))",
    "(top-level (pursue (unwind-protect (sleep 9) (sleep 1)) (sleep 1)))",
    "(top-level (with-tags (partial-order ((:tag a (sleep 1)) (:tag b (sleep 1))) (:order b a))))",
    "(top-level (cpl-impl::with-parallel-childs nil (running done failed) ((sleep 1)) (when done (return 1))))",
    """(top-level (with-tags (par (:tag a (without-scheduling (sleep 1)) (par (sleep 1) (sleep 1)))
                                  (with-task-suspended (a) (sleep 1))
                                  (progn (sleep 0.1) (join-task a)))))""",
    """(top-level (with-tags (par (:tag a (unwind-protect (sleep 9) (sleep 1)))
                                  (progn (sleep 1) (suspend a) (sleep 1) (wake-up a) (evaporate a)))))""",
    """(cpm:def-process-module testing-module (d) (declare (ignore d)) (unwind-protect (sleep 3) (sleep 1)))
       (cpm:with-process-modules-running (testing-module)
         (top-level (pursue (cpm:pm-execute 'testing-module (desig:make-designator :motion '((:type :x)))) (sleep 1))))""",
]


def test_a_branch_gets_the_same_label_in_every_run():
    def wait():
        return cpl.par(lambda: cpl.sleep(1))

    def plan():
        cpl.top_level(lambda: cpl.par(wait, lambda: (wait(), wait())))

    labels = [[point.task for point in testing.run(plan).points] for _ in range(2)]
    assert labels[0] == labels[1] and "TOP-LEVEL/PAR-CHILD-#2/2/PAR-CHILD-#1/1 (2)" in labels[0]
