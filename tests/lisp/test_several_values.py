"""Functions that end in ``values``, whose callers bind the values: what is bound is what the function gives when it is called otherwise."""

from __future__ import annotations

import functools
from itertools import count

import pytest

from lisp_text import LispText

_numbers = count(1)
TWO = "(defun two (x) (values x (list x)))"


@pytest.fixture
def lisp(session):
    name = f"SEVERAL-{next(_numbers)}"
    yield LispText(session, f"(defpackage :{name} (:use :cl)) (in-package :{name})")
    session.package = "COMMON-LISP-USER"


def check(lisp, call):
    """Bind the values of ``call`` to as many variables and to others; they are those that a list of them has."""
    for number in (2, 3, 5):
        names = "a b c d e"[: 2 * number - 1]
        lisp(f"(defun caller () (multiple-value-bind ({names}) {call} (list {names})))")
        assert lisp("(caller)") == lisp(
            f"(let ((all (multiple-value-list {call}))) (subseq (append all '(nil nil nil nil nil)) 0 {number}))"
        )
    lisp(f"(defun caller () (multiple-value-bind (a) {call} a))")
    assert lisp("(caller)") == lisp(f"(first (multiple-value-list {call}))")
    lisp(f"(defun caller () (multiple-value-bind () {call} :none))")
    assert lisp("(caller)") == ":NONE"


@pytest.mark.soak(all_but=3)
@pytest.mark.parametrize(
    "body",
    [
        "(values x 2)",
        "(values x 2 3)",
        "(progn (setf x 4) (values x 2))",
        "(if x (values x 2) (values 3 4 5))",
        "(if x 7 (values 3 4))",
        "(if x (values 3 4) 7)",
        "(if (eql x 1) nil (values 3 4))",
        "(when x (values 3 4))",
        "(cond ((null x) (values 1 2)) ((eql x 1) (values 3 4 5)) (t :other))",
        "(case x (1 (values 1 2)) (t (values)))",
        "(if x (values) (values 3 4))",
        "(if x (floor 7 2) (values 3 4))",
        "(if x (floor x 2) (values 3 4))",
        "(if x (truncate 7 2) (values 3 4))",
        "(if x (gethash 1 (make-hash-table) :none) (values 3 4))",
        "(if x (helper) (values 3 4))",
        "(if x (funcall #'helper) (values 3 4))",
        "(if x (values-list '(1 2 3)) (values 3 4))",
        "(if x (apply #'values '(1 2 3)) (values 3 4))",
        "(let ((y (list x))) (values y x))",
        "(let* ((y x) (z y)) (values x y z))",
        "(let ((*special* x)) (values *special* (see)))",
        "(multiple-value-bind (a b) (helper) (values b a))",
        "(flet ((other () (values 1 2))) (if x (other) (values 3 4)))",
        "(labels ((other (n) (if (> n 3) (values n 2) (other (1+ n))))) (values (other x) 1))",
        "(flet ((other () (return-from made (values 8 9)))) (other) (values 3 4))",
        "(progn (when x (return-from made (values 5 6))) (values 3 4))",
        "(progn (when x (return-from made 5)) (values 3 4))",
        "(progn (mapc (lambda (y) (return-from made (values y 6))) (list x 2)) (values 3 4))",
        "(block nil (when x (return (values 5 6 7))) (values 3 4))",
        "(block nil (when x (return (helper))) (values 3 4))",
        "(progn (tagbody (go out) out) (values x 4))",
        "(let ((n 0)) (dotimes (i 3) (incf n i)) (values n x))",
        "(if x (catch 'tag (throw 'tag (values 1 2))) (values 3 4))",
        "(if x (unwind-protect (values 1 2) (setf x 3)) (values 3 4))",
        "(if x (handler-case (error \"no\") (error () (values 1 2))) (values 3 4))",
        "(if x (multiple-value-prog1 (values 1 2) (setf x 3)) (values 3 4))",
        "(if x (the fixnum 4) (values 3 4))",
        "(values (values 1 2) (floor 7 2))",
        "(values (if x 1 2) (funcall (lambda () x)) (+ x 1.5d0))",
        "(or nil (values x 2))",
        "(and x (values x 2))",
        "(if x t (values 1 2))",
        "(if x \"text\" (values 1 2))",
        "(if x 2.5d0 (values 1 2))",
        "(if x *special* (values 1 2))",
        "(if x (setf *special* (values 1 2)) (values 1 2))",
        "(locally (declare (special x)) (values 1 2))",
    ],
)  # fmt: skip
def test_what_is_bound_is_what_is_given(lisp, body):
    lisp("(defvar *special* :global) (defun see () *special*) (defun helper () (values :h :i))")
    lisp(f"(defun made (x) {body})")
    check(lisp, "(made 1)")
    if "(+ x" not in body and "(> n" not in body and "(floor x" not in body:
        check(lisp, "(made nil)")


