"""What a check notices on the way of a plan, in the student's session: motions, failures, calls, how a line was drawn, and what was typed."""

from __future__ import annotations

import re
import types

import pytest

from cramhy_runtime.course.checking import hy_evaluator
from cramhy_runtime.grading import in_session
from cramhy_runtime.grading.in_session import faults
from cramhy_runtime.grading.noticing import NO_FAILURE
from cramhy_runtime.grading.problems import ExerciseError
from cramhy_runtime.repl.session import Session
from cramhy_runtime.session import Image

START = '(ros-load:load-system :cram-my-beginner-tutorial) (in-package :tut) (start-ros-node "t") (init-ros-turtle "turtle1")'
PLANS = """
(defun ahead (metres) (send-vel-cmd metres 0) (sleep 1))
(defun left (angle) (send-vel-cmd 0 angle) (sleep 1))
(defun square (angle) (dotimes (i 4) (ahead 1) (left angle)))
(defun pen () (call-set-pen 255 255 255 7 0) (ahead 1))
(defun by-module ()
  (top-level (with-process-modules-running (turtlesim-navigation)
    (pm-execute 'turtlesim-navigation (desig:a motion (type driving) (speed 1))) (sleep 1))))
(defun handled (what)
  (top-level (with-failure-handling ((plan-failure (failure) (declare (ignore failure)) (return :handled))) (fail what))))
(defun without () (top-level (pursue (sleep 1) (sleep 2)) :handled))
"""


@pytest.fixture
def turtle():
    with Image():
        session = Session(time="virtual")
        session.evaluate_text(START)
        session.evaluate_text(PLANS)
        yield session


def told_of(session, **table):
    return faults("t", [table], session.evaluate_text)


SQUARE = {"way": "repeat 4 [ forward 1 left 90 ]"}
AGAIN = "The lines of the drawing are right, but 1.0 m of them were drawn more than once."
OTHER = "The lines of the drawing are right, but the order matters: the turtle drew them in another one, or the other way round."
COLOUR = "The lines of the drawing are right, but 1.1 m of them have another colour than they should, near x 4.0, y 4.0."
MISSING = "2.0 m of the drawing are missing, the first near x 4.0, y 4.0."
MUCH = "1.1 m of the drawing should not be there, the first near x 4.0, y 4.0."


DRAWN = [
    ("(square 1.5708)", {**SQUARE, "ordered": True}, []),
    ("(progn (square 1.5708) (ahead 1))", SQUARE, []),
    ("(progn (square 1.5708) (ahead 1))", {**SQUARE, "ordered": True}, [AGAIN]),
    ("(progn (left 1.5708) (square -1.5708))", SQUARE, []),
    ("(progn (left 1.5708) (square -1.5708))", {**SQUARE, "ordered": True}, [OTHER]),
    ("(pen)", {"way": "forward 1", "width": 7}, []),
    ("(pen)", {"way": "forward 1", "width": 3}, ["The lines are 7 pixels wide. They should be 3."]),
    ("(ahead 1)", {"way": "colour 255 0 0 forward 1"}, [COLOUR]),
    ("(ahead 1)", {"way": "colour 255 0 0 forward 2"}, [MISSING, MUCH]),
    ("(progn (ahead 1) (pen))", {"way": "forward 2", "width": 7}, ["The lines are 3 and 7 pixels wide. They should be 7."]),
]


def test_how_a_line_was_drawn_counts_where_a_check_asks_for_it(turtle):
    for form, paper, told in DRAWN:
        assert told_of(turtle, do=form, start=[4, 4, 0], paper=paper) == told


TURNS = [
    (1.5708, []),
    (-4.7124, ["To the left the turtle turned by -270.0 degrees in all. It should be 84 to 96."]),
    (7.854, ["To the left the turtle turned by 450.0 degrees in all. It should be 84 to 96."]),
]


def test_a_turn_the_other_way_round_is_another_turn(turtle):
    for angle, told in TURNS:
        found = told_of(turtle, do=f"(left {angle})", turned=[84, 96], at={"heading": 90})
        assert [re.sub(r"-?\d+\.\d", lambda number: str(round(float(number[0]), -1)), line) for line in found] == told


def test_a_turtle_that_nobody_stops_is_not_still(turtle):
    for form in ("(progn (send-vel-cmd 1 0) (sleep 0.5))", "(progn (send-vel-cmd 0 1) (sleep 0.5))"):
        assert told_of(turtle, do=form, still=True) == ["When the plan is over, the turtle still moves."]
        assert told_of(turtle, do=f"(progn {form} (send-vel-cmd 0 0))", still=True) == []


