"""Slots without a value: whichever way an instance comes to lack one, reading it is Lisp's error, in compiled code and from Python.

A class whose instances all have values keeps nothing for its slots, because then Python reads them quickly.
"""

from itertools import count

import pytest

from lisp_text import LispText

_numbers = count(1)
CLASSES = """
(defclass base () ((b :initarg :b :initform 10 :accessor b-of)))
(defclass spot (base) ((x :initarg :x :initform 0 :accessor x-of)))
(defclass half (base) ((x :initarg :x :accessor x-of)))
(defun read-x (s) (x-of s))
(defun named-x (s) (slot-value s 'x))
(defun told (function thing)
  (handler-bind ((unbound-slot (lambda (c) (use-value (list :unbound (cell-error-name c)) c)))) (funcall function thing)))
(defun answers (thing) (list (told #'read-x thing) (told #'named-x thing) (slot-boundp thing 'x)))
(defvar *s* (make-instance 'spot :x 1))
(list (answers *s*) (answers (make-instance 'spot)) (answers (make-instance 'half :x 2)))
"""
UNBOUND = "((:UNBOUND X) (:UNBOUND X) NIL)"


@pytest.fixture
def lisp(session):
    name = f"UNBOUND-{next(_numbers)}"
    yield LispText(session, f"(defpackage :{name} (:use :cl)) (in-package :{name}) {CLASSES}")
    session.package = "COMMON-LISP-USER"


@pytest.mark.soak(all_but=4)
@pytest.mark.parametrize(
    ("before", "instance"),
    [
        ("", "(make-instance 'half)"),
        ("", "(let ((name 'half)) (make-instance name))"),
        ("(dotimes (i 9) (make-instance 'half :x i))", "(make-instance 'half)"),
        ("(defun half () (make-instance 'half)) (half)", "(half)"),
        ("(defclass part (half) ())", "(make-instance 'part)"),
        ("(defclass part (half) ((x :initform 3)))", "(make-instance 'half)"),
        ("(defclass both (base) ((x :initarg :x :accessor x-of)) (:default-initargs :x 5))", "(slot-makunbound (make-instance 'both) 'x)"),
        ("", "(slot-makunbound *s* 'x)"),
        ("", "(allocate-instance (find-class 'spot))"),
        ("(defclass spot (base) ((x :initarg :x :accessor x-of)))", "(make-instance 'spot)"),
        ("(defvar *old* (make-instance 'base)) (defclass base () ((x :accessor x-of)))", "*old*"),
        ("(defclass later (base) ()) (defvar *old* (make-instance 'later)) (defclass later (base) ((x :accessor x-of)))", "*old*"),
        ("(defclass later (base) ()) (defvar *old* (make-instance 'later)) (defclass base () ((x :accessor x-of)))", "*old*"),
        ("(defvar *old* (make-instance 'half)) (defclass half (base) ((x :accessor x-of)))", "*old*"),
        ("(defclass up () ((x))) (defclass low (up) ()) (defvar *old* (make-instance 'low)) (defclass up () ()) (defclass low (up) ((x :accessor x-of)))",
         "*old*"),
        ("(defclass shared () ((x :allocation :class :initform 1))) (defvar *old* (make-instance 'shared))"
         " (defclass shared () ((x :accessor x-of)))", "*old*"),
        ("(defclass shared () ((x :allocation :class :initform 1))) (defclass own (shared) ((x :allocation :instance :accessor x-of)))"
         " (defmethod shared-initialize ((s own) names &key) s)", "(make-instance 'own)"),
        ("", "(change-class (make-instance 'base) 'half)"),
        ("(defmethod update-instance-for-different-class ((a base) (b spot) &key) nil)", "(change-class (make-instance 'base) 'spot)"),
        ("(defmethod shared-initialize ((s spot) names &key) s)", "(make-instance 'spot)"),
        ("(defmethod initialize-instance ((s spot) &key) s)", "(make-instance 'spot :x 1)"),
        ("(defmethod initialize-instance :after ((s spot) &key) (slot-makunbound s 'x))", "(make-instance 'spot :x 1)"),
        ("(defmethod initialize-instance :after ((s half) &key) s)", "(make-instance 'half)"),
    ],
)  # fmt: skip
def test_a_missing_value_is_an_unbound_slot(lisp, before, instance):
    lisp(f"{before} (defvar *it* nil)")
    assert lisp(f"(answers (setf *it* {instance}))") == UNBOUND
    assert lisp("(setf (slot-value *it* 'x) 7) (answers *it*)").endswith("(7 7 T)")
    assert lisp("(slot-makunbound *it* 'x) (answers *it*)").endswith(UNBOUND)


