"""The laws are tested as users meet them: in Lisp text, in a package that uses CPL, on both back ends, in virtual time."""

import itertools
import re

import pytest
from not_in_hy import NOT_IN_HY
from plain_hy import PlainHy
from systems import BACKENDS

from cramhy_runtime import kernel
from cramhy_runtime.session import Image
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string, princ_to_string
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


@pytest.fixture(params=BACKENDS, autouse=True)
def fresh_kernel(request):
    with Image(as_now=True):
        yield kernel.start(clock="virtual", backend=request.param, time_limit=3600)


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


IN_HY = """
(setv *notes* None)
(defn note [#* things]
  (global *notes*)
  (setv *notes* (cl.append *notes* (cl.list (if (= (len things) 1) (get things 0) (cl.list #* things)))))
  *notes*)
(defn start [function [name "child"]] (cl.make-instance (lisp task) (lisp :name) name (lisp :thread-fun) function))
(defn later [task] (value (status task)))
(defmacro in-child [#* body] `(start (fn [] ~@body)))
"""


FOR_THE_SOAK = {("threads", "hy"), ("greenlet", "lisp")}
"""A law that is told in both languages runs in Lisp on threads and in Hy on greenlet. The two other pairs are for `make soak`."""


def pytest_itemcollected(item):
    parameters = getattr(getattr(item, "callspec", None), "params", {})
    language, backend = parameters.get("lisp") or parameters.get("plan_text"), parameters.get("fresh_kernel")
    if item.originalname in NOT_IN_HY:
        if language == "hy":
            item.add_marker(pytest.mark.skip(f"not in plain Hy: {NOT_IN_HY[item.originalname]}"))
    elif (backend, language) in FOR_THE_SOAK:
        item.add_marker(pytest.mark.soak)


@pytest.fixture(params=["lisp", "hy"])
def lisp(request):
    made = Lisp(request.getfixturevalue("fresh_kernel").backend.name)
    return made if request.param == "lisp" else PlainHy(made.session, IN_HY, ["note", "start", "later"], of_functions=["in-child"])


@pytest.fixture
def lisp_for_ten_seconds(request):
    return Lisp(request.getfixturevalue("fresh_kernel").backend.name, time_limit=10)


@pytest.fixture(params=["lisp", "hy"])
def plan_text(request, plan_text):
    if request.param == "lisp":
        return plan_text
    prelude = """
    (setv *notes* None)
    (defn note [thing] (global *notes*) (setv *notes* (cl.append *notes* (cl.list thing))) thing)
    """
    return PlainHy(plan_text.session, prelude, ["note"])
