"""What messages about changes add up to, here the lines on the paper: all that were drawn, thinned out, and nobody's are changed later."""

from __future__ import annotations

import math

from cramhy_runtime.chronicle.merge import PIECE, WorldState
from cramhy_runtime.ros.messages import message_class_exact


def worlds(count, clears=1, radius=2.0):
    """So many messages, in each of which a turtle draws one more line of a circle of 500 lines."""
    world, stroke = message_class_exact("cramhy_msgs/World"), message_class_exact("cramhy_msgs/Stroke")
    points = [(5 + radius * math.cos(step / 500 * math.tau), 5 + radius * math.sin(step / 500 * math.tau)) for step in range(count + 1)]
    return [
        world(stamp=float(index), clears=clears, strokes=[stroke(*points[index], *points[index + 1], 1, 2, 3, 4)]) for index in range(count)
    ]


def added(state, messages):
    for message in messages:
        state.add(message)
    return state


def test_the_lines_of_a_long_drive_are_few_and_where_they_were():
    state = added(WorldState(), worlds(5 * PIECE))
    strokes = state.message().strokes
    assert 100 < len(strokes) < PIECE
    for stroke in strokes:
        assert abs(math.hypot(stroke.x1 - 5, stroke.y1 - 5) - 2) < 0.02 and (stroke.r, stroke.g, stroke.b, stroke.width) == (1, 2, 3, 4)
    assert math.isclose(strokes[0].x1, 7) and math.isclose(strokes[-1].x2, 7, rel_tol=1e-5)
    for before, after in zip(strokes, strokes[1:]):
        assert math.isclose(before.x2, after.x1) and math.isclose(before.y2, after.y1)


def test_a_copy_is_what_it_was():
    for before in (10, PIECE - 1, PIECE, 3 * PIECE // 2):
        messages = worlds(3 * PIECE)
        state = added(WorldState(), messages[:before])
        copy = state.copy()
        was = [stroke.values() for stroke in copy.message().strokes]
        added(state, messages[before:])
        assert [stroke.values() for stroke in copy.message().strokes] == was
        added(copy, messages[before:])
        assert [stroke.values() for stroke in copy.message().strokes] == [stroke.values() for stroke in state.message().strokes]


def test_a_new_paper_is_empty():
    state = added(WorldState(), worlds(2 * PIECE))
    assert len(added(state, worlds(3, clears=2)).message().strokes) <= 3


def test_many_lines_at_once_are_thinned_out_too():
    (first, *rest) = worlds(4 * PIECE)
    first.strokes = [message.strokes[0] for message in [first, *rest]]
    state = added(WorldState(), [first])
    assert len(state.recent) == 0 and 100 < len(state.message().strokes) < PIECE
