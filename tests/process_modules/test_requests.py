"""Many requests at once, hooks, restarts, status fluents, and what a request leaves behind (process-modules.md section 4)."""

import gc
import re

import pytest
from systems import SOAK

from cramhy_runtime import cpl, kernel
from cramhy_runtime import process_modules as pm
from cramhy_runtime.cpl.failures.handling import attempt
from cramhy_runtime.process_modules.modules import ProcessModule, Request

from .test_modules import NAVIGATION, define, motion, with_modules


def test_two_hundred_calls_from_each_of_four_tasks_get_their_own_results(text):
    text("(def-process-module nav (motion) (when (evenp (goal-of motion)) (sleep 0.01)) (values (goal-of motion) (- (goal-of motion))))")
    assert (
        text("""(let ((wrong 0) (served 0))
                     (flet ((call (start)
                              (handler-bind ((warning #'muffle-warning))
                                (dotimes (n 200)
                                  (multiple-value-bind (one two) (pm-execute 'nav (motion (+ start n)))
                                    (incf served)
                                    (unless (and (eql one (+ start n)) (eql two (- one))) (incf wrong)))))))
                       (plan (nav) (par (call 0) (call 1000) (call 2000) (call 3000)))
                       (list served wrong)))""")
        == "(800 0)"
    )


def test_the_empty_input_gives_the_old_result_and_runs_nothing(text):
    text('(def-process-module nav (motion) (note :ran) (if (goal-of motion) (values (goal-of motion) :more) (fail "nowhere")))')
    assert (
        text("""(plan (nav)
                     (list (multiple-value-list (pm-execute 'nav nil))
                           (pm-execute 'nav (motion 1))
                           (multiple-value-list (pm-execute 'nav nil))
                           (text-of (pm-execute 'nav (motion nil)))
                           (text-of (pm-execute 'nav nil))))""")
        == '(NIL 1 (1 :MORE) "nowhere" "nowhere")'
    )
    assert text("*notes*") == "(:RAN :RAN)"


def test_what_is_no_designator_is_an_error_inside_of_the_module(text):
    text("(def-process-module nav (motion) motion)")
    said = text.error("(plan (nav) (pm-execute 'nav 5))")
    assert "CURRENT-DESIG" in said and "(5)" in said and "while process module NAV executed 5" in said


def test_an_error_of_the_body_tells_where_and_what_the_module_did(text):
    text("(def-process-module nav (motion)\n  (+ 1 (goal-of motion)))")
    assert (
        text.error("(plan (nav) (pm-execute 'nav (motion :wall)))")
        == """cramhy: TYPE-ERROR
  The value
    :WALL
  is not of type
    NUMBER
  at <repl>:2:3
  while process module NAV executed #<A MOTION (TYPE DRIVING) (GOAL WALL)>
"""
    )


@pytest.mark.parametrize("how", ["(pm-cancel 'nav)", "(setf (value (cancel (get-running-process-module 'nav))) t)"])
def test_a_run_that_somebody_cancels_fails_with_a_text_and_the_module_goes_on(text, how):
    text("(def-process-module nav (motion) (unwind-protect (sleep (goal-of motion)) (note :cleanup)))")
    assert (
        text(f"""(plan (nav)
                      (pm-cancel 'nav)
                      (let ((said nil))
                        (par (setf said (text-of (pm-execute 'nav (motion 10)))) (progn (sleep 1) {how}))
                        (pm-execute 'nav (motion 2))
                        said))""")
        == '"The execution of #<A MOTION (TYPE DRIVING) (GOAL 10)> by process module NAV was cancelled."'
    )
    assert text("*notes*") == "(:CLEANUP :CLEANUP)" and kernel.now() == 3


def test_a_failure_in_the_cleanup_of_a_cancelled_body_is_not_lost(text):
    text("""(def-process-module nav (motion) (declare (ignore motion)) (unwind-protect (sleep 10) (fail "brake broken")))""")
    assert text("(text-of (plan (nav) (pursue (pm-execute 'nav (motion)) (sleep 1))))") == '"brake broken"'
    assert (
        text("""(text-of (plan (nav)
                     (with-tags (par (:tag drive (pm-execute 'nav (motion)))
                                     (progn (sleep 1) (with-task-suspended (drive) (sleep 1)))))))""")
        == '"brake broken"'
    )


