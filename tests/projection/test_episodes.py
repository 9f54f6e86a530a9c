"""Episodes of plans: projection-and-events.md C1."""

import gc
import weakref

import pytest

from cramhy_runtime import cpl
from cramhy_runtime.cpl.tree import finished_plans
from cramhy_runtime.episodes import last_episode

PLANS = """
(def-cram-function grasp (thing) (sleep 1) (values thing :grasped))
(def-cram-function drop (thing) (sleep 2) (fail "~a dropped" thing))
(def-top-level-cram-function fetch (&rest things) (dolist (thing things) (grasp thing)) :fetched)
(def-top-level-cram-function lose () (grasp 'cup) (drop 'cup))
(defun paths (nodes) (mapcar #'task-tree-node-path nodes))
"""


@pytest.fixture
def plans(lisp):
    lisp(PLANS)
    return lisp


def test_there_is_no_episode_before_the_first_plan_and_none_is_current_outside_of_plans(plans):
    assert plans("(list cet:*episode-knowledge* cet:*last-episode-knowledge*)") == "(NIL NIL)"
    plans("(fetch 'cup)")
    assert plans("(list cet:*episode-knowledge* cet:*last-episode-knowledge*)") == (
        "(NIL #<CRAM-EXECUTION-TRACE:LIVE-EPISODE-KNOWLEDGE FETCH {}>)"
    )


@pytest.mark.law("projection-and-events", 24)
def test_the_episode_of_a_named_plan_can_be_fetched_by_its_name(plans):
    plans("(fetch 'cup) (top-level (grasp 'plate))")
    assert plans("(cet:get-top-level-episode-knowledge 'fetch)") == "#<CRAM-EXECUTION-TRACE:LIVE-EPISODE-KNOWLEDGE FETCH {}>"
    assert plans("(cet:with-top-level-episode-knowledge fetch (paths (cet:episode-knowledge-task-list)))") == (
        "(((TOP-LEVEL FETCH)) ((GRASP) (TOP-LEVEL FETCH)))"
    )
    assert plans("(cet:with-last-episode-knowledge (paths (cet:episode-knowledge-task-list)))") == "(((GRASP)))"
    assert plans("(eq (cet:get-top-level-episode-knowledge nil) cet:*last-episode-knowledge*)") == "T"


@pytest.mark.law("projection-and-events", 24)
def test_an_unknown_name_is_an_error_that_names_the_nearest_plan(plans):
    plans("(fetch 'cup)")
    text = "Accessing top-level episode-knowledge for unregisterd top-level plan FETHC."
    assert plans.error("(cet:get-top-level-episode-knowledge 'fethc)") == text
    assert plans.shown_error("(cet:get-top-level-episode-knowledge 'fethc)") == (
        f"cramhy: SIMPLE-ERROR\n  {text}\n  at <repl>:1:1\n    (cet:get-top-level-episode-knowledge 'fethc)\n    ^\n  Did you mean FETCH?\n"
    )


def test_a_plan_that_did_not_run_yet_has_an_empty_episode(plans):
    assert plans("(cet:get-top-level-episode-knowledge 'fetch)") == "#<CRAM-EXECUTION-TRACE:LIVE-EPISODE-KNOWLEDGE FETCH {}>"
    plans("(cet:register-top-level-episode-knowledge 'other)")
    assert plans.error("(cet:with-top-level-episode-knowledge other (cet:episode-knowledge-task-tree))") == (
        "Task tree has no top level node."
    )
    assert (
        plans("""(cet:with-top-level-episode-knowledge fetch
                      (list (cet:episode-knowledge-zero-time) (cet:episode-knowledge-max-time)))""")
        == "(NIL NIL)"
    )


