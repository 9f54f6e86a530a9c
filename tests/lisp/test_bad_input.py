"""Bad input: an error with a place, in bounded time and memory; never a Python traceback, never a dead session.

What may kill a process runs in one of its own, in ``tests/soak/test_hostile.py``.
"""

import time

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.conditions import Condition
from cramhy_runtime.lisp_core.data import all_values
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string
from cramhy_runtime.repl.session import Session, condition_of

MOST_SECONDS = 100  # on a busy machine; alone each takes less than two
DEEP = 10_000
DEEP_LIST = f"(let ((x nil)) (dotimes (i {DEEP}) (setf x (list x))) {{}})"
TOO_DEEP = "nested too deeply"
EXHAUSTED = "Control stack exhausted"
CIRCULAR = "The form contains itself. Only a quoted list may be circular."
ENDLESS = "does not end: after 10000 expansions"

ERRORS = {  # form: a part of the report
    "(" * DEEP: "end of file",
    "(list " * DEEP + ")" * DEEP: TOO_DEEP,
    "(lambda () " + "(progn " * DEEP + ")" * DEEP + ")": TOO_DEEP,
    "'" * 110_000 + "a": TOO_DEEP,
    "(+ 1 2) " + ")" * 100_000: "unmatched close parenthesis",
    DEEP_LIST.format("(prin1-to-string x)"): EXHAUSTED,
    DEEP_LIST.format("(let ((*print-pretty* t)) (prin1-to-string x))"): EXHAUSTED,
    DEEP_LIST.format("(let ((*print-circle* t)) (prin1-to-string x))"): EXHAUSTED,
    DEEP_LIST.format("(equal x (copy-tree x))"): EXHAUSTED,
    DEEP_LIST.format("(eval (subst '1+ nil x))"): EXHAUSTED,
    f"(let ((x 1)) (dotimes (i {DEEP}) (setf x (list '1+ x))) (eval x))": TOO_DEEP,
    "#1=(progn #1#)": CIRCULAR,
    "(progn . #1=(1 . #1#))": CIRCULAR,
    "(list . #1=(1 2 . #1#))": CIRCULAR,
    "(let #1=((x 1) . #1#) x)": CIRCULAR,
    "(lambda #1=(x . #1#) x)": CIRCULAR,
    "(loop . #1=(for x in y . #1#))": CIRCULAR,
    "(defun circular () . #1=(1 . #1#))": CIRCULAR,
    "(case 1 . #1=((2 3) . #1#))": CIRCULAR,
    "`(a . #1=(b . #1#))": CIRCULAR,
    "(eval '#1=(list 1 . #1#))": CIRCULAR,
    "(compile nil '(lambda () . #1=(1 . #1#)))": CIRCULAR,
    "(progn (defmacro pick (a b) (list 'list a b)) (eval '(pick 1 #1=(progn #1#))))": CIRCULAR,
    "(progn (defmacro pick (a b) (list 'list a b)) (eval '(let ((x 1)) (pick x #1=(+ 1 #1#)))))": CIRCULAR,
    "(progn (defmacro pick (a b) (list 'list a b)) (eval '(lambda () (progn (pick 1 #1=(2 . #1#))))))": CIRCULAR,
    "(typep 1 '#1=(or #1# integer))": EXHAUSTED,
    "(progn (defmacro endless () '(endless)) (endless))": ENDLESS,
    "(progn (defmacro endless (x) `(endless (,x ,x))) (endless 1))": ENDLESS,
    "(progn (defmacro endless () '(endless)) (macroexpand '(endless)))": ENDLESS,
    "(progn (defmacro endless () '(list (endless))) (endless))": TOO_DEEP,
    "(progn (defmacro deep (n) (if (= n 0) 1 `(+ 1 (deep ,(1- n))))) (deep 5000))": TOO_DEEP,
    "(symbol-macrolet ((x (list x))) x)": TOO_DEEP,
    "(loop for)": "LOOP source code ran out",
    "(loop for x)": "LOOP source code ran out",
    "(loop repeat)": "LOOP code ran out",
    "(loop collect 1 into)": "LOOP source code ran out",
    "(loop 5)": "5 found where a LOOP keyword expected",
    '(format nil "~a ~a" 1)': "No more arguments",
    '(format t "~d~%")': "No more arguments",
    "(format nil (make-string 100001 :initial-element #\\~))": "String ended before directive was found",
    "(format nil (apply #'concatenate 'string (loop repeat 10000 collect \"~{\")) nil)": EXHAUSTED,
    '(format nil "~100000000000000d" 1)': "Heap exhausted",
    '(format nil "~100000000000000%")': "Heap exhausted",
    '(format nil "~{x~}" \'(1 2))': "would never end",
    '(format nil "~{~}" "x" \'(1 2))': "would never end",
    '(format nil "~{~a~}" \'#1=(1 2 3 . #1#))': "circular",
    "#.(car 5)": "The value 5 is not of type LIST",
    "#.(labels ((f () (+ 1 (f)))) (f))": EXHAUSTED,
    '(let ((*read-eval* nil)) (read-from-string "#.(+ 1 2)"))': "can't read #. while *READ-EVAL* is NIL",
    "#99999999999999999999(1)": "too large",
    "#200A()": "too large",
    "(make-string 100000000000000)": "Heap exhausted",
    "(make-string 10000000000)": "Heap exhausted: 10000000000 elements would take 9 GB",
    "(make-array 10000000000)": "Heap exhausted",
    "(make-array '(100000 100000))": "Heap exhausted",
    "(make-list 10000000000)": "Heap exhausted",
    "(make-sequence 'vector 10000000000)": "Heap exhausted",
    "(ash 1 100000000000000)": "Heap exhausted",
}
ANSWERS = {
    "(length '" + "(" * DEEP + ")" * DEEP + ")": "1",
    '(length "' + "x" * 10_000_000 + '")': "10000000",
    "(length (symbol-name '" + "a" * 10_000_000 + "))": "10000000",
    "(integer-length " + "1" * 100_000 + ")": "332190",
    "(car '#1=(a . #1#))": "A",
    "(let ((x '#1=(a . #1#))) (eq x (cdr x)))": "T",
    "(progn (defun circular () '#1=(a . #1#)) (car (circular)))": "A",
    "(let ((v #1=#(1 #1#))) (eq v (aref v 1)))": "T",
    "(car '#.(let ((x (list 1))) (setf (cdr x) x)))": "1",
    "(progn (defmacro deep (n) (if (= n 0) 1 `(deep ,(1- n)))) (deep 5000))": "1",
    DEEP_LIST.format("(let ((*print-level* 3)) (prin1-to-string x))"): '"(((#)))"',
    "(let ((*print-length* 3)) (prin1-to-string (make-list 100000)))": '"(NIL NIL NIL ...)"',
    "(let ((x (list 1 2 3)) (*print-length* 5)) (setf (cdr (last x)) x) (prin1-to-string x))": '"(1 2 3 1 2 ...)"',
    "(length (format nil (make-string 100000 :initial-element #\\~)))": "50000",
    '(length (format nil "~1000000d" 1))': "1000000",
    "(progn (defmacro third-of (a b c) (list 'progn c)) (eval '(third-of #1=(1 . #1#) 2 3)))": "3",
    "(progn (defmacro steps (n &rest more) (if (= n 5) n `(steps ,(1+ n) ,@more))) (eval '#1=(steps 0 #1#)))": "5",
    "(progn (eval '(defun stepping () #1=(steps 0 #1#))) (stepping))": "5",
    "(progn (eval '(defmacro to-steps () #1=(steps 0 #1#))) (eval '(to-steps)))": "5",
    "(funcall (compile nil '(lambda () #1=(steps 0 #1#))))": "5",
    "(eval '(let ((x 1)) (when x (list x (third-of #1=(x #1#) 2 x)))))": "(1 1)",
}


