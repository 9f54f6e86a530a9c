"""The operators of the plan language in plain Hy: a file without ``in-package``, branches with Hy bodies."""

import types

import hy
import pytest

from cramhy_runtime import kernel
from cramhy_runtime.cpl import SimplePlanFailure

BEGINNING = """
(require cramhy *)
(import cramhy_runtime.cpl *)
(setv log [])
(defn note [what] (.append log what) what)
(defclass DoorStuck [PlanFailure])
"""


def run(text):
    """The value of the last form of ``text``, and what was noted on the way."""
    module = types.ModuleType("a_plan_in_hy")
    value = None
    for form in hy.read_many(BEGINNING + text):
        value = hy.eval(form, module=module)
    return value, module.log


def test_a_top_level_gives_the_value_of_its_last_form():
    assert run('(top-level (note "a") 7)') == (7, ["a"])


def test_par_runs_its_branches_at_once_and_gives_the_first_value():
    text = '(top-level (par (do (sleep 2) (note "slow")) (do (sleep 1) (note "fast"))))'
    assert run(text) == ("slow", ["fast", "slow"])
    assert kernel.now() == 2.0


def test_pursue_ends_the_loser_after_its_cleanup():
    text = '(top-level (pursue (try (sleep 9) (finally (note "cleaned"))) (do (sleep 1) (note "won"))))'
    assert run(text) == ("won", ["won", "cleaned"])


@pytest.mark.soak
def test_the_ways_to_try():
    assert run('(top-level (try-in-order (fail "a") 2 (note "never")))') == (2, [])
    assert run('(top-level (try-each-in-order [x [1 2 3]] (note x) (when (< x 2) (fail "small")) x))') == (2, [1, 2])
    assert run('(top-level (try-all (fail "a") (do (sleep 1) 5)))') == (5, [])


def test_par_loop_takes_all_elements_at_once():
    assert run("(top-level (par-loop [x [3 1 2]] (sleep x) (note x) (* 10 x)))") == (30, [1, 2, 3])


def test_whenever_is_left_by_break():
    text = """
    (setv count (make-fluent :value 0) total 0)
    (top-level
      (par
        (do (setv total 0)
            (whenever [(pulsed count :handle-missed-pulses :always)]
              (+= total 1)
              (when (= total 3) (break)))
            (note total))
        (for [n [1 2 3]] (sleep 1) (setv count.value n))))
    """
    assert run(text)[1] == [3]


def test_handlers_run_before_cleanup_and_retry_begins_again():
    text = """
    (setv tries [])
    (top-level
      (with-retry-counters [[again 2]]
        (with-failure-handling
          [[DoorStuck [e]
             (note "handler")
             (do-retry again (retry))
             (leave "gave up")]]
          (.append tries 1)
          (try (fail (DoorStuck)) (finally (note "cleanup"))))))
    """
    assert run(text) == ("gave up", ["handler", "cleanup"] * 3)


def test_a_handler_that_ends_declines_and_the_failure_leaves_the_plan():
    with pytest.raises(SimplePlanFailure, match="Stuck."):
        run('(top-level (with-failure-handling [[PlanFailure [e] (note "seen")]] (fail "Stuck.")))')


def test_tags_are_variables_that_can_be_ordered():
    text = """
    (top-level
      (with-tags
        (partial-order
          [(:tag place (note "place"))
           (do (sleep 1) (:tag grasp (note "grasp")))]
          (:order grasp place))))
    """
    assert run(text)[1] == ["grasp", "place"]


def test_a_tag_executed_again_is_a_new_task_of_the_same_name():
    text = """
    (top-level
      (with-tags
        (for [n [1 2]] (:tag step (sleep n)) (note step.status.name))
        (note (len (list step.path)))
        (. (get (list (get (list step.path) 0)) 1) name)))
    """
    assert run(text) == ("STEP", ["SUCCEEDED", "SUCCEEDED", 1])


def test_a_tagged_step_can_be_suspended():
    text = """
    (import cramhy_runtime [kernel])
    (top-level
      (with-tags
        (par (:tag drive (on-suspension (note "stopping") (sleep 3)) (note (kernel.now)))
             (do (sleep 1)
                 (with-task-suspended [drive] (note drive.status.name) (sleep 4))
                 (note "woken")))))
    """
    assert run(text)[1] == ["stopping", "SUSPENDED", "woken", 5.0]


def test_without_scheduling_a_request_waits():
    text = '(top-level (pursue (without-scheduling (sleep 3) (note "through")) (do (sleep 1) (note "over"))))'
    assert run(text)[1] == ["over", "through"]


def test_a_malformed_ordering_is_told_with_how_to_write_it():
    with pytest.raises(Exception, match=r"is malformed(.|\n)*It is written \(partial-order \[step...\] \(:order before after\)...\)"):
        run("(top-level (partial-order [1 2] (:order a)))")


def test_an_operator_outside_of_a_plan_says_so():
    with pytest.raises(Exception, match="'PAR' form not inside a plan."):
        run("(par 1 2)")
