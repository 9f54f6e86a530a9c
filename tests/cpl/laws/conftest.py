"""The laws are tested as users meet them: in Lisp text, in a package that uses CPL, on both back ends, in virtual time."""

import itertools
import re

import pytest

from cramhy_runtime.cpl import task_variables
from cramhy_runtime.lisp.printer.printer import prin1_to_string, princ_to_string
from cramhy_runtime.repl.session import Session, condition_of

PRELUDE = """
(defpackage {name} (:use :cpl) (:import-from :cpl-impl #:name #:execute #:child-tasks #:parent-task #:list-saved-tasks
                                #:*save-tasks* #:*tasks*))
(in-package {name})
(defvar *notes* nil)
(defun note (&rest things) (setf *notes* (append *notes* (list (if (rest things) things (first things))))))
(defun start (function &optional (name "child")) (make-instance 'task :name name :thread-fun function))
(defun later (task) (value (status task)))
(defmacro in-child (&body body) `(start (lambda () ,@body)))
"""
_numbers = itertools.count(1)


class Lisp:
    """``lisp(text)``: the values of the last form of ``text``, printed. Each test has a package of its own.

    ``(note x)`` adds to the list ``*notes*``; ``(in-child form...)`` starts a child task; ``(later task)`` is its status now.
    """

    def __init__(self, backend, time_limit=3600):
        self.session = Session(time="virtual", turtlesim=False, backend=backend, time_limit=time_limit)
        self.session.evaluate_text(PRELUDE.format(name=f"LAW-{next(_numbers)}"))

    def __call__(self, text):
        return " ; ".join(" ".join(prin1_to_string(value).split()) for value in self.session.evaluate_text(text))

    def error(self, text):
        """The text of the condition that ``text`` ends with, without addresses."""
        with pytest.raises(BaseException) as problem:
            self.session.evaluate_text(text)
        return re.sub(r"\{[0-9A-F]+\}", "{}", " ".join(princ_to_string(condition_of(problem.value)).split()))


@pytest.fixture(autouse=True)
def task_variables_of_its_own(monkeypatch):
    """Task variables that a test declares are forgotten, for they would be bound in all tasks of later tests."""
    monkeypatch.setattr(task_variables, "_declared", dict(task_variables._declared))


@pytest.fixture
def lisp(request):
    return Lisp(request.getfixturevalue("fresh_kernel").backend.name)


@pytest.fixture
def lisp_for_ten_seconds(request):
    return Lisp(request.getfixturevalue("fresh_kernel").backend.name, time_limit=10)