@pytest.mark.soak(all_but=3)
@pytest.mark.parametrize(
    ("parameters", "calls"),
    [
        ("(a &optional (b 2 b-p) c)", ["(made 1)", "(made 1 3)", "(made 1 nil 4)"]),
        ("(&rest all)", ["(made)", "(made 1 2)"]),
        ("(a &key (b (list a)) c)", ["(made 1)", "(made 1 :c 2)", "(made 1 :c 2 :b 3)"]),
        ("(&key ((:other b) 5) &allow-other-keys)", ["(made)", "(made :other 3)", "(made :x 3)"]),
        ("(a &aux (b (list a)))", ["(made 1)"]),
        ("(*special* &optional (b *special*))", ["(made 1)", "(made 1 2)"]),
    ],
)
def test_parameters_of_every_kind(lisp, parameters, calls):
    lisp("(defvar *special* :global)")
    names = [name for name in ("a", "b", "c", "b-p", "all", "*special*") if name in parameters.replace("(", " ").replace(")", " ").split()]
    lisp(f"(defun made {parameters} (values {' '.join(names)} :end))")
    for call in calls:
        check(lisp, call)


def test_a_function_with_a_state_has_it_once(lisp):
    lisp("(let ((n 0)) (defun next () (values (incf n) :n)))")
    lisp("(defun bound () (multiple-value-bind (n name) (next) (list n name)))")
    assert lisp("(list (bound) (next) (bound) (multiple-value-list (next)))") == "((1 :N) 2 (3 :N) (4 :N))"


def test_arguments_are_evaluated_once_and_in_order(lisp):
    lisp("(defvar *log* nil) (defun note (x) (push x *log*) x) (defun pair (a b) (values a b))")
    lisp("(defun bound () (multiple-value-bind (a b c) (pair (note 1) (note 2)) (list a b c)))")
    assert lisp("(list (bound) (reverse *log*))") == "((1 2 NIL) (1 2))"


@pytest.mark.parametrize(
    ("change", "answer"),
    [
        ("(defun two (x) (values :new x))", "(:NEW 1)"),
        ("(defun two (x) x)", "(1 NIL)"),
        ("(defun two (x &optional (y :y)) (values x y :third))", "(1 :Y)"),
        ("(setf (symbol-function 'two) (lambda (x) (values x :set)))", "(1 :SET)"),
        ("(setf (fdefinition 'two) #'list)", "((1) NIL)"),
        ("(progn (fmakunbound 'two) (defun two (x) (values x :made)))", "(1 :MADE)"),
        ("(progn (fmakunbound 'two) (defgeneric two (x)) (defmethod two ((x integer)) (values x :method)))", "(1 :METHOD)"),
        ("(fmakunbound 'two)", ":UNDEFINED"),
        ("(compile 'two)", "(1 (1))"),
        ("(let ((old #'two)) (setf (symbol-function 'two) (lambda (x) (multiple-value-bind (a b) (funcall old x) (values b a)))))", "((1) 1)"),
        ("(defun other (x) (values x :other)) (setf (symbol-function 'two) #'other)", "(1 :OTHER)"),
    ],
)  # fmt: skip
def test_another_function_is_seen_at_once(lisp, change, answer):
    lisp(TWO + "(defun bound () (handler-case (multiple-value-bind (a b) (two 1) (list a b)) (undefined-function () :undefined)))")
    assert lisp("(bound)") == "(1 (1))"
    lisp(change)
    assert lisp("(bound)") == answer
    lisp(TWO)
    assert lisp("(bound)") == "(1 (1))"


