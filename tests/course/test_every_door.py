"""A check knows what was typed, whatever the door: a number that was typed is not one that was computed, and a definition in vain is told.

Here are the prompt, files and Hy's prompt; `cramhy learn` is in ``test_tries.py``. Notebooks, the tab and Emacs are beside their other
tests: ``tests/jupyter/test_course.py``, ``tests/webassembly/test_desk.py``, ``tests/swank/test_evaluating.py``.
"""

from __future__ import annotations

import subprocess
import sys

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.course import checking
from cramhy_runtime.lisp_core.conditions import Condition
from cramhy_runtime.session.session import Session
from systems import needs_processes

CONSTANT = "The number is right, but for another side it would be wrong."
TYPED = "The number is right, but it stands in your form already."
IN_VAIN = "Your last definition of rectangle-around was not taken"
LISP = {
    "constant": "(defvar *side* 4) (defvar *around* 16)",
    "computed": "(defvar *side* 4)\n(defvar *around* (* 4 *side*))",
    "constant at last": "(defvar *side* 4) (defvar *around* (* 4 *side*)) (setf *around* 16)",
}
HY = {
    "constant": "(setv side 4 around 16)",
    "computed": "(setv side 4)\n(setv around (* 4 side))",
    "constant at last": "(setv side 4 around (* 4 side)) (setv around 16)",
}
CHECK = {"lisp": '(course:check "around-a-square")', "hy": '(import cramhy-runtime.course.package [check])\n(check "around-a-square" "hy")'}
KINDS = pytest.mark.parametrize("kind", LISP)


def right(kind, shown):
    assert (CONSTANT in shown, "Well done" in shown) == (("constant" in kind), kind == "computed"), shown


@pytest.fixture
def run(tmp_path):
    """``run(words, text)``: what `cramhy` prints, with this text as its input."""

    def run(*words, text=""):
        command = [sys.executable, "-m", "cramhy_runtime.cli", *words]
        done = subprocess.run(command, input=text, cwd=tmp_path, capture_output=True, text=True, timeout=300)
        return done.stdout + done.stderr

    return run


@pytest.mark.soak(all_but=1)
@needs_processes
@KINDS
def test_at_the_prompt(run, kind):
    right(kind, run("repl", text=f"{LISP[kind]}\n{CHECK['lisp']}\n"))


@pytest.mark.soak(all_but=1)
@needs_processes
@KINDS
def test_at_the_prompt_of_hy(run, kind):
    right(kind, run("repl", "--hy", text=f"{HY[kind]}\n{CHECK['hy']}\n"))


@pytest.mark.soak
@needs_processes
@KINDS
def test_in_a_file_that_asks_itself(run, tmp_path, kind):
    (tmp_path / "answer.lisp").write_text(f"{LISP[kind]}\n{CHECK['lisp']}\n(defvar *later* '(setf *around* 16))\n")
    for _ in range(2):  # its code is kept
        right(kind, run("run", "answer.lisp"))


@pytest.mark.soak
@needs_processes
@KINDS
def test_in_a_file_of_hy_that_asks_itself(run, tmp_path, kind):
    (tmp_path / "answer.hy").write_text(f"(require cramhy *)\n{HY[kind]}\n{CHECK['hy']}\n(setv around 16)\n")
    for _ in range(2):
        right(kind, run("run", "answer.hy"))


@pytest.mark.soak
@needs_processes
@KINDS
def test_in_a_file_that_is_loaded_before(run, tmp_path, kind):
    (tmp_path / "answer.lisp").write_text(LISP[kind])
    right(kind, run("repl", text=f'(load "answer.lisp")\n{CHECK["lisp"]}\n'))
    right(kind, run("repl", "--load", "answer.lisp", text=f"{CHECK['lisp']}\n"))


