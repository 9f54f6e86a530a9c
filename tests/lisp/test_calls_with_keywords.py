"""Compiled calls that give keywords as Python's: whatever takes the function's place is called as Lisp calls it."""

from itertools import count

import pytest

from lisp_text import LispText

_numbers = count(1)
FUNCTIONS = """
(defun hurry (name &key (fast 1) slow) (list name fast slow))
(defun call-it (n) (list (hurry n :fast 2) (hurry n :slow (incf n) :fast (incf n)) (hurry n)))
(defstruct place (x 0 :type integer) y)
(defun place-of (x) (let ((p (make-place :y 1 :x x))) (list (place-x p) (place-y p))))
"""


@pytest.fixture
def lisp(session):
    name = f"KEYED-{next(_numbers)}"
    yield LispText(session, f"(defpackage :{name} (:use :cl)) (in-package :{name}) {FUNCTIONS}")
    session.package = "COMMON-LISP-USER"


def test_arguments_are_evaluated_in_their_order(lisp):
    assert lisp("(call-it 5)") == "((5 2 NIL) (5 7 6) (7 1 NIL))"


@pytest.mark.parametrize(
    ("change", "answer"),
    [
        ("(defun hurry (&rest all) all)", "((5 :FAST 2) (5 :SLOW 6 :FAST 7) (7))"),
        ("(defun hurry (name &key ((:fast quick) 9) slow other) (list name quick slow other))", "((5 2 NIL NIL) (5 7 6 NIL) (7 9 NIL NIL))"),
        ("(defun hurry (name &rest all &key fast &allow-other-keys) (list name all fast))",
         "((5 (:FAST 2) 2) (5 (:SLOW 6 :FAST 7) 7) (7 NIL NIL))"),
        ("(progn (fmakunbound 'hurry) (defgeneric hurry (name &key)) (defmethod hurry ((name integer) &key fast slow) (list fast slow)))",
         "((2 NIL) (7 6) (NIL NIL))"),
        ("(let ((fast 5)) (setf (symbol-function 'hurry) (lambda (name &key fast (slow fast)) (list name fast slow))))",
         "((5 2 2) (5 7 6) (7 NIL NIL))"),
        ("(defun hurry (name &key (fast 0 given) (slow (list fast))) (list name given slow))", "((5 T (2)) (5 T 6) (7 NIL (0)))"),
        ("(defun hurry (name &optional a b c d) (list name a b c d))",
         "((5 :FAST 2 NIL NIL) (5 :SLOW 6 :FAST 7) (7 NIL NIL NIL NIL))"),
    ],
)  # fmt: skip
def test_a_change_is_seen_at_once(lisp, change, answer):
    lisp("(call-it 1)")
    lisp(change)
    assert lisp("(call-it 5)") == answer


@pytest.mark.parametrize("change", ["(defun hurry (name &key slow) (list name slow))", "(defun hurry (name) name)", "(fmakunbound 'hurry)"])
def test_what_the_function_does_not_take_is_refused(lisp, change):
    lisp("(call-it 1)")
    lisp(change)
    assert lisp("(handler-case (call-it 5) (program-error () :wrong) (undefined-function () :undefined))") in (":WRONG", ":UNDEFINED")


def test_keywords_come_in_both_ways(lisp):
    assert lisp("(list (hurry 1 :slow 2) (apply #'hurry 1 '(:slow 2 :fast 3)) (funcall 'hurry 1 :fast 4 :fast 5))") == (
        "((1 1 2) (1 3 2) (1 4 NIL))"
    )
    assert lisp("(handler-case (hurry 1 :lazy 2) (program-error () :wrong))") == ":WRONG"
    assert lisp("(hurry 1 :lazy 2 :allow-other-keys t :slow 3)") == "(1 1 3)"
    hurry = lisp.value("#'hurry")
    assert list(hurry(1, fast=2)) == [1, 2, None]
    assert list(hurry(1, lisp.value(":slow"), 3, fast=2)) == [1, 2, 3]


def test_keys_that_are_no_keywords(lisp):
    lisp("(defun odd (&key ((nil x) 5) ((secret y) 6) ((:|Lgiven| z) 7) ((:if w) 8)) (list x y z w))")
    assert lisp("(list (odd) (odd nil 1 'secret 2) (odd :|Lgiven| 3) (odd :if 4))") == "((5 6 7 8) (1 2 7 8) (5 6 3 8) (5 6 7 4))"


def test_a_trace_is_seen(lisp):
    lisp("(call-it 1) (trace hurry) (defvar *shown* (make-string-output-stream))")
    lisp("(let ((*trace-output* *shown*)) (call-it 5)) (untrace hurry)")
    assert "HURRY 5 :FAST 2)" in lisp.value("(get-output-stream-string *shown*)")


def test_constructors_of_structures(lisp):
    assert lisp("(place-of 3)") == "(3 1)"
    assert lisp("(handler-case (place-of :x) (type-error () :wrong))") == ":WRONG"
    assert lisp("(list (place-x (make-place)) (place-y (apply #'make-place '(:y 5 :x 2))))") == "(0 5)"
    assert lisp("(handler-case (make-place :z 1) (program-error () :wrong))") == ":WRONG"
    lisp("(defstruct place (x 7) (z 8) (y 9))")
    assert lisp("(place-of 4)") == "(4 1)"
    lisp("(defun make-place (&key x y) (list x y))")
    assert lisp("(handler-case (place-of 4) (type-error (e) (type-error-datum e)))") == "(4 1)"
    assert lisp.value("(defstruct spot (x 1) y) #'make-spot")(y=3).y == 3
