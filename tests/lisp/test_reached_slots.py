"""Compiled code that takes a slot of an object itself, where an accessor is called: whatever changes the accessor is seen at once."""

from itertools import count

import pytest

from lisp_text import LispText

_numbers = count(1)
CLASSES = """
(defclass spot () ((x :initarg :x :accessor spot-x)))
(defclass corner (spot) ())
(defstruct box side)
(defun read-it (spot) (spot-x spot))
(defun write-it (spot new) (setf (spot-x spot) new))
(defun write-for-effect (spot new) (setf (spot-x spot) new) nil)
(defun side-of (box) (box-side box))
(defvar *spot* (make-instance 'spot :x 1))
(list (read-it *spot*) (read-it (make-instance 'corner :x 2)) (write-it *spot* 3) (write-for-effect *spot* 4) (read-it *spot*))
"""


@pytest.fixture
def lisp(session):
    """Lisp text in a package of its own."""
    name = f"REACHED-{next(_numbers)}"
    yield LispText(session, f"(defpackage :{name} (:use :cl)) (in-package :{name})")
    session.package = "COMMON-LISP-USER"


@pytest.fixture
def classes(lisp):
    lisp(CLASSES)
    return lisp


def test_a_slot_is_read_and_written(lisp):
    assert lisp(CLASSES) == "(1 2 3 NIL 4)"


@pytest.mark.parametrize(
    ("change", "then", "answer"),
    [
        ("(defmethod spot-x :around ((s spot)) (list :around (call-next-method)))", "(read-it *spot*)", "(:AROUND 4)"),
        ("(defmethod spot-x ((s corner)) :corner)", "(list (read-it *spot*) (read-it (make-instance 'corner :x 2)))", "(4 :CORNER)"),
        ("(defmethod spot-x ((s (eql *spot*))) :this-one)", "(read-it *spot*)", ":THIS-ONE"),
        ("(defmethod (setf spot-x) :after (new (s spot)) (setf (slot-value s 'x) (list new)))", "(progn (write-it *spot* 5) (read-it *spot*))", "(5)"),
        ("(defmethod (setf spot-x) (new (s spot)) :other)", "(list (write-it *spot* 5) (read-it *spot*))", "(:OTHER 4)"),
        ("(progn (fmakunbound 'spot-x) (defun spot-x (s) s :plain))", "(read-it *spot*)", ":PLAIN"),
        ("(setf (symbol-function 'spot-x) (lambda (s) s :set))", "(read-it *spot*)", ":SET"),
        ("(defclass spot () ((x :initarg :x :accessor spot-x :allocation :class)))", "(progn (write-it *spot* 6) (read-it (make-instance 'spot)))", "6"),
        ("(defclass spot () ((y :initform 7) (x :initarg :x :accessor spot-x)))", "(list (read-it *spot*) (slot-value *spot* 'y))", "(4 7)"),
        ("(defclass spot () ((y :initform 7 :accessor spot-x)))", "(read-it *spot*)", "7"),
        ("(remove-method #'spot-x (find-method #'spot-x nil '(spot)))", "(handler-case (read-it *spot*) (error () :none))", ":NONE"),
        ("(slot-makunbound *spot* 'x)", "(handler-case (read-it *spot*) (unbound-slot () :unbound))", ":UNBOUND"),
        ("(defclass other () ((x :initform 8) (z :initform 9 :reader spot-x)))", "(read-it (change-class *spot* 'other))", "9"),
        ("(defstruct box lid side)", "(handler-case (side-of (make-box :side 3 :lid 2)) (error () :wrong))", "3"),
        ("(defun box-side (box) box :function)", "(side-of (make-box :side 3))", ":FUNCTION"),
        ("(defstruct (crate (:include box)) top)", "(side-of (make-crate :side 3))", "3"),
    ],
)  # fmt: skip
def test_a_change_is_seen_at_once(classes, change, then, answer):
    classes(change)
    assert classes(then).splitlines()[-1] == answer


def test_a_trace_is_seen(classes):
    classes("(trace spot-x) (defvar *shown* (make-string-output-stream))")
    seen = '(let ((*trace-output* *shown*)) (read-it *spot*)) (search "returned 4" (get-output-stream-string *shown*))'
    assert classes(seen) != "NIL"
    assert classes("(untrace spot-x)" + seen) == "NIL"


def test_what_is_no_such_object_is_refused(classes):
    assert classes("(handler-case (read-it 3) (error () :refused))") == ":REFUSED"
    assert classes("(handler-case (write-it 3 1) (error () :refused))") == ":REFUSED"
