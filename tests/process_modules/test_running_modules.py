"""Modules that are started by hand, nested, again and again, under two names, and that die (process-modules.md sections 3 to 5)."""

import pytest

from cramhy_runtime import kernel

NAV = "(def-process-module nav (motion) (sleep 1) (note (list :ran (goal-of motion))) (goal-of motion))"


def test_modules_can_be_run_by_hand_beside_a_plan(text):
    text(NAV)
    assert (
        text("""(top-level
                     (pursue (pm-run 'nav)
                             (pm-run 'nav 'second)
                             (progn (wait-for-process-module-running 'nav)
                                    (wait-for-process-module-running 'second)
                                    (list (pm-execute 'nav (motion 1)) (pm-execute 'second (motion 2))))))""")
        == "(1 2)"
    )
    assert text("""(top-level
                     (with-tags
                       (par (:tag module (pm-run 'nav))
                            (progn (wait-for-process-module-running 'nav)
                                   (note (pm-execute 'nav (motion 3)))
                                   (evaporate module)
                                   (get-running-process-module 'nav)))))""") in ("NIL", "")
    assert text("(first (last *notes*))") == "3"


def test_a_module_is_run_inside_of_a_plan_only(text):
    text(NAV)
    assert (
        text.error("(pm-run 'nav)")
        == """cramhy: COMMON-LISP:SIMPLE-ERROR
  'PM-RUN' form not inside a plan.
  at <repl>:1:1
    (pm-run 'nav)
    ^
  Plan forms run inside of a plan: write (top-level (pm-run ...)).
""".replace("COMMON-LISP:", "")
    )


def test_blocks_can_be_nested_and_started_a_hundred_times(text):
    text(NAV)
    text("(def-process-module arm (motion) (list :arm (goal-of motion)))")
    assert (
        text("""(with-process-modules-running (nav)
                     (plan (arm) (list (pm-execute 'nav (motion 1)) (pm-execute 'arm (motion 2)))))""")
        == "(1 (:ARM 2))"
    )
    assert (
        text("""(top-level
                     (let ((sum 0))
                       (dotimes (n 100 sum)
                         (with-process-modules-running (arm (other arm))
                           (incf sum (second (pm-execute 'arm (motion n))))))))""")
        == "4950"
    )
    assert text("(with-process-modules-running () (values 1 2))") == "1 ; 2"


def test_a_module_may_call_another_and_use_the_forms_of_the_language(text):
    text(NAV)
    text("""(def-cram-function reach (goal) (pm-execute 'nav (motion goal)))
            (def-process-module arm (motion)
              (note (list :path *current-path*))
              (with-failure-handling ((simple-plan-failure (e) (declare (ignore e)) (return :recovered)))
                (par (reach (goal-of motion)) (sleep 0.1))
                (pursue (sleep 100) (fail "slipped"))))""")
    assert text("(plan (nav arm) (pm-execute 'arm (motion 9)))") == ":RECOVERED"
    assert text("*notes*") == "((:PATH NIL) (:RAN 9))"


def test_the_body_sees_neither_the_handlers_nor_the_variables_nor_the_path_of_its_caller_or_of_what_runs_it(text):
    text("""(defvar *depth* 0)
            (define-condition lost (simple-plan-failure) ())
            (def-process-module nav (motion)
              (declare (ignore motion))
              (note (list *depth* *current-path* (find-restart 'help) (not (eq (current-task) (value (caller
                (get-running-process-module 'nav)))))))
              (fail 'lost))
            (defun run ()
              (let ((*depth* 2)) (handler-bind ((lost (lambda (e) (declare (ignore e)) (note :seen-outside)))) (pm-run 'nav))))""")
    assert (
        text("""(top-level
                     (let ((*depth* 1))
                       (pursue (run)
                               (progn (wait-for-process-module-running 'nav)
                                      (restart-case (handler-case (pm-execute 'nav (motion)) (lost () :lost))
                                        (help () nil))))))""")
        == ":LOST"
    )
    assert text("*notes*") == "((0 NIL NIL T))"


