"""The laws are tested as users meet them: in Lisp text, in a package that uses CUT and PROLOG, in virtual time."""

import itertools
import re

import pytest
from prolog_text import RegisteredWarnings

from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string, princ_to_string
from cramhy_runtime.prolog.builtins import productions, rete
from cramhy_runtime.repl.session import Session, condition_of

PRELUDE = """
(defpackage {name} (:use :cl :cut :prolog))
(in-package {name})
(defvar *notes* nil)
(defun note (thing) (setf *notes* (append *notes* (list thing))) t)
(defun all (goal &optional binds) (force-ll (prolog goal binds)))
"""
_numbers = itertools.count(1)


class Lisp:
    """``lisp(text)``: the values of the last form of ``text``, printed. Each test has a package of its own.

    ``(all 'goal)`` is the list of all solutions, ``(note x)`` adds to the list ``*notes*`` and is true. The texts of warnings are
    in ``lisp.warnings``.
    """

    def __init__(self):
        self.warnings = []
        self.session = Session(time="virtual", turtlesim=False)
        self.session.evaluate_text(PRELUDE.format(name=f"PROLOG-LAW-{next(_numbers)}"))

    def __call__(self, text):
        with RegisteredWarnings() as given:
            values = self.session.evaluate_text(text)
        self.warnings += given
        return " ; ".join(" ".join(prin1_to_string(value).split()) for value in values)

    def flat_warnings(self):
        """The texts of the warnings with each white space as one space: a condition in a text is laid out with the text."""
        return [" ".join(text.split()) for text in self.warnings]

    def error(self, text):
        """The whole text of the condition that ``text`` ends with, without addresses."""
        with RegisteredWarnings() as given, pytest.raises(BaseException) as problem:
            self.session.evaluate_text(text)
        self.warnings += given
        return re.sub(r"\{[0-9A-F]+\}", "{}", princ_to_string(condition_of(problem.value)))


@pytest.fixture
def lisp(fresh_kernel):
    rete.clear_alpha_network()
    productions.clear_productions()
    yield Lisp()
    rete.clear_alpha_network()
    productions.clear_productions()