@pytest.mark.parametrize(
    "method",
    [
        "(defmethod initialize-instance :before ((s spot) &key) (push (answers s) *seen*))",
        "(defmethod shared-initialize :around ((s spot) names &key) (push (answers s) *seen*) (call-next-method))",
        "(defmethod initialize-instance :around ((s spot) &key) (push (answers s) *seen*) (call-next-method))",
    ],
)
def test_a_method_sees_slots_that_are_not_filled_yet(lisp, method):
    lisp(f"(defvar *seen* nil) {method}")
    assert lisp("(list (answers (make-instance 'spot :x 4)) *seen*)") == f"((4 4 T) ({UNBOUND}))"


def test_an_initform_that_fails_leaves_a_class_as_it_was(lisp):
    lisp('(defclass odd () ((x :initform (error "no") :initarg :x :accessor x-of)))')
    assert lisp("(list (handler-case (make-instance 'odd) (error () :failed)) (answers (make-instance 'odd :x 3)))") == "(:FAILED (3 3 T))"


def test_use_value_and_store_value_and_the_method_slot_unbound(lisp):
    assert lisp("(handler-bind ((unbound-slot (lambda (c) (use-value 5 c)))) (read-x (make-instance 'half)))") == "5"
    stored = "(let ((h (make-instance 'half))) (handler-bind ((unbound-slot (lambda (c) (store-value 6 c)))) (read-x h)) (read-x h))"
    assert lisp(stored) == "6"
    lisp("(defmethod slot-unbound (class (h half) name) (list :none name))")
    assert lisp("(read-x (make-instance 'half))") == "(:NONE X)"


def test_python_sees_the_same(lisp, session):
    spot, half = lisp.value("*s*"), lisp.value("(make-instance 'half)")
    assert spot.x == 1
    with pytest.raises(Exception, match="slot .*X is unbound"):
        half.x  # noqa: B018
    del spot.x
    assert lisp("(handler-case (read-x *s*) (unbound-slot (c) (cell-error-name c)))") == "X"
    assert lisp("(list (slot-boundp *s* 'x) (told #'named-x *s*))") == "(NIL (:UNBOUND X))"


def test_a_class_that_python_wrote_makes_instances_as_it_likes(lisp):
    class Rover(lisp.value("(find-class 'spot)")):
        def __init__(self):
            pass

    lisp.value("#'answers")
    rover = Rover()
    assert [repr(part) for part in lisp.value("#'answers")(rover)][2] == "None"
    with pytest.raises(Exception, match="slot .*X is unbound"):
        rover.x  # noqa: B018


@pytest.mark.parametrize("name", ["spot", "base"])
def test_classes_whose_instances_have_values_keep_nothing_for_their_slots(lisp, name):
    lisp("(defclass spot (base) ((x :initarg :x :initform 0 :accessor x-of))) (dotimes (i 9) (make-instance 'spot) (make-instance 'base))")
    assert {"x", "b"}.isdisjoint(vars(lisp.value(f"(find-class '{name})")))
    assert "x" in vars(lisp.value("(progn (make-instance 'half) (find-class 'half))"))


def test_a_slot_of_instances_hides_the_shared_one_of_a_superclass(lisp):
    lisp("(defclass shared () ((x :allocation :class :initform 1 :accessor x-of)))")
    lisp("(defclass own (shared) ((x :allocation :instance :initarg :x)))")
    assert lisp("(mapcar #'read-x (list (make-instance 'own :x 2) (make-instance 'own :x 3) (make-instance 'shared)))") == "(2 3 1)"
