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
