"""Bricks that lie anywhere in reach, a little beside where the arm believes them, arrive where they are to be."""

from math import cos, hypot, pi, sin
from random import Random

import pytest


def anywhere(chance):
    """x, y and the turn of a place in reach."""
    angle, away = chance.uniform(-1.3, 1.3), chance.uniform(0.12, 0.24)
    return away * sin(angle), away * cos(angle), chance.uniform(-pi / 2, pi / 2)


@pytest.mark.parametrize("seed", [0, *(pytest.param(seed, marks=pytest.mark.soak) for seed in range(1, 40))])
def test_a_brick_from_anywhere_arrives_anywhere(table, seed):
    chance = Random(seed)
    (x, y, turn), goal = anywhere(chance), anywhere(chance)
    beside = [chance.uniform(-0.002, 0.002), chance.uniform(-0.002, 0.002), chance.uniform(-0.05, 0.05)]
    table.spawn(x + beside[0], y + beside[1], yaw=turn + beside[2])
    for place, height, opening in (
        ((x, y, turn), 0.05, 0.03),
        ((x, y, turn), 0.005, 0.03),
        ((x, y, turn), 0.005, 0.0),
        ((x, y, turn), 0.05, 0.0),
        (goal, 0.05, 0.0),
        (goal, 0.005, 0.0),
        (goal, 0.005, 0.03),
        (goal, 0.05, 0.03),
    ):
        table.reach(*place[:2], height, place[2], opening, wait=2.0)
    at = table.brick()
    assert hypot(at[0] - goal[0], at[1] - goal[1]) < 0.005 and abs(at[2]) < 0.001
    assert abs((at[3] - goal[2] + pi / 2) % pi - pi / 2) < 0.1
