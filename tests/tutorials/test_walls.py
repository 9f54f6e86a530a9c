"""Targets beyond the walls: the failure, the red way back, and the pen afterwards."""

from __future__ import annotations

import math
import random

import pytest

from .course import BACKENDS, SEEDS, STEP, course, seeded

RED, WHITE = ((204, 0, 0), 2), ((255, 255, 255), 1)
NEAR = 0.1 + STEP
WARNING = "[(DRAW-SIMPLE-SIMPLE) WARN] "
pytestmark = pytest.mark.usefixtures("language")


def navigate(turtle, x, y, plan="(navigate (list {x} {y} 0))"):
    plan = plan.format(x=x, y=y)
    return turtle(f"(top-level (with-process-modules-running (turtlesim-navigation turtlesim-pen-control) {plan}))")


def clamped(x, y):
    return min(max(x, 0.6), 10.4), min(max(y, 0.6), 10.4)


def out_of_bounds(x, y):
    return not (0.5 <= x <= 10.5 and 0.5 <= y <= 10.5)


def assert_recovered(turtle, x, y, told):
    """The turtle went out once, and is at the point next to the target that is inside."""
    (warning,) = [line for line in told.splitlines() if line.startswith(WARNING)]
    assert warning.endswith(": Moving went-wrong: Turtle went out of bounds.")
    assert math.dist(turtle.place, clamped(x, y)) < NEAR
    assert turtle.pen == (True, *WHITE)
    colours = [stroke[:2] for stroke in turtle.strokes]
    assert colours[-1] == RED and colours.count(RED) == 1
    assert any(out_of_bounds(*place) for place in turtle.poses)
    assert all(0.4 < min(place) and max(place) < 10.6 for place in turtle.poses)


@pytest.mark.soak
@pytest.mark.parametrize("seed", SEEDS)
def test_a_target_behind_a_wall_is_reached_as_nearly_as_may_be(seed, capsys):
    luck = random.Random(seed)
    side, beyond, along = luck.randrange(4), luck.uniform(0.8, 4), luck.uniform(1, 10)
    x, y = [(11 + beyond, along), (-beyond, along), (along, 11 + beyond), (along, -beyond)][side]
    with seeded(seed) as turtle:
        turtle.teleport(luck.uniform(1.5, 9.5), luck.uniform(1.5, 9.5), luck.uniform(-3, 3))
        capsys.readouterr()
        navigate(turtle, x, y)
        assert_recovered(turtle, x, y, capsys.readouterr().out)
        assert turtle.stands_still() and turtle.left() == []


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("x, y", [(20, 20), (-5, -5), (-5, 20), (20, -5)])
@pytest.mark.parametrize("backend", BACKENDS)
def test_a_target_behind_a_corner(backend, x, y, capsys):
    with course(backend) as turtle:
        capsys.readouterr()
        navigate(turtle, x, y)
        assert_recovered(turtle, x, y, capsys.readouterr().out)
        assert turtle.stands_still() and turtle.left() == []


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("seed", SEEDS)
def test_a_target_inside_needs_no_recovery(seed, capsys):
    luck = random.Random(seed)
    x, y = luck.uniform(0.6, 10.4), luck.uniform(0.6, 10.4)
    with seeded(seed) as turtle:
        pen = turtle.pen
        navigate(turtle, x, y)
        assert WARNING not in capsys.readouterr().out and turtle.pen == pen
        assert math.dist(turtle.place, (x, y)) < NEAR
        assert turtle.stands_still() and turtle.left() == []


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("seed", SEEDS)
def test_a_rectangle_that_is_too_large_is_drawn_as_far_as_it_goes(seed, capsys):
    """Each corner outside costs a failure of its own, and the plan goes on with the next corner."""
    with seeded(seed) as turtle:
        turtle.teleport(7, 7, 0)
        navigate(turtle, 0, 0, "(exe:perform (desig:an action (type drawing) (shape rectangle) (width 6) (height 2)))")
        assert capsys.readouterr().out.count(WARNING) == 2
        assert math.dist(turtle.place, (7, 7)) < NEAR
        assert sum(stroke[:2] == RED for stroke in turtle.strokes) == 2
        assert turtle.stands_still() and turtle.left() == []


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("backend", BACKENDS)
def test_without_a_pen_the_way_back_is_red_all_the_same(backend, capsys):
    with course(backend) as turtle:
        navigate(turtle, 5, 14, "(navigate-without-pen '({x} {y} 0))")
        assert [stroke[:2] for stroke in turtle.strokes] == [RED]
        assert turtle.pen == (True, *WHITE)
        assert turtle.left() == []


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("backend", BACKENDS)
def test_recovering_turns_to_the_middle_and_then_to_the_goal(backend):
    with course(backend) as turtle:
        turtle.teleport(10.6, 5.5, 0)
        turtle("(top-level (recover-from-oob (make-3d-vector 10.4 9 0)))")
        assert math.dist(turtle.place, (10.4, 5.5)) < 0.05
        assert abs(turtle("(relative-angle-to (make-3d-vector 10.4 9 0) (value *turtle-pose*))")) < 0.05
        assert [command[1:] for command in turtle.commands].count((1, 0)) == 1
        assert turtle.stands_still()
        turtle("(top-level (recover-from-oob))")
        assert turtle.commands[-1][1:] == (1, 0)
        turtle("(sleep 2)")
        assert turtle.left() == []
