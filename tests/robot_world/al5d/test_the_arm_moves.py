"""Commands and joint states of the arm: how fast, how far, and what is refused."""

from math import inf, nan, pi

import pytest

from cramhy_runtime import kernel

NAMES = ["Joint1", "Joint2", "Joint3", "Joint4", "Joint5", "Gripper"]


def test_it_stands_at_home_and_tells_its_joints_fifty_times_a_second(table):
    heard = table.states()
    kernel.sleep(2.001)
    assert len(heard) == 100 and list(heard[-1].name) == NAMES
    assert [float(value) for value in heard[-1].position] == pytest.approx([0, pi / 2, -pi / 2, 0, 0, 0.03175], abs=1e-6)
    assert heard[-1].header.stamp - heard[-2].header.stamp == pytest.approx(0.02)


def test_it_goes_where_a_command_sends_it(table):
    table.send(0.5, 1.2, -1.0, 0.3, -0.7, 0.01)
    assert table.joints() == pytest.approx([0.5, 1.2, -1.0, 0.3, -0.7, 0.01], abs=0.002)


def test_a_joint_turns_with_at_most_three_radians_a_second(table):
    heard = table.states()
    table.send(3.0, 1.57, -1.57, 0, 0, 0.03175)
    speeds = [float(message.velocity[0]) for message in heard]
    assert 2.9 < max(speeds) < 3.1
    arrived = next(number for number, message in enumerate(heard) if abs(message.position[0] - 3.0) < 0.02)
    assert 1.0 < arrived * 0.02 < 1.5


def test_the_fingers_move_with_at_most_a_tenth_of_a_metre_a_second(table):
    heard = table.states()
    table.send(0, 1.57, -1.57, 0, 0, 0.0)
    speeds = [float(message.velocity[5]) for message in heard]
    assert 0.09 < -min(speeds) < 0.11 and heard[-1].position[5] == pytest.approx(0, abs=1e-4)


def test_each_joint_stops_at_its_limit_and_one_line_says_so(table):
    table.send(9, -1, 9, -9, -9, 9)
    assert table.joints() == pytest.approx([pi, 0, 0, -pi / 2, -pi, 0.03175], abs=0.1)  # the hand lies on the table
    assert len(table.said) == 2
    assert table.said[1].endswith(
        "A command is beyond the limits of the arm, which goes as far as it can: "
        "Joint1 to 3.142, Joint2 to 0.000, Joint3 to 0.000, Joint4 to -1.571, Joint5 to -3.142, Gripper to 0.032."
    )


@pytest.mark.parametrize(
    ("numbers", "told"),
    [
        ((0.1,) * 5, "5 numbers"),
        ((0.1,) * 7, "7 numbers"),
        ((), "0 numbers"),
        ((nan, 0, 0, 0, 0, 0), "numbers that are not finite"),
        ((0, inf, 0, 0, 0, 0), "numbers that are not finite"),
        ((0, 0, 0, 0, 0, -inf), "numbers that are not finite"),
    ],
    ids=["five", "seven", "none", "nan", "infinity", "minus infinity"],
)
def test_a_command_that_is_none_moves_nothing(table, numbers, told):
    before = table.joints()
    table.send(*numbers)
    assert table.joints() == pytest.approx(before, abs=1e-6)
    assert table.said[-1].endswith(
        f"A command has 6 finite numbers: Joint1 to Joint5 in rad, and Gripper in m. This one has {told}. The arm goes on as before."
    )


def test_a_new_command_counts_at_once(table):
    heard = table.states()
    table.send(3.0, 1.57, -1.57, 0, 0, 0, wait=0.5)
    table.send(0.0, 1.57, -1.57, 0, 0, 0)
    assert max(float(message.position[0]) for message in heard) < 1.6
    assert heard[-1].position[0] == pytest.approx(0, abs=0.002)


def test_a_stream_of_commands_leads_the_arm_along(table):
    """A program that sends fifty goals a second is followed, and not held up by each of them."""
    heard = table.states()
    for step in range(100):
        table.send(step * 0.02, 1.57, -1.57, 0, 0, 0.03175, wait=0.02)
    assert heard[-1].position[0] == pytest.approx(1.98, abs=0.2)
    speeds = [float(message.velocity[0]) for message in heard[40:]]
    assert min(speeds) > 0.8 and max(speeds) < 1.3


def test_fingers_that_press_on_the_table_are_held_up_by_it(table):
    table.spawn(0, 0.2)
    table.send(0, 0.2, -0.5, -0.6, 0, 0.01)
    lowest = table.simulator.bench.bounds("al5d")[0][2]
    assert -0.002 < lowest < 0.002 and all(abs(value) < 1 for value in table.brick())


def test_while_nothing_moves_and_nobody_listens_no_timer_runs(table):
    table.send(0.5, 1.2, -1.0, 0.3, -0.7, 0.01)
    table.spawn()
    turns = []
    kernel.active().watch_instants(turns.append)
    kernel.sleep(1000)
    assert len(turns) < 5
