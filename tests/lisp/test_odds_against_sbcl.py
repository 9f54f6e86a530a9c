"""Loop variables in closures, initargs that nobody takes, classes that would be their own superclass, LOOP clauses that exclude each other.

``sbcl/odds.txt`` holds what SBCL 2.2.9 answered; ``make recorded`` asks it again. ``sbcl/corners.txt`` has more such forms, by chapters: the
order in which places are evaluated, the scope of declarations, strings and arrays that share their storage, and so on.
"""

import re

import pytest
from sbcl_answers import line, recorded

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.conditions import Condition
from cramhy_runtime.lisp_core.packages import sym
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string
from cramhy_runtime.repl import json_lines
from cramhy_runtime.repl.session import Session, condition_of


@pytest.fixture(scope="module")
def session():
    made = Session(time="virtual", turtlesim=False)
    made.package = "COMMON-LISP-USER"
    pretty = sym("*PRINT-PRETTY*")
    before, pretty.value = pretty.value, None
    yield made
    pretty.value = before
    kernel.stop()


def without_addresses(text):
    return re.sub(r"\{[0-9A-F]+\}", "{}", text)


@pytest.mark.soak(all_but=18)
@pytest.mark.parametrize(("form", "wanted"), recorded("odds.txt") + recorded("corners.txt"))
def test_the_answer_is_that_of_sbcl(session, form, wanted):
    try:
        told = "=> " + " ; ".join(line(prin1_to_string(value)) for value in session.evaluate_text(form))
    except (Condition, Exception) as problem:
        condition = condition_of(problem)
        told = f"!! {condition.lisp_name.rpartition(':')[2]} {line(condition.report())}"
    assert without_addresses(told) == without_addresses(wanted)


def undefined(session, form):
    """The functions of which the compiler says that they are undefined, when ``form`` is a form of the prompt."""
    warnings = json_lines.evaluate(session, form).get("warnings", ())
    return [each["message"].rpartition(":")[2] for each in warnings if each["message"].startswith("undefined function")]


@pytest.mark.parametrize(
    ("form", "names"),
    [
        ("(define-condition od-a (error) ((f :reader od-f)) (:report (lambda (c s) (princ (od-f c) s))))", []),
        ("(define-condition od-b (error) ((f :accessor od-g)) (:report (lambda (c s) (setf (od-g c) 1) (princ (od-g c) s))))", []),
        ("(define-condition od-c (error) ((f :writer od-set)) (:report (lambda (c s) (od-set 1 c) (od-no c) (princ 1 s))))", ["OD-NO"]),
        ("(defstruct od-d (a 1) (b (od-d-a (make-od-d :b 2))))", []),
        ("(defstruct (od-e (:conc-name od-e.)) (a 1) (b (lambda (e) (setf (od-e.a e) 2))))", []),
        ("(defstruct (od-h (:constructor new-od-h)) (a (lambda () (od-h-p (copy-od-h (new-od-h))))))", []),
        ("(defstruct od-i (a (od-i-b 1)))", ["OD-I-B"]),
        ("(defclass od-j () ((k :initform (od-k 1) :reader od-k)))", ["OD-K"]),  # as in SBCL
        ("(progn (defclass od-l () ((q :accessor od-q))) (defun od-use (o) (setf (od-q o) 1) (od-q o)))", []),
    ],
)
def test_what_a_definition_calls_of_its_own_is_no_undefined_function(session, form, names):
    assert undefined(session, form) == names
