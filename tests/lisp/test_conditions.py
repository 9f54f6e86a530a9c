"""Conditions where Lisp meets Python, and where there is a debugger; the rest is compared with SBCL."""

from __future__ import annotations

import weakref

import pytest

from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.lisp_core.conditions import Condition, PythonError, SimpleError
from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.lisp_core.packages import sym
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string


@pytest.fixture
def evaluate(session):
    session.package = "CL-USER"

    def fails():
        raise KeyError("missing")

    sym("CL-USER::PYTHON-FAILS").function = fails

    def run(text):
        return " ; ".join(" ".join(prin1_to_string(value).split()) for value in session.evaluate_text(text))

    return run


def test_an_exception_of_python_is_an_error(evaluate):
    assert evaluate("(handler-case (python-fails) (error (c) (princ-to-string c)))") == '''"There is no key 'missing'."'''
    assert evaluate("(ignore-errors (python-fails) 1)").startswith("NIL ; #<")
    assert evaluate("(let ((r nil)) (ignore-errors (unwind-protect (python-fails) (push 'cleanup r))) r)") == "(CLEANUP)"


def test_who_called_a_local_function_wrongly_is_told_though_a_weak_proxy_has_outlived_its_object(evaluate):
    thing = conditions.SimpleError("gone")
    proxy = weakref.proxy(thing)
    del thing
    text = "(handler-case (labels ((f (x) x)) (funcall #'f 1 2)) (error (c) (princ-to-string c)))"
    assert evaluate(text) == '"invalid number of arguments: 2"'
    assert type(proxy) is weakref.ProxyType


def test_a_handler_sees_an_exception_of_python_once_for_each_binding(evaluate):
    assert evaluate("(let ((n 0)) (handler-case (handler-bind ((error (lambda (c) c (incf n)))) (python-fails)) (error () n)))") == "1"


def test_python_sees_its_own_exception_again(evaluate):
    with pytest.raises(KeyError):
        evaluate("(handler-bind ((error (lambda (c) c nil))) (python-fails))")


def test_an_error_signalled_in_python_runs_lisp_handlers_before_unwinding(evaluate):
    sym("CL-USER::SIGNALS").function = lambda: conditions.restart_case(
        [(sym("USE-VALUE"), lambda value: value)], lambda: conditions.error(SimpleError("from Python"))
    )
    assert evaluate("(handler-bind ((simple-error (lambda (c) c (use-value 42)))) (signals))") == "42"


def test_the_debugger_runs_on_top_of_the_error_and_may_choose_a_restart(evaluate):
    seen = []

    def debugger(condition):
        seen.append(condition.report())
        conditions.invoke_restart(sym("CONTINUE"))

    conditions.install_debugger(debugger)
    try:
        assert evaluate('(let ((r nil)) (unwind-protect (progn (cerror "Go on" "stop ~a" 1) (push 1 r)) (push 2 r)) r)') == "(2 1)"
        assert evaluate('(progn (break "here ~a" 2) (quote after))') == "AFTER"
    finally:
        conditions.install_debugger(None)
    assert seen == ["stop 1", "here 2"]


def test_break_does_not_ask_the_hook_of_a_program(evaluate):
    with pytest.raises(Condition) as caught:
        evaluate('(let ((*debugger-hook* (lambda (c h) c h (throw 1 2)))) (break "x"))')
    assert caught.value.report() == "x"


def test_the_hook_is_asked_before_the_debugger(evaluate):
    assert evaluate('(block nil (let ((*debugger-hook* (lambda (c h) h (return (princ-to-string c))))) (error "hooked")))') == '"hooked"'


def test_break_on_signals(evaluate):
    with pytest.raises(Condition) as caught:
        evaluate('(let ((*break-on-signals* (quote error))) (ignore-errors (error "inner")))')
    assert caught.value.report() == "inner\nBREAK was entered because of *BREAK-ON-SIGNALS* (now rebound to NIL)."


def test_an_unknown_condition_class(evaluate):
    for operator in ("make-condition", "error", "signal", "warn"):
        assert (
            evaluate(f"(handler-case ({operator} 'nope) (simple-error () 'simple) (type-error (c) (princ-to-string c)))")
            == '"NOPE does not designate a condition class."'
        )


@pytest.mark.parametrize(
    ("form", "wanted"),
    [
        ("(ecase 3 (1 1) ((2 4) 2))", "(MEMBER 1 2 4)"),
        ("(etypecase 3 (string 1) (symbol 2))", "(OR STRING SYMBOL)"),
        ("(etypecase 3 (string 1))", "(OR STRING)"),
        ("(car 5)", "LIST"),
        ("(+ 'a 1)", "NUMBER"),
        ("(< nil 1)", "REAL"),
        ("(let ((x 1)) (check-type x string))", "STRING"),
    ],
)
def test_the_expected_type_is_a_type_specifier(evaluate, form, wanted):
    assert evaluate(f"(handler-case {form} (type-error (c) (type-error-expected-type c)))") == wanted


def test_names_in_reports_stand_in_the_right_package(evaluate):
    evaluate("(defpackage shadows (:use :cl) (:shadow #:/ #:car))")
    evaluate("(in-package :shadows)")
    assert (
        evaluate("(handler-case (cl:/ 1 0) (error (c) (princ-to-string c)))")
        == '"arithmetic error DIVISION-BY-ZERO signalled Operation was (COMMON-LISP:/ 1 0)."'
    )
    assert (
        evaluate("(handler-case (error 'type-error :datum 'xx :expected-type 'foo) (error (c) (princ-to-string c)))")
        == '"The value XX is not of type SHADOWS::FOO"'
    )
    assert (
        evaluate("(handler-case (setf (nowhere 1) 2) (error (c) (princ-to-string c)))")
        == '"The function (COMMON-LISP:SETF SHADOWS::NOWHERE) is undefined."'
    )


def test_assert_and_check_type_try_again(evaluate):
    assert evaluate("(let ((x 0)) (handler-bind ((error (lambda (c) c (continue)))) (assert (> (incf x) 3))) x)") == "4"
    assert (
        evaluate(
            "(let ((x 'a) (n 0)) (handler-bind ((error (lambda (c) c (incf n) (store-value (if (< n 3) 'b 5))))) "
            "(check-type x integer)) (list x n))"
        )
        == "(5 3)"
    )


def test_binding_nothing_is_allowed(session):
    with binding():
        pass


def test_the_condition_for_an_exception_is_made_once(evaluate):
    problem = ValueError("x")
    assert conditions.from_python(problem) is conditions.from_python(problem)
    assert isinstance(conditions.from_python(problem), PythonError)


INNER_RESTARTS = [
    "(symbol-macrolet ((failing (error \"Boo!\"))) (restart-case (restart-case failing (foo () 'inner)) (foo () 'outer)))",
    "(restart-case (restart-case always-failing (foo () 'inner)) (foo () 'outer))",
    '(restart-case (with-simple-restart (foo "inner") (error "Boo!")) (foo () \'outer))',
]


@pytest.mark.parametrize("form", INNER_RESTARTS)
def test_a_restart_of_a_form_that_signals_belongs_to_its_condition(session, form):
    session.package = "CL-USER"
    session.evaluate_text('(define-symbol-macro always-failing (error "Boo!"))')
    first = "(handler-bind ((error (lambda (c) (invoke-restart (find-restart 'foo c)))))"
    assert session.evaluate_text(f'(string {first} (handler-bind ((error (lambda (c) c (error "Blah")))) {form})))') == ["OUTER"]
