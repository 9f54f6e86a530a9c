"""The turtle moves as the C++ turtlesim computed it (turtlesim.md 4, 14, 15; golden/turtle-facts)."""

import math

import pytest

from cramhy_runtime import kernel


def run(turtle, forward=0.0, turn=0.0, sideways=0.0, seconds=1.5):
    """The poses from a command on."""
    turtle.poses.clear()
    turtle.drive(forward, turn, sideways)
    kernel.sleep(seconds)
    return [tuple(map(float, pose.values())) for pose in turtle.poses]


def test_a_fresh_turtle_stands_in_the_centre(turtle):
    assert turtle.pose == (5.544444561004639, 5.544444561004639, 0.0, 0.0, 0.0)
    assert turtle.colour == (69, 86, 255)


def test_poses_come_every_16_ms_also_at_rest(turtle):
    turtle.poses.clear()
    turtle.colours.clear()
    kernel.sleep(10.0)
    assert len(turtle.poses) == len(turtle.colours) == 625


@pytest.mark.parametrize(
    "command, final",
    [
        ((2, 0, 0), (7.560444355, 5.544444561, 0)),
        ((1, 0, 0), (6.552444458, 5.544444561, 0)),
        ((-2, 0, 0), (3.528444529, 5.544444561, 0)),
        ((0, 1, 0), (5.544444561, 6.552444458, 0)),
        ((0, 0, 2), (5.544444561, 5.544444561, 2.016)),
        ((0, 0, -2), (5.544444561, 5.544444561, -2.016)),
        ((0, 0, 3.5), (5.544444561, 5.544444561, -2.755185)),
        ((2, 0, 1.8), (6.602816582, 6.938989639, 1.8144)),
    ],
)
def test_reference_numbers(turtle, command, final):
    forward, sideways, turn = command
    assert run(turtle, forward, turn, sideways)[-1][:3] == pytest.approx(final, abs=1e-6)


def test_the_first_update_is_one_tick_of_movement(turtle):
    assert run(turtle, forward=2)[0][0] == pytest.approx(5.576444626, abs=1e-9)


def test_the_speed_is_never_negative(turtle):
    assert {pose[3] for pose in run(turtle, forward=-2) if pose[3]} == {2.0}


def test_turning_on_the_spot_leaves_position_and_paper_untouched(turtle):
    poses = run(turtle, turn=2)
    assert {pose[:2] for pose in poses} == {(5.544444561004639, 5.544444561004639)}
    assert turtle.colour == (69, 86, 255)


def test_velocities_are_those_of_the_command_until_it_is_a_second_old(turtle):
    run(turtle, forward=2, seconds=0.5)
    assert turtle.pose[3:] == (2.0, 0.0)
    kernel.sleep(0.6)
    assert turtle.pose[3:] == (0.0, 0.0)


def test_repeated_commands_move_without_interruption(turtle):
    start = turtle.pose[0]
    for _ in range(6):
        turtle.drive(1)
        kernel.sleep(0.5)
    kernel.sleep(1.1)
    assert turtle.pose[0] - start == pytest.approx(3.5, abs=0.05)


def test_a_stop_command_stops(turtle):
    start = turtle.pose[0]
    turtle.drive(5)
    kernel.sleep(0.1)
    turtle.drive()
    kernel.sleep(1.0)
    assert 0.4 < turtle.pose[0] - start < 0.6


def test_only_the_last_command_of_a_tick_counts(turtle):
    turtle.drive(5)
    turtle.drive(0, 5)
    turtle.drive(1)
    kernel.sleep(0.05)
    assert turtle.pose[3:] == (1.0, 0.0)


def test_other_components_of_a_command_have_no_effect(turtle):
    before = turtle.pose
    message = turtle.twist()
    message.linear.z, message.angular.x, message.angular.y = 1.0, 2.0, 3.0
    turtle.commands.publish(message)
    kernel.sleep(1.5)
    assert turtle.pose == before


def test_the_heading_stays_within_half_a_turn(turtle):
    poses = run(turtle, turn=100)
    assert all(-3.1415927 <= pose[2] <= 3.1415927 for pose in poses)
    assert len({pose[2] for pose in poses}) > 10


def test_driving_a_circle_has_the_radius_of_speed_over_turn(turtle):
    turtle.teleport(5.5, 3.5)
    turtle.poses.clear()
    for _ in range(14):
        turtle.drive(2, 1)
        kernel.sleep(0.5)
    for x, y, *_ in [pose.values() for pose in turtle.poses]:
        assert math.hypot(float(x) - 5.5, float(y) - 5.5) == pytest.approx(2.0, abs=0.02)


