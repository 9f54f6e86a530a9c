"""Hooks as users define and use them: cpl.md section 11."""

import pytest

NOTED = {
    "on-make-fluent-hook": "(fluent allow-tracing max-tracing-freq) (note :fluent (name fluent) allow-tracing max-tracing-freq)",
    "on-top-level-setup-hook": "(name tree) (note :setup name (task-tree-node-p tree)) (cons '(*given*) '(5))",
    "on-top-level-cleanup-hook": "(name) (note :cleanup name *given*)",
    "on-def-top-level-plan-hook": "(name) (note :defined name)",
    "cpl-impl::on-preparing-named-top-level": "(name) (note :preparing name) 1",
    "cpl-impl::on-finishing-named-top-level": "(id) (note :finishing id)",
    "cpl-impl::on-begin-execute-tag-task": "(task) (note :tag (task-path task)) 2",
    "cpl-impl::on-finish-execute-tag-task": "(id) (note :tag-over id)",
    "cpl-impl::on-preparing-task-execution": "(name log-parameters pattern lambda-list parameters) "
    "(note :task name log-parameters pattern lambda-list parameters) 3",
    "cpl-impl::on-finishing-task-execution": "(id) (note :task-over id)",
}


@pytest.fixture
def noted(lisp):
    """Each hook of the table notes its call."""
    lisp("(define-task-variable *given* nil)")
    for name, rest in NOTED.items():
        parameters, _, body = rest.partition(") ")
        lisp(f"(defmethod {name} laws {parameters}) {body})")
    yield lisp
    for name, rest in NOTED.items():
        specializers = " ".join("t" for _ in rest.partition(") ")[0].split())
        lisp(f"(remove-method #'{name} (find-method #'{name} '(laws) (list {specializers})))")


def test_a_plan_calls_the_hooks_at_their_moments_with_their_arguments(noted):
    noted("(def-top-level-cram-function tidy (thing) (:tag grasp (make-fluent :name 'hand)) (list thing *given*))")
    assert noted("*notes*") == "((:DEFINED TIDY))"
    assert noted("(setf *notes* nil) (tidy 'cup)") == "(CUP 5)"
    assert noted("*notes*") == (
        '((:PREPARING TIDY) (:SETUP TIDY T) (:TASK "REPLACEABLE-FUNCTION-TIDY" NIL NIL (THING) (CUP)) '
        "(:TAG ((TAGGED GRASP) (TOP-LEVEL TIDY))) (:FLUENT HAND T NIL) (:TAG-OVER 2) (:TASK-OVER 3) (:FINISHING 1) (:CLEANUP TIDY 5))"
    )


def test_a_goal_tells_its_arguments_and_its_pattern(noted):
    noted("(declare-goal reach (where)) (def-goal (reach ?where) ?where)")
    assert noted("(setf *notes* nil) (top-level (reach 'shelf))") == "SHELF"
    assert noted("(find :task *notes* :key #'first)").startswith('(:TASK "GOAL-REACH" (SHELF) (?WHERE) ')


def test_a_failing_plan_ends_what_its_hooks_began(noted):
    noted('(def-cram-function drop () (:tag a (fail "dropped")))')
    assert noted.error("(top-level (drop))") == "dropped"
    assert noted("(mapcar #'first *notes*)") == "(:PREPARING :SETUP :TASK :TAG :TAG-OVER :TASK-OVER :FINISHING :CLEANUP)"


def test_a_hook_of_the_users_calls_all_methods_the_most_specific_first_and_lists_their_results(lisp):
    lisp("""(cut:define-hook on-grasp (what force) (:documentation "Something is grasped."))""")
    assert lisp("(on-grasp 1 2)") == "NIL"
    lisp("""(defmethod on-grasp one ((what number) force) force (list :number what))
            (defmethod on-grasp two ((what integer) force) (list :integer force))""")
    assert lisp("(on-grasp 1 2)") == "((:INTEGER 2) (:NUMBER 1))"
    assert lisp('(on-grasp "x" 2)') == "NIL"


def test_another_operator_may_take_the_results(lisp):
    lisp("""(cut:define-hook weight (what) (:method-combination :hook-combination +))
            (defmethod weight one ((what number)) 3) (defmethod weight two ((what integer)) 4)""")
    assert lisp("(list (weight 1) (weight 1.5))") == "(7 3)"
