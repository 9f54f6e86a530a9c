"""Synchronous modules, and running them: invariants 1 to 23 of process-modules.md, as text that a user writes."""

import re

import pytest

from cramhy_runtime import kernel

NAV = "(def-process-module nav (motion) (sleep 1) (note (list :ran (goal-of motion))) (values (goal-of motion) :done))"


@pytest.mark.law("process-modules", 1, 3)
def test_the_body_runs_when_a_designator_is_sent_and_its_values_come_back(text):
    text(NAV)
    assert text("(plan (nav) (pm-execute 'nav (motion 5)))") == "5 ; :DONE"
    assert text("*notes*") == "((:RAN 5))" and kernel.now() == 1
    assert text("(def-process-module silent (m) (declare (ignore m)) (values)) (plan (silent) (pm-execute 'silent (motion)))") == ""


@pytest.mark.law("process-modules", 2)
def test_instances_of_one_class_under_two_names_process_their_own_inputs(text):
    text(NAV)
    assert (
        text("""(plan ((left nav) (right nav))
                     (let ((results nil))
                       (par (push (list :left (pm-execute 'left (motion 1))) results)
                            (push (list :right (pm-execute 'right (motion 2))) results))
                       results))""")
        == "((:RIGHT 2) (:LEFT 1))"
    )
    assert kernel.now() == 1


@pytest.mark.law("process-modules", 4)
def test_the_body_sees_the_newest_equated_designator(text):
    text("(def-process-module nav (motion) (goal-of motion))")
    assert (
        text("""(let ((old (motion 1)) (new (motion 2)))
                     (equate old new)
                     (plan (nav) (list (pm-execute 'nav old) (pm-execute 'nav new))))""")
        == "(2 2)"
    )


@pytest.mark.soak(all_but=3)
@pytest.mark.law("process-modules", 5)
@pytest.mark.parametrize("signal", ["(fail *failure*)", "(error *failure*)", "(par (sleep 1) (fail *failure*))"])
@pytest.mark.parametrize("kind", ["simple-plan-failure", "simple-error"])
def test_a_condition_of_the_body_reaches_the_caller_as_the_identical_object(text, kind, signal):
    text(f"""(defvar *failure* (make-condition '{kind} :format-control "stuck"))
             (def-process-module nav (motion) (declare (ignore motion)) {signal})""")
    assert text("(plan (nav) (handler-case (pm-execute 'nav (motion)) (condition (c) (eq c *failure*))))") == "T"
    assert text("(handler-case (plan (nav) (pm-execute 'nav (motion))) (condition (c) (eq c *failure*)))") == "T"


@pytest.mark.law("process-modules", 6)
def test_after_a_failure_the_module_accepts_the_next_input_and_its_status_tells(text):
    text('(def-process-module nav (motion) (if (eql (goal-of motion) :wall) (fail "wall") (goal-of motion)))')
    assert (
        text("""(plan (nav)
                     (register-update-callback (pm-status 'nav) 'watch #'note)
                     (failure-of (pm-execute 'nav (motion :wall)))
                     (note (list :now (status-now 'nav)))
                     (pm-execute 'nav (motion :door)))""")
        == ":DOOR"
    )
    assert text("*notes*") == "(:RUNNING :FAILED (:NOW :FAILED) :RUNNING :WAITING :OFFLINE)"


@pytest.mark.law("process-modules", 7)
def test_failure_handling_around_pm_execute_handles_its_failures(text):
    text("""(define-condition wall (simple-plan-failure) ())
            (def-process-module nav (motion) (if (< (goal-of motion) 3) (fail 'wall) (goal-of motion)))""")
    assert (
        text("""(plan (nav)
                     (let ((goal 0))
                       (with-failure-handling ((wall (e) (declare (ignore e)) (incf goal) (retry)))
                         (pm-execute 'nav (motion goal)))))""")
        == "3"
    )


@pytest.mark.law("process-modules", 8)
@pytest.mark.parametrize("restart, after", [("continue-pm", "(:FAILED 5)"), ("terminate-pm", "(:GONE :GONE)")])
def test_a_debugger_hook_decides_whether_the_module_goes_on(text, restart, after):
    text("(def-process-module nav (motion) (if (eql (goal-of motion) 1) (car (goal-of motion)) (goal-of motion)))")
    assert (
        text(f"""(let ((*process-module-debugger-hook*
                            (lambda (c hook) (declare (ignore hook)) (note (type-of c)) (invoke-restart '{restart}))))
                      (plan (nav)
                        (note (text-of (pm-execute 'nav (motion 1))))
                        (sleep 0.1)
                        (if (get-running-process-module 'nav)
                            (list (status-now 'nav) (pm-execute 'nav (motion 5)))
                            '(:gone :gone))))""")
        == after
    )
    assert text("*notes*") == '(TYPE-ERROR "The value 1 is not of type LIST when binding LIST")'


