"""What fresh readers stumbled at: each mistake is typed at the prompt of ``cramhy learn``, and the screen says what helps."""

from __future__ import annotations

import pytest


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


@pytest.mark.parametrize("form", IN_HY)
def test_an_error_in_hy_speaks_hy(typed, form):
    shown = words(typed([*form.split("\n"), ":quit"], language="hy"))
    assert IN_HY[form] in shown and not [word for word in OF_PYTHON if word in shown]
