"""Evaluates the text of an example in Lisp, Hy and Python, each in a session of its own, and gives what they return as Lisp data."""

from __future__ import annotations

import ast
import contextlib
import itertools
import os
import pathlib
import tempfile
import textwrap

from plain_hy import hy_module, hy_value, lisp_value

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.data import Cons, Keyword, LispString, Symbol
from cramhy_runtime.lisp_core.packages import COMMON_LISP_USER
from cramhy_runtime.languages.hy.lisp_data import plan_package
from cramhy_runtime.languages.commonlisp.printer.print_controls import PACKAGE
from cramhy_runtime.repl.session import Session
from cramhy_runtime.session import Image

_numbers = itertools.count(1)

LISP = """(defvar *notes* nil) (defun note (thing) (setf *notes* (append *notes* (list thing))) thing)"""

HY = """
(import cramhy_runtime.cpl [PlanFailure])
(setv notes [])
(defn note [thing] (.append notes thing) thing)
"""

PYTHON = """
from cramhy_runtime import cpl, kernel
from cramhy_runtime.cpl import run
from cramhy_runtime.designators import *
from cramhy_runtime.process_modules import *
from cramhy_runtime.prolog import *
from cramhy_runtime.ros.python import *
notes = []
def note(thing):
    notes.append(thing)
    return thing
def five():
    cpl.sleep(1)
    return 5
"""


@contextlib.contextmanager
def surroundings():
    """An image and a folder of their own, with a file of notes."""
    before = os.getcwd()
    with tempfile.TemporaryDirectory() as folder, Image(as_now=True):
        os.chdir(folder)
        pathlib.Path("notes.txt").write_text("notes")
        try:
            yield
        finally:
            os.chdir(before)
            kernel.stop()
            PACKAGE.value = COMMON_LISP_USER


def new_session(backend, turtlesim=False):
    session = Session(time="virtual", turtlesim=turtlesim, backend=backend, time_limit=3600)
    session.package = plan_package(f"EXAMPLE-{next(_numbers)}").name
    session.evaluate_text("(shadowing-import '(cpl:fail cpl:< cpl:> cpl:not cpl:eq cpl:eql cpl:+ cpl:- cpl:* cpl:/ cpl:= cpl:sleep))")
    return session


@surroundings()
def in_lisp(text, backend):
    """What the last form of a Lisp text returns, and what it noted."""
    session = new_session(backend)
    session.evaluate_text(LISP)
    values = session.evaluate_text(text)
    notes = session.evaluate_text("*notes*")[0]
    return shown(values[0] if len(values) == 1 else tuple(values)), shown(notes)


@surroundings()
def in_hy(text, backend):
    """As `in_lisp`, of a text of plain Hy."""
    module = hy_module(new_session(backend), HY)
    value = hy_value(module, text)
    return shown(value), shown(module.notes)


@surroundings()
def in_python(text, backend):
    """As `in_lisp`, of statements of Python and an expression."""
    new_session(backend)
    names = {"__name__": "an_example"}
    exec(PYTHON, names)
    tree = ast.parse(textwrap.dedent(text).strip())
    last = ast.Expression(tree.body.pop().value)
    exec(compile(tree, "<example>", "exec"), names)
    value = eval(compile(last, "<example>", "eval"), names)
    kernel.settle()
    return shown(value), shown(names["notes"])


def shown(value):
    """A Lisp object as text, names without their packages; objects by their types."""
    value = lisp_value(value)
    if isinstance(value, tuple):
        return " ; ".join(map(shown, value))
    if value is None:
        return "NIL"
    if value is True:
        return "T"
    if isinstance(value, Cons):
        items = []
        while isinstance(value, Cons):
            items.append(shown(value.car))
            value = value.cdr
        return "(" + " ".join(items + ([] if value is None else [".", shown(value)])) + ")"
    if isinstance(value, Keyword):
        return ":" + value.name
    if isinstance(value, Symbol):
        return value.name
    if isinstance(value, (str, LispString)):
        return '"' + str(value) + '"'
    if isinstance(value, (int, float)):
        return repr(value)
    if callable(value):
        return "a function"
    return f"a {type(value).__name__}"
