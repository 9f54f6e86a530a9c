"""At the end of the input every question and every reader signals END-OF-FILE, as in SBCL, and asks no more."""

from __future__ import annotations

import io
import sys

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.printing import prin1_to_string
from cramhy_runtime.session.session import Session

# What SBCL 2.2.9 answers with nothing on standard input: sbcl --script, with each form in a handler-case for end-of-file.
QUESTIONS = [
    "(y-or-n-p)",
    '(y-or-n-p "Sure of ~a?" 1)',
    "(yes-or-no-p)",
    '(yes-or-no-p "Sure?")',
    "(read)",
    "(read-preserving-whitespace)",
    "(read-line)",
    "(read-char)",
    "(read-char-no-hang)",
    "(peek-char)",
    "(peek-char t)",
    "(read-delimited-list #\\))",
    "(handler-bind ((error (lambda (c) c (invoke-restart-interactively 'use-value)))) (symbol-value 'unbound-here))",
    "(handler-bind ((type-error (lambda (c) c (invoke-restart-interactively 'store-value)))) (let ((x 1)) (check-type x string) x))",
    "(handler-bind ((type-error (lambda (c) c (invoke-restart-interactively 'store-value)))) (let ((x 1)) (ccase x (2 :two))))",
    "(handler-bind ((simple-error (lambda (c) c (invoke-restart-interactively 'continue)))) (let ((x 1)) (assert (= x 2) (x)) x))",
]


@pytest.fixture
def answer(monkeypatch):
    """``answer(form, typed)``: what a form answers whose user types that text, and then no more."""
    made = Session(time="virtual", turtlesim=False)

    def answer(form, typed=""):
        monkeypatch.setattr(sys, "stdin", io.StringIO(typed))
        [value] = made.evaluate_text(f"(handler-case {form} (end-of-file () :end))")
        return prin1_to_string(value)

    yield answer
    kernel.stop()


@pytest.mark.parametrize("form", QUESTIONS)
def test_a_question_at_the_end_of_the_input_is_an_end_of_file(answer, form):
    assert answer(form) == ":END"


@pytest.mark.parametrize("form", ["(y-or-n-p)", "(yes-or-no-p)"])
@pytest.mark.parametrize("typed", ["perhaps", "perhaps\n", "\n\n\n"])
def test_a_question_that_gets_no_answer_ends_with_the_input(answer, form, typed):
    assert answer(form, typed) == ":END"


@pytest.mark.parametrize(("typed", "value"), [("y", "T"), ("n", "NIL"), ("x\nY\n", "T"), ("x\n N \n", "NIL")])
def test_a_last_line_without_its_end_is_an_answer(answer, typed, value):
    assert answer("(y-or-n-p)", typed) == value


@pytest.mark.parametrize("form", ["(py:input)", '(py:call "builtins.input" "x? ")', '(py:eval "input()")'])
def test_what_asks_in_python_is_an_end_of_file_and_an_eof_error(answer, form):
    assert answer(form) == ":END"
    assert answer(f"(handler-case {form} (python::eof-error () :python))") == ":PYTHON"


def test_a_loop_of_questions_ends(answer):
    assert answer('(loop until (y-or-n-p "Done?"))', "n\nn\n") == ":END"
