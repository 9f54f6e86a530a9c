"""Checks of what stands in a session that is there already: nothing is loaded, and the session goes on afterwards."""

from __future__ import annotations

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.grading.in_session import NO_TURTLE, faults
from cramhy_runtime.grading.problems import ExerciseError
from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.repl.session import Interruption, Session
from cramhy_runtime.session import Image
from cramhy_runtime.turtlesim.node import running_simulator

START = '(ros-load:load-system :cram-my-beginner-tutorial) (in-package :tut) (start-ros-node "t") (init-ros-turtle "turtle1")'
AHEAD = "(defun ahead (metres) (send-vel-cmd metres 0) (sleep 1))"


@pytest.fixture
def session():
    with Image():
        yield Session(time="virtual")


@pytest.fixture
def turtle(session):
    session.evaluate_text(START)
    session.evaluate_text(AHEAD)
    return session


def of(session, *tables):
    return faults("t", list(tables), session.evaluate_text)


def test_questions_with_seeds_and_all_of_them_must_be_right(session):
    session.evaluate_text("(defun twice (x) (if (= x 3) 6 (* 2 x)))")
    asked = {"vary": {"x": [3, 5, 8]}, "seeds": 3, "ask": [["(twice {x})", "{2 * x}"]]}
    assert of(session, asked) == []
    session.evaluate_text("(defun twice (x) (if (= x 3) 6 0))")
    (told,) = of(session, asked)
    assert "should give" in told and "and gave 0" in told


@pytest.mark.parametrize(
    ("form", "told"),
    [
        ("(nothing-here 1)", "There is no function nothing-here yet."),
        ("(list (nothing-here))", "There is no function nothing-here yet."),
        ("*nothing*", "There is no variable *nothing* yet."),
        ("(1+ *nothing*)", "There is no variable *nothing* yet."),
        ("(funcall #'nothing-here 1)", "There is no function nothing-here yet."),
    ],
)
def test_what_is_not_defined_yet_is_told_plainly(session, form, told):
    assert of(session, {"ask": [[form, "1"]]}) == [told]


def test_a_function_that_is_counted_or_replaced_and_not_there_opens_no_debugger(turtle):
    opened = []
    debugger = conditions.install_debugger(opened.append)
    try:
        counted = of(turtle, {"do": "(nothing-here)", "calls": {"nothing-here": 1}})
        replaced = of(turtle, {"ask": [["1", "1"]], "instead": {"nothing-here": "(lambda () 1)"}, "say": "No."})
    finally:
        conditions.install_debugger(debugger)
    assert "There is no function nothing-here yet." in counted
    assert replaced == ["There is no function nothing-here yet."] and not opened


def test_an_error_below_the_function_is_told_with_its_place(session):
    session.evaluate_text("(defun f () (g 1))")
    (told,) = of(session, {"ask": [["(f)", "1"]]})
    assert "(f) ended with an error" in told and "COMMON-LISP-USER::G is undefined" in told


def test_a_hint_is_added_and_say_replaces(session):
    assert of(session, {"ask": [["1", "2"]], "hint": "Think."}) == ["1 should give 2, and gave 1.", "Think."]
    assert of(session, {"ask": [["1", "2"]], "say": "No."}) == ["No."]


def test_the_first_check_that_fails_is_told(session):
    assert of(session, {"ask": [["1", "1"]]}, {"ask": [["2", "1"]]}, {"ask": [["3", "1"]]}) == ["2 should give 1, and gave 2."]


def test_of_many_wrong_answers_three_are_told_and_of_many_errors_one(session):
    assert len(of(session, {"ask": [[str(number), "0"] for number in range(1, 7)]})) == 3
    assert len(of(session, {"ask": [[f"(error {text})", "0"] for text in ('"one"', '"two"')]})) == 1


def test_true_and_false_are_told_in_the_language_of_the_check(session):
    table = {"ask": [["(> 1 2)", "T"]]}
    assert faults("t", [table], session.evaluate_text, "lisp") == ["(> 1 2) should give T, and gave NIL."]
    assert faults("t", [table], session.evaluate_text, "hy") == ["(> 1 2) should give True, and gave None."]


def test_a_table_that_means_nothing_is_an_error_of_the_page(session):
    with pytest.raises(ExerciseError, match="has aks, which means nothing there"):
        of(session, {"ask": [["1", "1"]], "aks": 1})


def test_a_plan_begins_with_a_clean_paper_wherever_the_turtle_was(turtle):
    turtle.evaluate_text("(ahead 3) (call-set-pen 0 0 0 3 1) (send-vel-cmd 0 1)")
    driven = {"do": "(ahead 2)", "start": [3, 4, 0], "paper": {"way": "forward 2"}, "at": {"x": 5, "y": 4}}
    assert of(turtle, driven) == [] == of(turtle, driven)
    assert "should end at x 9.0" in of(turtle, {**driven, "at": {"x": 9, "y": 4}})[0]


def test_the_paper_and_the_place_can_be_looked_at_as_they_are(turtle):
    turtle.evaluate_text("(ahead 2) (sleep 0.1)")
    assert of(turtle, {"paper": {"way": "forward 2", "from": [5.544, 5.544, 0]}, "at": {"x": 7.544, "y": 5.544}}) == []
    assert "missing" in of(turtle, {"paper": {"way": "forward 4", "from": [5.544, 5.544, 0]}})[0]
    x, y, *_ = running_simulator().turtles["turtle1"].pose()
    assert (round(x, 1), round(y, 1)) == (7.6, 5.5), "a look moves nothing"


@pytest.mark.parametrize("table", [{"do": "1", "at": {"x": 1}}, {"at": {"x": 1}}])
def test_without_a_turtle_that_is_told(session, table):
    assert of(session, table) == [NO_TURTLE]


def test_the_session_is_afterwards_as_it_was(turtle):
    simulator, debugger = running_simulator(), object()
    conditions.install_debugger(debugger)
    kernel.pace().set_speed(4)
    kernel.pace().pause()
    of(turtle, {"do": "(car 7)", "at": {"x": 1}})
    assert simulator.listener is None and simulator.observers == ()
    assert kernel.pace().speed == 4 and kernel.pace().paused
    kernel.pace().resume()
    kernel.pace().set_speed(None)
    assert conditions.install_debugger(None) is debugger
    assert turtle.evaluate_text("(+ 1 1)") == [2]


def test_a_plan_that_never_ends_is_ended_by_the_turtles_time(turtle):
    assert of(turtle, {"do": "(loop (sleep 1))", "at": {"x": 1}})[0] == "(loop (sleep 1)) did not come to its end in 120 seconds."


def test_an_interrupt_ends_the_check_and_is_no_verdict(session):
    def evaluate(form):
        raise Interruption

    with pytest.raises(Interruption):
        faults("t", [{"ask": [["1", "1"], ["2", "2"]]}], evaluate)


def test_a_program_that_wants_to_leave_leaves_the_check_only(session):
    assert "ended the session with (quit)" in of(session, {"ask": [["(quit)", "1"]]})[0]
