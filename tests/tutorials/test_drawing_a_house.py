"""The house of the high-level plan: where its corners are, what lies between its parts, and how the plan ends."""

from __future__ import annotations

import math
import random

import pytest

from .course import BACKENDS, SEEDS, course, missed, seeded

WHITE = (255, 255, 255)
NEAR = 0.25  # metres from the place of a corner
PARTS = {  # each from its lower left corner and back to it
    "walls": [(3, 2), (8, 2), (8, 6.5), (3, 6.5), (3, 2)],
    "door": [(6, 2), (7, 2), (7, 4.5), (6, 4.5), (6, 2)],
    "window": [(3.5, 4), (4.5, 4), (4.5, 5), (3.5, 5), (3.5, 4)],
    "roof": [(3, 6.5), (8, 6.5), (5.5, 10.5), (3, 6.5)],
}
pytestmark = pytest.mark.usefixtures("language")


def distance_from(outline, point):
    """How far ``point`` is from the sides of a figure."""
    return min(distance_from_side(start, end, point) for start, end in zip(outline, outline[1:]))


def distance_from_side(start, end, point):
    along = (end[0] - start[0], end[1] - start[1])
    part = ((point[0] - start[0]) * along[0] + (point[1] - start[1]) * along[1]) / (along[0] ** 2 + along[1] ** 2)
    part = min(max(part, 0), 1)
    return math.dist(point, (start[0] + part * along[0], start[1] + part * along[1]))


def assert_house(strokes):
    """Four strokes of the plain pen, each along the outline of its part and around all of its corners."""
    assert [stroke[:2] for stroke in strokes] == [(WHITE, 1)] * len(PARTS)
    for (name, outline), (_, _, points) in zip(PARTS.items(), strokes):
        assert missed(outline, points, NEAR) is None, name
        astray = max(points, key=lambda point: distance_from(outline, point))
        assert distance_from(outline, astray) < NEAR, (name, astray)


@pytest.mark.soak
@pytest.mark.parametrize("seed", SEEDS)
def test_the_house_stands_where_it_should_wherever_the_turtle_comes_from(seed, capsys):
    start = random.Random(seed)
    with seeded(seed) as turtle:
        turtle.teleport(start.uniform(0.6, 10.4), start.uniform(0.6, 10.4), start.uniform(-3, 3))
        turtle("(perform-draw-house)")
        assert_house(turtle.strokes)
        assert turtle.pen == (True, WHITE, 1)
        assert turtle.stands_still()
        assert turtle.left() == []
    told = capsys.readouterr()
    assert "WARN" not in told.out and told.err == ""


@pytest.mark.soak
@pytest.mark.parametrize("backend", BACKENDS)
def test_between_the_parts_the_pen_is_up(backend):
    """The turtle goes from the middle to the first corner and from part to part, and no line leads there."""
    with course(backend) as turtle:
        turtle("(perform-draw-house)")
        drawn = [point for _, _, points in turtle.strokes for point in points[::10]]
        way_in = [place for place in turtle.poses if min(math.dist(place, point) for point in drawn) > 0.5]
        assert math.dist(way_in[0], (5.544, 5.544)) < 0.1
        gaps = [math.dist(before[-1], after[0]) for (_, _, before), (_, _, after) in zip(turtle.strokes, turtle.strokes[1:])]
        assert gaps == pytest.approx([3, math.dist((6, 2), (3.5, 4)), math.dist((3.5, 4), (3, 6.5))], abs=0.3)


@pytest.mark.soak
@pytest.mark.parametrize("backend", BACKENDS)
def test_a_house_that_is_interrupted_leaves_a_turtle_that_stands_and_the_next_one_is_drawn(backend):
    with course(backend) as turtle:
        assert (
            turtle(
                "(top-level (pursue (with-process-modules-running (turtlesim-navigation turtlesim-pen-control)"
                " (navigate-without-pen '(3 2 0)) (draw-house)) (sleep 12)))"
            )
            is None
        )
        assert turtle.stands_still()
        turtle.simulator.canvas.clear((69, 86, 255))
        turtle.strokes.clear()
        turtle("(perform-draw-house)")
        assert_house(turtle.strokes)
        assert turtle.stands_still() and turtle.left() == []


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("seed", SEEDS)
def test_shapes_are_drawn_from_where_the_turtle_is(seed):
    with seeded(seed) as turtle:
        turtle.teleport(2, 3, 1)
        turtle("""(top-level (with-process-modules-running (turtlesim-navigation turtlesim-pen-control)
                    (draw-simple-shape (get-shape-vertices :triangle 4 3))
                    (exe:perform (desig:an action (type drawing) (shape rectangle) (width 6) (height 2)))))""")
        ((_, _, points),) = turtle.strokes
        triangle, rectangle = [(2, 3), (6, 3), (4, 6), (2, 3)], [(8, 3), (8, 5), (2, 5), (2, 3)]
        assert missed(triangle + rectangle, points, NEAR) is None
        assert turtle.stands_still() and turtle.left() == []
