"""``trace``, ``time``, ``step``, ``disassemble`` and ``function-lambda-expression``: watching and looking into functions."""

from __future__ import annotations

import re

import pytest

from cramhy_runtime.lisp_core.conditions import CompileError, Condition
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string
from cramhy_runtime.languages.commonlisp.streams.streams import ERROR_OUTPUT, STANDARD_OUTPUT, TRACE_OUTPUT, StringOutputStream

DEFINITIONS = """
(defun fib (n) (if (< n 2) n (+ (fib (- n 1)) (fib (- n 2)))))
(defgeneric area (x)) (defmethod area ((x integer)) (list x "s"))
(defun several () (values 1 2)) (defun none () (values))
(defun fails () (error "x"))
(defun (setf place) (new old) (list new old))
"""


@pytest.fixture
def lisp(session, monkeypatch):
    """``lisp(text)``: what evaluating ``text`` in CL-USER printed; the values, as text, are in ``lisp.values``."""

    def lisp(text):
        output = StringOutputStream()
        for stream in (STANDARD_OUTPUT, ERROR_OUTPUT, TRACE_OUTPUT):
            monkeypatch.setattr(stream, "value", output)
        lisp.values = [prin1_to_string(value) for value in session.evaluate_text(text)]
        return output.text()

    session.package = "COMMON-LISP-USER"
    session.evaluate_text(DEFINITIONS)
    yield lisp
    session.evaluate_text("(untrace)")


def test_calls_are_nested_as_in_sbcl(lisp):
    lisp("(trace fib)")
    assert lisp.values == ["(FIB)"]
    assert (
        lisp("(fib 3)")
        == """\
  0: (FIB 3)
    1: (FIB 2)
      2: (FIB 1)
      2: FIB returned 1
      2: (FIB 0)
      2: FIB returned 0
    1: FIB returned 1
    1: (FIB 1)
    1: FIB returned 1
  0: FIB returned 2
"""
    )
    assert lisp.values == ["2"]


def test_values_of_all_numbers_and_exits(lisp):
    lisp("(trace several none fails)")
    assert lisp("(progn (several) (none))") == "  0: (SEVERAL)\n  0: SEVERAL returned 1 2\n  0: (NONE)\n  0: NONE returned\n"
    assert lisp("(ignore-errors (fails))") == "  0: (FAILS)\n  0: FAILS exited non-locally\n"


def test_generic_functions_and_setf_functions(lisp):
    lisp("(trace area (setf place))")
    assert lisp.values == ["(AREA (SETF PLACE))"]
    assert lisp("(area 3)") == '  0: (AREA 3)\n  0: AREA returned (3 "s")\n'
    assert lisp("(setf (place 1) 2)") == "  0: ((SETF PLACE) 2 1)\n  0: (SETF PLACE) returned (2 1)\n"
    assert lisp('(defmethod area ((x string)) x) (area "a")').endswith('  0: AREA returned "a"\n')
    assert "generic-function" in lisp("(describe #'area)")
    lisp("(untrace area)")
    assert lisp("(area 3)") == ""


def test_a_function_that_is_defined_again_stays_traced(lisp):
    lisp("(trace fib)")
    lisp("(defun fib (n) (list n))")
    assert lisp("(fib 2)") == "  0: (FIB 2)\n  0: FIB returned (2)\n"
    lisp("(setf (symbol-function 'fib) (lambda (n) n))")
    assert lisp("(fib 2)") == "  0: (FIB 2)\n  0: FIB returned 2\n"
    lisp("(untrace)")
    assert lisp("(fib 2)") == ""
    assert lisp.values == ["2"]


def test_trace_without_names_lists_and_untrace_takes_away(lisp):
    lisp("(progn (trace fib area) (trace))")
    assert lisp.values == ["(FIB AREA)"]
    assert lisp("(untrace fib)") == ""
    assert lisp.values == ["T"]
    lisp("(trace)")
    assert lisp.values == ["(AREA)"]
    lisp("(progn (untrace) (trace))")
    assert lisp.values == ["NIL"]


def test_what_cannot_be_traced_is_said(lisp):
    assert lisp("(trace no-such)") == "WARNING: COMMON-LISP-USER::NO-SUCH is undefined, not tracing.\n"
    assert lisp.values == ["NIL"]
    assert lisp("(untrace fib)") == "WARNING: Function is not TRACEd: FIB\n"
    assert "is a macro, not tracing" in lisp("(trace when)")
    lisp("(trace fib)")
    assert lisp("(trace fib)") == "WARNING: FIB is already TRACE'd, untracing it first.\n"
    with pytest.raises(CompileError) as caught:
        lisp("(trace 5)")
    assert str(caught.value).startswith("TRACE cannot use 5: what is traced is named by a symbol")
    with pytest.raises(CompileError):
        lisp("(trace fib :no-such-option 1)")


