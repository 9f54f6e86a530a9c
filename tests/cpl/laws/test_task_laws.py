"""Tasks in the words of a plan: invariants 40 to 64 of the reference. Waits of cleanup are in ``test_cleanup_laws.py``."""

import pytest

from cramhy_runtime import kernel


@pytest.mark.soak(all_but=5)
@pytest.mark.law(40)
@pytest.mark.parametrize(
    "body, statuses",
    [
        ("1", "(:RUNNING :SUCCEEDED)"),
        ("(fail)", "(:RUNNING :FAILED)"),
        ("(car 1)", "(:RUNNING :FAILED)"),
        ("(evaporate (current-task))", "(:RUNNING :EVAPORATED)"),
        ("(sleep 10)", "(:RUNNING :SUSPENDED :RUNNING :SUCCEEDED)"),
        ("(on-suspension (fail) (sleep 10))", "(:RUNNING :FAILED)"),
        ("(on-suspension (evaporate (current-task) :sync nil) (sleep 10))", "(:RUNNING :SUSPENDED :EVAPORATED)"),
    ],
)
def test_the_statuses_that_a_callback_sees_are_a_path_of_the_table_from_running_to_one_dead_state(lisp, body, statuses):
    assert (
        lisp(f"""
        (top-level
          (let ((task (make-instance 'task :name "t" :thread-fun (lambda () {body}) :run-thread nil)))
            (register-update-callback (status task) 'watch #'note)
            (execute task)
            (sleep 1)
            (with-task-suspended (task) (sleep 1))
            (sleep 20)))
        *notes*""")
        == statuses
    )


@pytest.mark.law(40)
def test_a_suspended_task_that_is_evaporated_ends_without_running_again(lisp):
    assert (
        lisp("""
        (top-level
          (let ((task (in-child (sleep 10))))
            (register-update-callback (status task) 'watch #'note)
            (sleep 1) (suspend task) (evaporate task)))
        *notes*""")
        == "(:RUNNING :SUSPENDED :EVAPORATED)"
    )


@pytest.mark.law(41)
@pytest.mark.parametrize("body, result", [("(values 1 2)", "(1 2)"), ("(values)", "NIL"), ('(fail "x")', "T")])
def test_when_a_status_is_dead_the_result_is_final(lisp, body, result):
    assert (
        lisp(f"""
        (top-level
          (let ((task (in-child {body})))
            (register-update-callback (status task) 'watch
              (lambda (status) (when (member status +dead+) (note (multiple-value-list (result task))))))
            (wait-for (task-dead task))
            (let ((seen (first *notes*)))
              (if (typep (first seen) 'plan-failure) (eq (first seen) (result task)) seen))))""")
        == result
    )


@pytest.mark.law(42)
def test_a_parent_that_succeeds_leaves_no_living_child(lisp):
    assert (
        lisp("""
        (let (short long)
          (top-level
            (in-child (setf short (in-child (sleep 1)) long (in-child (sleep 100))) (sleep 2))
            (sleep 5)
            (list (later short) (later long))))""")
        == "(:SUCCEEDED :EVAPORATED)"
    )


@pytest.mark.law(43)
def test_grandchildren_that_end_first_then_children_then_the_parent_have_all_succeeded(lisp):
    assert (
        lisp("""
        (let (parent child grandchild)
          (top-level
            (setf parent (in-child
                           (setf child (in-child (setf grandchild (in-child (sleep 1))) (sleep 2)))
                           (sleep 3)))
            (join-task parent)
            (mapcar #'later (list grandchild child parent))))""")
        == "(:SUCCEEDED :SUCCEEDED :SUCCEEDED)"
    )


@pytest.mark.law(44)
def test_evaporating_a_parent_ends_all_below_it_and_those_that_lived_are_evaporated(lisp):
    assert (
        lisp("""
        (let (parent child done grandchild)
          (top-level
            (setf parent (in-child
                           (setf done (in-child 1)
                                 child (in-child (setf grandchild (in-child (sleep 100))) (sleep 100)))
                           (sleep 100)))
            (sleep 1)
            (evaporate parent)
            (mapcar #'later (list parent child grandchild done))))""")
        == "(:EVAPORATED :EVAPORATED :EVAPORATED :SUCCEEDED)"
    )


@pytest.mark.law(45)
def test_evaporating_a_child_leaves_the_parent_running(lisp):
    assert (
        lisp("""
        (top-level
          (let* (child (parent (in-child (setf child (in-child (sleep 100))) (sleep 2) :unharmed)))
            (sleep 1)
            (evaporate child)
            (list (later child) (later parent) (join-task parent))))""")
        == "(:EVAPORATED :RUNNING :UNHARMED)"
    )


