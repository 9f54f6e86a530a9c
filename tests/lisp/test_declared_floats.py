"""A variable that is declared to be a float refuses what is none, or is one of another kind, wherever it is bound or assigned."""

from itertools import count

import pytest

from lisp_text import LispText

from cramhy_runtime.repl.session import Session

_numbers = count(1)
TYPES = [
    "single-float",
    "double-float",
    "float",
    "short-float",
    "(single-float 0.0 10.0)",
    "(double-float 0d0 *)",
    "(or null single-float)",
]
SHAPES = {
    "a parameter": "(lambda (y) (declare (type ~ y)) (list y))",
    "a parameter that is computed with": "(lambda (y) (declare (type ~ y)) (list (when (numberp y) (+ y y)) (when (numberp y) (* y y))))",
    "an optional parameter": "(lambda (&optional y) (declare (type ~ y)) (list y))",
    "a parameter behind another": "(lambda (y &key (z y)) (declare (type ~ y z)) (list z y))",
    "a variable of let": "(lambda (v) (let ((y v)) (declare (type ~ y)) (list y)))",
    "an assigned variable": "(lambda (v &aux (y 2.0)) (declare (type (or null float) y)) (setq y (the ~ v)) (list y))",
    "a parameter that is assigned": "(lambda (y) (declare (type ~ y)) (setq y (if (numberp y) (+ y y) y)) (list y))",
    "a local function": "(lambda (v) (flet ((f (y) (declare (type ~ y)) (list y))) (f v)))",
    "a closed over parameter": "(lambda (y) (declare (type ~ y)) (funcall (lambda () (list y))))",
}
VALUES = ["3", "3.0", "3d0", "1/2", '"s"', ":k", "nil"]


@pytest.fixture(scope="module")
def lisp():
    return LispText(Session(time="virtual", turtlesim=False), f"(defpackage :df-{(n := next(_numbers))} (:use :cl)) (in-package :df-{n})")


@pytest.mark.soak(all_but=8)
@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("kind", TYPES)
def test_a_declared_float_is_checked(lisp, kind, shape):
    lisp(
        f"(defun declared (v) (handler-case (progn (funcall {SHAPES[shape].replace('~', kind)} v) t) (type-error (e) (type-error-datum e))))"
    )
    for value in VALUES:
        fits = lisp(f"(typep {value} '{kind})") == "T"
        assert lisp(f"(declared {value})") == ("T" if fits else lisp(value))