def test_task_variables_reach_the_body(text):
    text("""(define-task-variable *speed* 1)
            (def-process-module nav (motion) (declare (ignore motion)) (incf *speed*))""")
    assert (
        text("""(let ((*speed* 5))
                     (plan (nav) (list (pm-execute 'nav (motion)) (pm-execute 'nav (motion)))))""")
        == "(6 6)"
    )


def test_what_a_body_started_and_did_not_wait_for_ends_with_it(text):
    text("""(def-process-module nav (motion)
              (declare (ignore motion))
              (make-instance 'task :thread-fun (lambda () (unwind-protect (sleep 100) (note :stray-ended))))
              (sleep 1)
              (note :body-over))""")
    text("(plan (nav) (pm-execute 'nav (motion)) (note :caller-goes-on))")
    assert text("*notes*") == "(:BODY-OVER :STRAY-ENDED :CALLER-GOES-ON)" and kernel.now() == 1


def test_the_body_cannot_be_left_by_an_exit_to_a_form_around_the_module(text):
    text("(def-process-module nav (motion) (declare (ignore motion)) (throw 'out 1))")
    assert (
        text("""(top-level (pursue (catch 'out (pm-run 'nav))
                                      (progn (wait-for-process-module-running 'nav)
                                             (list (text-of (pm-execute 'nav (motion))) (status-now 'nav)))))""")
        == '("attempt to THROW to a tag that does not exist: OUT" :FAILED)'
    )
    text("(defvar *way-out*) (def-process-module nav (motion) (declare (ignore motion)) (funcall *way-out*))")
    said = text("""(top-level (pursue (block around
                                        (setf *way-out* (lambda () (return-from around :left)))
                                        (pm-run 'nav))
                                      (progn (wait-for-process-module-running 'nav)
                                             (list (text-of (pm-execute 'nav (motion))) (status-now 'nav)))))""")
    assert "tried to leave a form around it" in said and said.endswith(":FAILED)")


def test_the_language_can_be_left_by_forms_of_the_body(text):
    text("(def-process-module nav (motion) (when (eql (goal-of motion) 1) (return :early)) (catch 'out (throw 'out :thrown)))")
    assert text("(plan (nav) (list (pm-execute 'nav (motion 1)) (pm-execute 'nav (motion 2))))") == "(:EARLY :THROWN)"


# ---------------------------------------------------------------------------------------------------------------- names


def test_aliases_are_taken_back_and_take_no_name_from_another_module(text):
    text(NAV + "(def-process-module arm (motion) (goal-of motion))")
    assert (
        text("""(plan (nav arm)
                     (list (text-of (process-module-alias 'arm 'nav))
                           (with-process-module-aliases ((legs nav) (legs nav) (nav nav)) (pm-execute 'legs (motion 1)))
                           (text-of (with-process-module-aliases ((hand arm) (arm nav)) 1))
                           (get-running-process-module 'hand)
                           (pm-execute 'arm (motion 2)) (pm-execute 'nav (motion 3))))""")
        == '("Process module `ARM\' already running" 1 "Process module `ARM\' already running" NIL 2 3)'
    )


def test_a_registered_module_is_known_but_nothing_runs_it(text):
    text(NAV)
    assert (
        text("""(let ((module (make-instance 'nav :name 'base)))
                     (top-level
                       (with-process-module-registered-running ('base module)
                         (list (eq module (get-running-process-module 'base))
                               (pursue (noting-warnings (pm-execute 'base (motion 1))) (progn (sleep 3) :still-waiting))))))""")
        == "(T :STILL-WAITING)"
    )
    assert text("(list (get-running-process-module 'base) (length *notes*))") == "(NIL 1)"
    assert (
        text("""(plan (nav) (with-process-module-registered-running ('nav (make-instance 'nav :name 'other)) 1)
                               (pm-execute 'nav (motion 4)))""")
        == "4"
    )


