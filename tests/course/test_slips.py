"""What is said of slips: lines as Python writes them, parentheses for brackets, and forms that were passed over with ``:next``."""

from __future__ import annotations

import pytest

from cramhy_runtime.course.slips import Form, names, of_failed_form, of_line, of_missing

KNOWN = ("init", "ahead")
LINES = {
    "import math": ("In Hy this is written (import math)", "This is not Lisp. It loads no modules of Python"),
    "from math import pi, sin": ("In Hy this is written (import math [pi sin])", "This is not Lisp."),
    "from math import pi": ("In Hy this is written (import math [pi])", "This is not Lisp."),
    "import math, random": ("(import math random)", "This is not Lisp."),
    "(defun f (x y) (* 2 + x y))": ("Each + has parentheses of its own: (* 2 (+ x y))", "Each + has parentheses of its own: (* 2 (+ x y))"),
    "def area(x, y):": ("In Hy this is written (defn area [x y] ...)", "In Lisp this is written (defun area (x y) ...)"),
    "def area(x): return x * x": ("(defn area [x] ...)", "(defun area (x) ...)"),
    "for i in range(4):": ("(for [i (range 4)] ...)", "(dotimes (i 4) ...)"),
    "for i in range(3): print(i)": ("(for [i (range 3)] ...)", "(dotimes (i 3) ...)"),
    "for place in places:": ("(for [place places] ...)", "(dolist (place places) ...)"),
    "while x < 3:": ("(while (< x 3) ...)", "(loop while (< x 3) do ...)"),
    "if x == 3:": ("(if (= x 3) this that)", "(if (= x 3) this that)"),
    "else:": ("(if condition this that)", "(if condition this that)"),
    "return x": ("Hy needs no return here: the last form of a function is its value.", "Lisp needs no return here"),
    "metres = 2": ("(setv metres 2)", "(defvar *metres* 2)"),
    "side=4": ("(setv side 4)", "(defvar *side* 4)"),
    "max(3, 7, 5)": ("(max 3 7 5)", "(max 3 7 5)"),
    "turn-left()": ("(turn-left)", "(turn-left)"),
    "2 + 3": ("The name of a function comes first, in parentheses: (+ 2 3)", "(+ 2 3)"),
    "24*60*60": ("(* 24 60 60)", "(* 24 60 60)"),
    "sleep 1": ("A form has parentheses around it: (sleep 1)", "A form has parentheses around it: (sleep 1)"),
    "defun f (x) x": ("A form has parentheses around it: (defun f (x) x)", "A form has parentheses around it: (defun f (x) x)"),
}


@pytest.mark.parametrize("line", LINES)
def test_a_line_of_python_is_told_as_it_is_written_here(line):
    for language, told in zip(("hy", "lisp"), LINES[line], strict=True):
        assert told in (of_line(line, language) or ""), of_line(line, language)


@pytest.mark.parametrize(
    "line", ["42", "metres", "*side*", "far-right.value", "turtle-pose", "(+ 1 2)", '"a = b"', "; x = 2", ":next", "", "-3"]
)
def test_of_forms_nothing_is_said(line):
    assert of_line(line, "hy") is None and of_line(line, "lisp") is None


@pytest.mark.parametrize(
    ("form", "told"),
    [
        ("(2 + 3)", "; The name of the function comes first: (+ 2 3)"),
        ("(defn f [] (24 * 60 * 60))", "; The name of the function comes first: (* 24 60 60)"),
        ("(defn turn-left () (sleep 1))", "; The arguments stand in brackets: (defn turn-left [] ...)"),
        ("(for (i (range 4)) (ahead 1))", "; The names and values stand in brackets: (for [i (range 4)] ...)"),
        ("(let (x 4) x)", "; The names and values stand in brackets: (let [x 4] ...)"),
        ("(max 1 two)", None),
    ],
)
def test_a_form_of_hy_that_is_written_otherwise(form, told):
    assert of_failed_form(form, "hy") == told and of_failed_form(form, "lisp") is None


def test_the_names_that_a_form_defines():
    assert names("(defn ahead [metres]\n  (sleep 1))") == {"ahead"} and names("(defvar *side* 4)") == {"*side*"}
    assert names("(import cram-my-beginner-tutorial :as tut)") == {"tut"} and names("(import math [pi sin])") == {"pi", "sin"}
    assert names("(setv far-right (> 1 2))") == {"far-right"} and names("(ahead 1)") == set()
    assert names("(defclass [dataclass] Way [])") == {"way"}


def test_a_missing_name_leads_back_to_the_form_that_was_passed_over():
    forms = [Form("(in-package :tut)", 4), Form("(defun ahead (metres)\n  (sleep 1))", 6)]
    ahead = "; ahead is defined by a form that you have not typed: (defun ahead (metres) ... :page 1 6 leads back to it."
    assert of_missing("AHEAD", forms, 7, 1, KNOWN) == ahead
    assert (
        of_missing("AHEAD", forms, 6, 1, KNOWN)
        == "; ahead is defined by a form of this step that you have not typed yet: (defun ahead (metres) ..."
    )
    loaded = "; What this page needs is loaded by a form that you have not typed: (in-package :tut). :page 1 4 leads back to it."
    assert of_missing("INIT", forms, 5, 1, KNOWN) == loaded and of_missing("inti", forms, 5, 1, KNOWN) is None
    assert of_missing("init", forms[1:], 5, 1, KNOWN) is None and of_missing("ahead", [], 5, 1, KNOWN) is None
