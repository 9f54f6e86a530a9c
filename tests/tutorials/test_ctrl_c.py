"""Ctrl-C in the middle of the house: the turtle stands, the modules are gone, the report says where the plan was, and one goes on."""

from __future__ import annotations

import pytest

from repl.terminal import Terminal

from .course import BACKENDS

PROMPT = "TUT> "
SPEED = """(py:method (py:call "cramhy_runtime.kernel.pace") "set_speed" {})"""  # that the plan is not over before the key is pressed
PLACE = "(with-fields (x y theta) (value *turtle-pose*) (list x y theta))"


@pytest.mark.soak
@pytest.mark.parametrize("backend", BACKENDS)
@pytest.mark.parametrize("motions", [1, 4, 9], ids=["on the way", "at the walls", "at the door"])
def test_a_house_is_left_unfinished(backend, motions):
    with Terminal("repl", "--time", "virtual", "--backend", backend, "--load", "cram-my-beginner-tutorial", "--package", "tut") as terminal:

        def answer(form):
            terminal.type(form)
            return terminal.expect(PROMPT).removesuffix(PROMPT).strip().splitlines()[1:]

        terminal.expect(PROMPT)
        answer("(init)")
        answer(SPEED.format(30))
        terminal.type("(perform-draw-house)")
        for _ in range(motions):
            terminal.expect("TYPE MOVING")
        terminal.control_c()
        assert "; Interrupted." in terminal.expect(PROMPT)
        answer(SPEED.format("nil"))
        report = "\n".join(answer("(describe-task-tree)"))
        assert "No plan runs now. The last one when it was interrupted" in report
        assert "[GOAL-PERFORM] (GOAL (PERFORM #<A MOTION (TYPE MOVING)" in report
        answer("(sleep 0.1)")
        place = answer(PLACE)
        answer("(sleep 2)")
        assert answer(PLACE) == place
        assert answer("(list (get-running-process-module 'turtlesim-navigation) (get-running-process-module 'turtlesim-pen-control))") == [
            "(NIL NIL)"
        ]
        assert answer("(move-simple 5 5)")[-1] == "T"