def test_the_status_fluents_can_be_waited_for(text):
    text("(def-process-module nav (motion) (sleep 2) (goal-of motion))")
    assert (
        text("""(plan (nav)
                     (let* ((module (get-running-process-module 'nav))
                            (running (running-fluent module)) (finished (finished-fluent module)))
                       (par (pm-execute 'nav (motion 1))
                            (progn (wait-for running) (note (list :running (value finished) (goal-of (value (input module)))
                                                                  (type-of (value (caller module)))))
                                   (wait-for finished) (note (list :finished (value running) (value (input module))
                                                                   (value (result module)) (cl:eq (pm-status 'nav) (status module))))))))
                 """)
        == "1"
    )
    assert text("*notes*") == "((:RUNNING NIL 1 TASK) (:FINISHED NIL NIL (1) T))"


def test_hooks_that_fail_end_the_module_and_nobody_waits_for_ever(text):
    text("""(def-process-module hooked (motion) (goal-of motion))
            (defmethod on-process-module-finished broken-hook ((m hooked) input result) (declare (ignore input result)) (car 5))""")
    said = text.error("(plan (hooked) (pm-execute 'hooked (motion 1)) (sleep 1) :went-on)")
    assert "The value\n    5" in said


@pytest.mark.parametrize("restart, after", [("CONTINUE-PM", "(:FAILED 2)"), ("TERMINATE-PM", "NIL")])
def test_the_restarts_are_offered_in_the_debugger(text, restart, after):
    """With ``*debug-on-lisp-errors*`` an error stops in the module, in front of the user, who chooses how it goes on."""
    from cramhy_runtime.lisp_core import conditions

    seen = []

    def debugger(condition):
        if conditions.find_restart(conditions.sym(f"CPM::{restart}")) is not None:
            seen.extend(known.report() for known in conditions.compute_restarts(condition)[:2])
            conditions.invoke_restart(conditions.sym(f"CPM::{restart}"))

    text("(def-process-module nav (motion) (if (eql (goal-of motion) 1) (car (goal-of motion)) (goal-of motion)))")
    old = conditions.install_debugger(debugger)
    try:
        assert (
            text("""(let ((*debug-on-lisp-errors* t))
                         (plan (nav)
                           (note (handler-case (pm-execute 'nav (motion 1)) (type-error (c) (type-error-datum c))))
                           (sleep 0.1)
                           (and (get-running-process-module 'nav) (list (status-now 'nav) (pm-execute 'nav (motion 2))))))""")
            == after
        )
    finally:
        conditions.install_debugger(old)
    assert seen == ["Ignore error and restart process module main loop.", "Terminate process module"] and text("*notes*") == "(1)"


# ------------------------------------------------------------------------------------------------ suspension of the module


def test_a_module_can_be_suspended_with_its_body_and_goes_on_where_it_was(text):
    text("(def-process-module nav (motion) (dotimes (n 4) (sleep 1) (note n)) (goal-of motion))")
    assert (
        text("""(top-level
                     (with-tags
                       (pursue (:tag module (pm-run 'nav))
                               (progn (wait-for-process-module-running 'nav) (pm-execute 'nav (motion 5)))
                               (progn (sleep 2.5) (with-task-suspended (module) (note :standing) (sleep 10)) (sleep 100)))))""")
        == "5"
    )
    assert text("*notes*") == "(0 1 :STANDING 2 3)"


def test_a_body_can_be_cancelled_while_its_module_is_suspended_which_stays_so(text):
    """The caller waits for the end of the body, and whoever ends the caller may be who has suspended the module."""
    text("(def-process-module nav (motion) (unwind-protect (par (sleep 100) (sleep 50)) (sleep 1) (note :cleanup)))")
    assert (
        text("""(top-level
                     (with-tags
                       (pursue (:tag module (pm-run 'nav))
                               (progn (:tag caller (wait-for-process-module-running 'nav) (pm-execute 'nav (motion))) (sleep 100))
                               (progn (sleep 1)
                                      (with-task-suspended (module)
                                        (evaporate caller)
                                        (note (list :ended (value (status module))))
                                        (sleep 1)
                                        (note (value (status module))))
                                      (note (pm-execute 'nav nil))
                                      :done))))""")
        == ":DONE"
    )
    assert text("*notes*") == "(:CLEANUP (:ENDED :SUSPENDED) :SUSPENDED NIL)"


# ------------------------------------------------------------------------------------------------------ what is left behind


def _alive(*classes):
    gc.collect()
    return sum(isinstance(thing, classes) for thing in gc.get_objects())