@pytest.mark.law(46)
def test_the_children_of_a_failing_parent_are_dead_before_anybody_sees_it_fail(lisp):
    """Repaired: in the original they die some time later."""
    assert (
        lisp("""
        (let (child)
          (top-level
            (with-failure-handling ((plan-failure (e) (declare (ignore e)) (note (later child) (length *notes*)) (return :handled)))
              (pursue (progn (setf child (in-child (unwind-protect (sleep 100) (sleep 1) (note :cleaned-up)))) (sleep 1) (fail))
                      (sleep 100)))
            *notes*))""")
        == "(:CLEANED-UP (:EVAPORATED 1))"
    )


@pytest.mark.law(47)
def test_suspending_a_parent_stops_all_below_it_until_it_is_woken(lisp):
    assert (
        lisp("""
        (let ((count 0) (tick (make-fluent)) tasks)
          (flet ((counting () (push (current-task) tasks)
                   (whenever ((pulsed tick :handle-missed-pulses :never)) (incf count))))
            (top-level
              (let ((parent (in-child (par (counting) (par (counting) (counting))))))
                (sleep 1)
                (with-task-suspended (parent)
                  (note (mapcar #'later tasks))
                  (dotimes (i 5) (pulse tick) (sleep 1))
                  (note count))
                (pulse tick) (sleep 1)
                (note (>= count 3))
                (evaporate parent)))
            *notes*))""")
        == "((:SUSPENDED :SUSPENDED :SUSPENDED) 0 T)"
    )


@pytest.mark.law(47)
def test_a_task_that_has_not_begun_is_suspended_with_its_parent(lisp):
    assert (
        lisp(
            """
        (top-level
          (let ((parent (in-child (start (lambda () (loop (note (value-of-time)) (sleep 1)))) (sleep 100))))
            (sleep 1/2)
            (suspend parent)
            (let ((before (length *notes*)))
              (sleep 10)
              (= before (length *notes*)))))""".replace("(value-of-time)", ":tick")
        )
        == "T"
    )


@pytest.mark.law(48)
def test_suspending_a_child_leaves_its_parent_running(lisp):
    assert (
        lisp("""
        (top-level
          (let* (child (parent (in-child (setf child (in-child (sleep 2))) (join-task child) :done)))
            (sleep 1)
            (with-task-suspended (child) (note (later child) (later parent)))
            (list *notes* (join-task parent))))""")
        == "(((:SUSPENDED :RUNNING)) :DONE)"
    )


@pytest.mark.law(49)
def test_a_condition_that_came_true_during_suspension_is_found_after_wake_up(lisp):
    assert (
        lisp("""
        (top-level
          (let* ((door (make-fluent)) (task (in-child (wait-for door))))
            (sleep 1)
            (with-task-suspended (task) (setf (value door) :open) (sleep 1))
            (join-task task)))""")
        == ":OPEN"
    )


@pytest.mark.law(50)
def test_a_suspended_task_can_be_evaporated_and_cleans_up(lisp):
    assert (
        lisp("""
        (top-level
          (let ((task (in-child (unwind-protect (par (unwind-protect (sleep 100) (note :branch))) (sleep 1) (note :parent)))))
            (sleep 1)
            (suspend task)
            (evaporate task)
            (list (later task) *notes*)))""")
        == "(:EVAPORATED (:BRANCH :PARENT))"
    )


@pytest.mark.law(51)
def test_a_parent_that_succeeds_evaporates_a_suspended_child(lisp):
    assert (
        lisp("""
        (let (child)
          (top-level
            (setf child (in-child (sleep 100)))
            (sleep 1)
            (suspend child))
          (later child))""")
        == ":EVAPORATED"
    )


@pytest.mark.law(52)
def test_after_suspend_and_wake_up_a_task_can_still_be_evaporated(lisp):
    assert (
        lisp("""
        (top-level
          (let ((task (in-child (sleep 100))))
            (sleep 1) (suspend task) (sleep 1) (wake-up task) (sleep 1)
            (note (later task))
            (evaporate task)
            (note (later task))
            *notes*))""")
        == "(:RUNNING :EVAPORATED)"
    )
    assert kernel.now() == 3


@pytest.mark.law(53)
@pytest.mark.parametrize("way_out", ["(evaporate task)", "(progn (suspend task) (evaporate task))", "(wake-up task)", "(fail)"])
def test_cleanup_forms_of_an_evaporated_task_run_exactly_once_and_completely(lisp, way_out):
    assert (
        lisp(f"""
        (ignore-errors (top-level
          (with-failure-handling ((plan-failure (e) (declare (ignore e)) (return nil)))
            (let ((task (in-child
                          (unwind-protect
                            (unwind-protect (sleep 100) (note 1) (sleep 1) (note 2))
                            (note 3) (sleep 1) (note 4)))))
              (sleep 1)
              {way_out}))))
        *notes*""")
        == "(1 2 3 4)"
    )