def test_a_query_without_an_episode_says_how_to_choose_one(plans):
    told = plans.error("(cet:episode-knowledge-task-list)")
    assert told == (
        "The value NIL is not of type CRAM-EXECUTION-TRACE:EPISODE-KNOWLEDGE (Which episode is meant? Write "
        "(with-last-episode-knowledge ...) around the query, or give one as last argument.)"
    )
    assert "is not of type CRAM-EXECUTION-TRACE:EPISODE-KNOWLEDGE" in plans.error("(cet:with-last-episode-knowledge 1)")
    assert "is not of type CRAM-EXECUTION-TRACE:EPISODE-KNOWLEDGE" in plans.error("(setf cet:*episode-knowledge* 5)")


def test_the_current_episode_of_a_plan_is_its_own_also_in_its_branches(plans):
    assert plans(
        """(top-level (let ((mine cet:*episode-knowledge*))
                      (par (note (eq mine cet:*episode-knowledge*)) (grasp 'cup))
                      (note (paths (cet:episode-knowledge-task-list)) (cet:episode-knowledge-max-time))
                      (setf *last* mine)))
                    (list (notes) (eq *last* cet:*last-episode-knowledge*))""".replace("*last*", "cl-user::*last*")
    ) == ("((T ((((GRASP))) 1.1d0)) T)")


def test_an_earlier_episode_can_be_chosen_within_a_plan_for_its_branches_too_but_not_for_another_plan(plans):
    plans("""(fetch 'cup)
             (cet:with-last-episode-knowledge (top-level (grasp 'plate) (note (paths (cet:episode-knowledge-task-list)))))
             (fetch 'cup 'plate)
             (top-level
               (grasp 'fork)
               (cet:with-last-episode-knowledge
                 (par (note :last (length (cet:episode-knowledge-task-list))) (sleep 1))
                 (note :last (length (cet:episode-knowledge-task-list))))
               (note :own (length (cet:episode-knowledge-task-list))))""")
    assert plans("(notes)") == "((((GRASP))) (:LAST 3) (:LAST 3) (:OWN 1))"
    assert plans("cet:*episode-knowledge*") == "NIL"


def test_the_choice_of_one_task_is_not_that_of_another(plans):
    plans("""(fetch 'cup 'plate)
             (top-level
               (par (progn (cet:with-last-episode-knowledge (sleep 2) (note 1 (length (cet:episode-knowledge-task-list)))) (sleep 1)
                           (note 2 (length (cet:episode-knowledge-task-list))))
                    (progn (grasp 'fork) (note 3 (length (cet:episode-knowledge-task-list))))))""")
    assert plans("(notes)") == "((3 1) (1 3) (2 1))"


def test_nodes_that_did_not_run_this_time_are_left_out(plans):
    plans("(fetch 'cup 'plate) (fetch 'cup)")
    assert plans("(cet:with-last-episode-knowledge (paths (cet:episode-knowledge-task-list)))") == (
        "(((TOP-LEVEL FETCH)) ((GRASP) (TOP-LEVEL FETCH)))"
    )
    assert plans("(length (coerce (flatten-task-tree (get-top-level-task-tree 'fetch)) 'vector))") == "4"


def test_an_episode_that_somebody_holds_stays_what_it_was_when_the_plan_runs_again(plans):
    plans("(fetch 'cup 'plate) (defvar *first* cet:*last-episode-knowledge*) (fetch 'fork)")
    results = "(mapcar #'task-tree-node-parameters (cet:episode-knowledge-task-list {}))"
    assert plans(results.format("*first*")) == "((CUP PLATE) (PLATE) (CUP))"
    assert plans(results.format("cet:*last-episode-knowledge*")) == "((FORK) (FORK))"


def test_a_plan_may_look_at_its_own_last_run_while_it_runs_again(plans):
    plans("""(def-top-level-cram-function again (thing)
               (grasp thing)
               (when cet:*last-episode-knowledge*
                 (note (mapcar #'task-tree-node-parameters (cet:episode-knowledge-task-list cet:*last-episode-knowledge*)))))
             (again 'cup) (again 'plate)""")
    assert plans("(notes)") == "(((CUP) (CUP)))"


