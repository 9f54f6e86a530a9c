"""Python from Lisp: modules as packages, calls, attributes and items, collections, exceptions as conditions (docs/python.md)."""

from __future__ import annotations

import re
import types
from pathlib import Path

import pytest

from cramhy_runtime.lisp_core.conditions import Condition, PythonError
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string

PAGE = Path(__file__).parents[2] / "docs" / "python.md"


@pytest.fixture
def lisp(session):
    """``lisp(text)``: the values of the last form of ``text`` as they print."""
    session.package = "COMMON-LISP-USER"
    return lambda text: " ; ".join(map(prin1_to_string, session.evaluate_text(text)))


def test_the_examples_of_the_page(lisp):
    shown = re.findall(r"```lisp\n(CL-USER> .*?)```", PAGE.read_text(), re.S)
    examples = [example for block in shown for example in block.split("CL-USER> ")[1:]]
    assert len(examples) > 12
    for example in examples:
        form, _, answer = example.partition("\n")
        assert without_addresses(lisp(form)) == without_addresses(" ; ".join(answer.strip().split("\n"))), form


def without_addresses(text):
    return re.sub(r"\{[0-9A-F]{10}\}", "{}", text)


@pytest.mark.parametrize(
    ("form", "answer"),
    [
        ("(progn (py:import math) (list (package-name (find-package :math)) (fboundp 'cl-user::no)))", '("MATH" NIL)'),
        ('(py:call "math.pow" 2 3)', "8.0d0"),
        ('(py:call "int" "ff" :base 16)', "255"),
        ('(py:call (py:object "operator.add") 1 2)', "3"),
        ('(py:call-blocking "math.sqrt" 4)', "2.0d0"),
        ('(funcall (function py:len) "abc")', "3"),
        ('(mapcar (function py:int) (list "1" "2"))', "(1 2)"),
        ("(py:len (list 1 2 3))", "3"),
        ("(py:len (make-string 3 :initial-element #\\a))", "3"),
        ('(py:getattr (py:eval "1j") "imag")', "1.0d0"),
        ('(py:getattr "abc" \'no-such :default)', ":DEFAULT"),
        ('(list (py:hasattr "abc" \'upper) (py:hasattr "abc" \'uper))', "(T NIL)"),
        ('(py:method "a-b" \'split "-")', '#("a" "b")'),
        ('(py:-> "abc" (upper) (replace "B" "-"))', '"A-C"'),
        ('(py:item (py:eval "[1, 2, 3]") -1)', "3"),
        ('(py:item (py:eval "{(1, 2): 5}") 1 2)', "5"),
        ('(let ((d (py:dict "k" 1 :a-b 2))) (py:delitem d "k") d)', "#<PYTHON {'a_b': 2}>"),
        ('(py:dict (list (cons "a" 1) (cons 2 nil)))', "#<PYTHON {'a': 1, 2: None}>"),
        ("(let ((h (make-hash-table))) (setf (gethash 1 h) 2) (py:dict h))", "#<PYTHON {1: 2}>"),
        ('(gethash "a" (py:hash-table (py:dict "a" 1)))', "1 ; T"),
        ("(py:vector '(1 2))", "#(1 2)"),
        ("(py:tuple '(1 2))", "#<PYTHON (1, 2)>"),
        ("(py:len (py:set '(1 1 2)))", "2"),
        ('(list (py:list nil) (py:vector nil) (py:list "ab"))', '(NIL #() ("a" "b"))'),
        ('(list (py:str 1.5) (py:repr "a") (py:str :speed))', '("1.5" "\'a\'" "speed")'),
        ("(list py:true py:false py:none (if py:false 1 2))", "(T NIL NIL 2)"),
        ("(let ((n 0)) (py:for (x (py:range 5)) (incf n x)) n)", "10"),
        ("(py:for (x (py:range 5)) (when (= x 3) (return :three)))", ":THREE"),
        ('(progn (py:exec "def twice(x):\n  return 2 * x") (py:eval "twice(n)" :n 4))', "8"),
        ("(py:list (py:map (lambda (x) (* x x)) '(1 2)))", "(1 4)"),
        ("(typep (py:dict) 'py:dict)", "T"),
        ("(py:import logging) (list logging:+debug+ (functionp #'logging:debug))", "(10 T)"),
        ("(py:import collections) (py:len (collections:|OrderedDict|))", "0"),
        ("(py:len (collections:ordered-dict))", "0"),
        (
            "(defmethod kind ((x collections:OrderedDict)) :ordered) (defmethod kind (x) :other) "
            "(list (kind (collections:OrderedDict)) (kind (py:dict)))",
            "(:ORDERED :OTHER)",
        ),
        ("(defpackage :uses-math (:use :cl) (:import-from :math #:hypot)) (uses-math::hypot 3 4)", "5.0d0"),
    ],
)
def test_calls_and_collections(lisp, form, answer):
    assert lisp(form) == answer


