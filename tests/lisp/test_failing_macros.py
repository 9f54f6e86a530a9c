"""A macro that fails while a function is compiled is a warning, and the call fails when it is reached, as on SBCL (ANSI 3.2.5)."""

from __future__ import annotations

import sys

import pytest
from lisp_text import LispText

PRELUDE = """
(defpackage :failing-macros (:use :cl))
(in-package :failing-macros)
(defmacro failing (x) (error "There is no ~a." x))
(defmacro outer (x) `(list 1 (failing ,x)))
(define-symbol-macro here (failing 5))
(defun helper (x) (car x))
(defmacro by-helper () (helper 5))
(defmacro odd-use (&key a) a)
"""


@pytest.fixture
def lisp(session):
    session.package = "CL-USER"
    return LispText(session, PRELUDE)


@pytest.mark.soak(all_but=4)
@pytest.mark.parametrize(
    ("definition", "call", "form", "cause"),
    [
        ("(defun f (x) (if x (failing 3) :fine))", "(f {})", "(FAILING 3)", "There is no 3."),
        ("(defun f (x) (if x (outer 4) :fine))", "(f {})", "(FAILING 4)", "There is no 4."),
        ("(defun f (x) (if x here :fine))", "(f {})", "(FAILING 5)", "There is no 5."),
        ("(defun f (x) (if x (by-helper) :fine))", "(f {})", "(BY-HELPER)", "is not of type"),
        ('(defun f (x) (if x (macrolet ((m () (error "no m"))) (m)) :fine))', "(f {})", "(M)", "no m"),
        ("(defun f (x) (if x (odd-use :b 1) :fine))", "(f {})", "(ODD-USE :B 1)", ":B"),
        ("(defmethod g (x) (if x (failing 3) :fine))", "(g {})", "(FAILING 3)", "There is no 3."),
        ("(defparameter *f* (lambda (x) (if x (failing 3) :fine)))", "(funcall *f* {})", "(FAILING 3)", "There is no 3."),
    ],
)
def test_the_function_is_defined_with_a_warning_and_only_the_call_fails(lisp, definition, call, form, cause):
    said = " ".join(lisp.warnings(definition).split())
    assert said.startswith("; caught WARNING:") and f"The macro call {form} fails" in said and cause in said
    assert lisp(call.format("nil")) == ":FINE"
    told = " ".join(lisp.error(call.format("t")).split())
    assert told.startswith(f"Execution of a form compiled with errors. Form: {form} Compile-time error: ") and cause in told
    assert lisp(f"(handler-case {call.format('t')} (sb-int:compiled-program-error () :error))") == ":ERROR"
    assert lisp(f"(handler-case {call.format('t')} (program-error () :error))") == ":ERROR"


@pytest.mark.parametrize("form", ["(failing 3)", "(progn (failing 3))", "(list 1 (failing 3))", "(list (+ 1 (outer 3)))"])
def test_at_the_prompt_it_is_the_error_itself(lisp, form):
    assert lisp.error(form) == "There is no 3."


@pytest.mark.parametrize(
    ("form", "answer"),
    [
        ("(handler-case (failing 1) (error () :caught))", ":CAUGHT"),
        ("(multiple-value-bind (a b) (ignore-errors (failing 1) 2) (list a (typep b 'program-error)))", "(NIL T)"),
        ("(let ((x 1)) (handler-case (failing x) (error () (list :caught x))))", "(:CAUGHT 1)"),
        ("(block nil (handler-bind ((error (lambda (e) (return :bound)))) (failing 1)))", ":BOUND"),
        ("(let ((l nil)) (ignore-errors (push 1 l) (failing 2)) l)", "(1)"),
        ("(if nil (failing 1) :not-reached)", ":NOT-REACHED"),
        ("(let ((l nil)) (unwind-protect (ignore-errors (failing 2)) (push 3 l)) l)", "(3)"),
        ("(handler-case (outer 1) (error () :caught))", ":CAUGHT"),
        ("(handler-case (odd-use :b 1) (error () :caught))", ":CAUGHT"),
        ('(handler-case (macrolet ((m () (error "x"))) (m)) (error () :caught))', ":CAUGHT"),
        ("(handler-case here (error () :caught))", ":CAUGHT"),
        ("(dotimes (i 3 :done) (when (> i 5) (failing i)))", ":DONE"),
        ("(loop for i below 3 collect (handler-case (failing i) (error () i)))", "(0 1 2)"),
        ("(list (cond ((= 1 1) :yes) (t (failing 2))))", "(:YES)"),
        ("(list 1 (ignore-errors (failing 1)))", "(1 NIL)"),
    ],
)
def test_at_top_level_too_only_the_call_fails(lisp, form, answer):
    assert lisp(form) == answer


def test_the_prompt_warns_of_a_call_that_is_not_reached(lisp):
    said = lisp.warnings("(if nil (failing 1) :not-reached)")
    assert "The macro call (FAILING 1) fails" in said and "There is no 1." in said


def test_a_form_of_lisp_that_is_written_wrongly_is_an_error_at_once_as_before(lisp):
    assert "DOLIST" in lisp.error("(defun f () (dolist))").upper()


def test_the_warning_is_given_for_each_loading_and_the_other_functions_are_there(lisp, tmp_path, monkeypatch):
    monkeypatch.setattr(sys, "dont_write_bytecode", False)
    path = tmp_path / "plan.lisp"
    path.write_text("(in-package :failing-macros)\n(defun one () 1)\n(defun two ()\n  (failing 2))\n(defun three () 3)\n")
    for _ in range(2):
        said = lisp.warnings(f'(load "{path}")')
        assert f"{path}:4:3" in said and "There is no 2." in said
        assert lisp("(list (one) (three))") == "(1 3)"


def test_handlers_around_the_compilation_do_not_hear_the_error_of_the_macro(lisp):
    assert lisp("(let (heard) (handler-bind ((error (lambda (e) (push (princ-to-string e) heard))) (warning #'muffle-warning))"
                " (compile nil '(lambda () (failing 7)))) heard)") == "NIL"  # fmt: skip