class TestWalls:
    def test_the_right_wall_holds_the_turtle_exactly(self, turtle):
        turtle.drive(20)
        kernel.sleep(1.5)
        assert turtle.pose[0] == 11.088889122009277
        warnings = [text for text in turtle.log() if "wall" in text]
        assert len(warnings) == 46
        assert warnings[0] == "Oh no! I hit the wall! (Clamping from [x=11.304445, y=5.544445])"
        assert warnings[-1] == "Oh no! I hit the wall! (Clamping from [x=11.408889, y=5.544445])"

    def test_the_recorded_run_from_x_10_5(self, turtle):
        turtle.teleport(10.5, 5.5)
        turtle.drive(2)
        kernel.sleep(0.6)
        assert turtle.pose[3] == 2.0
        kernel.sleep(1.0)
        warnings = [text for text in turtle.log() if "wall" in text]
        assert warnings[0].endswith("[x=11.108000, y=5.588889])")
        assert warnings[1].endswith("[x=11.120889, y=5.588889])")
        assert turtle.pose == (11.088889122009277, 5.5, 0.0, 0.0, 0.0)

    def test_the_warning_at_the_top_tells_the_screen_coordinate(self, turtle):
        turtle.teleport(5.5, 11.0, math.pi / 2)
        turtle.drive(2)
        kernel.sleep(1.5)
        assert turtle.pose[1] == 11.088889122009277
        assert any("[x=5.500000, y=-0.032000]" in text for text in turtle.log())

    def test_while_pushing_the_pose_reports_the_command_and_each_tick_warns(self, turtle):
        turtle.teleport(11.088889, 5.5)
        turtle.drive(1)
        before = len(turtle.log())
        kernel.sleep(0.48)
        assert turtle.pose[3] == 1.0
        assert len(turtle.log()) - before == 30


class TestTeleports:
    def test_absolute_within_two_ticks_and_velocities_unchanged(self, turtle):
        turtle.drive(0, 1)
        kernel.sleep(0.05)
        turtle.teleport(1, 1)
        assert turtle.pose[:2] == (1.0, 1.0)
        assert turtle.pose[3:] == (0.0, 1.0)

    @pytest.mark.parametrize(
        "request_, result, warning",
        [
            ((20, 5, 0), (11.088889122009277, 5.0), "[x=20.000000, y=6.088889]"),
            ((5, 20, 0), (5.0, 11.088889122009277), None),
            ((-3, 5, 0), (0.0, 5.0), "[x=-3.000000, y=6.088889]"),
            ((5, -3, 0), (5.0, 0.0), "[x=5.000000, y=14.088889]"),
        ],
    )
    def test_beyond_the_walls(self, turtle, request_, result, warning):
        turtle.teleport(*request_)
        assert turtle.pose[:2] == result
        warnings = [text for text in turtle.log() if "wall" in text]
        assert [warning in text for text in warnings] == ([True] if warning else [])

    @pytest.mark.parametrize(
        "theta, published", [(math.pi, -3.1415925), (-math.pi, 3.1415925), (4, -2.2831852), (7, 0.7168147), (10.0, -2.5663704872131348)]
    )
    def test_angles_are_wrapped_at_the_truncated_pi(self, turtle, theta, published):
        turtle.teleport(5, 5, theta)
        assert turtle.pose[2] == pytest.approx(published, abs=1e-6)

    def test_relative_turns_first(self, turtle):
        turtle.teleport(1, 1)
        turtle.call("/turtle1/teleport_relative", "turtlesim/TeleportRelative", linear=2, angular=math.pi / 2)
        kernel.sleep(0.04)
        assert turtle.pose[:3] == pytest.approx((1, 3, 1.5707964), abs=1e-6)

    def test_two_relative_ones_in_a_row(self, turtle):
        for _ in range(2):
            turtle.call("/turtle1/teleport_relative", "turtlesim/TeleportRelative", linear=1, angular=math.pi / 2)
        kernel.sleep(0.04)
        assert turtle.pose[:3] == pytest.approx((4.544445, 6.544445, -3.1415925), abs=1e-6)


def test_a_command_that_is_not_a_number_makes_the_pose_not_a_number_until_a_teleport(turtle):
    turtle.drive(math.nan)
    kernel.sleep(0.1)
    assert turtle.poses[-1].x.name == "NOT-A-NUMBER"
    turtle.drive()
    turtle.teleport(5, 5)
    assert turtle.pose == (5.0, 5.0, 0.0, 0.0, 0.0)
