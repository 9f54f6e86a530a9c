"""What fresh readers stumbled at: each mistake is typed at the prompt of ``cramhy learn``, and the screen says what helps."""

from __future__ import annotations

from pathlib import Path

import pytest

from cramhy_runtime.course.parts import Typed
from cramhy_runtime.course.progress import Progress
from cramhy_runtime.course.steps import answer_shown

from .test_learn import step_with

SOLUTIONS = Path(__file__).parent / "solutions"


def words(shown):
    """The words of the screen, without the line ends that the width made."""
    return " ".join(shown.replace("\n;", " ").split())


# ------------------------------------------------------------------------------------------------------------- outside of a plan

START = {
    "lisp": ['(ros-load:load-system "cram_my_beginner_tutorial" :cram-my-beginner-tutorial)', "(in-package :tut)"],
    "hy": ["(import cram-my-beginner-tutorial :as tut)"],
}
OUTSIDE = {
    "lisp": {
        "(move-to (make-3d-vector 8 5 0))": "(move-to (make-3d-vector 8 5 0))",
        "(progn 1 (rotate-to (make-3d-vector 8 5 0)))": "(progn 1 (rotate-to (make-3d-vector 8 5 0)))",
        "(defun drive-to (x y) (move-to (make-3d-vector x y 0)))\n(drive-to 3 3)": "(drive-to 3 3)",
        "(move-to\n (make-3d-vector 8 5 0))": "(move-to ...)",
    },
    "hy": {
        "(tut.move-to (make-3d-vector 8 5 0))": "(tut.move-to (make-3d-vector 8 5 0))",
        "(do 1 (tut.rotate-to (make-3d-vector 8 5 0)))": "(tut.rotate-to (make-3d-vector 8 5 0))",
        "(defn drive-to [x y] (tut.move-to (make-3d-vector x y 0)))\n(drive-to 3 3)": "(drive-to 3 3)",
        "(setv there (tut.move-to\n (make-3d-vector 8 5 0)))": "(tut.move-to ...)",
    },
}


@pytest.mark.soak
@pytest.mark.parametrize(("language", "form"), [(language, form) for language, forms in OUTSIDE.items() for form in forms])
def test_a_plan_function_outside_of_a_plan_names_the_form_of_the_student(typed, language, form):
    shown = words(
        typed([*START[language], "(init)" if language == "lisp" else "(tut.init)", *form.split("\n"), "q", ":quit"], language=language)
    )
    told = f"Functions with plan forms are called inside of a plan: write (top-level {OUTSIDE[language][form]})."
    assert "form not inside a plan" in shown and told in shown and "this leads there" not in shown


@pytest.mark.parametrize("language", ["lisp", "hy"])
def test_a_plan_form_that_was_typed_itself_is_named_as_before(typed, language):
    shown = words(typed([*START[language], "(par (sleep 1))", "q", ":quit"], language=language))
    assert "Plan forms run inside of a plan: write (top-level (par ...))." in shown


# --------------------------------------------------------------------------------------------------------- the words of Hy in Hy


IN_HY = {
    "(top-level (wait-for 1))": "wait-for takes a fluent, but was given 1 (of the type int), which never changes. Write (wait-for f)",
    "(top-level (wait-for (> 1 0)))": "Write (wait-for (< f x)) or (wait-for (fl-eql f x)) with the fluent f itself.",
    "(top-level (wait-for max))": "and write (wait-for (fl-funcall function f)) or (wait-for (< f 1)).",
    "(nosuch-name 1)": "NameError: name 'nosuch-name' is not defined",
    "(print nosuch_name)": "NameError: name 'nosuch_name' is not defined",
    "(print nosuch->name)": "NameError: name 'nosuch->name' is not defined",
    "(cpm:matching-process-modul 1)": "NameError: name 'cpm:matching-process-modul' is not defined",
    "(. max no-such)": "has no attribute 'no-such'",
    "(print (2 3))": "TypeError: 'int' object is not callable",
    "(defn go? [] (none?))\n(go?)": "NameError: name 'none?' is not defined",
}
OF_PYTHON = ("cpl.", "hyx_", "missed a comma")


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("form", IN_HY)
def test_an_error_in_hy_speaks_hy(typed, form):
    shown = words(typed([*form.split("\n"), ":quit"], language="hy"))
    assert IN_HY[form] in shown and not [word for word in OF_PYTHON if word in shown]


# ------------------------------------------------------------------------------------------------------------ the words of Lisp in Lisp