def test_a_caller_of_an_offline_module_is_warned_and_waits_until_it_comes_up(text):
    text(NAV)
    assert (
        text("""(let ((module (make-instance 'nav :name 'base)))
                     (top-level
                       (pursue (progn (sleep 2) (pm-run module)) (noting-warnings (pm-execute module (motion 1))))))""")
        == "1"
    )
    assert text.session.evaluate_text("(first *notes*)")[0].endswith("> not running. Status is OFFLINE. Waiting for it to come up.")
    assert kernel.now() == 3


def test_the_registry_tells_names_and_classes(text):
    text(NAV + "(def-process-module arm (motion) motion)")
    assert text("(subseq (get-process-module-names) 0 2)") == "(ARM NAV)"
    assert text("(register-process-module 'nav)").startswith("(NAV ARM")
    assert (
        text("""(with-process-modules-running ((left nav))
                     (let ((module (get-running-process-module 'left)))
                       (list (get-running-process-module-name module) (get-running-process-module-names module)
                             (get-running-process-module-name (make-instance 'arm :name 'arm)) (get-running-process-module 'nav))))""")
        == "(LEFT (LEFT) NIL NIL)"
    )


# --------------------------------------------------------------------------------------------------------- modules that die


def test_a_module_that_dies_leaves_the_others_as_they_were_and_the_reason_is_told(text):
    text(
        NAV
        + """
        (def-asynchronous-process-module belt ())
        (defmethod synchronization-fluent ((m belt) input) (declare (ignore input)) t)
        (defmethod on-input ((m belt) input) (sleep 1) (fail "jammed at ~a" (goal-of input)))"""
    )
    assert (
        text("""(handler-case
                       (plan (nav belt)
                         (pm-execute 'belt (motion 7))
                         (sleep 2)
                         (note (get-running-process-module 'belt))
                         (note (pm-execute 'nav (motion 1)))
                         (note (text-of (pm-execute 'belt (motion 8)))))
                     (plan-failure (e) (format nil "~a" e)))""")
        == '"jammed at 7"'
    )
    assert text("(cdr *notes*)") == '((:RAN 1) 1 "Unknown process module: BELT ")'


def test_the_error_about_a_module_that_died_says_why(text):
    text("""(def-asynchronous-process-module belt ())
            (defmethod synchronization-fluent ((m belt) input) (declare (ignore input)) t)
            (defmethod on-input ((m belt) input) (car (goal-of input)))""")
    with pytest.raises(Exception, match="The value"):
        text("(plan (belt) (pm-execute 'belt (motion 7)) (sleep 2) (note (handler-case (pm-execute 'belt (motion 8)) (error (c) c))))")
    problem = text.session.evaluate_text("(first *notes*)")[0]
    assert problem.hint.startswith("It has ended by a failure of its own: The value 7 is not of type LIST when binding LIST, at <repl>:")
    assert "Running now: none. Defined: " in problem.hint and problem.hint.endswith(
        "Modules run in (cpm:with-process-modules-running (belt) ...)."
    )


def test_the_form_fails_with_the_failure_of_a_module_that_nobody_asked_for(text):
    text("""(def-asynchronous-process-module belt ())
            (defmethod synchronization-fluent ((m belt) input) (declare (ignore input)) t)
            (defmethod on-input ((m belt) input) (declare (ignore input)) (sleep 1) (fail "jammed"))""")
    said = text.error("(plan (belt) (pm-execute 'belt (motion 7)) (sleep 2) :fine)")
    assert said.startswith("cramhy: CRAM-LANGUAGE-IMPLEMENTATION:SIMPLE-PLAN-FAILURE\n  jammed\n  at <repl>:3:")
    assert said.endswith("  while process module BELT took #<A MOTION (TYPE DRIVING) (GOAL 7)>\n")