@pytest.mark.law(53)
def test_cleanup_that_a_failure_began_is_not_cut_short_by_the_failure_of_a_sibling(lisp):
    assert (
        lisp.error("""
        (top-level
          (par (unwind-protect (fail "first") (sleep 1) (note :complete))
               (progn (sleep 1/2) (fail "second"))))""")
        == "second"
    )
    assert lisp("*notes*") == "(:COMPLETE)"


@pytest.mark.law(54)
def test_a_second_request_does_not_disturb_cleanup_that_computes(lisp):
    assert (
        lisp("""
        (top-level
          (let ((task (in-child (unwind-protect (sleep 100) (dotimes (i 20000)) (note :complete)))))
            (sleep 1)
            (evaporate task :sync nil)
            (loop until (task-dead-p task) do (evaporate task :sync nil))
            *notes*))""")
        == "(:COMPLETE)"
    )


@pytest.mark.law(54)
def test_requests_of_forms_never_disturb_cleanup_that_waits(lisp):
    assert (
        lisp("""
        (top-level
          (pursue
            (pursue
              (pursue (unwind-protect (sleep 100) (sleep 5) (note :complete)) (sleep 1))
              (sleep 2))
            (sleep 3)))
        *notes*""")
        == "(:COMPLETE)"
    )
    assert kernel.now() == 6


@pytest.mark.law(55)
def test_time_spent_suspended_counts_as_slept(lisp):
    lisp("(top-level (let ((task (in-child (sleep 4)))) (sleep 1) (with-task-suspended (task) (sleep 1)) (join-task task)))")
    assert kernel.now() == 4
    lisp("(top-level (let ((task (in-child (sleep 4)))) (sleep 1) (with-task-suspended (task) (sleep 9)) (join-task task)))")
    assert kernel.now() == 14


@pytest.mark.law(56)
def test_on_suspension_forms_run_once_per_suspension_innermost_first_and_before_the_controllers_body(lisp):
    assert lisp("""
        (top-level
          (let ((task (in-child
                        (on-suspension (note :outer (later (current-task)))
                          (on-suspension (note :inner (later (current-task)))
                            (par (on-suspension (note :branch) (sleep 10))))))))
            (sleep 1)
            (with-task-suspended (task) (note :body))
            (with-task-suspended (task) (note :again))))
        *notes*""") == ("((:INNER :RUNNING) (:OUTER :RUNNING) :BRANCH :BODY (:INNER :RUNNING) (:OUTER :RUNNING) :BRANCH :AGAIN)")


@pytest.mark.law(56)
def test_leaving_an_on_suspension_form_by_a_non_local_exit_is_an_error_of_the_task(lisp):
    assert "not to perform a non-local exit. Caught attempt to do so." in lisp.error("""
        (top-level
          (let ((task (in-child (block out (on-suspension (return-from out) (sleep 10))))))
            (sleep 1) (with-task-suspended (task)) (join-task task)))""")


@pytest.mark.law(57)
def test_retry_after_suspension_cleans_up_at_suspension_and_starts_again_after_wake_up(lisp):
    assert (
        lisp("""
        (top-level
          (let* ((n 0)
                 (task (in-child
                         (on-suspension (note :handler)
                           (retry-after-suspension
                             (note :start)
                             (retry-after-suspension
                               (unwind-protect (sleep 2) (note :cleanup)))
                             (values (incf n) :values))))))
            (sleep 1)
            (with-task-suspended (task) (note :suspended))
            (note (multiple-value-list (join-task task)))
            *notes*))""")
        == "(:START :CLEANUP :HANDLER :SUSPENDED :START :CLEANUP (1 :VALUES))"
    )


@pytest.mark.law(58)
@pytest.mark.parametrize(
    "body, ends",
    [("(values 1 2)", "(1 2)"), ("(fail)", "(:FAILED)"), ("(return-from out (values 3 4))", "(3 4)"), ("(throw :out 5)", "(5)")],
)
def test_with_task_suspended_returns_its_bodys_values_and_wakes_the_task_on_every_way_out(lisp, body, ends):
    assert (
        lisp(f"""
        (top-level
          (let ((task (in-child (sleep 100))))
            (sleep 1)
            (note (multiple-value-list
                    (catch :out (block out
                      (with-failure-handling ((plan-failure (e) (declare (ignore e)) (return :failed)))
                        (with-task-suspended (task :reason "a test") {body}))))))
            (note (later task))
            *notes*))""")
        == f"({ends} :RUNNING)"
    )