def test_a_thousand_failing_runs_leave_nothing_behind():
    """Neither the requests nor their failures, nor the modules that they came through."""
    define(lambda designator: cpl.fail("no way"))

    def fail_often():
        for _ in range(100):
            attempt(lambda: pm.pm_execute(NAVIGATION, motion()))

    with_modules(fail_often)
    before = _alive(Request, cpl.PlanFailure, ProcessModule, cpl.Task)
    for _ in range(10):
        with_modules(fail_often)
    assert _alive(Request, cpl.PlanFailure, ProcessModule, cpl.Task) <= before


def test_a_failure_holds_no_observer_of_the_module_that_it_came_through():
    define(lambda designator: cpl.fail("no way"))
    modules = []

    def body():
        modules.append(pm.get_running_process_module(NAVIGATION))
        pm.pm_execute(NAVIGATION, motion())

    with pytest.raises(cpl.PlanFailure):
        with_modules(body)
    assert [module.cancel.callbacks for module in modules] == [None] and not modules[0].status_fluent.waiters


def test_ten_thousand_requests_of_three_callers_leave_nothing_behind():
    """As many when soaking; a tenth of it otherwise."""
    count = 5_000 if SOAK else 500
    define(lambda designator: designator)

    def call():
        for _ in range(count // 3):
            mine = motion()
            assert pm.pm_execute(NAVIGATION, mine) is mine

    def body():
        counts = []
        for _ in range(2):
            cpl.par(call, call, call)
            gc.collect()
            counts.append(len(gc.get_objects()))
        return counts

    middle, after = with_modules(body)
    assert after < middle + 100


def test_a_monitor_of_a_synchronous_module_takes_a_list(text):
    text("(def-process-module nav (motion) (goal-of motion))")
    assert (
        text("""(plan (nav)
                     (list (handler-case (monitor-process-module 'nav :designators 5) (type-error (c) (type-error-expected-type c)))
                           (pursue (monitor-process-module 'nav :designators '(5)) (progn (sleep 1) :waits))))""")
        == "(LIST :WAITS)"
    )


def test_the_names_of_modules_do_not_pile_up(text):
    text("(def-process-module nav (motion) (goal-of motion))")
    text("(dotimes (n 20) (plan (nav) (pm-execute 'nav (motion 1))))")
    count = text('(let ((n 0)) (do-symbols (s *package* n) (when (search "NAV-" (symbol-name s)) (incf n))))')
    assert re.fullmatch(r"\d+", count) and int(count) < 10


# ------------------------------------------------------------------------------------------------- cleanup that does not end


STUCK = """(defvar *never* (make-fluent :name 'never))
           (def-process-module nav (motion)
             (if (eql (goal-of motion) :stuck)
                 (unwind-protect (unwind-protect (sleep 100) (wait-for *never*) (note :not-reached)) (note :outer))
                 (goal-of motion)))"""


def test_a_second_evaporation_of_the_caller_ends_the_wait_that_the_cleanup_of_the_body_is_stuck_in(text):
    text(STUCK)
    assert (
        text("""(plan (nav)
                     (with-tags
                       (par (:tag drive (pm-execute 'nav (motion :stuck)))
                            (progn (sleep 1) (evaporate drive :sync nil) (sleep 1) (note :again) (evaporate drive))))
                     (pm-execute 'nav (motion 5)))""")
        == "5"
    )
    assert text("*notes*") == "(:AGAIN :OUTER)" and kernel.now() == 2


def test_the_limit_of_cleanup_holds_for_the_cleanup_of_a_body(text, capsys):
    text(STUCK)
    assert (
        text("""(let ((cpl-impl::*cleanup-time-limit* 3))
                     (plan (nav)
                       (pursue (pm-execute 'nav (motion :stuck)) (sleep 1))
                       (pm-execute 'nav (motion 5))))""")
        == "5"
    )
    assert text("*notes*") == "(:OUTER)" and kernel.now() == 4
    assert "waited for the fluent #<FLUENT NEVER [NIL]>" in capsys.readouterr().err


def test_a_deadlock_in_the_cleanup_of_a_body_brings_the_plan_down_with_a_warning(text, capsys):
    text(STUCK)
    with pytest.raises(kernel.Deadlock, match="process module NAV to stop"):
        text("(plan (nav) (pursue (pm-execute 'nav (motion :stuck)) (sleep 1)))")
    assert text("(list *notes* (get-running-process-module 'nav))") == "((:OUTER) NIL)"
    assert "waited for the fluent #<FLUENT NEVER [NIL]>" in capsys.readouterr().err
