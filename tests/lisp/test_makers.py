"""``make-instance`` in compiled code with a quoted class: whatever changes how instances are made is seen at once."""

from itertools import count

import pytest

from lisp_text import LispText

_numbers = count(1)
CLASSES = """
(defvar *log* nil)
(defclass base () ((b :initarg :b :initform (progn (push :b *log*) 10))))
(defclass spot (base) ((x :initarg :x :initform 0) (y :initarg :y)) (:default-initargs :y (progn (push :y *log*) 5)))
(defun make-it (x) (make-instance 'spot :x x))
(defun parts (it) (mapcar (lambda (slot) (if (slot-boundp it slot) (slot-value it slot) :none)) '(b x y)))
(parts (make-it 1))
"""


@pytest.fixture
def lisp(session):
    name = f"MAKERS-{next(_numbers)}"
    yield LispText(session, f"(defpackage :{name} (:use :cl)) (in-package :{name}) {CLASSES}")
    session.package = "COMMON-LISP-USER"


def test_slots_are_filled_in_their_order(lisp):
    assert lisp("(setf *log* nil) (list (parts (make-it 2)) *log*)") == "((10 2 5) (:B :Y))"


@pytest.mark.parametrize(
    ("change", "then", "answer"),
    [
        ("(defclass spot (base) ((x :initarg :x) (y :initform 7) (z :initform 8)))", "(let ((s (make-it 2))) (list (parts s) (slot-value s 'z)))",
         "((10 2 7) 8)"),
        ("(defclass base () ((b :initform 11)))", "(parts (make-it 2))", "(11 2 5)"),
        ("(defmethod initialize-instance :after ((s spot) &key x) (setf (slot-value s 'y) (list x)))", "(parts (make-it 2))", "(10 2 (2))"),
        ("(defmethod shared-initialize :after ((s base) names &key) (setf (slot-value s 'b) names))", "(parts (make-it 2))", "(T 2 5)"),
        ("(defmethod make-instance ((class (eql (find-class 'spot))) &key x) (list :made x))", "(make-it 2)", "(:MADE 2)"),
        ("(progn (defclass other () ((x :initarg :x) b y)) (setf (find-class 'spot) (find-class 'other)))", "(parts (make-it 2))", "(:NONE 2 :NONE)"),
        ("(setf (find-class 'spot) nil)", "(handler-case (make-it 2) (error () :none))", ":NONE"),
        ("(defclass spot (base) ((y :initarg :x)))", "(handler-case (parts (make-it 2)) (error () :no-slot))", ":NO-SLOT"),
        ("(defclass spot (base) (x y))", "(handler-case (make-it 2) (program-error () :no-initarg))", ":NO-INITARG"),
        ("(defclass spot (base) ((x :initarg :x :allocation :class) (y :initarg :x)))", "(progn (make-it 3) (parts (make-instance 'spot)))",
         "(10 3 :NONE)"),
        ("(progn (setf (find-class 'spot) nil) (defstruct spot x))", "(spot-x (make-it 2))", "2"),
        ("(progn (setf (find-class 'spot) nil) (define-condition spot (error) ((x :initarg :x :reader at))))", "(at (make-it 2))", "2"),
    ],
)  # fmt: skip
def test_a_change_is_seen_at_once(lisp, change, then, answer):
    lisp(change)
    assert lisp(then) == answer


def test_a_method_that_goes_is_forgotten(lisp):
    lisp("(defmethod initialize-instance :after ((s spot) &key) (setf (slot-value s 'y) 1))")
    assert lisp("(parts (make-it 2))") == "(10 2 1)"
    lisp("(remove-method #'initialize-instance (find-method #'initialize-instance '(:after) '(spot)))")
    assert lisp("(parts (make-it 2))") == "(10 2 5)"


def test_odd_initargs_are_handled_as_ever(lisp):
    assert lisp("(parts (make-instance 'spot :x 1 :x 2))") == "(10 1 5)"
    assert lisp("(parts (make-instance 'spot :x 1 :z 2 :allow-other-keys t))") == "(10 1 5)"
    assert lisp("(handler-case (make-instance 'spot :z 2) (program-error () :wrong))") == ":WRONG"
    assert lisp("(handler-case (make-instance 'no-such-class :z 2) (error () :none))") == ":NONE"


def test_a_trace_is_seen(lisp):
    lisp("(trace make-instance) (defvar *shown* (make-string-output-stream))")
    lisp("(let ((*trace-output* *shown*)) (make-it 5)) (untrace make-instance)")
    assert "MAKE-INSTANCE SPOT :X 5)" in lisp.value("(get-output-stream-string *shown*)")


def test_a_kept_file_makes_instances(lisp, tmp_path):
    path = tmp_path / "kept.lisp"
    path.write_text("(defclass kept () ((x :initarg :x :reader kept-x)))\n(defun from-file (x) (kept-x (make-instance 'kept :x x)))\n")
    lisp(f'(load (compile-file "{path}"))')
    assert lisp("(from-file 3)") == "3"