def test_monitors_and_callers_of_a_module_that_ends_are_told(text):
    text("""(def-asynchronous-process-module belt ((ready :initform (make-fluent :name 'ready) :reader ready)))
            (defmethod synchronization-fluent ((m belt) input) (declare (ignore input)) (ready m))
            (defmethod on-run ((m belt)) (sleep 1) (fail "power cut"))""")
    assert (
        text("""(text-of (plan (belt)
                     (par (note (text-of (pm-execute 'belt (motion 1))))
                          (note (text-of (pm-execute 'belt (motion 2)))))))""")
        == '"power cut"'
    )
    assert text("*notes*") == "(" + " ".join(['"Process module `BELT\' not running."'] * 2) + ")" and kernel.now() == 1
    text("""(defmethod on-run ((m belt)))
            (defmethod on-input ((m belt) input) (sleep 1) (fail "jammed at ~a" (goal-of input)))
            (defmethod synchronization-fluent ((m belt) input) (declare (ignore input)) t)
            (setf *notes* nil)""")
    assert text("(text-of (plan (belt) (pm-execute 'belt (motion 1)) (note (text-of (monitor-process-module 'belt)))))") == '"jammed at 1"'
    assert text("*notes*") == '("Process module `BELT\' not running.")'
    text(NAV + "(setf *notes* nil)")
    assert text("""(top-level (with-tags (par (:tag module (pm-run 'nav))
                                              (progn (sleep 1) (evaporate module) :ended)
                                              (progn (wait-for-process-module-running 'nav)
                                                     (note (text-of (monitor-process-module 'nav)))))))""") in (":ENDED", "NIL", "")
    assert text("*notes*") == '("Process module `NAV\' not running.")'


def test_requests_in_the_queue_of_a_module_that_terminates_are_told(text):
    text("(def-process-module nav (motion) (sleep 1) (car (goal-of motion)))")
    assert (
        text("""(let ((*process-module-debugger-hook* (lambda (c hook) (declare (ignore c hook)) (invoke-restart 'terminate-pm))))
                     (plan (nav)
                       (let ((said nil))
                         (par (push (text-of (pm-execute 'nav (motion 1))) said)
                              (progn (sleep 0.5) (push (noting-warnings (text-of (pm-execute 'nav (motion 2)))) said)))
                         (reverse said))))""")
        == '("The value 1 is not of type LIST when binding LIST" "Process module `NAV\' not running.")'
    )


def test_a_class_that_is_defined_anew_while_it_runs_disturbs_nothing(text):
    text("(def-process-module nav (motion) (sleep 1) (list :old (goal-of motion)))")
    assert (
        text("""(plan (nav)
                     (par (note (pm-execute 'nav (motion 1)))
                          (progn (sleep 0.5) (eval '(def-process-module nav (motion) (list :new (goal-of motion))))))
                     (note (pm-execute 'nav (motion 2)))
                     (status-now 'nav))""")
        == ":WAITING"
    )
    assert text("*notes*") == "((:OLD 1) (:OLD 2))"
    assert text("(plan (nav) (pm-execute 'nav (motion 3)))") == "(:NEW 3)"


def test_an_error_while_modules_start_ends_those_that_run_already_and_reaches_the_caller(text):
    text(NAV)
    assert (
        text("(list (text-of (with-process-modules-running (nav nvx) (note :never))) (get-running-process-module 'nav))")
        == '("Unknown process module: NVX " NIL)'
    )
    assert text("*notes*") == "NIL"


def test_a_body_that_is_evaporated_awaits_the_end_of_the_modules(text):
    text("""(def-process-module nav (motion) (declare (ignore motion)) (unwind-protect (sleep 100) (sleep 1) (note :nav-stopped)))""")
    text("""(top-level
              (pursue (with-process-modules-running (nav) (pm-execute 'nav (motion)))
                      (sleep 2))
              (note :after))""")
    assert text("*notes*") == "(:NAV-STOPPED :AFTER)" and kernel.now() == 3
    assert text("(get-running-process-module 'nav)") == "NIL"
