"""Projection, occasions and episodes are tested as users meet them: in Lisp text, in virtual time, on both back ends."""

import gc
import io
import itertools
import re

import pytest
from image_as_it_was import image_as_it_was
from lisp_text import LispLine

from cramhy_runtime import image
from cramhy_runtime.cpl import past_plans, task_variables
from cramhy_runtime.episodes import auto_tracing, backends, tracing
from cramhy_runtime.projection import environments
from cramhy_runtime.prolog import rete
from cramhy_runtime.repl.console import report
from cramhy_runtime.repl.session import Session

image.boot()

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
        super().__init__(Session(time="virtual", turtlesim=False, backend=backend, time_limit=3600),
                         PRELUDE.format(name=f"PROJECTION-TEST-{next(_numbers)}"))

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


@pytest.fixture(params=["threads", "greenlet"])
def lisp(request, monkeypatch, tmp_path):
    """What a test defines for all (task variables, environments, fact groups, facts) is forgotten after it."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(task_variables, "_declared", dict(task_variables._declared))
    monkeypatch.setattr(environments, "_environments", {})
    monkeypatch.setattr(environments, "_special_variables", {})
    monkeypatch.setattr(auto_tracing, "_directory", None)
    monkeypatch.setattr(backends, "_stores", {})
    monkeypatch.setattr(backends, "_restores", {})
    past_plans.forget()
    with image_as_it_was():
        yield Lisp(request.param)
    rete.clear_alpha_network()
    auto_tracing.disable_auto_tracing()
    tracing.disable_fluent_tracing()
    past_plans.forget()
