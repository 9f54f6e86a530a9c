"""The debugger in a task of a plan: `*debug-on-lisp-errors*`, `*break-on-plan-failures*` and BREAK, as they are typed and shown."""

from __future__ import annotations

import pytest

from cramhy_runtime.cpl.failures import debugging

PLAN = """
(top-level (with-failure-handling (((or error simple-plan-failure) (c) (format t "parent: ~a~%" c) (return :handled)))
             (par (progn (sleep 5) (format t "other~%"))
                  (let ((x 5)) (unwind-protect (error "boom ~a" x) (format t "cleanup~%"))))))"""


@pytest.fixture(autouse=True)
def variables_as_at_first():
    yield
    debugging.DEBUG_ON_LISP_ERRORS.value = debugging.BREAK_ON_PLAN_FAILURES.value = None


def test_an_error_stops_its_task_in_the_debugger_when_that_is_wanted(type_in, backend):
    shown = type_in(f"(setf *debug-on-lisp-errors* t){PLAN}\n(list :task (not (null *current-task*)))\n0", backend=backend)
    assert "debugger invoked on a SIMPLE-ERROR:\n  boom 5\n" in shown
    assert '  0: [RETHROW ] Rethrow condition `#<SIMPLE-ERROR "boom ~a" {' in shown
    assert '  1: [TEARDOWN] Tear down #<TASK "[PAR-CHILD-#2/2]-' in shown
    assert "0] (list :task (not (null *current-task*)))\n(:TASK T)\n0] 0\ncleanup\nparent: boom 5\n:HANDLED\n" in shown
    assert "\nother" not in shown


@pytest.mark.parametrize("answer", [":teardown", "q"])
def test_a_task_that_is_torn_down_fails_as_aborted(type_in, backend, answer):
    shown = type_in(f"(setf *debug-on-lisp-errors* t){PLAN}\n{answer}", backend=backend)
    assert shown.endswith(f"0] {answer}\ncleanup\nparent: Aborted.\n:HANDLED\n")


def test_an_error_of_a_form_typed_in_a_tasks_debugger_is_another_level_of_it(type_in, backend):
    shown = type_in(f"(setf *debug-on-lisp-errors* t){PLAN}\n(car 1)\na\n0", backend=backend)
    assert "1] a\n0] 0\ncleanup\n" in shown and shown.endswith(":HANDLED\n")


def test_the_default_goes_on_to_the_parent(type_in, backend):
    shown = type_in(PLAN, backend=backend)
    assert "debugger" not in shown and shown.endswith("cleanup\nparent: boom 5\n:HANDLED\n")


def test_a_plan_failure_of_the_wanted_type_stops_before_its_handlers(type_in, backend):
    shown = type_in(
        """(setf *break-on-plan-failures* 'simple-plan-failure)
(top-level (with-failure-handling ((plan-failure (c) (format t "handler: ~a~%" c) (return :handled))) (fail "f ~a" 1)))
0
(top-level (with-failure-handling ((plan-failure () (return :other))) (fail 'composite-failure)))
(setf *break-on-plan-failures* nil)""".replace("()", "(c) c"),
        backend=backend,
    )
    assert "  f 1\n" in shown and "  0: [CONTINUE] Continue failure signalling.\n" in shown
    assert "] 0\nhandler: f 1\n:HANDLED\n" in shown
    assert shown.count("debugger invoked") == 1 and "\n:OTHER\n" in shown


def test_break_stops_a_task_and_lets_it_go_on(type_in, backend):
    shown = type_in('(top-level (par (progn (break "here ~a" 1) :after)))\n0', backend=backend)
    assert "debugger invoked on a SIMPLE-CONDITION:\n  here 1\n" in shown and "Return from BREAK." in shown
    assert shown.endswith("0] 0\n:AFTER\n")


def test_the_end_of_input_in_a_tasks_debugger_ends_the_session(type_in, backend):
    shown = type_in(f"(setf *debug-on-lisp-errors* t){PLAN}", backend=backend)
    assert shown.endswith("cleanup\nparent: Aborted.\n:HANDLED\n") and type_in.status == 0


def test_a_script_never_stops(cramhy, tmp_path):
    (tmp_path / "plan.lisp").write_text(
        "(in-package :cpl-user)\n(setf *debug-on-lisp-errors* t *break-on-plan-failures* t)\n"
        f'(print {PLAN})\n(top-level (par (error "the end")))'
    )
    done = cramhy("run", "plan.lisp", "--time", "virtual", "--no-turtlesim")
    assert done.returncode == 1 and ":HANDLED" in done.stdout and "the end" in done.stderr


MODULE = """
(in-package :cram-user)
(setf *debug-on-lisp-errors* t)
(cpm:def-process-module debugged (motion) (+ 1 (desig:desig-prop-value motion :speed)))
(cpm:with-process-modules-running (debugged)
  (top-level
    (flet ((drive (speed)
             (handler-case (cpm:pm-execute 'debugged (desig:make-designator :motion `((:speed ,speed)))) (error (e) (type-of e)))))
      (list (drive :fast) (sleep 1) (if (cpm:get-running-process-module 'debugged) (drive 2) :gone)))))"""


@pytest.mark.soak(all_but=4)
@pytest.mark.parametrize(
    "answer, result",
    [
        ("0", "(TYPE-ERROR NIL 3)"),
        ("1", "(TYPE-ERROR NIL :GONE)"),
        (":continue-pm", "(TYPE-ERROR NIL 3)"),
        (":terminate-pm", "(TYPE-ERROR NIL :GONE)"),
    ],
)
def test_an_error_in_a_process_module_offers_to_let_the_module_go_on_or_end(type_in, backend, answer, result):
    """Both let the caller have the error."""
    looking = "(desig:desig-prop-value (cpl:value (cpm:input (cpm:get-running-process-module 'debugged))) :speed)"
    shown = type_in(f"{MODULE}\n{looking}\n{answer}", backend=backend)
    assert "  0: [CONTINUE-PM ] Ignore error and restart process module main loop.\n" in shown
    assert "  1: [TERMINATE-PM] Terminate process module\n" in shown
    assert ":FAST\n" in shown and shown.endswith(f"{result}\n")
