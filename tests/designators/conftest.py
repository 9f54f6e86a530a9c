"""Each test has its own virtual time, on both back ends; in Lisp text it has a package of its own, and leaves no rules behind."""

import itertools
import re


import pytest
from cramhy_runtime.session import Image
from lisp_text import LispLine
from systems import ONE_BACKEND

from cramhy_runtime import kernel
from cramhy_runtime.session import boot
from cramhy_runtime.lisp_core.data import all_values
from cramhy_runtime.repl.session import Session

boot()

PRELUDE = """
(defpackage {name} (:use :common-lisp :cram-prolog :desig :cpl-desig-supp :cut))
(in-package {name})
(defvar *notes* nil)
(defun note (thing) (setf *notes* (append *notes* (list thing))) thing)
(defun props (designator) (description designator))
(defun answers (goal) (force-ll (prolog goal)))
(defun solutions (designator)
  (loop for d = designator then (next-solution d) while d collect (reference d)))
"""
_numbers = itertools.count(1)


@pytest.fixture(params=ONE_BACKEND, autouse=True)
def fresh_kernel(request):
    with Image(as_now=True):
        yield kernel.start(clock="virtual", backend=request.param, time_limit=3600)
        kernel.stop()


class Lisp(LispLine):
    """``lisp(text)``: the values of the last form of ``text``, printed in one line. Each test has a package of its own.

    ``(note x)`` adds to the list ``*notes*``; ``(answers goal)`` are all answers of Prolog; ``(solutions d)`` the references of
    ``d`` and of all its next solutions; ``(props d)`` is its description.
    """

    def __init__(self, backend, time_limit=3600):
        super().__init__(
            Session(time="virtual", turtlesim=False, backend=backend, time_limit=time_limit),
            PRELUDE.format(name=f"DESIGNATORS-{next(_numbers)}"),
        )

    def text(self, form):
        """The string that ``form`` returns, as it is."""
        (value,) = all_values(self.session.evaluate_text(form)[-1])
        return value

    def error(self, text):
        """The text of the condition that ``text`` ends with, without addresses."""
        return re.sub(r"\{[0-9A-F]+\}", "{}", super().error(text))


@pytest.fixture
def lisp(request):
    return Lisp(request.getfixturevalue("fresh_kernel").backend.name)