@pytest.mark.law("process-modules", 9)
def test_evaporating_the_caller_stops_the_body_early_and_runs_its_cleanup_before_anything_else(text):
    text("""(def-process-module nav (motion) (declare (ignore motion))
              (unwind-protect (sleep 100) (sleep 0.5) (note :stopped)))""")
    text("(plan (nav) (pursue (pm-execute 'nav (motion)) (sleep 1)) (note :after-pursue) (note (status-now 'nav)))")
    assert text("*notes*") == "(:STOPPED :AFTER-PURSUE :WAITING)" and kernel.now() == 1.5


@pytest.mark.law("process-modules", 10)
def test_suspending_and_waking_the_caller_runs_the_body_again_from_the_start(text):
    text("""(def-process-module nav (motion) (declare (ignore motion))
              (note :start) (unwind-protect (progn (sleep 2) (length *notes*)) (note :cleanup)))""")
    assert (
        text("""(plan (nav)
                     (with-tags
                       (par (:tag drive (pm-execute 'nav (motion)))
                            (progn (sleep 1) (with-task-suspended (drive) (note :suspended) (sleep 10) (note :on))))))""")
        == "5"
    )
    assert text("*notes*") == "(:START :CLEANUP :SUSPENDED :ON :START :CLEANUP)" and kernel.now() == 13


@pytest.mark.law("process-modules", 11)
def test_while_a_caller_is_suspended_the_input_of_another_is_processed_first(text):
    text("(def-process-module nav (motion) (sleep 2) (note (goal-of motion)))")
    text("""(plan (nav)
              (with-tags
                (par (:tag drive (pm-execute 'nav (motion :first)))
                     (progn (sleep 1) (with-task-suspended (drive) (pm-execute 'nav (motion :other)))))))""")
    assert text("*notes*") == "(:OTHER :FIRST)" and kernel.now() == 5


@pytest.mark.law("process-modules", 12)
def test_a_second_caller_is_warned_in_its_own_thread_and_served_afterwards(text):
    text("(def-process-module nav (motion) (sleep 1) (note (goal-of motion)))")
    text("""(defun drive (goal)
              (handler-bind ((warning (lambda (w) (note (list goal :warned (task-path (current-task)) (format nil "~a" w)))
                                                  (muffle-warning w))))
                (pm-execute 'nav (motion goal))))
            (plan (nav) (with-tags (par (:tag one (drive 1)) (:tag two (drive 2)))))""")
    assert re.sub("{[0-9A-F]+}", "{}", text("*notes*")) == (
        '((2 :WARNED ((TAGGED TWO)) "Process module #<NAV {}> already processing input. Waiting for it to become free.") 1 2)'
    )
    assert kernel.now() == 2


@pytest.mark.soak(all_but=4)
@pytest.mark.law("process-modules", 13)
@pytest.mark.parametrize(
    "form",
    [
        "(pm-execute 'nvx (motion))",
        "(pm-execute nil (motion))",
        "(pm-cancel 'nvx)",
        "(pm-status 'nvx)",
        "(monitor-process-module 'nvx)",
        "(pm-cancel nil)",
        "(pm-status nil)",
        "(monitor-process-module nil)",
    ],
)
def test_an_unknown_name_is_an_error_at_once(text, form):
    name = "NIL" if "nil" in form else "NVX"
    assert text(f"(top-level (text-of {form}))") == f'"Unknown process module: {name} "' and kernel.now() == 0
    assert text(f"(top-level (handler-case {form} (cpm::unknown-process-module (c) (typep c 'simple-error))))") == "T"


@pytest.mark.law("process-modules", 14)
def test_an_unknown_class_cannot_be_started(text):
    assert text("(top-level (text-of (pm-run 'nvx)))") == '"Unknown process module: NVX "'
    assert text("(text-of (with-process-modules-running (nvx) (note :never)))") == '"Unknown process module: NVX "'
    assert text("*notes*") == "NIL"


@pytest.mark.law("process-modules", 15)
def test_a_module_runs_once_under_one_name(text):
    text(NAV)
    assert text("(plan (nav) (text-of (pm-run 'nav)))") == '"Process module `NAV\' already running. foo foo"'
    assert (
        text("(plan (nav) (list (pm-execute 'nav (motion 1)) (text-of (with-process-modules-running (nav) (note :never)))))")
        == '(1 "Process module `NAV\' already running. foo foo")'
    )
    assert text("(plan (nav) (text-of (pm-run (get-running-process-module 'nav) 'other)))") == '"Process module `NAV\' already running."'


@pytest.mark.law("process-modules", 16)
def test_a_module_needs_a_name(text):
    text(NAV)
    assert text("(text-of (make-instance 'nav))") == '"Process modules need a name."'
    assert text("(handler-case (make-instance 'nav) (simple-error () :simple-error))") == ":SIMPLE-ERROR"
    assert text("(handler-case (make-instance 'nav :name 5) (type-error (c) (type-error-datum c)))") == "5"


