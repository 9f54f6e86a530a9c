import itertools

import pytest
from lisp_text import LispText

from cramhy_runtime import kernel

_numbers = itertools.count(1)
PRELUDE = """(defpackage {name} (:use :cl :cl-transforms))
(in-package {name})
(defvar *x* (make-3d-vector 1 0 0))
(defvar *y* (make-3d-vector 0 1 0))
(defvar *z* (make-3d-vector 0 0 1))
(defvar *a* (make-transform (make-3d-vector 1 2 3) (axis-angle->quaternion *z* (/ pi 2))))
(defun near (a b &optional (tolerance 1d-9))
  (flet ((numbers (thing) (if (listp thing) thing
                              (mapcar (lambda (reader) (funcall reader thing))
                                      (if (typep thing 'quaternion) '(x y z w) '(x y z))))))
    (every (lambda (p q) (< (abs (- p q)) tolerance)) (numbers a) (numbers b))))"""


@pytest.fixture(autouse=True)
def fresh_kernel():
    yield kernel.start(clock="virtual")
    kernel.stop()


@pytest.fixture
def lisp(session):
    """Text in a package of its own that uses CL-TRANSFORMS; ``(near a b)`` compares vectors, quaternions or lists of numbers."""
    return LispText(session, PRELUDE.format(name=f"GEOMETRY-{next(_numbers)}"))
