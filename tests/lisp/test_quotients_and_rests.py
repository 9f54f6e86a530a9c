"""Both values of ``floor`` and ``truncate``, and ``nth-value``: in place they are what the functions give."""

from itertools import count

import pytest

from lisp_text import LispText

_numbers = count(1)
NUMBERS = ["0", "7", "-7", "6", "12345678901234567890123", "7/2", "-2.5", "7.5d0", "1e30"]
DIVISORS = ["1", "2", "-2", "3", "10", "12345678901234567890", "1/3", "2.5", "-2.5d0"]


@pytest.fixture(scope="module")
def lisp(module_session):
    name = f"QUOTIENTS-{next(_numbers)}"
    return LispText(module_session, f"(defpackage :{name} (:use :cl)) (in-package :{name})")


@pytest.fixture(scope="module")
def module_session():
    from cramhy_runtime.repl.session import Session

    return Session(time="virtual", turtlesim=False)


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("name", ["floor", "truncate", "ceiling", "round"])
def test_both_values_are_those_of_the_function(lisp, name):
    lisp(f"(defun any (x y) (multiple-value-bind (q r) ({name} x y) (list q r)))")
    lisp(f"(defun whole (x y) (declare (fixnum x y)) (multiple-value-bind (q r) ({name} x y) (list q r)))")
    lisp(f"(defun called (x y) (multiple-value-list (funcall #'{name} x y)))")
    for divisor in DIVISORS:
        lisp(f"(defun by (x) (multiple-value-bind (q r) ({name} x {divisor}) (list q r)))")
        lisp(f"(defun rest-of (x) (list ({name} x {divisor}) (nth-value 0 ({name} x {divisor})) (nth-value 1 ({name} x {divisor}))))")
        for number in NUMBERS:
            expected = lisp(f"(called {number} {divisor})")
            assert lisp(f"(any {number} {divisor})") == expected
            assert lisp(f"(by {number})") == expected
            quotient, rest = expected.strip("()").split(" ", 1)
            assert lisp(f"(rest-of {number})") == f"({quotient} {quotient} {rest})"
            if {number, divisor} <= {"0", "7", "-7", "6", "1", "2", "-2", "3", "10"}:
                assert lisp(f"(whole {number} {divisor})") == expected


@pytest.mark.parametrize("name", ["floor", "truncate"])
@pytest.mark.parametrize("arguments", ["1 0", "'a 2", "1 'b", "nil nil", "1.5 0", "#c(1 2) 2"])
def test_what_cannot_be_divided_is_told_alike(lisp, name, arguments):
    lisp(f"(defun any (x y) (multiple-value-bind (q r) ({name} x y) (list q r))) (defun called (x y) (funcall #'{name} x y))")
    told = "(handler-case (~ %) (error (c) (list (type-of c) (princ-to-string c))))".replace("%", arguments)
    assert lisp(told.replace("~", "any")) == lisp(told.replace("~", "called"))
    number, divisor = arguments.split(" ", 1)
    lisp(f"(defun by () (multiple-value-bind (q r) ({name} {number} {divisor}) (list q r)))")
    if " 0" in arguments:
        assert lisp("(handler-case (by) (division-by-zero () :zero))") == ":ZERO"


def test_arguments_are_evaluated_once_and_in_order(lisp):
    lisp("(defvar *log* nil) (defun note (x) (push x *log*) x)")
    for name in ("floor", "truncate"):
        for first, second in [("7", "2"), ("7", "2.0"), ("7.5d0", "2"), ("-7", "2"), ("7", "(* 2 0.5)")]:
            form = f"(multiple-value-bind (q r) ({name} (progn (note :first) {first}) (progn (note :second) {second})) (list q r))"
            assert lisp(f"(progn (setf *log* nil) {form} (reverse *log*))") == "(:FIRST :SECOND)"
    assert lisp("(let ((x 7)) (multiple-value-bind (q r) (floor x (setf x 2)) (list q r)))") == "(3 1)"
    assert lisp("(let ((x 7)) (flet ((two () (setf x 2))) (multiple-value-bind (q r) (floor x (two)) (list q r))))") == "(3 1)"


@pytest.mark.parametrize(
    ("form", "answer"),
    [
        ("(nth-value 0 (values 1 2))", "1"),
        ("(nth-value 1 (values 1 2))", "2"),
        ("(nth-value 2 (values 1 2))", "NIL"),
        ("(nth-value 4 (values 1 2 3 4 5))", "5"),
        ("(nth-value 6 (values 1 2 3 4 5 6 7))", "7"),
        ("(nth-value 1 1)", "NIL"),
        ("(nth-value 0 (values))", "NIL"),
        ("(nth-value (+ 0 1) (values 1 2))", "2"),
        ("(let ((n 1)) (nth-value n (values 1 2)))", "2"),
        ("(let ((n 1)) (nth-value n (progn (setf n 0) (values 1 2))))", "2"),
        ("(multiple-value-list (nth-value 1 (values 1 2)))", "(2)"),
        ("(handler-case (nth-value -1 (values 1 2)) (type-error () :wrong))", ":WRONG"),
        ("(handler-case (nth-value 'a (values 1 2)) (type-error () :wrong))", ":WRONG"),
        ("(let ((value 3)) (nth-value 1 (values value (1+ value))))", "4"),
        ("(let ((h (make-hash-table))) (setf (gethash 1 h) nil) (list (nth-value 1 (gethash 1 h)) (nth-value 1 (gethash 2 h))))", "(T NIL)"),
        ("(nth-value 1 (ignore-errors (error \"no\") 1))", None),
    ],
)  # fmt: skip
def test_nth_value(lisp, form, answer):
    shown = lisp(form)
    assert shown.startswith("#<SIMPLE-ERROR") if answer is None else shown == answer


FLOATS = "0.5 1.5 2.5 -0.5 -1.5 -0.0 0.49999997 8388609.0 1e30 -3.7 0.5d0 2.5d0 -0.0d0 4503599627370497.5d0 -1d300 7 7/2 -5/2".split()
DECLARED = {"": FLOATS, "single-float": [each for each in FLOATS if "." in each and "d" not in each], "double-float": FLOATS[10:15]}


@pytest.mark.soak(all_but=5)
@pytest.mark.parametrize("name", ["floor", "truncate", "ceiling", "round"])
@pytest.mark.parametrize("kind", DECLARED)
def test_the_quotient_by_one_alone_is_that_of_the_function(lisp, name, kind):
    declaration = f"(declare ({kind} x))" if kind else ""
    lisp(f"(defun alone (x) {declaration} (let ((q ({name} x))) (list q (+ ({name} x) 1))))")
    lisp(f"(defun half (x) {declaration} (nth-value 0 ({name} (* x 0.5))))")
    for number in DECLARED[kind]:
        quotient = lisp(f"(nth-value 0 (funcall #'{name} {number}))")
        assert lisp(f"(alone {number})") == f"({quotient} {int(quotient) + 1})"
        assert lisp(f"(half {number})") == lisp(f"(nth-value 0 (funcall #'{name} (funcall #'* {number} 0.5)))")


def test_the_quotient_of_an_infinity_alone_is_an_error(lisp):
    lisp("(defun endless (x) (handler-case (round x) (arithmetic-error () :none)))")
    assert lisp("(endless sb-ext:double-float-positive-infinity)") == lisp("(endless sb-ext:single-float-negative-infinity)") == ":NONE"