def test_options(lisp):
    lisp("(defvar *wanted* nil)")
    lisp("(trace fib :condition *wanted* :print *wanted*)")
    assert lisp("(fib 1)") == ""
    assert lisp("(setf *wanted* 7) (fib 1)") == "  0: (FIB 1)\n  0: *WANTED* = 7\n  0: FIB returned 1\n"
    lisp("(trace :report nil fib)")
    assert lisp("(fib 1)") == ""
    lisp("(trace fib :break t)")
    with pytest.raises(Condition) as caught:
        lisp("(fib 1)")
    assert str(caught.value) == "breaking before traced call to FIB:"


def test_all_functions_of_a_package(lisp):
    lisp('(defpackage :traced-package (:use :cl)) (defun traced-package::f () 1) (trace "TRACED-PACKAGE")')
    assert lisp.values == ["(TRACED-PACKAGE::F)"]
    lisp("(untrace) (delete-package :traced-package)")


def test_each_task_counts_its_own_depth(lisp):
    lisp("""(defun outer (n) (cpl:sleep 1) (inner n)) (defun inner (n) (cpl:sleep 1) n) (trace outer inner)""")
    assert (
        lisp("(cpl:top-level (cpl:par (outer 1) (outer 2)))")
        == """\
  0: (OUTER 1)
  0: (OUTER 2)
    1: (INNER 1)
    1: (INNER 2)
    1: INNER returned 1
  0: OUTER returned 1
    1: INNER returned 2
  0: OUTER returned 2
"""
    )


def test_time(lisp):
    shown = lisp("(time (progn (sleep 5) (values 1 2)))")
    assert lisp.values == ["1", "2"]
    assert re.fullmatch(
        r"""Evaluation took:
  \d+\.\d{3} seconds of real time
  \d+\.\d{6} seconds of total run time \(\d+\.\d{6} user, \d+\.\d{6} system\)
  \d+\.\d\d% CPU
  5\.000 seconds of plan time
""",
        shown,
    ), shown


def test_step_shows_the_calls(lisp):
    assert lisp("(step (+ 1 (fib 1)))") == "  0: (FIB 1)\n  0: FIB returned 1\n"
    assert lisp.values == ["2"]
    assert lisp("(fib 1)") == ""


def test_disassemble_shows_the_python(lisp):
    assert lisp("(disassemble 'several)") == "; Python of SEVERAL\ndef several():\n    return LMultipleValues((1, 2))\n"
    assert lisp("(disassemble #'several)") == lisp("(disassemble 'several)")
    assert lisp("(defun hi (x) (list x (fib x))) (disassemble 'hi)") == (
        "; Python of HI\ndef hi(x):\n"
        "    return LCons(x, LCons(Lv if (Lv := (Lf := «FIB».function)(x)).__class__ is not LMultipleValues else Lone(Lv), None))\n"
    )
    assert lisp("(disassemble (lambda (x) (acons x 1 nil)))").endswith("\nlambda x: acons(x, 1, None)\n")
    assert "return lst.car" in lisp("(disassemble 'car)")
    assert "LOAD_FAST" in lisp("(disassemble '(lambda (x) x))")
    assert "LCons(x, LCons('s', None))" in lisp("(disassemble 'area)")
    with pytest.raises(Condition) as caught:
        lisp("(disassemble 'no-such)")
    assert str(caught.value) == "The function COMMON-LISP-USER::NO-SUCH is undefined."


def test_function_lambda_expression(lisp):
    lisp('(defun hi (x) "doc" (declare (ignorable x)) (list x)) (function-lambda-expression #\'hi)')
    assert lisp.values == ['(LAMBDA (X) "doc" (DECLARE (IGNORABLE X)) (BLOCK HI (LIST X)))', "T", "HI"]
    lisp("(function-lambda-expression #'car)")
    assert lisp.values[0] == "NIL"


def test_a_file_keeps_its_lambda_expressions(lisp, tmp_path):
    path = tmp_path / "f.lisp"
    path.write_text("(defpackage :lambda-file (:use :cl))\n(in-package :lambda-file)\n\n(defun from-file (a &key b)\n  (list a b))\n")
    lisp(f'(load "{path}")')
    lisp("(function-lambda-expression #'lambda-file::from-file)")
    assert lisp.values[0].replace("LAMBDA-FILE::", "").split() == "(LAMBDA (A &KEY B) (BLOCK FROM-FILE (LIST A B)))".split()
    assert f"Source file: {path}:4\n" in lisp("(describe 'lambda-file::from-file)")
    assert "def from_file(a, *Lgiven, b=None, **Lpython):" in lisp("(disassemble 'lambda-file::from-file)")
    lisp("(delete-package :lambda-file)")
