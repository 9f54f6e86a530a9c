"""Compiled code that finds the methods of a call itself: whatever changes a generic function is seen at once."""

from itertools import count

import pytest

from lisp_text import LispText

_numbers = count(1)
FUNCTIONS = """
(defclass base () ()) (defclass arm (base) ())
(defgeneric side (arm)) (defmethod side ((arm base)) :base)
(defgeneric move-to (arm place)) (defmethod move-to ((arm base) place) (list :moved place))
(defvar *arm* (make-instance 'arm))
(defun side-of (it) (side it))
(defun moved (it place) (move-to it place))
(list (side-of *arm*) (moved *arm* 1))
"""


@pytest.fixture
def lisp(session):
    name = f"GENERIC-CALLS-{next(_numbers)}"
    yield LispText(session, f"(defpackage :{name} (:use :cl)) (in-package :{name}) {FUNCTIONS}")
    session.package = "COMMON-LISP-USER"


@pytest.mark.parametrize(
    ("change", "answer"),
    [
        ("nil", "(:BASE (:MOVED 1))"),
        ("(defmethod side ((arm arm)) (list :arm (call-next-method)))", "((:ARM :BASE) (:MOVED 1))"),
        ("(defmethod side ((arm (eql *arm*))) :this-arm)", "(:THIS-ARM (:MOVED 1))"),
        ("(defmethod side :around ((arm base)) (list :around (call-next-method)))", "((:AROUND :BASE) (:MOVED 1))"),
        ("(defmethod move-to ((arm base) (place integer)) :integer)", "(:BASE :INTEGER)"),
        ("(defmethod move-to :before ((arm arm) place) (setf (symbol-function 'side) (lambda (arm) arm :lambda)))", "(:LAMBDA (:MOVED 1))"),
        ("(defgeneric side (arm) (:method ((arm base)) :again))", "(:AGAIN (:MOVED 1))"),
        ("(progn (fmakunbound 'side) (defgeneric side (arm) (:method-combination list)) (defmethod side list ((arm base)) 1))", "((1) (:MOVED 1))"),
        ("(progn (fmakunbound 'side) (defgeneric side (arm &optional more)) (defmethod side ((arm base) &optional more) (list more)))",
         "((NIL) (:MOVED 1))"),
        ("(defun moved (it place) (list it place) :plain)", "(:BASE :PLAIN)"),
        ("(progn (defclass other () ()) (defmethod side ((arm other)) :other) (change-class *arm* 'other) (defmethod move-to ((arm other) place) place))",
         "(:OTHER 1)"),
        ("(progn (defmethod side ((arm standard-object)) :object) (remove-method #'side (find-method #'side nil '(base))))",
         "(:OBJECT (:MOVED 1))"),
        ("(progn (defclass new-base () ()) (defmethod side ((arm new-base)) :new) (defclass arm (new-base base) ()))", "(:NEW (:MOVED 1))"),
    ],
)  # fmt: skip
def test_a_change_is_seen_at_once(lisp, change, answer):
    lisp(change)
    order = "(nreverse (list (moved *arm* 1) (side-of *arm*)))" if ":before" in change else "(list (side-of *arm*) (moved *arm* 1))"
    assert lisp(order) == answer


def test_what_has_no_method_is_refused(lisp):
    assert lisp("(handler-case (side-of 1) (error () :refused))") == ":REFUSED"
    lisp("(remove-method #'side (find-method #'side nil '(base)))")
    assert lisp("(handler-case (side-of *arm*) (error () :refused))") == ":REFUSED"


def test_a_trace_is_seen(lisp):
    lisp("(trace side) (defvar *shown* (make-string-output-stream))")
    lisp("(let ((*trace-output* *shown*)) (side-of *arm*)) (untrace side)")
    assert "SIDE returned :BASE" in lisp.value("(get-output-stream-string *shown*)")


@pytest.mark.parametrize(
    "call", ["(call-next-method)", "(funcall #'call-next-method)", "(call-next-method arm 7)", "(apply #'call-next-method nil)"]
)
def test_the_next_method_gets_what_this_one_got(lisp, call):
    lisp(f"(defmethod move-to ((arm arm) place) (setf place (list place)) (list (next-method-p) {call} place))")
    assert lisp("(moved *arm* 1)") == f"(T (:MOVED {7 if '7' in call else 1}) (1))"
    lisp("(remove-method #'move-to (find-method #'move-to nil '(base t)))")
    assert lisp("(handler-case (moved *arm* 1) (error () :none))") == ":NONE"


def test_methods_on_the_class_of_conditions_classes(lisp):
    """A class of conditions is an instance of SB-PCL::CONDITION-CLASS, be it ours or a user's, and no standard class, as on SBCL."""
    lisp("(define-condition lost (error) ((place :initarg :place)))")
    lisp("(defclass thing () ()) (defstruct part) (defgeneric kind (object class))")
    lisp("(defmethod kind (object (class standard-class)) :standard)")
    lisp("(defmethod kind (object (class structure-class)) :structure)")
    kinds = "(mapcar (lambda (name) (ignore-errors (kind 1 (find-class name)))) '(lost division-by-zero thing error part integer warning))"
    lisp("(defmethod kind (object (class sb-pcl::condition-class)) :condition)")
    assert lisp(kinds) == "(:CONDITION :CONDITION :STANDARD :CONDITION :STRUCTURE NIL :CONDITION)"
    lisp("(defmethod kind :around (object (class class)) (list (call-next-method)))")
    assert lisp(kinds) == "((:CONDITION) (:CONDITION) (:STANDARD) (:CONDITION) (:STRUCTURE) NIL (:CONDITION))"
    lisp("(defmethod kind ((object fixnum) (class sb-pcl::condition-class)) (list :small (call-next-method object class)))")
    assert lisp("(list (kind 1 (find-class 'error)) (kind (expt 2 70) (find-class 'lost)))") == "(((:SMALL :CONDITION)) (:CONDITION))"
