"""The readers of message fields are generic functions, as genlisp makes them: classes may have accessors of their names, and methods may be added."""

from __future__ import annotations

import pytest
from lisp_text import LispText

PRELUDE = """
(defpackage :generic-readers (:use :cl :roslisp))
(in-package :generic-readers)
(defun point (x) (make-message "geometry_msgs/Point" :x x :y 4))
"""


@pytest.fixture
def lisp(session):
    session.package = "CL-USER"
    return LispText(session, PRELUDE)


def test_a_reader_is_a_generic_function(lisp):
    assert lisp("(list (typep #'geometry_msgs-msg:x 'generic-function) (functionp #'std_msgs-msg:data))") == "(T T)"
    assert (
        lisp('(handler-case (geometry_msgs-msg:x 5) (error (e) (not (null (search "no applicable method" (princ-to-string e))))))') == "T"
    )


def test_a_class_may_have_an_accessor_of_that_name(lisp):
    lisp("(defclass place () ((x :initarg :x :accessor geometry_msgs-msg:x)))")
    assert lisp(
        "(let ((p (make-instance 'place :x 1))) (incf (geometry_msgs-msg:x p)) (list (geometry_msgs-msg:x p) (geometry_msgs-msg:x (point 3))))"
    ) == ("(2 3)")
    assert "no applicable method" in lisp.error("(geometry_msgs-msg:x 5)").lower()


def test_methods_may_be_added_and_call_the_next_one(lisp):
    lisp("(defmethod geometry_msgs-msg:y ((name symbol)) name)")
    lisp("(defmethod geometry_msgs-msg:y :around ((m geometry_msgs-msg:point)) (list :around (call-next-method)))")
    assert lisp("(list (geometry_msgs-msg:y 'a) (geometry_msgs-msg:y (point 1)))") == "(A (:AROUND 4))"
    assert lisp("(with-fields (y) (point 1) y)") == "4"


def test_messages_that_are_loaded_later_have_the_reader_too(lisp):
    lisp("(defmethod geometry_msgs-msg:z ((name symbol)) name)")
    assert lisp('(list (geometry_msgs-msg:z (make-message "geometry_msgs/Vector3" :z 2)) (geometry_msgs-msg:z :k))') == "(2 :K)"
    lisp("(defclass named () ((name :initarg :name :reader sensor_msgs-msg:name)))")
    assert lisp(
        '(list (sensor_msgs-msg:name (make-instance (quote named) :name 1)) (sensor_msgs-msg:name (make-message "sensor_msgs/JointState" :name #("a"))))'
    ) == ('(1 #("a"))')


def test_a_defgeneric_of_that_name_keeps_the_messages_readers(lisp):
    lisp("(defgeneric std_msgs-msg:data (thing))")
    assert lisp('(std_msgs-msg:data (make-message "std_msgs/String" :data "x"))') == '"x"'
