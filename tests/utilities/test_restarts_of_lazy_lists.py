"""The functions of lazy lists offer the restarts of ``lazy-list`` to the functions that they call: ``:rest`` and ``:finish`` (prolog.md 13)."""

from __future__ import annotations

import pytest
from lisp_text import LispText

PRELUDE = """
(defpackage :restarts-of-lazy-lists (:use :cl :cut))
(in-package :restarts-of-lazy-lists)
(defmacro with-restart-at-three (name values &body body)
  `(handler-bind ((error (lambda (problem) (declare (ignore problem)) (invoke-restart ',name ,@values))))
     (force-ll (progn ,@body))))
(defun checked (x) (if (= x 3) (error "three") x))
"""


@pytest.fixture
def lisp():
    from cramhy_runtime.repl.session import Session

    return LispText(Session(time="virtual", turtlesim=False), PRELUDE)


@pytest.mark.soak(all_but=2)
@pytest.mark.parametrize(
    ("form", "value"),
    [
        ("(with-restart-at-three :rest ('(:a :b)) (lazy-mapcar #'checked '(1 2 3 4)))", "(1 2 :A :B)"),
        ("(with-restart-at-three :rest (nil) (lazy-mapcar #'checked '(1 2 3 4)))", "(1 2)"),
        ("(with-restart-at-three :rest ('(:a :b)) (lazy-mapcan (lambda (x) (list (checked x) x)) '(1 2 3 4)))", "(1 1 2 2 :A :B)"),
        ("(with-restart-at-three :rest ('(:a)) (lazy-filter (lambda (x) (oddp (checked x))) '(1 2 3 4)))", "(1 :A)"),
        ("(with-restart-at-three :finish (9) (lazy-mapcar #'checked '(1 2 3 4)))", "(1 2 9)"),
        ("(with-restart-at-three :finish () (lazy-mapcar #'checked '(1 2 3 4)))", "(1 2)"),
        ("(force-ll (lazy-mapcar #'checked '(1 2 4)))", "(1 2 4)"),
        ("(handler-case (force-ll (lazy-mapcar #'checked '(1 3))) (error (e) (princ-to-string e)))", '"three"'),
    ],
)
def test_restarts(lisp, form, value):
    assert lisp(form) == value