@pytest.mark.law("process-modules", 17)
def test_the_status_is_offline_before_and_after_and_waiting_between_requests(text):
    text(NAV)
    assert (
        text("""(let* ((module (make-instance 'nav :name 'nav)) (before (value (pm-status module))))
                     (top-level
                       (list before
                             (pursue (pm-run module)
                                     (progn (wait-for-process-module-running module)
                                            (let ((idle (status-now 'nav)))
                                              (pm-execute module (motion))
                                              (list idle (status-now 'nav)))))
                             (value (pm-status module)))))""")
        == "(:OFFLINE (:WAITING :WAITING) :OFFLINE)"
    )


@pytest.mark.law("process-modules", 18)
def test_a_running_module_can_be_got_by_its_name_inside_the_block_only(text):
    text(NAV)
    assert (
        text("""(list (get-running-process-module 'nav)
                         (with-process-modules-running (nav) (type-of (get-running-process-module 'nav)))
                         (get-running-process-module 'nav))""")
        == "(NIL NAV NIL)"
    )


@pytest.mark.law("process-modules", 19)
def test_an_alias_reaches_the_module_and_ends_with_it(text):
    text(NAV)
    assert (
        text("""(plan (nav)
                     (process-module-alias 'base 'nav)
                     (list (pm-execute 'base (motion 7)) (get-running-process-module-name (get-running-process-module 'base))
                           (get-running-process-module-names (get-running-process-module 'nav))))""")
        == "(7 NAV (BASE NAV))"
    )
    assert text("(top-level (text-of (pm-execute 'base (motion))))") == '"Unknown process module: BASE "'
    assert text("(text-of (process-module-alias 'base 'nav))") == '"Could not find process module with name `NAV\'"'
    assert (
        text("""(plan (nav) (list (with-process-module-aliases ((base nav) (legs nav)) (pm-execute 'legs (motion 8)))
                                     (get-running-process-module 'legs)))""")
        == "(8 NIL)"
    )


@pytest.mark.law("process-modules", 20)
def test_monitoring_after_an_execution_gives_the_result_once_more(text):
    text(NAV)
    assert (
        text("""(plan (nav)
                     (let ((first (motion 1)) (second (motion 2)))
                       (pm-execute 'nav first)
                       (pm-execute 'nav second)
                       (list (multiple-value-list (monitor-process-module 'nav :designators (list second)))
                             (multiple-value-list (monitor-process-module 'nav)))))""")
        == "((2 :DONE) (1 :DONE))"
    )
    assert kernel.now() == 2


@pytest.mark.law("process-modules", 21)
@pytest.mark.parametrize("designators", ["", ":designators (list (motion 9) sent)"])
def test_monitoring_beside_an_execution_gives_the_same_value(text, designators):
    text(NAV)
    assert (
        text(f"""(let ((sent (motion 3)) (seen nil))
                      (plan (nav)
                        (par (setf seen (monitor-process-module 'nav {designators}))
                             (progn (sleep 1) (note (pm-execute 'nav sent)))))
                      (list seen *notes*))""")
        == "(3 ((:RAN 3) 3))"
    )


@pytest.mark.law("process-modules", 22)
def test_waiting_for_a_module_ends_with_its_start_or_with_the_timeout(text):
    text(NAV)
    assert text("(wait-for-process-module-running 'nav :timeout 2)") == "NIL" and kernel.now() == 2
    assert (
        text("""(top-level (par (wait-for-process-module-running 'nav :timeout 5)
                                   (progn (sleep 1) (with-process-modules-running (nav) (sleep 3)))))""")
        == "T"
    )
    assert kernel.now() == 6
    assert text("(with-process-modules-running (nav) (wait-for-process-module-running 'nav))") == "T"


@pytest.mark.law("process-modules", 23)
def test_hooks_run_with_module_input_and_outcome(text):
    text("""(def-process-module hooked (motion) (if (eql (goal-of motion) :wall) (fail "wall") (goal-of motion)))
            (defmethod on-process-module-started law-23 ((m hooked) input) (note (list :started (type-of m) (goal-of input))))
            (defmethod cpm::on-process-module-failed law-23 ((m hooked) input failure)
              (note (list :failed (goal-of input) (format nil "~a" failure))))
            (defmethod on-process-module-finished law-23 ((m hooked) input result)
              (note (list :finished (goal-of input) (if (listp result) result (type-of result)))))""")
    text("(plan (hooked) (pm-execute 'hooked (motion 3)) (failure-of (pm-execute 'hooked (motion :wall))) (sleep 1))")
    assert text("*notes*") == (
        '((:STARTED HOOKED 3) (:FINISHED 3 (3)) (:STARTED HOOKED :WALL) (:FAILED :WALL "wall") (:FINISHED :WALL SIMPLE-PLAN-FAILURE))'
    )