IN_LISP = {
    "true": "In Lisp, True is written t.",
    "None": "In Lisp, None is written nil.",
    "(defn f [x] x)": "In Lisp, defn is written (defun name (argument ...) form...).",
    "(setv x 5)": "In Lisp, setv is written (setf name value).",
    "(len 5)": "In Lisp, len is written (length values).",
    "(list [1 2])": "Lisp has no [ here. It writes '(1 2), or #(1 2) for a vector.",
}


@pytest.mark.soak(all_but=3)
@pytest.mark.parametrize("form", IN_LISP)
def test_an_error_in_lisp_speaks_lisp(typed, form):
    shown = words(typed([form, "q", ":quit"]))
    assert IN_LISP[form] in shown and "Hy" not in shown.split("debugger invoked")[1] and "in-hy" not in shown


# -------------------------------------------------------------------------------------------------------------- what fills the screen


def test_the_debugger_repeats_no_choices_of_the_errors_before(typed):
    shown = typed(["(+ 1 two)", "(car 7)", "(cdr 8)", "0", "0", "q", "(+ 40 2)", ":quit"])
    first, second, third = shown.split("debugger invoked on ")[1:]
    assert "  3: [ABORT      ] Exit debugger, returning to top level.\n" in first
    assert "  0: [ABORT] Return to debugger level 0.\n  1 and more: the choices of the errors before\n;" in second
    assert "  0: [ABORT] Return to debugger level 1.\n  1 and more: the choices of the errors before\n;" in third
    assert "\n42\n" in third and "There is no choice" not in shown


@pytest.mark.parametrize("language", ["lisp", "hy"])
def test_type_writes_nothing_over_a_solved_task_unless_asked_again(typed, language):
    progress = Progress()
    progress.solved.add("rectangle")
    here = step_with(2, language, "rectangle")
    told = "; This task is solved, and your solution counts."
    shown = typed([here, ":type", ":quit"], "names-and-functions", language, progress)
    assert told in shown and f"> ({'defun' if language == 'lisp' else 'defn'} rectangle-around" not in shown.split(told)[1]
    shown = typed([here, ":type", ":type", "(rectangle-around 2 3)", ":quit"], "names-and-functions", language, progress)
    assert "\n5\n" in shown.split(told)[1]


@pytest.mark.soak
@pytest.mark.parametrize("language", ["lisp", "hy"])
def test_a_check_shows_no_log_and_no_warning_of_its_own_facts(typed, language):
    begin = (
        ['(ros-load:load-system "cram_my_beginner_tutorial" :cram-my-beginner-tutorial)', "(in-package :tut)", "(init)"]
        if language == "lisp"
        else [
            "(lisp-package :turtlesim-in-hy)",
            "(import turtlesim-in-hy.process-modules [init])",
            "(import turtlesim-in-hy.selecting-process-modules [perform-some-motion])",
            "(init)",
        ]
    )
    dash = (SOLUTIONS / f"blue-dash.{'lisp' if language == 'lisp' else 'hy'}").read_text()
    shown = typed(
        [*begin, *dash.strip().split("\n"), step_with(8, language, "blue-dash"), ":check", ":quit"], "choosing-a-module", language
    )
    checked = shown.rsplit(":page", 1)[-1] if ":page" in shown else shown
    assert "Well done" in shown and "invoked with motion designator" not in checked


def test_a_broken_line_of_an_answer_has_no_marks_below_it():
    long, short = "    " + "(word) " * 12, "    (word)"
    shown = answer_shown(Typed("=> ", "(f)", f"Traceback (most recent\n{long}\n          ^^^^\n{short}\n     ^^^^\nNameError\n"))
    assert f"{long}\n{short}\n     ^^^^\n" in shown


@pytest.mark.parametrize(("step", "foot"), [("4 4", "; :next shows it."), ("4 6", "; :next goes on.")])
def test_a_step_whose_text_ends_in_a_colon_says_that_the_next_one_shows_it(typed, step, foot):
    assert foot in typed([f":page {step}", ":quit"], "lecture-34")


@pytest.mark.parametrize("language", ["lisp", "hy"])
def test_a_name_of_the_students_own_leads_to_no_form_that_loads(typed, language):
    far = step_with(1, language, "first-square")
    assert "is loaded by" not in words(typed([far, "(blubb 1)", "q", ":quit"], language=language))
    start = "(init)" if language == "lisp" else "(tut.init)"
    assert "by a form that you have not typed:" in words(typed([far, start, "q", ":quit"], language=language))
