"""Looking on tick by tick: strokes, clears, turtles (`Turtlesim.observe`), and what one who comes late is told (`Canvas.strokes`)."""

import math

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.ros import graph
from cramhy_runtime.turtlesim import strokes as ink
from cramhy_runtime.turtlesim.strokes import Ink, thinned

CENTRE = 5.544444561004639
PEN = (179, 184, 255)


@pytest.fixture
def seen(turtle):
    """[(clears, strokes), ...] per tick from now on."""
    ticks = []
    turtle.simulator.observe(lambda simulator, strokes: ticks.append((simulator.canvas.clears, strokes)))
    return ticks


def test_an_observer_is_called_once_per_tick_also_when_nothing_happens(turtle, seen):
    kernel.sleep(1.6)
    assert [strokes for _, strokes in seen] == [[]] * 100


def test_a_drive_is_a_stroke_per_tick_from_where_the_turtle_was_to_where_it_is(turtle, seen):
    turtle.drive(1)
    kernel.sleep(1.5)
    strokes = [stroke for _, tick in seen for stroke in tick]
    assert len(strokes) == 63
    assert strokes[0] == (pytest.approx(CENTRE), pytest.approx(CENTRE), pytest.approx(CENTRE + 0.016), pytest.approx(CENTRE), PEN, 3)
    assert all(before[2:4] == after[:2] for before, after in zip(strokes, strokes[1:]))
    assert strokes[-1][2] == pytest.approx(turtle.pose[0], abs=1e-6)


def test_y_counts_up_as_in_the_world(turtle, seen):
    turtle.teleport(1, 2)
    (stroke,) = [stroke for _, tick in seen for stroke in tick]
    assert stroke[2:4] == (1.0, pytest.approx(2.0))


def test_strokes_before_a_clear_are_not_told_after_it(turtle, seen):
    before = seen[-1][0] if seen else turtle.simulator.canvas.clears
    turtle.teleport(1, 2)
    turtle.simulator.turtles["turtle1"].teleport_absolute(5.0, 5.0, 0.0)
    graph.active().parameters.set("/turtlesim/background_r", 1)
    turtle.call("/clear", "std_srvs/Empty")
    kernel.sleep(0.05)
    assert {clears for clears, _ in seen} == {before, before + 1}
    assert len([stroke for clears, tick in seen if clears > before for stroke in tick]) == 1
    assert turtle.simulator.canvas.background == (1, 86, 255)


def test_lines_to_nowhere_are_no_strokes(turtle, seen):
    turtle.drive(math.nan)
    kernel.sleep(0.1)
    turtle.drive(math.inf)
    kernel.sleep(0.1)
    turtle.drive()
    turtle.teleport(2, 2)
    turtle.teleport(3, 3)
    ends = [stroke[2:4] for _, tick in seen for stroke in tick]
    assert ends[-1] == (3.0, pytest.approx(3.0))
    assert all(math.isfinite(value) for end in ends for value in end)
    assert all(math.isfinite(value) for stroke in turtle.simulator.canvas.strokes() for value in stroke[:4])


def test_who_does_not_observe_any_more_is_left_alone(turtle):
    calls = []

    def first(simulator, strokes):
        calls.append("first")

    def second(simulator, strokes):
        calls.append("second")
        simulator.unobserve(second)

    turtle.simulator.observe(first)
    turtle.simulator.observe(second)
    kernel.sleep(0.032)
    assert calls == ["first", "second", "first"]
    turtle.simulator.unobserve(first)
    turtle.simulator.unobserve(first)
    assert turtle.simulator.canvas.news is None
    kernel.sleep(0.1)
    assert len(calls) == 3


def test_an_observer_that_fails_is_reported_once_and_the_turtles_go_on(turtle, seen, capsys):
    turtle.simulator.observe(lambda simulator, strokes: 1 / 0)
    turtle.drive(1)
    kernel.sleep(1.5)
    assert capsys.readouterr().err.count("division by zero") == 1
    assert turtle.pose[0] == pytest.approx(CENTRE + 1.008, abs=1e-5)
    assert len(seen) in (93, 94)


def test_each_observer_has_a_list_of_its_own(turtle):
    lists = []
    for _ in range(2):
        turtle.simulator.observe(lambda simulator, strokes: lists.append(strokes))
    turtle.teleport(1, 1)
    assert any(strokes for strokes in lists)
    for first, second in zip(lists[::2], lists[1::2]):
        assert first == second and first is not second


class TestWhoComesLate:
    def test_gets_everything_since_the_last_clear(self, turtle):
        turtle.teleport(1, 1)
        turtle.call("/clear", "std_srvs/Empty")
        assert turtle.simulator.canvas.strokes() == []
        turtle.set_pen(255, 0, 0, 5)
        turtle.teleport(2, 2)
        turtle.drive(1)
        kernel.sleep(1.5)
        strokes = turtle.simulator.canvas.strokes()
        assert {stroke[4:] for stroke in strokes} == {((255, 0, 0), 5)}
        assert strokes[0][:2] == pytest.approx((1, 1), abs=1e-6)
        assert strokes[-1][2:4] == pytest.approx((3.008, 2), abs=1e-5)
        assert len(strokes) < 5  # a straight drive of 63 ticks is one line

    def test_a_circle_is_told_within_a_fifth_of_a_pixel(self, turtle):
        turtle.teleport(5.5, 3.5)
        turtle.call("/clear", "std_srvs/Empty")
        for _ in range(14):
            turtle.drive(2, 1)
            kernel.sleep(0.5)
        strokes = turtle.simulator.canvas.strokes()
        assert len(strokes) < 100
        for x1, y1, x2, y2, *_ in strokes:
            for x, y in ((x1, y1), ((x1 + x2) / 2, (y1 + y2) / 2)):
                assert math.hypot(x - 5.5, y - 5.5) == pytest.approx(2.0, abs=0.021)

    def test_a_turn_back_on_the_way_is_not_left_out(self):
        assert thinned([(0, 0), (1, 0), (2, 0), (1, 0)]) == [(0, 0), (2, 0), (1, 0)]
        assert thinned([(0, 0), (1, 0), (0, 0)]) == [(0, 0), (1, 0), (0, 0)]

    def test_a_long_run_is_bounded_and_forgets_the_oldest_only_when_thinning_does_not_do(self, monkeypatch):
        monkeypatch.setattr(ink, "MOST_LINES", 1000)
        straight, zigzag = Ink(), Ink()
        for number in range(5000):
            straight.take([((number + 1) / 1000, 1.0, number / 1000, 1.0, PEN, 3)])
            zigzag.take([((number + 1) % 7, number % 5, number % 7, (number - 1) % 5, PEN, 3)])
        assert len(straight) <= 1000 and len(zigzag) <= 1000
        x1, _, _, _, _, _ = straight.strokes()[0]
        assert x1 == 0.0 and straight.strokes()[-1][2] == 5.0
        assert zigzag.polylines()[-1][2][-1] == (5000 % 7, 4999 % 5)