@pytest.mark.soak
@needs_processes
@KINDS
def test_in_what_hy_runs_before_its_prompt_and_what_it_reads_from_a_pipe(tmp_path, kind):
    program = f"(require cramhy *)\n{HY[kind]}\n"
    (tmp_path / "answer.hy").write_text(program)
    for words, text in ((["-i", "answer.hy"], f"{CHECK['hy']}\n"), ([], f"{program}{CHECK['hy']}\n")):
        command = [sys.executable, "-m", "hy", *words]
        done = subprocess.run(command, input=text, cwd=tmp_path, capture_output=True, text=True, timeout=300)
        right(kind, done.stdout + done.stderr)


# ------------------------------------------------------------------------------------------------------------------- the record


@pytest.fixture
def session():
    yield Session(time="virtual", turtlesim=False)
    kernel.stop()


def told(name, session, language="lisp", **more):
    return " ".join(checking.check(name, session, language, **more)["told"])


def test_a_form_that_is_checked_is_no_form_that_was_typed(session):
    session.evaluate_text("(defvar *side* 4) (defvar *around* (* 4 *side*))")
    assert "Well done" in told("around-a-square", session)
    session.evaluate_text("86400")
    assert TYPED in told("seconds-of-a-day", session)
    session.evaluate_text("(* 24 60 60)")
    assert "Well done" in told("seconds-of-a-day", session)


def test_a_definition_in_vain_is_told_whatever_has_failed(session, tmp_path):
    good = "(defun rectangle-around (width height) (* 2 (+ width height)))"
    session.evaluate_text(good)
    for wrong in (
        "(defun rectangle-around (width height) (* 2 (+ width #<)))",
        "(defun rectangle-around (width height",
        "(defun rectangle-around (width height) (let))",
        "(car 5) (defun rectangle-around (width height) 5)",
    ):
        with pytest.raises((Condition, SyntaxError)):
            session.evaluate_text(wrong)
        assert IN_VAIN in told("rectangle", session)
        session.evaluate_text(good)
        assert "Well done" in told("rectangle", session)
    file = tmp_path / "answer.lisp"
    file.write_text("(defun rectangle-around (width height) (* 2 width height #<))")
    with pytest.raises((Condition, SyntaxError)):
        session.load(str(file))
    assert IN_VAIN in told("rectangle", session)
    file.write_text(good)
    session.load(str(file))
    assert "Well done" in told("rectangle", session)


def test_what_stands_before_a_form_that_failed_was_taken(session):
    with pytest.raises((Condition, SyntaxError)):
        session.evaluate_text("(defun rectangle-around (width height) (* 2 (+ width height))) (car 5)")
    assert "Well done" in told("rectangle", session)


def test_another_session_knows_nothing_of_it(session):
    session.evaluate_text("(defvar *side* 4) (defvar *around* 16)")
    kernel.stop()
    other = Session(time="virtual", turtlesim=False)
    other.evaluate_text("(setf *side* 4)")
    assert CONSTANT not in told("around-a-square", other)


PRINTED = "Printing is not answering: the answer of a function is the value of its last form."


@pytest.mark.parametrize("body", ["(progn (print (* 2 (+ width height))) nil)", '(format t "~a" (* 2 (+ width height)))'])
def test_that_printing_is_not_answering_is_told_in_lisp(session, body):
    session.evaluate_text(f"(defun rectangle-around (width height) {body})")
    said = told("rectangle", session)
    assert said.startswith("(rectangle-around 2 3) should give 10, and gave NIL. ") and said.endswith(f" {PRINTED}")
    session.evaluate_text("(defun rectangle-around (width height) (unless width height))")
    assert "and gave NIL." in told("rectangle", session) and PRINTED not in told("rectangle", session)


@pytest.mark.soak
@needs_processes
def test_hy_speaks_of_none_and_true_when_a_check_does(run):
    check = '(import cramhy-runtime.course.package [check])\n(check "rectangle" "hy")\n'
    shown = run("repl", "--hy", text=f"(defn rectangle-around [width height] (print (* 2 (+ width height))))\n{check}")
    assert "should give 10, and gave None." in shown and PRINTED in shown
    assert "gave True." in run("repl", "--hy", text=f"(defn rectangle-around [width height] True)\n{check}")