def test_a_trace_is_seen(lisp):
    lisp(TWO + "(defun bound () (multiple-value-bind (a b) (two 1) (list a b))) (trace two) (defvar *shown* (make-string-output-stream))")
    assert lisp("(let ((*trace-output* *shown*)) (bound))") == "(1 (1))"
    assert "returned 1 (1)" in lisp.value("(get-output-stream-string *shown*)")
    lisp(TWO)
    lisp("(let ((*trace-output* *shown*)) (bound)) (untrace two)")
    assert "returned 1 (1)" in lisp.value("(get-output-stream-string *shown*)")
    assert lisp("(let ((*trace-output* *shown*)) (bound))") == "(1 (1))"
    assert lisp.value("(get-output-stream-string *shown*)") == ""


def test_a_function_of_python_around_it_is_called(lisp):
    lisp(TWO + "(defun bound () (multiple-value-bind (a b) (two 1) (list a b)))")
    calls, two = [], lisp.value("'two")

    def around(function):
        @functools.wraps(function)
        def call(*arguments):
            calls.append(arguments)
            return function(*arguments)

        return call

    two.function = around(two.function)
    two.function_changed()
    assert lisp("(bound)") == "(1 (1))" and calls == [(1,)]


def test_local_functions_and_declarations(lisp):
    lisp(TWO)
    assert lisp("(flet ((two (x) (values :local x))) (multiple-value-bind (a b) (two 1) (list a b)))") == "(:LOCAL 1)"
    assert lisp("(labels ((two (x) (values :local x))) (multiple-value-bind (a b) (two 1) (list a b)))") == "(:LOCAL 1)"
    assert lisp("(macrolet ((two (x) `(values :macro ,x))) (multiple-value-bind (a b) (two 1) (list a b)))") == "(:MACRO 1)"
    assert lisp("(locally (declare (notinline two)) (multiple-value-bind (a b) (two 1) (list a b)))") == "(1 (1))"


def test_wrong_calls_and_errors_are_told_as_of_any_call(lisp):
    lisp("(defun two (x y) (values (car x) y))")
    for arguments in ("1", "1 2 3", "1 2"):
        lisp(f"(defun bound () (multiple-value-bind (a b) (two {arguments}) (list a b)))")
        lisp(f"(defun called () (two {arguments}))")
        told = lisp("(handler-case (bound) (error (c) (list (type-of c) (princ-to-string c))))")
        assert told == lisp("(handler-case (called) (error (c) (list (type-of c) (princ-to-string c))))")


def test_a_backtrace_has_the_function_once(lisp):
    lisp("(defun two (x) (values (car x) (cdr x))) (defun bound () (multiple-value-bind (a b) (two 1) (list a b)))")
    shown = lisp.value(
        "(catch 'done (handler-bind ((error (lambda (c) c (throw 'done (with-output-to-string (s) (sb-debug:print-backtrace :stream s))))))"
        " (bound)))"
    )
    assert shown.upper().count("TWO") == 1 and shown.upper().count("BOUND") == 1


def test_the_python_that_is_shown_is_that_of_the_function(lisp):
    lisp(TWO)
    assert "MultipleValues" in lisp("(with-output-to-string (*standard-output*) (disassemble 'two))")


def test_a_kept_file_binds_several_values(lisp, tmp_path):
    path = tmp_path / "kept.lisp"
    path.write_text(TWO + "\n(defun bound () (multiple-value-bind (a b) (two 1) (list a b)))\n")
    lisp(f'(load (compile-file "{path}"))')
    assert lisp("(bound)") == "(1 (1))"
    lisp(f'(load (compile-file "{path}"))')
    assert lisp("(progn (defun two (x) (values :new x)) (bound))") == "(:NEW 1)"