@pytest.mark.parametrize(
    ("form", "answer"),
    [
        ('(handler-case (py:int "x") (py:value-error () :value))', ":VALUE"),
        ('(handler-case (py:int "x") (py:KeyError () :key) (error () :other))', ":OTHER"),
        ('(handler-case (json:loads "{") (py:value-error (e) (type-of e)))', "PYTHON::JSON-DECODE-ERROR"),
        ('(handler-case (py:item (py:dict) "b") (py:lookup-error (e) (princ-to-string e)))', "\"There is no key 'b'.\""),
        ("(handler-case (py:len) (py:TypeError (e) (princ-to-string e)))", '"len() takes exactly one argument (0 given)"'),
        ('(handler-case (py:call "operator.truediv" 1 0) (division-by-zero () :zero))', ":ZERO"),
        ('(handler-case (py:call "operator.truediv" 1 0) (py:ZeroDivisionError () :zero))', ":ZERO"),
        ('(handler-case (py:raise "FileNotFoundError" 2 "gone") (py:OSError (e) (py:getattr (py:exception e) "errno")))', "2"),
        ('(restart-case (handler-bind ((py:ValueError (lambda (e) (invoke-restart \'other 7)))) (py:int "x")) (other (n) n))', "7"),
        ('(nth-value 1 (ignore-errors (py:raise (py:call "ValueError" "a"))))', "#<PYTHON:VALUE-ERROR {}>"),
        ("(list (subtypep 'py:value-error 'error) (subtypep 'py:FileNotFoundError 'py:OSError))", "(T T)"),
    ],
)
def test_exceptions_are_conditions(lisp, form, answer):
    lisp("(py:import json)")
    assert without_addresses(lisp(form)) == answer


def test_a_handler_is_asked_once(lisp):
    assert (
        lisp("""(let ((n 0)) (handler-bind ((error (lambda (e) (incf n))))
        (handler-bind ((py:ValueError (lambda (e) (incf n 10)))) (ignore-errors (progn (py:int "x"))))) n)""")
        == "0"
    )
    assert (
        lisp("""(let ((n 0)) (ignore-errors (handler-bind ((error (lambda (e) (incf n))))
        (handler-bind ((py:ValueError (lambda (e) (incf n 10)))) (py:int "x")))) n)""")
        == "11"
    )


def test_an_exception_that_passes_lisp_and_python_in_turn_is_signalled_once(lisp):
    assert (
        lisp("""(let ((n 0)) (ignore-errors (handler-bind ((error (lambda (e) (incf n))))
        (py:list (py:map (lambda (x) (py:int "x")) '(1))))) n)""")
        == "1"
    )


def test_an_exception_that_is_raised_again_is_signalled_again(lisp):
    lisp('(defvar *exception* (py:call "ValueError" "again"))')
    for _ in range(2):
        with pytest.raises(ValueError):
            lisp("(py:raise *exception*)")
        assert lisp("(handler-case (py:raise *exception*) (py:ValueError () :seen))") == ":SEEN"


def test_python_code_above_sees_its_own_exception(lisp, session):
    lisp("(defun reads (text) (py:int text))")
    with pytest.raises(ValueError, match="invalid literal"):
        session.evaluate_text('(reads "x")')


def test_conditions_pass_through_python(lisp):
    assert (
        lisp("""(define-condition mine (error) ())
        (handler-case (py:list (py:map (lambda (x) (error 'mine)) '(1))) (mine () :mine))""")
        == ":MINE"
    )


