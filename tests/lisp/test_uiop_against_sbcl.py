"""UIOP beside SBCL's: the answers that SBCL gave are recorded in ``sbcl/uiop.txt``. And what cannot be had says why."""

from __future__ import annotations

from pathlib import Path

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.conditions import Condition
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string
from cramhy_runtime.languages.commonlisp.uiop.building import NOT_HERE
from cramhy_runtime.repl.session import Session, condition_of
from cramhy_runtime.session import Image

LINES = (Path(__file__).parent / "sbcl" / "uiop.txt").read_text(encoding="utf-8").splitlines()[1:]
PAIRS = list(zip(LINES[::2], LINES[1::2]))


@pytest.fixture(scope="module")
def session():
    with Image():
        session = Session(time="virtual", turtlesim=False)
        session.evaluate_text("(in-package :cl-user)")
        yield session
        kernel.stop()


def shown(session, form):
    """What is recorded of a form: its value as it is printed, or the kind of its condition."""
    text = f"(handler-bind ((warning #'muffle-warning)) (let ((*print-pretty* nil)) (prin1-to-string (let ((*standard-output* (make-broadcast-stream))) {form}))))"
    try:
        return " ".join(str(session.evaluate_text(text)[0]).split())
    except (Condition, Exception) as problem:
        return f"ERROR {condition_of(problem).lisp_name.rpartition(':')[2]}"


@pytest.mark.soak
def test_as_sbcl_answers(session, tmp_path):
    """One after the other, since some use what others define."""
    different = []
    for pair in PAIRS:
        form, answer = (text.replace("FOLDER", str(tmp_path)) for text in pair)
        if (told := shown(session, form)) != " ".join(answer.split()):
            different.append((form, answer, told))
    assert not different, "\n".join(map(repr, different))


def test_a_compiled_file(session, tmp_path):
    """SBCL writes machine code there, and here is what loads the same: no warning, no failure, and a file."""
    (tmp_path / "l.lisp").write_text("(defparameter cl-user::*compiled-by-uiop* 5)")
    session.evaluate_text(f'(load (uiop:compile-file* "{tmp_path}/l.lisp" :output-file "{tmp_path}/l.fasl"))')
    assert session.evaluate_text("cl-user::*compiled-by-uiop*") == [5]


@pytest.mark.parametrize("name", NOT_HERE)
def test_what_cannot_be_had_says_why(session, name):
    with pytest.raises(Condition) as problem:
        session.evaluate_text(f'(uiop:{name} "x")')
    assert problem.value.report() == f"Not (currently) implemented on cramhy: UIOP:{name.upper()}\n{NOT_HERE[name]}."


def test_times_rise(session):
    """UIOP's own says nil of all but the empty list, against its documentation: this is a difference."""
    forms = "(list (uiop:timestamp*< 1 2 3) (uiop:timestamp*< 1 3 2) (uiop:timestamp*<))"
    assert prin1_to_string(session.evaluate_text(forms)[0]) == "(T NIL T)"
