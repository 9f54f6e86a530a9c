"""Projection, occasions and episodes are tested as users meet them: in Lisp text, in virtual time, on both back ends."""

import gc
import io
import itertools
import re

import pytest
from systems import ONE_BACKEND
from cramhy_runtime.session import Image
from lisp_text import LispLine

from cramhy_runtime.session import boot
from cramhy_runtime.repl.console import report
from cramhy_runtime.repl.session import Session

boot()

PRELUDE = """
(defpackage {name} (:use :cpl :cram-projection))
(in-package {name})
(defvar *notes* nil)
(defun note (&rest things) (setf *notes* (append *notes* (list (if (rest things) things (first things))))))
(defun notes () (prog1 *notes* (setf *notes* nil)))
(defmacro warnings-of (&body body)
  `(let ((texts nil))
     (handler-bind ((warning (lambda (w) (push (princ-to-string w) texts) (muffle-warning w)))) ,@body)
     (reverse texts)))
"""
_numbers = itertools.count(1)


class Lisp(LispLine):
    """``lisp(text)``: the values of the last form of ``text``, printed on one line. Each test has a package of its own.

    In the text, ``(note x)`` adds to a list and ``(notes)`` gives and empties it; ``(warnings-of form...)`` are texts of warnings.
    """

    name = "<repl>"

    def __init__(self, backend):
        super().__init__(
            Session(time="virtual", turtlesim=False, backend=backend, time_limit=3600),
            PRELUDE.format(name=f"PROJECTION-TEST-{next(_numbers)}"),
        )

    def __call__(self, text):
        return re.sub(r"\{[0-9A-F]+\}", "{}", super().__call__(text))

    def shown_error(self, text):
        """What the user is shown of the condition that ``text`` ends with."""
        written = io.StringIO()
        report(self.condition(text), file=written)
        return written.getvalue()


@pytest.fixture(scope="module", autouse=True)
def no_fluents_of_other_files():
    """Fluents that nobody holds any more are traced until they are collected, and may hold objects of classes that were taken back."""
    gc.collect()


@pytest.fixture(params=ONE_BACKEND)
def lisp(request, monkeypatch, tmp_path):
    """What a test defines for all (task variables, environments, fact groups, facts) is forgotten after it."""
    monkeypatch.chdir(tmp_path)
    with Image(as_now=True):
        yield Lisp(request.param)