@pytest.fixture(scope="module")
def session():
    yield Session(time="virtual", turtlesim=False)
    kernel.stop()


def named(form):
    return form if len(form) < 80 else f"{form[:30]}...{form[-30:]}"


@pytest.mark.parametrize("form", ERRORS, ids=named)
def test_it_is_an_error_with_a_place_and_the_session_goes_on(session, form):
    start = time.perf_counter()
    try:
        session.evaluate_text(form)
    except (Condition, Exception) as problem:
        condition = condition_of(problem)
        assert ERRORS[form] in " ".join(condition.report().split())
        assert not condition.lisp_name.endswith("PYTHON-ERROR")
        assert condition.position is not None
    else:
        pytest.fail("no error")
    assert time.perf_counter() - start < MOST_SECONDS
    assert session.evaluate_text("(+ 1 2)") == [3]


@pytest.mark.parametrize("form", ANSWERS, ids=named)
def test_what_is_merely_large_or_circular_has_its_value(session, form):
    start = time.perf_counter()
    assert prin1_to_string(all_values(session.evaluate_text(form)[0])[0]) == ANSWERS[form]
    assert time.perf_counter() - start < MOST_SECONDS


@pytest.mark.parametrize(
    "form, value",
    [
        ("(macrolet ((m (&rest r) (declare (ignore r)) 2)) (m . #1=(a . #1#)))", 2),
        ("(macrolet ((m (x &rest r) (declare (ignore r)) `(length ',(list x)))) (m . #1=(a . #1#)))", 1),
        ("(let ((y 3)) (macrolet ((m (x) (declare (ignore x)) '(+ 1 2))) (+ y (m #1=(a b . #1#)))))", 6),
        ("(flet ((f (x) (macrolet ((m (z) `(list ',(car z)))) (+ x (length (m #1=(q . #1#))))))) (f 5))", 6),
        ("(macrolet ((m (x) (declare (ignore x)) 4)) (m #1=(n (m #1#))))", 4),
    ],
)
def test_a_call_of_a_local_macro_may_contain_itself(session, form, value):
    assert session.evaluate_text(form) == [value]


def test_what_a_local_macro_makes_may_not_contain_itself(session):
    session.evaluate_text("(defvar *round* (let ((l (list 'progn 1))) (setf (cddr l) (list l)) l))")
    form = "(handler-case (eval '(macrolet ((m (x) (declare (ignore x)) *round*)) (m #1=(a . #1#)))) (error (e) (princ-to-string e)))"
    assert session.evaluate_text(form) == [CIRCULAR]
