"""An error in what shows an error: one line says which object cannot be printed, why and where, at every door, and soon."""

from __future__ import annotations

import bad_printers
import pytest

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.lisp_core.conditions import Condition
from cramhy_runtime.languages.commonlisp.streams import streams
from cramhy_runtime.languages.commonlisp.tools.error_reports import report_lines
from cramhy_runtime.repl import json_lines
from cramhy_runtime.repl.console import Console
from cramhy_runtime.repl.session import Session, condition_of

from .conftest import Script

FORMS = {what: (form, said) for what, form, said in bad_printers.forms()}


@pytest.fixture(scope="module")
def session():
    made = Session(time="virtual", turtlesim=False)
    made.package = "COMMON-LISP-USER"
    json_lines.evaluate(made, bad_printers.DEFINITIONS)
    yield made
    kernel.stop()


@pytest.fixture(autouse=True)
def as_it_was():
    saved = conditions._debugger.value, streams.ERROR_OUTPUT.value
    yield
    conditions.install_debugger(saved[0])
    streams.ERROR_OUTPUT.value = saved[1]


def at_the_prompt(session, form, capsys):
    """What the prompt shows of a form, and then of its debugger's calls."""
    return typed(session, f"{form}\nbacktrace\n0\n", capsys)


def typed(session, text, capsys):
    console = Console(None, Script(text))
    console.session = session
    with console.listening():
        console.converse()
    return capsys.readouterr().out


def in_eval(session, form, capsys):
    """The answer of ``cramhy eval``, all its texts."""
    conditions.install_debugger(json_lines.signalled_here)
    error = json_lines.evaluate(session, form)["error"]
    assert error["restarts"][-1] == "ABORT" and len(error["restarts"]) <= 4
    return error["message"] + "\n" + error.get("hint", "")


def in_a_run(session, form, capsys):
    """What ``cramhy run`` prints of the error that ends it."""
    from cramhy_runtime.session.session import value_text

    try:
        [value_text(value) for value in session.evaluate_text(form)]
    except (Exception, Condition) as problem:
        return "\n".join(report_lines(condition_of(problem)))


DOORS = [at_the_prompt, in_eval, in_a_run]


@pytest.mark.soak(all_but=4)
@pytest.mark.parametrize("door", DOORS, ids=lambda door: door.__name__)
@pytest.mark.parametrize("what", FORMS)
def test_an_error_is_shown_though_something_in_it_cannot_be_printed(session, door, what, capsys):
    form, said = FORMS[what]
    shown = door(session, form, capsys)
    assert said in " ".join(shown.split()) and len(shown) < bad_printers.MOST
    assert shown.count("\n") < 60


def test_the_whole_of_it(session, capsys):
    session.evaluate_text("(defclass bp-slotless () ((a)))")
    session.evaluate_text("(defmethod print-object ((object bp-slotless) stream) (princ (slot-value object 'a) stream))", name="plan.lisp")
    shown = at_the_prompt(session, '(error "The arm holds ~a." (make-instance \'bp-slotless))', capsys)
    assert (
        "debugger invoked on a SIMPLE-ERROR:\n"
        "  The arm holds #<error printing a BP-SLOTLESS: The slot COMMON-LISP-USER::A is unbound in the object #<BP-SLOTLESS>."
        " (at plan.lisp:1:62)>.\n"
    ) in shown
    assert shown.count("[ABORT") == 1 and "  0: [ABORT] Exit debugger, returning to top level.\n" in shown


class TestOtherTextsOfADebugger:
    def test_the_report_of_a_restart(self, session, capsys):
        form = '(restart-case (error "x") (go-on () :report (lambda (stream) (car (list* 5 stream))(car 5)) 1))'
        shown = at_the_prompt(session, form, capsys)
        assert "0: [GO-ON] #<error printing a RESTART: The value 5 is not of type LIST" in shown and "1: [ABORT]" in shown

    def test_a_hint_that_cannot_be_found_out(self, session, capsys):
        try:
            conditions.error("x", hint=lambda: 1 / 0)
        except Condition as problem:
            assert "What to try could not be told: arithmetic error DIVISION-BY-ZERO signalled" in "\n".join(report_lines(problem))

    def test_a_debugger_in_a_debugger(self, session, capsys):
        shown = typed(session, "(bp-fail (make-instance 'bp-empty))\n" * 3 + "(make-instance 'bp-empty)\n", capsys)
        assert shown.count("debugger invoked on") == 4 and len(shown) < bad_printers.MOST


class TestOtherDoors:
    def test_a_line_of_the_log_does_not_end_the_plan(self, session):
        found = json_lines.evaluate(session, '(progn (roslisp:ros-info (x) "at ~a" (make-instance \'bp-empty)) 1)')
        assert found["values"] == ["1"] and "INFO] " in found["output"] and "at #<error printing a BP-EMPTY: " in found["output"]

    def test_describe_and_trace_go_on_as_in_sbcl(self, session):
        found = json_lines.evaluate(session, "(describe (make-instance 'bp-empty))")
        assert found["output"].startswith("#<error printing a BP-EMPTY: ") and found["error"] is None
        found = json_lines.evaluate(session, "(defun bp-same (x) x) (trace bp-same) (progn (bp-same (make-instance 'bp-empty)) 1)")
        json_lines.evaluate(session, "(untrace bp-same)")
        assert found["values"] == ["1"] and found["output"].count("#<error printing a BP-EMPTY: ") == 2

    def test_a_documentation_method_that_fails(self, session):
        text = "(defmethod documentation ((name (eql 'bp-name)) kind) (car (list* 5 kind)) (car 5)) (defvar bp-name 1) (describe 'bp-name)"
        found = json_lines.evaluate(session, text)
        assert found["error"] is None and "#<error finding the documentation: The value 5 is not of type LIST" in found["output"]

    @pytest.mark.parametrize("form", ["(print (make-instance 'bp-empty))", '(format nil "~a" (make-instance \'bp-empty))'])
    def test_a_program_that_prints_hears_of_it_as_in_sbcl(self, session, form):
        assert json_lines.evaluate(session, form)["error"]["type"] == "UNBOUND-SLOT"
        handled = json_lines.evaluate(session, f"(handler-case {form} (unbound-slot (e) (cell-error-name e)))")
        assert handled["values"] == ["A"]

    def test_the_variable_of_sbcl(self, session):
        form = "(let ((sb-ext:*suppress-print-errors* t)) (prin1-to-string (list (make-instance 'bp-empty) 2)))"
        (shown,) = json_lines.evaluate(session, form)["values"]
        assert shown.startswith('"(#<error printing a BP-EMPTY: ') and shown.split()[-1] == '2)"'
        form = "(let ((sb-ext:*suppress-print-errors* 'type-error)) (prin1-to-string (make-instance 'bp-empty)))"
        assert json_lines.evaluate(session, form)["error"]["type"] == "UNBOUND-SLOT"

    def test_handlers_around_hear_of_the_error_only(self, session):
        form = (
            "(let ((heard nil)) (block nil (handler-bind ((error (lambda (e) (push (type-of e) heard)"
            " (let ((sb-ext:*suppress-print-errors* t)) (princ-to-string e)) (return)))) (bp-fail (make-instance 'bp-empty)))) heard)"
        )
        assert json_lines.evaluate(session, form)["values"] == ["(SIMPLE-ERROR)"]
