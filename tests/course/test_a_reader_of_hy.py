"""What stopped a fresh reader of Hy on pages 1 to 8, in the terminal: what is said at each such place."""

from __future__ import annotations

import pytest

from cramhy_runtime.course.mistyped import of_error, of_failed_form, of_form, of_name, of_text
from cramhy_runtime.course.progress import Progress
from cramhy_runtime.course.slips import first_line, in_words_of_hy

from .test_fresh_readers import START
from .test_learn import step_of_form, step_with, words

NAMES = {
    "(import math)\n(sin 1)": "sin is a name of math: math.sin",
    "(import cram-my-beginner-tutorial :as tut)\n(send-vel-cmd 2 0)": "send-vel-cmd is a name of tut: tut.send-vel-cmd",
    "(import cram-my-beginner-tutorial :as tut)\n(defn f [] turtle-pose)\n(f)": "turtle-pose is a name of tut: tut.turtle-pose",
    "sleep 1": "sleep stands at the head of its form, as in (sleep ...).",
    "import math": "import stands at the head of its form, as in (import ...).",
    "top-level": "top-level stands at the head of its form, as in (top-level ...).",
}


@pytest.mark.soak
@pytest.mark.parametrize("form", NAMES)
def test_a_name_that_is_missing_is_found_where_it_is(typed, form):
    shown = words(typed([*form.split("\n"), ":quit"], language="hy"))
    assert NAMES[form] in shown and "is Common Lisp" not in shown and "Lisp package" not in shown


@pytest.mark.soak
@pytest.mark.parametrize("form", ["(mapcar 1 2)", "(y 1)", "(nosuch 1)"])
def test_other_names_stand_at_no_head_and_in_no_module(typed, form):
    shown = typed(["(import cram-my-beginner-tutorial :as tut)", form, ":quit"], language="hy")
    assert "stands at the head" not in shown and "is a name of" not in shown


ERRORS = {
    ("'ValueFluent' object is not callable", "(turtle-pose)"): "(turtle-pose) calls turtle-pose, which is not a function.",
    ("'int' object is not callable", "(call-set-pen (255 255 0) 10 0)"): "(255 ...) is a call of 255, and a number is not a function.",
    ("'ValueFluent' object has no attribute 'linear_velocity'", "(f p.linear-velocity)"): "A fluent has no linear-velocity, but its value has.",
    ("'bool' object has no attribute 'value'", "high.value"): "A value that was computed once does not change any more",
    ("The value 9 is not of type\n    CL-TRANSFORMS:POINT", "(rotate-to 9 9)"): "A point is made by make-3d-vector",
    ("no applicable method for the generic function\n    #<STANDARD-GENERIC-FUNCTION CL-TRANSFORMS:X>", "(move-to p)"): "A point is made by",
    ("Can't assign or delete a non-expression", "(for [(x y) points] (f x))"): "stand in brackets: (for [[x y] ...] ...)",
}  # fmt: skip


@pytest.mark.parametrize("error", ERRORS)
def test_an_error_that_does_not_name_the_slip_is_explained(error):
    assert ERRORS[error] in (of_error(*error, "hy") or "")


@pytest.mark.parametrize(
    "error",
    [("'int' object is not callable", "(f x)"), ("'str' object has no attribute 'value'", "x.value"), ("is not of type LIST", "(f 1)")],
)
def test_other_errors_are_left_as_they_are(error):
    assert of_error(*error, "hy") is None


@pytest.mark.soak
def test_slips_in_rules():
    arrow = "Each fact and each rule of a group stands in a form of its own that begins with <-"
    assert arrow in of_failed_form("(def-fact-group shapes [] (shape house 5))", "hy")
    assert arrow in of_failed_form("(def-fact-group shapes () (shape house 5))", "lisp")
    assert "(<- (shape ...))" in of_failed_form("(def-fact-group shapes [] (<- shape house 5))", "hy")
    assert of_failed_form("(def-fact-group shapes [motion-grounding] (<- (shape house 5)) (<- (shape castle 9)))", "hy") is None
    for language, group in (("hy", "[]"), ("lisp", "()")):
        assert "as in (> ?number 7)" in of_form(f"(def-fact-group l {group} (<- (big ?s) (shape ?s ?size) (?size > 5)))", language)
        assert of_form(f"(def-fact-group l {group} (<- (big ?s) (shape ?s ?size) (> ?size 5)))", language) is None


