"""A cost function that is slow is asked about the cells that places are drawn from, not about all of a map."""

import random

import numpy as np
import pytest

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.conditions import Condition
from cramhy_runtime.robot_world.costmaps import costmap, costs

SIDE = 80  # cells


class Slow:
    """A cost function with a loop of some turns; it counts its calls."""

    def __init__(self, cost, turns=100):
        self.cost, self.turns, self.asked = cost, turns, []

    def __call__(self, x, y):
        self.asked.append((x, y))
        for _ in range(self.turns):
            kernel.checkpoint()
        return self.cost(x, y)


def a_map(*functions):
    made = costmap.LocationCostmap(width=SIDE, height=SIDE, resolution=1)
    for number, function in enumerate(functions):
        made.register(function, number)
    return made


def test_a_place_costs_a_few_calls_and_a_quick_function_is_asked_everywhere():
    slow, quick = Slow(lambda x, y: float(x < 40)), Slow(lambda x, y: float(x < 40), turns=0)
    draws = random.Random(1)
    for function in (slow, quick):
        column, _ = a_map(function, costs.Gauss((30, 30), [[200, 0], [0, 200]])).draw(draws.random)
        assert column < 40
    assert len(slow.asked) < 20 and len(quick.asked) == SIDE * SIDE + 1


@pytest.mark.parametrize("cost", [lambda x, y: float((x // 7 + y // 7) % 2), lambda x, y: (x % 5) / 4], ids=["0 or 1", "steps"])
def test_places_are_drawn_as_often_as_from_the_whole_map(cost):
    gauss, draws = costs.Gauss((30, 30), [[200, 0], [0, 90]]), random.Random(7)
    sieved, whole = a_map(Slow(cost), gauss), a_map(cost, gauss).values()
    found = np.zeros((SIDE, SIDE))
    for _ in range(20_000):
        column, row = sieved.draw(draws.random)
        found[row, column] += 1 / 20_000
    assert not found[whole == 0].any()
    blocks = [table.reshape(8, 10, 8, 10).sum(axis=(1, 3)) for table in (found, whole)]
    assert np.abs(blocks[0] - blocks[1]).max() < 0.012


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("part", [0.05, 0.1, 0.6])
def test_what_is_above_a_part_of_the_greatest_value_is_as_in_the_whole_map(part):
    def cost(x, y):
        return float((x // 9 + y // 4) % 3 == 1)

    gauss = costs.Gauss((30, 30), [[200, 0], [0, 90]])
    sieved, whole = a_map(Slow(cost), gauss), a_map(cost, gauss)
    places = [(x, y) for x in range(-3, SIDE + 3, 7) for y in range(-3, SIDE + 3, 5)]
    assert [sieved.above(x, y, part) for x, y in places] == [whole.value(x, y) / whole.maximum > part for x, y in places]


def test_values_that_are_asked_for_are_all_computed():
    gauss = costs.Gauss((30, 30), [[200, 0], [0, 90]])
    sieved = a_map(Slow(lambda x, y: x % 2), gauss)
    sieved.draw(random.Random(1).random)
    assert np.allclose(sieved.values(), a_map(lambda x, y: x % 2, gauss).values())


def test_a_map_that_is_0_everywhere_is_found_to_be():
    for call in ("ready", "draw"):
        sieved = a_map(Slow(lambda x, y: 0), costs.Gauss((30, 30), [[200, 0], [0, 90]]))
        with pytest.raises(costmap.NothingPossible) as problem:
            sieved.ready() if call == "ready" else sieved.draw(random.Random(1).random)
        assert problem.value.names == [1, 0]


def test_one_place_among_many_and_costs_above_1_are_found_in_the_whole_map():
    one = a_map(Slow(lambda x, y: float((x, y) == (3, 70))))
    assert one.draw(random.Random(1).random) == (3, 70)
    great = a_map(Slow(lambda x, y: 1 + 5 * (x == 3)))
    draws = random.Random(1)
    threes = sum(great.draw(draws.random)[0] == 3 for _ in range(5000)) / 5000
    assert threes == pytest.approx(6 / (6 + SIDE - 1), abs=0.02)


def test_a_cost_that_is_not_a_number_is_an_error():
    with pytest.raises(Condition, match="A number from 0 to 1 is wanted"):
        a_map(Slow(lambda x, y: None)).ready()