@pytest.mark.parametrize(
    ("form", "text", "hint"),
    [
        ('(py:call "no.such.thing")', "No module named 'no'", "Is there a module no in this Python, or is it to be installed with pip?"),
        (
            "(math:sqrtt 2)",
            'Symbol "SQRTT" not found in the MATH package.',
            "MATH exports no symbol SQRTT. Did you mean math:sqrt or math:isqrt?",
        ),
        ("(py:sorted '(1) :key)", "The keyword :KEY has no value in a call of Python.", None),
        ("(py:raise 5)", "PY:RAISE cannot raise 5, which is not an exception of Python; conditions are signalled with ERROR.", None),
        ("(py:dict 1 2 3)", "PY:DICT takes keys and values in turn, one hash table, or one association list, not 3 arguments.", None),
        ("(py:with (x 5) x)", "The value\n  5\nis not of type\n  (SATISFIES CONTEXT-MANAGER)", None),
    ],
)
def test_mistakes_are_explained(lisp, session, form, text, hint):
    lisp("(py:import math)")
    with pytest.raises((Condition, Exception)) as caught:
        session.evaluate_text(form)
    from cramhy_runtime.repl.session import condition_of

    condition = condition_of(caught.value)
    assert str(condition) == text
    assert getattr(condition, "hint", None) == hint


def test_a_name_that_could_be_several_is_an_error(session, lisp, monkeypatch):
    import sys

    module = types.ModuleType("ambiguous_names")
    module.doIt, module.DoIt = 1, 2
    monkeypatch.setitem(sys.modules, "ambiguous_names", module)
    lisp("(py:import ambiguous-names)")
    with pytest.raises(Condition) as caught:
        lisp("ambiguous-names:doit")
    assert str(caught.value) == "doit may mean DoIt or doIt in Python. Write the one that is meant in bars, as in |DoIt|."
    assert lisp("(list ambiguous-names:|doIt| ambiguous-names:|DoIt|)") == "(1 2)"


def test_variables_of_a_module_are_read_and_set(lisp, monkeypatch):
    import sys

    module = types.ModuleType("with_variables")
    module.speed = 1
    monkeypatch.setitem(sys.modules, "with_variables", module)
    assert lisp("(py:import with-variables) with-variables:speed") == "1"
    module.speed = 2
    assert lisp("with-variables:speed") == "2"
    lisp("(setf with-variables:speed 5)")
    assert module.speed == 5


def test_a_name_that_a_lisp_package_has(lisp, session, monkeypatch):
    import sys

    monkeypatch.setitem(sys.modules, "taken", types.ModuleType("taken"))
    lisp("(defpackage :taken (:use))")
    with pytest.raises(Condition) as caught:
        lisp("(py:import taken)")
    assert str(caught.value) == (
        "The Python module taken cannot have the package TAKEN: that name belongs to another package. Give it a "
        "name of its own, as in (py:import taken :as py-taken)."
    )
    assert lisp("(package-name (py:import taken :as py-taken))") == '"PY-TAKEN"'
    lisp("(delete-package :taken)")


def test_with_closes_what_it_opened(lisp, tmp_path):
    path = tmp_path / "x.txt"
    assert lisp(f'(py:with (f (py:open "{path}" "w")) (py:method f \'write "hello"))') == "5"
    assert lisp(f'(py:with (f (py:open "{path}")) (list (py:-> f (read)) (py:getattr f \'closed)))') == '("hello" NIL)'
    assert (
        lisp(f"""(let (kept)
        (ignore-errors (py:with (f (py:open "{path}")) (setf kept f) (error "x")))
        (py:getattr kept 'closed))""")
        == "T"
    )


def test_other_tasks_run_during_a_blocking_call(lisp):
    lisp("(defvar *seen* nil)")
    assert (
        lisp("""(let ((seen nil)) (cpl:top-level (cpl:par
        (progn (py:call-blocking "math.sqrt" 4) (push :call seen)) (progn (push :other seen)))) (length seen))""")
        == "2"
    )


def test_functions_of_python_are_described(lisp, capsys):
    lisp("(py:import math)")
    capsys.readouterr()
    lisp("(describe 'math:hypot)")
    assert "HYPOT names a compiled function:" in capsys.readouterr().out


def test_a_file_that_uses_python_is_kept_and_loaded_again(lisp, tmp_path):
    path = tmp_path / "uses-python.lisp"
    path.write_text(
        "(defpackage :uses-python (:use :cl))\n(in-package :uses-python)\n(py:import math)\n(defun f (x) (math:floor x))\n"
        '(defun g () (handler-case (py:int "x") (py:ValueError () math:inf)))\n'
    )
    for _ in range(2):
        lisp(f'(load "{path}")')
        assert lisp("(list (uses-python::f 2.5) (> (uses-python::g) 100))") == "(2 T)"


def test_an_exception_without_a_class_in_lisp_is_still_a_python_error(lisp):
    assert issubclass(type(_condition(lisp)), PythonError)


def _condition(lisp):
    from cramhy_runtime.lisp_core.python_exceptions import from_python

    return from_python(LookupError("x"))
