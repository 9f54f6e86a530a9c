"""Bricks: services that bring, take and move them, and what holds and drops them."""

from math import pi

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.ros import graph

EMPTY = "std_srvs/Empty"
CLOSE, TURNED = 0.005, 0.1  # metres and radians: so near to its goal the exercise wants a brick


def lies(table, x, y, yaw, name="brick1"):
    """Whether a brick lies there, either way round."""
    at = table.brick(name)
    turn = abs((at[3] - yaw + pi / 2) % pi - pi / 2)
    return abs(at[0] - x) < CLOSE and abs(at[1] - y) < CLOSE and abs(at[2]) < 0.001 and turn < TURNED


# --------------------------------------------------------------------------------------------------------------- services


def test_a_brick_lies_where_it_was_put_and_tells_where(table):
    assert table.spawn(0.02, 0.17, yaw=0.785) == "brick1"
    assert table.brick() == pytest.approx((0.02, 0.17, 0, 0.785), abs=0.001)


def test_bricks_without_names_are_numbered(table):
    assert [table.spawn(x, settle=0) for x in (-0.1, 0.0, 0.1)] == ["brick1", "brick2", "brick3"]
    assert table.kill("brick3").result is True
    assert table.spawn(0.1, settle=0) == "brick3"
    table.spawn(0.2, name="brick4", settle=0)
    assert table.spawn(0.3, settle=0) == "brick5"


@pytest.mark.parametrize(
    ("fields", "text"),
    [
        ({"name": "mine"}, "Brick mine already exists."),
        ({"colour": "yellow"}, 'Bricks are blue, green, red, not "yellow".'),
        ({"colour": ""}, 'Bricks are blue, green, red, not "".'),
        ({"name": "a/b"}, "A brick cannot be called a/b. Letters, digits and _ make a name."),
        ({"name": "table"}, "A brick cannot be called table. Letters, digits and _ make a name."),
        ({"x": float("nan")}, "A pose is six finite numbers; these are nan, 0.17, 0, 0, 0, 0."),
    ],
    ids=["taken", "another colour", "no colour", "slash", "of the table", "nan"],
)
def test_a_brick_that_cannot_be_is_refused(table, fields, text):
    table.spawn(-0.1, name="mine", settle=0)
    assert table.spawn(**fields) == text
    assert list(table.simulator.bricks) == ["mine"]


def test_more_than_sixty_bricks_are_refused(table, monkeypatch):
    monkeypatch.setattr("cramhy_runtime.robot_world.al5d.node.MOST_BRICKS", 2)
    assert [table.spawn(x, settle=0) for x in (0.0, 0.1, 0.2)][2] == "2 bricks are there already; more are not allowed. Kill some."


def test_killing_a_brick_takes_its_topic_and_services_along(table):
    table.spawn(settle=0)
    answer = table.kill("brick1")
    assert (answer.result, answer.message) == (True, "Brick brick1 was taken away.")
    here = graph.active()
    assert not [name for name in (*here.topics, *here.services) if "brick1" in name]
    assert table.kill("brick1") == "Brick brick1 doesn't exist. On the table: no brick."
    table.spawn(settle=0)
    assert table.kill("rubble") == "Brick rubble doesn't exist. On the table: brick1."


def test_clear_takes_all_bricks_away_and_counts_anew(table):
    for x in (-0.1, 0.1):
        table.spawn(x, settle=0)
    table.call("clear", EMPTY)
    assert not table.simulator.bricks and table.spawn(settle=0) == "brick1"


def test_reset_clears_the_table_and_sends_the_arm_home(table):
    table.spawn(settle=0)
    table.send(1, 1, -1, 0.3, 0.3, 0)
    table.call("reset", EMPTY)
    kernel.sleep(3)
    assert table.joints() == pytest.approx([0, 1.57, -1.57, 0, 0, 0.03], abs=0.002)
    assert not table.simulator.bricks and table.spawn(settle=0) == "brick1"


def test_teleports_put_a_brick_elsewhere_and_turn_it(table):
    table.spawn()
    table.teleport("brick1", "absolute", 0.1, 0.2, 0, 0, 0, pi / 2)
    assert table.brick() == pytest.approx((0.1, 0.2, 0, pi / 2), abs=0.001)
    table.teleport("brick1", "relative", -0.2, 0.05, 0, 0, 0, -1.0)
    assert table.brick() == pytest.approx((-0.1, 0.25, 0, pi / 2 - 1), abs=0.001)
    assert table.teleport("brick1", "absolute", float("inf")) == "A pose is six finite numbers; these are inf, 0, 0, 0, 0, 0."