MOTIONS = [
    ("(by-module)", ["turtlesim-navigation"], []),
    ("(by-module)", ["turtlesim-navigation driving speed"], []),
    ("(ahead 1)", ["turtlesim-navigation"], "The process module turtlesim-navigation has got no motion from your plan."),
    (
        "(by-module)",
        ["turtlesim-navigation", "turtlesim-navigation"],
        "The process module turtlesim-navigation has got 1 motion from your plan, and that is not enough.",
    ),
    (
        "(by-module)",
        ["turtlesim-navigation going-to location"],
        "The process module turtlesim-navigation has not got all motions that it should: one described by going-to and location is missing.",
    ),
]


def test_a_check_sees_whether_a_module_got_a_motion(turtle):
    for form, motions, told in MOTIONS:
        assert told_of(turtle, do=form, motions=motions) == ([told] if told else [])


FAILURES = [
    ('(handled "text")', "simple-plan-failure", True),
    ("(handled 'simple-plan-failure)", "simple-plan-failure", True),
    ("(handled (make-condition 'simple-plan-failure))", "plan-failure", True),
    ("(handled 'plan-failure)", "simple-plan-failure", False),
    ("(without)", "simple-plan-failure", False),
]


def test_a_check_sees_whether_a_failure_came_up_though_it_was_handled(turtle):
    for form, failure, comes in FAILURES:
        assert told_of(turtle, do=form, value=":handled", failure=failure) == ([] if comes else [NO_FAILURE])


CALLED = "Your plan called ahead 4 times. It should be 2 to 3."
QUESTION = {"lisp": ["(list (twice 1) (twice 2))", "(2 4)"], "hy": ["(+ (twice 1) (twice 2))", "6"]}
STANDS = {"lisp": "(lambda (x) (1+ (funcall right x)))", "hy": "(fn [x] (+ 1 (right x)))"}


def test_calls_are_counted_and_the_function_is_there_again(turtle):
    assert told_of(turtle, do="(square 1)", calls={"ahead": [2, 3]}) == [CALLED]
    assert told_of(turtle, do="(square 1)", calls={"ahead": 4, "left": [1, 9]}) == []
    assert told_of(turtle, do="(ahead 1)", calls={"left": 1}) == ["Your plan called left 0 times. It should be 1."]
    assert turtle.evaluate_text("(get 'ahead :noticed)") == [None]


@pytest.mark.parametrize("language", ["lisp", "hy"])
def test_functions_stand_in_and_are_counted_in_both_languages(language):
    with Image():
        if language == "lisp":
            evaluate = Session(time="virtual").evaluate_text
            evaluate("(defun twice (x) (* 2 x))")
        else:
            Session(time="virtual")
            evaluate = hy_evaluator(types.ModuleType("students"))
            evaluate("(defn twice [x] (* 2 x))")
        form, answer = QUESTION[language]
        asked = {"ask": [[form, answer]]}
        assert faults("t", [{**asked, "calls": {"twice": 2}}], evaluate, language) == []
        (told,) = faults("t", [{**asked, "instead": {"twice": STANDS[language]}}], evaluate, language)
        assert told.endswith("and gave (3 5)." if language == "lisp" else "and gave 8.")
        assert faults("t", [asked], evaluate, language) == []


OTHERS = [
    ({"motions": "turtlesim-navigation"}, "motions is 'turtlesim-navigation', and not a list."),
    ({"calls": ["ahead"]}, "calls is ['ahead'], and not a dict."),
    ({"failure": True}, "failure is True, and not a str."),
]


def test_an_entry_of_another_kind_is_an_error_of_the_page(turtle):
    for table, told in OTHERS:
        with pytest.raises(ExerciseError) as problem:
            told_of(turtle, do="(ahead 1)", **table)
        assert str(problem.value) == told


def test_what_varies_is_tried_with_a_seed_that_nobody_knows(turtle, monkeypatch):
    seeds = []
    monkeypatch.setattr(in_session, "fresh_seed", lambda: seeds.append(1) or 99)
    known = {"vary": {"n": {"from": 1, "to": 1000, "step": 1}}, "ask": [["{n}", "{n}"]]}
    assert told_of(turtle, **known) == [] and len(seeds) == 1
    assert told_of(turtle, ask=[["1", "1"]]) == [] and len(seeds) == 1


def test_a_run_that_varies_is_told_with_its_call(turtle):
    found = told_of(turtle, do="(ahead {n})", vary={"n": [2]}, start=[3, 4, 0], distance=1)
    assert found[-1] == "The check called (ahead 2), with the turtle at x 3.0, y 4.0, looking to 0 degrees."


def test_what_was_typed_stands_in_a_question(turtle):
    asked = {"ask": [["(let ((n 3)) (typed *n*))", "6"]], "say": "No."}
    for form, told in [("(* 2 n)", []), ("6", []), ("(* n n)", ["No."]), (None, [])]:
        assert faults("t", [asked], turtle.evaluate_text, "lisp", {"*n*": form}.get) == told
    assert faults("t", [asked], turtle.evaluate_text) == []
