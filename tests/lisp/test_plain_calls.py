"""A plain call at the top level is not analysed: its code is that which the compiler makes, to the byte and the column."""

from __future__ import annotations

import sys
import types
from collections import Counter

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.languages.commonlisp.evaluation import evaluator
from cramhy_runtime.languages.commonlisp.evaluation.plain_calls import code_of_plain_call
from cramhy_runtime.repl.session import Session

DEFINED = """(defun drive (a b &optional c) (list a b c)) (defun none () 1) (defun keyed (a &key b) (list a b)) (defun several (a) (values a 1))
(defun rest-of (&rest r) r) (defmacro twice (x) `(* 2 ,x)) (defun macroed (x) x) (define-compiler-macro macroed (x) `(list ,x))
(defgeneric generic (x)) (defmethod generic (x) x) (defstruct spot x)"""


@pytest.fixture(scope="module")
def session():
    session = Session(time="virtual", turtlesim=False)
    session.evaluate_text(DEFINED, "<t>")
    yield session
    kernel.stop()


def shown(code):
    """All that a code object is, and those inside of it."""
    constants = [shown(item) if isinstance(item, types.CodeType) else (item.__class__, item) for item in code.co_consts]
    names = code.co_names, code.co_varnames, code.co_name, code.co_qualname, code.co_filename, code.co_firstlineno, code.co_flags
    return code.co_code, constants, names, list(code.co_positions()), code.co_stacksize, code.co_exceptiontable


@pytest.fixture
def compared(session, monkeypatch):
    """A function: evaluate a text; for each form whether it was plain. The code of a plain one is that of the compiler."""

    def compare(text):
        plain = []

        def both(form, unit):
            code = code_of_plain_call(form, unit)
            plain.append(code is not None)
            if code is not None:
                assert shown(code) == shown(unit.compile(form))
            return code

        monkeypatch.setattr(evaluator, "code_of_plain_call", both)
        try:
            session.evaluate_text(text, "<t>")
        except Exception:  # what it answers is not the question here
            pass
        return plain

    return compare


@pytest.mark.parametrize(
    "text",
    [
        "(drive 5 2)",
        "(none)",
        '   (drive \'a "text")',
        "(drive :key '(1 2) 2.5)",
        "(drive 5.0d0 nil t)",
        "(drive #\\a 1/2)",
        "(drive\n 1\n  2)",
        "(drive 123456789012345678901234567890 #(1 2))",
        "(drive -1 18446744073709551615)",
        "(several 3)",
        "(drive #.(let ((x (make-hash-table))) x) 2)",
    ],
)
def test_a_plain_call_has_the_code_that_the_compiler_makes(compared, text):
    assert compared(text)[-1]


@pytest.mark.parametrize(
    "text",
    "(drive_1)|(drive_1_2_3_4)|(drive_x_1)|(drive_(none)_1)|(drive_1_._2)|(keyed_1_:b_2)|(rest-of_1)|(twice_2)|(macroed_1)|(generic_1)|(spot-x_1)"
    "|(undefined-here_1)|(+_1_2)|(list_1)|(drive_'1_(quote))|(drive_`(1)_2)|((lambda_(x)_x)_1)|(progn_1)|(cram-language:sleep_0)".split(
        "|"
    ),
)
def test_any_other_call_is_compiled(compared, text):
    assert True not in compared(text.replace("_", " "))


@pytest.mark.parametrize(
    "variable",
    [
        "*seen*",
        "written",
        "+most+",
        "pi",
        "cpl:*of-task*",
        "cpl:*of-parameter*",
        "cram-execution-trace:*last-episode-knowledge*",
        "*",
        "drive",
    ],
)
def test_a_variable_of_any_kind_is_not_a_constant(session, compared, variable):
    session.evaluate_text(
        """(defvar *seen* 1) (define-symbol-macro written *seen*) (defconstant +most+ 3) (cpl:define-task-variable cpl::*of-task* 4)
        (cpl:def-cpl-parameter cpl::*of-parameter* 5)""",
        "<t>",
    )
    assert compared(f"(drive {variable.replace(':*of', '::*of')} 2)") == [False]


def test_a_traced_function_is_called_as_it_is(session, compared):
    session.evaluate_text("(trace drive)", "<t>")
    try:
        assert compared("(drive 1 2)") == [False]
    finally:
        session.evaluate_text("(untrace drive)", "<t>")


def test_a_plain_call_takes_few_calls_of_python(session):
    """Budget: a form that is analysed takes 245 calls in 41 files."""
    session.evaluate_text("(drive 5 2)", "<t>")
    calls = Counter()

    def count(frame, event, _):
        if event == "call":
            calls[frame.f_code.co_filename] += 1

    before = sys.getprofile()
    sys.setprofile(count)
    try:
        session.evaluate_text("(drive 5 2)", "<t>")
    finally:
        sys.setprofile(before)
    assert (calls.total() <= 130, len(calls) <= 26) == (True, True), calls


def test_the_place_of_an_error_in_a_plain_call_is_told(session):
    session.evaluate_text('(defun fails (x) (error "no ~a" x))', "<t>")
    from cramhy_runtime.repl.session import condition_of

    with pytest.raises(Exception) as caught:
        session.evaluate_text("(list 1)\n  (fails 5)", "<t>")
    assert condition_of(caught.value).report() == "no 5"