def test_a_brick_beside_the_table_falls_on_the_floor(table):
    table.spawn(0.9, 0.17, settle=2.0)
    assert table.brick()[2] == pytest.approx(-0.75, abs=0.02)


# ---------------------------------------------------------------------------------------------------------------- physics


def test_the_exercise_of_the_course_ends_with_the_brick_where_it_is_to_be(table):
    table.spawn(0, 0.15, yaw=pi / 4)
    table.pick(0, 0.15, pi / 4)
    assert table.joints()[5] == pytest.approx(0.0158, abs=0.0003)
    assert table.brick()[2] == pytest.approx(0.02, abs=0.002)
    table.place(0.06, 0.18, 3 * pi / 4)
    assert lies(table, 0.06, 0.18, 3 * pi / 4)


@pytest.mark.parametrize(("x", "y"), [(0.003, 0.15), (0, 0.147)])
def test_a_brick_that_is_not_quite_there_is_taken_all_the_same(table, x, y):
    table.spawn(x, y, yaw=pi / 2)
    table.pick(0, 0.15, pi / 2)
    assert table.brick()[2] > 0.015


def test_fingers_that_are_wider_than_the_brick_hold_nothing(table):
    table.spawn(0, 0.15)
    table.pick(0, 0.15, 0, closed=0.017)
    assert abs(table.brick()[2]) < 0.001


def test_fingers_that_are_a_little_narrower_than_the_brick_hold_it(table):
    table.spawn(0, 0.15)
    table.pick(0, 0.15, 0, closed=0.015)
    assert table.brick()[2] > 0.015


def test_a_brick_goes_from_one_side_to_the_other_and_is_turned(table):
    table.spawn(0.08, 0.16)
    table.pick(0.08, 0.16, 0)
    table.place(-0.1, 0.15, pi / 2)
    assert lies(table, -0.1, 0.15, pi / 2)


def test_a_brick_that_is_taken_out_of_the_hand_leaves_it_empty(table):
    table.spawn(0, 0.15)
    table.pick(0, 0.15, 0)
    table.teleport("brick1", "absolute", 0.1, 0.2, 0, 0, 0, 0)
    assert table.brick() == pytest.approx((0.1, 0.2, 0, 0), abs=0.001) and table.joints()[5] < 0.001


def test_a_brick_stands_on_another_one_and_one_in_the_air_falls(table):
    table.spawn(0, 0.2, name="low")
    table.spawn(0, 0.2, 0.0115, name="high")
    table.spawn(0.1, 0.2, 0.2, name="falling")
    kernel.sleep(10)
    assert 0.0096 < table.brick("high")[2] < 0.0116 and abs(table.brick("falling")[2]) < 0.001


def test_open_fingers_drop_the_brick(table):
    table.spawn(0, 0.15)
    table.pick(0, 0.15, 0)
    table.reach(0, 0.15, 0.1, 0, 0.0)
    assert table.brick()[2] == pytest.approx(0.095, abs=0.003)
    table.reach(0, 0.15, 0.1, 0, 0.03, wait=0.1)
    kernel.sleep(1.0)
    assert table.brick()[2] < 0.02


def test_a_brick_stays_in_the_hand_while_the_arm_swings(table):
    table.spawn(0, 0.15)
    table.pick(0, 0.15, 0)
    for side in (1.4, -1.4, 1.4, 0.0):
        joints = table.joints()
        table.send(side, *joints[1:5], 0.0, wait=1.5)
    assert table.brick()[2] > 0.015


def test_a_heavy_hand_pushes_bricks_and_breaks_nothing(table):
    for number in range(4):
        table.spawn(-0.06 + 0.04 * number, 0.243, settle=0)
    for x in (-0.15, 0.15, -0.15):
        table.reach(x, 0.2, 0.002, 0, 0.0, wait=1.0)
    places = [table.brick(name) for name in table.simulator.bricks]
    assert all(abs(value) < 1.0 for place in places for value in place[:3])
    assert any(abs(place[0] + 0.06 - 0.04 * number) > 0.01 for number, place in enumerate(places))