def test_a_plan_that_calls_several_functions_has_a_root_with_its_own_task(plans):
    plans("(top-level (grasp 'cup) (grasp 'plate) :both)")
    assert plans("""(cet:with-last-episode-knowledge
                      (let ((root (cet:episode-knowledge-task-tree)))
                        (list (task-tree-node-path root) (task-tree-node-result root) (length (task-tree-node-children root)))))""") == (
        "(NIL :BOTH 2)"
    )


def test_replaced_code_is_what_ran(plans):
    plans("""(def-top-level-cram-function outer () (grasp 'cup))
             (cpl-impl:replace-task-code nil (lambda (thing) (list :replaced thing)) '((grasp) (top-level outer))
                                         (get-top-level-task-tree 'outer))
             (outer) (defvar *first* cet:*last-episode-knowledge*) (outer)""")
    assert plans("(mapcar #'task-tree-node-result (cet:episode-knowledge-task-list *first*))") == "((:REPLACED CUP) (:REPLACED CUP))"


@pytest.mark.law("projection-and-events", 25)
def test_outcomes_and_results_are_in_the_tree_also_of_a_plan_that_failed(plans):
    assert plans.error("(lose)") == "CUP dropped"
    assert plans("""(cet:with-last-episode-knowledge
                      (mapcar (lambda (node) (list (value (task-tree-node-status-fluent node)) (task-tree-node-result node)))
                              (cet:episode-knowledge-task-list)))""") == (
        '((:FAILED #<SIMPLE-PLAN-FAILURE "~a dropped" {}>) (:FAILED #<SIMPLE-PLAN-FAILURE "~a dropped" {}>) (:SUCCEEDED CUP))'
    )


def test_goals_are_told_from_other_tasks(plans):
    plans("(declare-goal reach (where)) (def-goal (reach ?where) (grasp ?where)) (top-level (reach 'shelf))")
    assert plans("(cet:with-last-episode-knowledge (mapcar #'goal-task-tree-node-goal (cet:episode-knowledge-goal-task-list)))") == (
        "((REACH SHELF))"
    )


def test_times_are_seconds_of_the_kernels_clock(plans):
    plans("(sleep 2) (fetch 'cup)")
    assert plans("""(cet:with-last-episode-knowledge
                      (list (cet:episode-knowledge-zero-time) (cet::episode-knowledge-end-time) (cet:episode-knowledge-max-time)))""") == (
        "(2.0d0 3.0d0 3.1d0)"
    )


def test_times_follow_the_function_that_gives_time_stamps(plans):
    plans(
        "(let ((cut:*timestamp-function* (lambda () (+ 1000.0d0 (cut:current-timestamp :real))))) (fetch 'cup) "
        "(note (cet:episode-knowledge-zero-time cet:*last-episode-knowledge*)))"
    )
    assert plans("(notes)") == "(1000.0d0)"


def test_process_modules_are_no_plan_of_the_users(plans):
    plans("""(cpm:def-process-module arm (designator) designator)
             (cpm:with-process-modules-running (arm) (fetch 'cup))""")
    assert plans("(cet:with-last-episode-knowledge (paths (cet:episode-knowledge-task-list)))") == (
        "(((TOP-LEVEL FETCH)) ((GRASP) (TOP-LEVEL FETCH)))"
    )


def test_plans_in_python_are_episodes_too(plans):
    with cpl.plan():
        cpl.sleep(3)
    assert (last_episode().zero_time, last_episode().end_time, last_episode().running) == (0, 3, False)


def test_only_the_last_episode_and_those_with_names_are_kept(plans):
    for count in range(3):
        plans(f"(top-level (grasp 'cup)) (fetch {count})")
        if not count:
            first = [weakref.ref(task) for task in finished_plans.by_name.values()]
    gc.collect()
    assert [reference() for reference in first] == [None, None]
    assert len(finished_plans.by_name) == 2


def test_an_episode_describes_itself(plans):
    plans("(fetch 'cup)")
    shown = plans("(with-output-to-string (*standard-output*) (describe cet:*last-episode-knowledge*))")
    for line in ("Plan: FETCH", "Began at: 0.0d0", "Ended at: 1.0d0", "Tasks: 2", "Traced fluents: NIL"):
        assert line in shown
