import itertools

import pytest
from lisp_text import LispText

_numbers = itertools.count(1)
PRELUDE = """(defpackage {name} (:use :cl :cl-tf))
(in-package {name})
(defun vec (x y z) (make-3d-vector x y z))
(defun still () (make-identity-rotation))
(defun numbers (vector) (list (x vector) (y vector) (z vector)))
(defvar *tf* (make-instance 'transformer))
(defun at (parent child stamp x &optional (y 0) (rotation (still)))
  (make-transform-stamped parent child stamp (vec x y 0) rotation))
(defun told (&rest arguments) (set-transform *tf* (apply #'at arguments)))
(defun cached (target source &optional time)
  (lookup-cached-transform *tf* :target-frame target :source-frame source :time time))"""
EXAMPLE = """(told "map" "base" 1.0 1) (told "map" "base" 2.0 2) (told "base" "tool" 1.0 0 1) (told "base" "tool" 2.0 0 2)"""


@pytest.fixture
def lisp(session):
    """Text in a package of its own that uses CL-TF, with an empty transformer in ``*tf*``.

    ``(told parent child stamp x [y rotation])`` stores a transform in it, ``(cached target source [time])`` asks it at once.
    """
    return LispText(session, PRELUDE.format(name=f"FRAMES-{next(_numbers)}"))


@pytest.fixture
def example(lisp):
    """The same with the example of cl-transforms.md 7 in the buffer."""
    lisp(EXAMPLE)
    return lisp


@pytest.fixture
def node(lisp):
    """The same with a running ROS node."""
    lisp('(roslisp:start-ros-node "frames")')
    return lisp
