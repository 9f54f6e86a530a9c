"""Marks, and what is said of their order."""

import pytest

from cramhy_runtime import cpl, kernel, testing
from cramhy_runtime.testing import assert_after, assert_before, assert_concurrent, assert_never, assert_order, assert_times, mark

PLAN = """
(top-level
  (mark :reach)
  (par (progn (mark :grasp) (sleep 1) (mark :grasp))
       (progn (sleep 0.5) (mark :look 7) (sleep 1)))
  (mark "done")
  :ok)
"""


@pytest.fixture
def trace():
    outcome = testing.run(PLAN)
    assert str(outcome) == ":OK"
    return outcome.trace


def test_marks_have_names_times_tasks_and_values(trace):
    assert trace.names == ["reach", "grasp", "look", "grasp", "done"]
    assert str(trace).splitlines() == [
        "   0.000 s  reach  (TOP-LEVEL)",
        "   0.000 s  grasp  (TOP-LEVEL/PAR-CHILD-#1/2)",
        "   0.500 s  look 7  (TOP-LEVEL/PAR-CHILD-#2/2)",
        "   1.000 s  grasp  (TOP-LEVEL/PAR-CHILD-#1/2)",
        "   1.500 s  done  (TOP-LEVEL)",
    ]


def test_orders_that_hold(trace):
    assert_order(trace, ("reach", "grasp", "done"), ("reach", "look", "done"))
    assert_before(trace, "reach", "look")
    assert_after(trace, "done", "grasp")
    assert_concurrent(trace, "grasp", "look")
    assert_never(trace, "drop")
    assert_times(trace, "grasp", 2)


def test_an_order_that_does_not_hold_shows_the_trace(trace):
    with pytest.raises(AssertionError) as problem:
        assert_order(trace, ("reach", "look", "grasp"))
    assert (
        str(problem.value)
        == """\
grasp came before look: it should be reach < look < grasp.
    0.000 s  reach  (TOP-LEVEL)
>    0.000 s  grasp  (TOP-LEVEL/PAR-CHILD-#1/2)
>    0.500 s  look 7  (TOP-LEVEL/PAR-CHILD-#2/2)
     1.000 s  grasp  (TOP-LEVEL/PAR-CHILD-#1/2)
     1.500 s  done  (TOP-LEVEL)""".replace("\n    0.000", "\n     0.000")
    )


def test_spans_that_do_not_overlap(trace):
    with pytest.raises(AssertionError, match="reach was over at 0 s, before look began at 0.5 s: they should overlap."):
        assert_concurrent(trace, "look", "reach")


def test_what_did_not_happen_is_said_with_what_did(trace):
    with pytest.raises(AssertionError, match="drop did not happen. Marks that did: reach, grasp, look, done."):
        assert_before(trace, "drop", "done")
    with pytest.raises(AssertionError, match="grasp happened 2 times, not 1."):
        assert_times(trace, "grasp", 1)
    with pytest.raises(AssertionError, match="look happened, which it should not."):
        assert_never(trace, "drop", "look")


def test_a_mark_means_nothing_outside_of_tests():
    kernel.start()
    try:
        assert cpl.top_level(lambda: mark("nobody sees it")) is None
    finally:
        kernel.stop()


def test_the_statuses_of_a_task_tree_are_compared_by_path():
    testing.plans.with_lisp(lambda: None)
    text = """
    (def-cram-function testing-step (n) (if (= n 2) (fail "two") n))
    (def-top-level-cram-function testing-steps () (:tag first-of-all (testing-step 1)) (testing-step 2))
    (progn (ignore-errors (handler-case (testing-steps) (plan-failure () nil))) (get-top-level-task-tree 'testing-steps))
    """
    tree = testing.run(text).value
    testing.assert_all_dead(tree)
    testing.assert_tree(
        tree,
        {"*/tagged-first-of-all": "succeeded", "*/testing-step": "*"}
        if False
        else {"*/tagged-first-of-all": "succeeded", "top-level-testing-steps": "failed"},
    )
    with pytest.raises(AssertionError) as problem:
        testing.assert_tree(tree, {"*/tagged-first-of-all": "failed", "nowhere": "succeeded"})
    text = str(problem.value)
    assert text.startswith("top-level-testing-steps/tagged-first-of-all succeeded, not failed; no task at nowhere.\nThe tree:\n")
