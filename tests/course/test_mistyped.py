"""Slips of writing at the prompt of ``cramhy learn``: the guide says what stands wrong, and nothing of what is right."""

from __future__ import annotations

import pathlib

import pytest

from cramhy_runtime.course import reading
from cramhy_runtime.course.mistyped import of_failed_form, of_form, of_name
from cramhy_runtime.course.parts import Code, File

from .test_stumbles import words

EITHER = {
    "(print 'done')": '; A text stands in double quotes: "done"',
    "(print 'it is done')": '; A text stands in double quotes: "it is done"',
    "(print “done”)": '; A text stands in straight double quotes: "done"',
    "(print „done“)": '; A text stands in straight double quotes: "done"',
}
HY = {
    **EITHER,
    "[4, 5]": "; Between values stand spaces, and no commas: [4 5]",
    "(defn area [width, height] (* width height))": "; Between values stand spaces, and no commas: [width height]",
    "(max 8, 5.5)": "; Between values stand spaces, and no commas: (max 8 5.5)",
    "(visit [[8, 5] [8 9]])": "; Between values stand spaces, and no commas: [8 5]",
    "(setv angle 1,57)": "; A number has a point: 1.57. Hy leaves the comma in 1,57 out.",
    "(setv metres = 5)": "; setv takes no =: (setv metres 5)",
    "(setv area = (* 2 3))": "; setv takes no =: (setv area ...)",
    "(let [x = 4] x)": "; let takes no =: (let [x 4] ...)",
    "(import math as m)": "; A colon stands before as: math :as m",
    "(import math [pi as p])": "; A colon stands before as: pi :as p",
}
LISP = {
    **EITHER,
    "(defvar *metres* = 5)": "; defvar takes no =: (defvar *metres* 5)",
    "(setf *metres* = 5)": "; setf takes no =: (setf *metres* 5)",
    "(let ((x = 4)) x)": "; let takes no =: (let ((x 4)) ...)",
}


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize(("language", "form"), [("hy", form) for form in HY] + [("lisp", form) for form in LISP])
def test_a_slip_is_told_with_the_words_of_the_student(typed, language, form):
    told = {"hy": HY, "lisp": LISP}[language][form]
    assert of_form(form, language) == told
    assert told[2:] in words(typed([form, "q", ":quit"], language=language))


@pytest.mark.parametrize(
    "form",
    [
        "(print \"a, b 'c' = d\")",
        "(f 'a 'b)",
        "(+ 1 2) ; one, two",
        "`(a ,b ,@c)",
        "(= x 5)",
        "(setv x (= y 5))",
        "1,000",
        "(print '(a b))",
        "[]",
    ],
)
def test_of_other_forms_nothing_is_said(form):
    assert of_form(form, "hy") is None and of_form(form, "lisp") is None


def forms_of_all_pages(language):
    for page in reading.pages():
        for part in page.parts:
            if isinstance(part, Code):
                yield from (each.text for each in getattr(part, language))
            elif isinstance(part, File) and getattr(part, language):
                yield getattr(part, language)[1]
    for file in (pathlib.Path(__file__).parent / "solutions").glob("*.lisp" if language == "lisp" else "*.hy"):
        yield file.read_text(encoding="utf-8")


@pytest.mark.parametrize("language", ["lisp", "hy"])
def test_no_form_of_the_pages_and_no_solution_is_taken_for_a_slip(language):
    assert [form for form in forms_of_all_pages(language) if of_form(form, language)] == []


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize(("name", "written"), [("true", "True"), ("false", "False"), ("null", "None"), ("nil", "None")])
def test_other_names_for_values_are_told_in_hy(typed, name, written):
    assert written in of_name(name, "hy") and of_name(name, "lisp") is None and of_name("truth", "hy") is None
    for form in (name, f"(if {name} 1 2)", f"(setv x {name})"):
        assert f"Hy writes {written}" in words(typed([form, ":quit"], language="hy"))


FAILED = {
    "(prolog (shape box))": "A question to Prolog is not a call. A quote stands before it: (prolog '(shape ...))",
    "(def-fact-group shapes\n  (<- (shape box)))": "and {} if it extends none: (def-fact-group shapes {} ...)",
}


@pytest.mark.parametrize("language", ["lisp", "hy"])
def test_what_was_left_out_is_told_where_a_form_has_failed(typed, language):
    begin = ["(in-package :tut)"] if language == "lisp" else []
    load = ['(ros-load:load-system "cram_my_beginner_tutorial" :cram-my-beginner-tutorial)'] if language == "lisp" else []
    for form, told in FAILED.items():
        told = told.replace("{}", "[]" if language == "hy" else "()")
        assert told in of_failed_form(form, language)
        assert told in words(typed([*load, *begin, *form.split("\n"), "q", ":quit"], language=language))
    assert of_failed_form("(prolog '(shape ?x))", language) is None


HANDLERS = {
    "lisp": (
        "(defun go-on ()",
        '  (top-level (with-failure-handling ((simple-plan-failure (e) (print "no"))) (fail "Lost."))))',
        "(return ...)",
    ),
    "hy": (
        "(defn go-on []",
        '  (top-level (with-failure-handling [[simple-plan-failure [e] (print "no")]] (fail "Lost."))))',
        "(leave ...)",
    ),
}


@pytest.mark.parametrize("language", ["lisp", "hy"])
def test_a_handler_that_passes_the_failure_on_is_told(typed, language):
    head, body, leave = HANDLERS[language]
    begin = (
        ['(ros-load:load-system "cram_my_beginner_tutorial" :cram-my-beginner-tutorial)', "(in-package :tut)"] if language == "lisp" else []
    )
    shown = words(typed([*begin, head, body, "(go-on)", "q", ":quit"], language=language))
    assert f"A handler that comes to its end passes the failure on. {leave} in it ends the block" in shown
    good = body.replace('(print "no")', f"{leave.split()[0]} 1)")
    assert "passes the failure on" not in typed([*begin, head, good, '(fail "x")', "q", ":quit"], language=language)


def test_a_form_that_answers_rightly_on_the_page_has_no_remark(typed):
    assert "stand spaces" not in typed(['(print "4, 5")', ":quit"], language="hy")


@pytest.mark.soak
def test_a_misspelt_name_of_a_package_is_guessed_in_hy(typed):
    begin = ["(import cram-my-beginner-tutorial :as tut)"]
    shown = words(typed([*begin, "(cpm:matching-process-modul 1)", "(exe:perfrom 1)", "(cpm:xyzzy 1)", ":quit"], language="hy"))
    assert "Did you mean cpm:matching-process-module" in shown and "Did you mean exe:perform?" in shown and shown.count("Did you mean") == 2
