"""Process modules as users write them: Lisp text in a package of the test's own, on the back end of the test, in virtual time."""

import io
import itertools
import re

import pytest

from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string
from cramhy_runtime.repl.console import report
from cramhy_runtime.repl.session import Session, condition_of

BEGINNING = """
(defpackage {0} (:use :cpl :cpm :exe)
  (:import-from :desig #:a #:an #:the #:make-designator #:desig-prop-value #:motion-grounding #:action-grounding #:desig-prop
                       #:reference #:equate #:current-desig #:designator-error)
  (:import-from :prolog #:def-fact-group #:<-))
(in-package {0})
(defvar *notes* nil)
(defun note (thing) (setf *notes* (append *notes* (list thing))) thing)
(defun motion (&optional (goal 1)) (make-designator :motion `((:type :driving) (:goal ,goal))))
(defun goal-of (motion) (desig-prop-value motion :goal))
(defmacro text-of (&body body) `(handler-case (progn ,@body) (serious-condition (c) (format nil "~a" c))))
(defmacro noting-warnings (&body body)
  `(handler-bind ((warning (lambda (w) (note (format nil "~a" w)) (muffle-warning w)))) ,@body))
(defmacro plan (modules &body body) `(with-process-modules-running ,modules (top-level ,@body)))
(defmacro failure-of (&body body)
  `(block failure (with-failure-handling ((plan-failure (e) (return-from failure e))) ,@body)))
(defun status-now (name) (value (pm-status name)))
"""


class Text:
    """``text(form...)``: the values of the last form as they are printed, separated by `` ; ``."""

    numbers = itertools.count(1)

    def __init__(self, backend, time_limit=3600):
        self.session = Session(time="virtual", turtlesim=False, backend=backend, time_limit=time_limit)
        self.session.evaluate_text(BEGINNING.format(f"PM-TEXT-{next(self.numbers)}"))
        self.said = ""

    def __call__(self, text):
        return " ; ".join(" ".join(prin1_to_string(value).split()) for value in self.session.evaluate_text(text, "<repl>"))

    def error(self, text):
        """What is shown of the error that ``text`` ends with; the package's name and addresses are cut out."""
        with pytest.raises(BaseException) as problem:
            self.session.evaluate_text(text, "<repl>")
        written = io.StringIO()
        report(condition_of(problem.value), file=written)
        return re.sub(r"PM-TEXT-\d+::", "", re.sub(r"\{[0-9A-F]+\}", "{}", written.getvalue()))