def test_a_text_without_its_quotes_is_told_from_the_page():
    forms = ['(start-ros-node "turtle1")', "(sleep 0.1)"]
    assert of_text("cram", "(start-ros-node cram)", forms) == '; A text stands in double quotes: (start-ros-node "cram")'
    assert of_text("cram", "(sleep cram)", forms) is None and of_text("node", "(start-ros-node cram)", forms) is None


@pytest.mark.soak
def test_a_minus_before_a_name_is_a_call():
    assert of_name("-motion", "hy", "(f -motion.angle)") == "; The minus is a function, with parentheses around the call: (- motion.angle)"
    assert of_name("-", "hy") is None


def test_the_words_of_lisp_in_messages():
    told = "Running now: none. Modules run in (cpm:with-process-modules-running (a b) ...)."
    assert in_words_of_hy(told).endswith("Modules run in (with-process-modules-running [a b] ...).")
    nested = "already: leave TOP-LEVEL away here, or make what is called a plan function with DEF-CRAM-FUNCTION."
    assert in_words_of_hy(nested) == "already: leave top-level away here."


@pytest.mark.soak
def test_forms_are_named_by_their_first_lines():
    assert first_line("(init)") == "(init)" and first_line("(top-level\n  (f))") == "(top-level ...)"
    assert first_line("(defn f [x]\n  x)") == "(defn f [x] ..."


@pytest.mark.soak
def test_a_form_that_failed_was_not_typed(typed):
    """(init) came before the form that makes it known."""
    first, load, init = "(lisp-package :turtlesim-in-hy)", "(import turtlesim-in-hy.process-modules [init])", "(init)"
    choose = "(import turtlesim-in-hy.selecting-process-modules [perform-some-motion])"
    place = step_of_form(8, "hy", init)
    drive = "(perform-some-motion (desig:a motion (type driving) (speed 3)))"
    shown = words(typed([place, init, first, load, choose, drive, ":quit"], "choosing-a-module", "hy"))
    assert f"The robot is started by a form of this step that you have not typed yet: {init}" in shown
    assert "The robot is started" not in typed([place, first, load, choose, init, drive, ":quit"], "choosing-a-module", "hy")


@pytest.mark.soak
def test_what_was_ended_by_ctrl_c_is_not_typed_again(typed, tmp_path):
    path = str(tmp_path / "learn.json")
    typed([":n", "(setv a 1)", "(raise KeyboardInterrupt)", ":quit"], language="hy", progress=Progress(path))
    shown = typed([":replay", "a", ":quit"], None, "hy", Progress(path))
    assert "; Typed again: 1 text." in shown and "raise" not in shown


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize(
    ("form", "told"),
    [
        ("(defn rectangle-around [w h] (2 * (+ w h)))", "7 * 9 is written (* 7 9)"),
        ("(defn rectangle-around [w h] (for [i w] h))", "A loop goes through values"),
        ("(defn rectangle-around [w h] (+ w -w))", "The minus is a function"),
    ],
)
def test_a_slip_that_only_the_check_meets_is_told_below_it(typed, form, told):
    shown = typed([step_with(2, "hy", "rectangle"), form, ":check", ":quit"], "names-and-functions", "hy")
    assert told in words(shown) and "hyx_" not in shown.split(":check")[1]


@pytest.mark.soak
def test_a_check_names_functions_as_hy_does(typed):
    forms = [*START["hy"], "(defn turn-left [] (tut.send-vel-cmd 1))", step_with(1, "hy", "turn-left"), ":check", ":quit"]
    shown = words(typed(forms, language="hy"))
    assert "send-vel-cmd takes 2 arguments." in shown and "SEND-VEL-CMD takes" not in shown
