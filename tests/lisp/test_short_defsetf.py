"""A short ``defsetf`` whose updater is a macro gets the forms as they stand, as on SBCL; modify macros evaluate each form once."""

from __future__ import annotations

import pytest
from lisp_text import LispText

PRELUDE = """
(defpackage :short-defsetf (:use :cl))
(in-package :short-defsetf)
(defvar *table* (make-hash-table))
(defparameter *notes* nil)
(defun note (x) (setf *notes* (append *notes* (list x))) x)
(defun entry (key) (gethash key *table*))
(defmacro put-quoted (key value) `(progn (setf (gethash ',key *table*) ,value)))
(defsetf entry put-quoted)
(defun store (key value) (setf (gethash key *table*) value))
(defun plain (key) (gethash key *table*))
(defsetf plain store)
(defmacro later-store (key value) `(store ,key ,value))
(defun later (key) (gethash key *table*))
(defsetf later later-store)
"""


@pytest.fixture
def lisp(session):
    session.package = "CL-USER"
    return LispText(session, PRELUDE)


@pytest.mark.soak(all_but=3)
@pytest.mark.parametrize(
    ("form", "value"),
    [
        ("(progn (setf (entry a) 4) (values (gethash 'a *table*)))", "4"),
        ("(progn (setf (entry a) 4 (entry b) 5) (list (gethash 'a *table*) (gethash 'b *table*)))", "(4 5)"),
        ("(setf (entry c) 9)", "9"),
        ("(progn (setf (plain (note 'd)) (note 3)) (list *notes* (plain 'd)))", "((D 3) 3)"),
        ("(progn (setf (plain 'd) 1) (incf (plain (note 'd))) (list *notes* (plain 'd)))", "((D) 2)"),
        ("(progn (setf (later 'e) nil) (push (note 1) (later (note 'e))) (list *notes* (later 'e)))", "((1 E) (1))"),
        ("(let ((n 0)) (setf (later (incf n)) (incf n)) (list n (later 1)))", "(2 2)"),
        ("(let ((x 'f)) (psetf (later x) 1 x 'g) (list x (later 'f)))", "(G 1)"),
    ],
)
def test_setf(lisp, form, value):
    assert lisp(form) == value
