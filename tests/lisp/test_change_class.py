"""What ``change-class`` refuses, and roots of integers in loops, as SBCL answers."""

from __future__ import annotations

import pytest
from lisp_text import LispText

PRELUDE = """
(defpackage :changing (:use :cl))
(in-package :changing)
(defclass a () ((a :initarg :a)))
(defclass b () ((b :initarg :b)))
(defmethod update-instance-for-different-class ((p number) (c number) &key &allow-other-keys) nil)
(defmethod update-instance-for-different-class :after ((p a) (c a) &key zap) zap)
(defun tried (function) (handler-case (progn (funcall function) :done) (error () :error)))
"""
BUILT_IN = "1", "#'car", "*standard-output*", "(make-hash-table)"


@pytest.fixture
def lisp(session):
    session.package = "CL-USER"
    return LispText(session, PRELUDE)


def test_initargs_are_those_of_the_new_class_and_of_methods_that_apply(lisp):
    assert lisp("(tried (lambda () (change-class (make-instance 'a) 'b :nonsense t)))") == ":ERROR"
    assert lisp("(tried (lambda () (change-class (make-instance 'a) 'b :zap t)))") == ":ERROR"
    assert lisp("(tried (lambda () (change-class (make-instance 'a) 'a :zap t)))") == ":DONE"
    assert lisp("(slot-value (change-class (make-instance 'a) 'b :b 4) 'b)") == "4"


@pytest.mark.parametrize("thing", BUILT_IN)
def test_objects_and_classes_without_slots_are_refused(lisp, thing):
    assert lisp(f"(tried (lambda () (change-class {thing} 'a)))") == ":ERROR"
    assert lisp(f"(tried (lambda () (change-class (make-instance 'a) (class-of {thing}))))") == ":ERROR"


def test_roots_of_integers_that_grow_in_a_loop_are_singles(lisp):
    assert lisp("(let ((r nil)) (do ((i 1 (1+ i))) ((> i 3)) (push (sqrt i) r)) r)") == "(1.7320508 1.4142135 1.0)"
    assert lisp("(loop for x from 1 to 3 for x2 = (* x x) collect (sqrt x2))") == "(1.0 2.0 3.0)"