@pytest.mark.law(58)
def test_a_task_is_woken_when_the_one_that_suspends_it_is_evaporated_meanwhile(lisp):
    assert (
        lisp("""
        (top-level
          (let* ((slow (in-child (without-scheduling (sleep 2)) (sleep 100)))
                 (other (in-child (with-task-suspended (slow) (note :never)))))
            (sleep 1)
            (evaporate other)
            (sleep 5)
            (list (later slow) *notes*)))""")
        == "(:RUNNING NIL)"
    )


@pytest.mark.law(59)
@pytest.mark.parametrize("before", ["(sleep 1)", "nil"])
def test_inside_of_with_task_suspended_the_task_is_suspended_even_if_it_has_only_just_been_started(lisp, before):
    assert (
        lisp(f"""
        (top-level
          (with-tags
            (par (:tag a (sleep 1) (note :went-on))
                 (progn {before} (with-task-suspended (a) (note (later a)) (sleep 5) (note (later a)))))))
        *notes*""")
        == "(:SUSPENDED :SUSPENDED :WENT-ON)"
    )


@pytest.mark.law(60)
def test_join_task_gives_all_values_the_identical_condition_or_nothing(lisp):
    assert lisp("(top-level (multiple-value-list (join-task (in-child (sleep 1) (values 1 2)))))") == "(1 2)"
    assert (
        lisp("""
        (top-level
          (let ((task (in-child (fail "x"))))
            (with-failure-handling ((plan-failure (e) (return (eq e (result task))))) (join-task task))))""")
        == "T"
    )
    assert (
        lisp("""
        (top-level
          (let ((task (in-child (sleep 10))))
            (sleep 1) (evaporate task)
            (multiple-value-list (join-task task))))""")
        == "NIL"
    )


@pytest.mark.law(61)
@pytest.mark.parametrize(
    "form, text",
    [
        ("(top-level (join-task (current-task)))", "Cannot join current task."),
        ("(top-level (execute (in-child 1)))", 'Task #<TASK "child" {}> is already running a thread.'),
        ('(top-level (execute (make-instance \'task :name "t")))', 'Tried to execute task #<TASK "t" {}> which has no thread-fun.'),
        ("(start #'car)", "No current task active (*CURRENT-TASK* is NIL)."),
        ("(top-level (make-instance 'toplevel-task :thread-fun #'list))", "top-level calls cannot be nested."),
    ],
)
def test_wrong_use_of_tasks_has_the_documented_texts(lisp, form, text):
    assert lisp.error(form) == text


@pytest.mark.law(62)
def test_a_task_variable_bound_around_top_level_is_seen_in_all_tasks_and_an_ordinary_one_is_not(lisp):
    assert (
        lisp("""
        (define-task-variable *inherited* :global "A variable of tasks.")
        (defvar *ordinary* :global)
        (let ((*inherited* :bound) (*ordinary* :bound))
          (top-level
            (note *inherited* *ordinary*)
            (par (par (note *inherited* *ordinary*)))
            (let ((*inherited* :deeper)) (par (note *inherited*)))))
        *notes*""")
        == "((:BOUND :GLOBAL) (:BOUND :GLOBAL) :DEEPER)"
    )


@pytest.mark.law(63)
def test_assigning_a_task_variable_in_a_child_is_seen_by_later_children_of_it_only(lisp):
    assert (
        lisp("""
        (define-task-variable *v* 0)
        (top-level
          (par (progn (setf *v* 1) (sleep 1) (par (note :below *v*)))
               (progn (sleep 2) (note :sibling *v*)))
          (note :parent *v*))
        *notes*""")
        == "((:BELOW 1) (:SIBLING 0) (:PARENT 0))"
    )


@pytest.mark.law(64)
@pytest.mark.parametrize("request_, status", [("(suspend task)", ":SUSPENDED"), ("(evaporate task)", ":EVAPORATED")])
def test_without_scheduling_delays_a_request_to_its_end(lisp, request_, status):
    assert (
        lisp(f"""
        (top-level
          (let ((task (in-child (without-scheduling (sleep 2) (note :protected)) (note :after) (sleep 100))))
            (sleep 1)
            {request_}
            (note (later task))
            *notes*))""")
        == f"(:PROTECTED {status})"
    )
    assert kernel.now() == 2
    assert lisp("(multiple-value-list (top-level (without-scheduling (values 1 2))))") == "(1 2)"
    assert lisp("(multiple-value-list (without-scheduling (values 1 2)))") == "(1 2)"


@pytest.mark.law(64)
def test_with_scheduling_inside_of_it_obeys_again(lisp):
    assert (
        lisp("""
        (top-level
          (let ((task (in-child (without-scheduling (sleep 2) (with-scheduling (sleep 10)) (note :never)))))
            (sleep 1)
            (evaporate task)
            (list (later task) *notes*)))""")
        == "(:EVAPORATED NIL)"
    )
    assert kernel.now() == 2
