"""The functions of simple plans and process modules, each with many seeds: where the turtle is afterwards, and that it stands."""

from __future__ import annotations

import math
import random

import pytest

from .course import SEEDS, STEP, seeded

pytestmark = [pytest.mark.parametrize("seed", SEEDS), pytest.mark.usefixtures("language")]
NEAR = 0.1 + STEP  # metres: the threshold of move-to, and the way of a tick


@pytest.fixture
def turtle(seed):
    """A turtle; after the test it stands still and nothing is left of the plans."""
    with seeded(seed) as course:
        yield course
        assert course.stands_still()
        assert course.left() == []


@pytest.mark.soak(all_but=1)
def test_simple_plans_reach_their_goals(turtle, seed):
    luck = random.Random(seed)
    for _ in range(3):
        x, y = luck.uniform(1, 10), luck.uniform(1, 10)
        turtle(f"(top-level (rotate-to (make-3d-vector {x} {y} 0)))")
        angle = turtle(f"(relative-angle-to (make-3d-vector {x} {y} 0) (value *turtle-pose*))")
        assert abs(angle) < 0.05
        assert turtle(f"(calculate-angular-cmd (make-3d-vector {x} {y} 0))") == 4 * angle
        turtle(f"(top-level (move-to (make-3d-vector {x} {y} 0)))")
        assert math.dist(turtle.place, (x, y)) < NEAR
    here = turtle("(translation (pose-msg->transform (value *turtle-pose*)))")
    assert (here.x, here.y, here.z) == (*turtle.place, 0)


@pytest.mark.soak(all_but=1)
def test_a_plan_that_is_ended_stops_the_turtle_on_the_way(turtle):
    turtle("(top-level (pursue (move-to (make-3d-vector 9 9 0)) (sleep 1)))")
    assert 1 < math.dist(turtle.place, (5.544, 5.544)) < 2
    turtle("(top-level (pursue (rotate-to (make-3d-vector 1 1 0)) (sleep 0.1)))")


@pytest.mark.soak(all_but=1)
def test_drive_is_one_command(turtle):
    assert turtle("(drive 3 2)") == 2  # subscribers: the turtle, and the witness of this test
    turtle("(sleep 1.1)")
    assert [command[1:] for command in turtle.commands] == [(3, 2)]
    turtle("(send-vel-cmd 0 0)")


@pytest.mark.soak(all_but=1)
def test_move_simple(turtle):
    turtle("(move-simple 2 7)")
    assert math.dist(turtle.place, (2, 7)) < NEAR
    turtle("(move-simple 7 2)")
    assert math.dist(turtle.place, (7, 2)) < NEAR


@pytest.mark.soak(all_but=1)
def test_move_parallel_does_one_thing_after_the_other(turtle, capsys):
    """Which of the two requests is handed in first is a choice of the seed; on the slides it is the goal."""
    turtle("(move-parallel)")
    waited = capsys.readouterr().err.count("already processing input. Waiting for it to become free.")
    commands = [command[1:] for command in turtle.commands]
    assert commands.count((3, 8)) == 1
    assert math.dist(turtle.place, (9, 1)) < NEAR
    if commands[-1] == (3, 8):
        assert waited == 1 and commands[-2] == (0, 0)
        turtle("(sleep 1.1)")
        assert math.dist(turtle.place, (9, 1)) < NEAR + 2 * 3 / 8  # a circle of three metres in eight radians
        turtle("(send-vel-cmd 0 0)")
    else:
        assert waited <= 1 and commands[0] == (3, 8) and commands[-1] == (0, 0)


@pytest.mark.soak(all_but=1)
def test_drive_n_draw_does_two_things_at_once(turtle, seed):
    turtle("(drive-n-draw 9 9)")
    assert math.dist(turtle.place, (9, 9)) < NEAR
    on, colour, width = turtle.pen
    assert on and all(0 <= part < 255 for part in colour) and 3 <= width < 8
    assert 6 <= len(turtle.strokes) <= 8  # every half second of the three that it takes there is another pen
    assert len({stroke[:2] for stroke in turtle.strokes}) == len(turtle.strokes)


@pytest.mark.soak(all_but=2)
@pytest.mark.parametrize(
    "motion",
    [
        "(type driving) (speed 1) (angle 1)",
        "(type moving) (goal (4 4 0))",
        "(type going-to) (goal ?place)",
        "(type setting-pen) (r 9) (g 8) (b 7) (width 5)",
    ],
)
def test_a_motion_finds_its_module(turtle, motion, capsys):
    turtle(f"""(let ((?place (desig:a location (horizontal-position :right) (vertical-position :bottom))))
                 (perform-some-motion (desig:a motion {motion})))""")
    pen = "setting-pen" in motion
    assert ("TurtleSim pen control invoked" in capsys.readouterr().out) == pen
    assert (turtle.pen == (True, (9, 8, 7), 5)) == pen
    assert bool(turtle.commands) != pen
    turtle("(send-vel-cmd 0 0)")


@pytest.mark.soak(all_but=1)
def test_the_paper_is_wiped(turtle):
    turtle("(move-simple 8 8)")
    assert set(turtle.simulator.canvas.rgb()) != {69, 86, 255}
    turtle("(call-clear-background)")
    assert set(turtle.simulator.canvas.rgb()) == {69, 86, 255}
