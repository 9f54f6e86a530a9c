"""The simulator's topics, services, parameters and log (turtlesim.md 3, 7, 8, 15)."""

import math

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.ros import graph
from cramhy_runtime.ros.services import Refusal
from cramhy_runtime.turtlesim.node import start_turtlesim
from cramhy_runtime.turtlesim.teleop import Teleop

PEN, GROUND = (179, 184, 255), (69, 86, 255)


def test_it_says_two_things_at_the_start(turtle):
    assert turtle.log() == [
        "Starting turtlesim with node name /turtlesim",
        "Spawning turtle [turtle1] at x=[5.544445], y=[5.544445], theta=[0.000000]",
    ]
    assert turtle.simulator.lines[0].startswith("[ INFO] [1292688669.")


def test_the_first_tick_publishes_nothing(simulator, watch):
    probe = watch(simulator)
    kernel.sleep(0.02)
    assert not probe.poses
    kernel.sleep(0.016)
    assert len(probe.poses) == 1


def test_topics_and_services_are_those_of_the_original(simulator):
    here = graph.active()
    assert sorted(here.topics) == ["/rosout", "/rosout_agg", "/turtle1/cmd_vel", "/turtle1/color_sensor", "/turtle1/pose"]
    assert sorted(here.services) == [
        "/clear",
        "/kill",
        "/reset",
        "/rosout/get_loggers",
        "/rosout/set_logger_level",
        "/spawn",
        "/turtle1/set_pen",
        "/turtle1/teleport_absolute",
        "/turtle1/teleport_relative",
        "/turtlesim/get_loggers",
        "/turtlesim/set_logger_level",
    ]


def test_a_background_that_was_set_before_is_kept(watch):
    kernel.start()
    graph.active().parameters.set("/turtlesim/background_r", 10)
    probe = watch(start_turtlesim())
    kernel.sleep(0.1)
    assert probe.colour == (10, 86, 255)
    assert [graph.active().parameters.get(f"/turtlesim/background_{part}") for part in "rgb"] == [10, 86, 255]


class TestPen:
    def test_at_the_end_of_its_trail_the_turtle_reads_the_pen(self, turtle):
        turtle.drive(1)
        kernel.sleep(1.5)
        assert turtle.colour == PEN

    @pytest.mark.parametrize(
        "speed, recorded", [(0.2, 61 / 61), (0.5, 61 / 62), (1.0, 49 / 62), (1.5, 27 / 62), (2.0, 4 / 62), (2.5, 0), (5.0, 0)]
    )
    def test_while_driving_it_reads_the_pen_as_often_as_recorded(self, turtle, speed, recorded):
        turtle.teleport(1, 5.544445)
        turtle.call("/clear", "std_srvs/Empty")
        turtle.colours.clear()
        turtle.drive(speed)
        kernel.sleep(1.0)
        readings = [tuple(colour.values()) for colour in turtle.colours]
        assert readings.count(PEN) / len(readings) == pytest.approx(recorded, abs=0.06)

    def test_a_teleport_draws_a_line(self, turtle):
        turtle.teleport(2, 2)
        assert turtle.colour == PEN
        turtle.set_pen(off=1)
        turtle.teleport(3.772, 3.772)
        assert turtle.colour == PEN
        turtle.teleport(3, 4)
        assert turtle.colour == GROUND

    def test_a_teleport_that_only_turns_paints_a_dot(self, turtle):
        turtle.call("/turtle1/teleport_relative", "turtlesim/TeleportRelative", linear=0, angular=0.5)
        kernel.sleep(0.04)
        assert turtle.colour == PEN
        assert turtle.simulator.canvas.rgb().count(bytes(PEN)) == 9

    def test_set_pen_takes_colour_and_width(self, turtle):
        turtle.set_pen(255, 0, 0, 5)
        turtle.teleport(8, 5.544445)
        assert turtle.colour == (255, 0, 0)
        column = [turtle.simulator.canvas.pixel(300 / 45, row / 45) for row in range(500)]
        assert column.count((255, 0, 0)) == 5

    def test_a_pen_that_is_off_leaves_the_ground_clean_and_keeps_its_colour_to_itself(self, turtle):
        turtle.set_pen(9, 9, 9, 9, off=1)
        turtle.drive(1)
        kernel.sleep(1.5)
        assert turtle.colour == GROUND
        turtle.set_pen(0, 255, 0, 0)
        turtle.teleport(9, 5.544445)
        column = [turtle.simulator.canvas.pixel(350 / 45, row / 45) for row in range(500)]
        assert column.count((0, 255, 0)) == 1

    def test_width_zero_misses_the_sensor_when_driving_through_the_centre_as_recorded(self, turtle):
        turtle.set_pen(255, 0, 0, 0)
        turtle.drive(1)
        kernel.sleep(1.5)
        assert turtle.colour == GROUND


class TestGlobalServices:
    def test_spawn_answers_with_the_name(self, turtle, watch):
        assert turtle.call("/spawn", "turtlesim/Spawn", x=2, y=2, theta=0.2, name="").name == "turtle2"
        assert turtle.log()[-1] == "Spawning turtle [turtle2] at x=[2.000000], y=[2.000000], theta=[0.200000]"
        other = watch(turtle.simulator, "turtle2")
        kernel.sleep(0.05)
        assert other.pose[:3] == pytest.approx((2, 2, 0.2), abs=1e-6)

    def test_a_name_that_is_taken_is_refused_without_a_text(self, turtle):
        before = turtle.pose
        with pytest.raises(Refusal) as refusal:
            turtle.call("/spawn", "turtlesim/Spawn", x=3, y=3, name="turtle1")
        assert str(refusal.value) == ""
        assert turtle.log()[-1] == "A turtled named [turtle1] already exists"
        kernel.sleep(0.05)
        assert turtle.pose == before

    def test_another_spelling_of_a_name_is_the_same_name_so_nobody_loses_topics(self, turtle):
        with pytest.raises(Refusal):
            turtle.call("/spawn", "turtlesim/Spawn", x=3, y=3, name="/turtle1")
        assert turtle.log()[-1] == "A turtled named [/turtle1] already exists"
        turtle.call("/spawn", "turtlesim/Spawn", x=3, y=3, name="/turtle2")
        assert turtle.call("/spawn", "turtlesim/Spawn", x=3, y=3, name="").name == "turtle3"

    def test_drawings_are_given_out_in_turn_and_begin_anew(self, turtle):
        numbers = [turtle.simulator.turtles["turtle1"].number]
        for _ in range(14):
            name = turtle.call("/spawn", "turtlesim/Spawn", x=3, y=3, name="").name
            numbers.append(turtle.simulator.turtles[name].number)
        assert numbers == [*range(14), 0]

    @pytest.mark.parametrize(
        "name, complaint",
        [
            (
                "bad name!",
                "Character [ ] at element [3] is not valid in Graph Resource Name [bad name!].  "
                "Valid characters are a-z, A-Z, 0-9, / and _.",
            ),
            (
                "1abc",
                "Character [1] is not valid as the first character in Graph Resource Name [1abc].  Valid characters are a-z, A-Z, / and in "
                "some cases ~.",
            ),
        ],
    )
    def test_an_illegal_name_is_refused_with_roscpps_text(self, turtle, name, complaint):
        with pytest.raises(Refusal) as refusal:
            turtle.call("/spawn", "turtlesim/Spawn", x=3, y=3, name=name)
        assert str(refusal.value) == complaint
        assert turtle.log()[-1] == "Exception thrown while processing service call: " + complaint

    def test_unnamed_turtles_skip_names_that_are_taken(self, turtle):
        turtle.call("/spawn", "turtlesim/Spawn", x=3, y=3, name="turtle2")
        assert turtle.call("/spawn", "turtlesim/Spawn", x=3, y=3, name="").name == "turtle3"

    def test_names_of_the_dead_are_not_used_again_until_reset(self, turtle):
        turtle.call("/kill", "turtlesim/Kill", name="turtle1")
        assert turtle.call("/spawn", "turtlesim/Spawn", x=3, y=3, name="").name == "turtle2"
        turtle.call("/reset", "std_srvs/Empty")
        assert list(turtle.simulator.turtles) == ["turtle1"]
        assert turtle.call("/spawn", "turtlesim/Spawn", x=3, y=3, name="").name == "turtle2"

    def test_killing_nobody_is_refused(self, turtle):
        with pytest.raises(Refusal):
            turtle.call("/kill", "turtlesim/Kill", name="nobody")
        assert turtle.log()[-1] == "Tried to kill turtle [nobody], which does not exist"

    def test_a_killed_turtle_leaves_the_graph_but_its_trail_stays(self, turtle):
        turtle.teleport(8, 8)
        turtle.call("/kill", "turtlesim/Kill", name="turtle1")
        here = graph.active()
        assert not [name for name in here.services if name.startswith("/turtle1/")]
        assert not here.topics["/turtle1/pose"].publications
        assert bytes(PEN) in turtle.simulator.canvas.rgb()

    def test_reset_starts_over(self, turtle):
        turtle.teleport(8, 8)
        turtle.set_pen(1, 2, 3, 7)
        turtle.drive(5)
        turtle.call("/reset", "std_srvs/Empty")
        kernel.sleep(0.2)
        assert turtle.pose == (5.544444561004639, 5.544444561004639, 0.0, 0.0, 0.0)
        assert turtle.simulator.canvas.rgb() == bytes(GROUND) * 250_000
        turtle.drive(1)
        kernel.sleep(1.2)
        assert turtle.colour == PEN
        assert turtle.log()[2:4] == ["Resetting turtlesim.", "Spawning turtle [turtle1] at x=[5.544445], y=[5.544445], theta=[0.000000]"]

    @pytest.mark.parametrize(
        "value, red",
        [(150, 150), (150.0, 150), (10.5, 11), (257, 1), (-1, 255), (math.inf, 69), (math.nan, 69), ("150", 69), (True, 69), ([1], 69)],
    )
    def test_a_background_of_another_kind_counts_as_in_roscpp(self, turtle, value, red):
        graph.active().parameters.set("/turtlesim/background_r", value)
        turtle.call("/clear", "std_srvs/Empty")
        assert turtle.simulator.canvas.background == (red, 86, 255)

    def test_the_background_changes_with_clear_and_not_before(self, turtle):
        graph.active().parameters.set("/turtlesim/background_r", 150)
        kernel.sleep(0.1)
        assert turtle.colour == GROUND
        turtle.call("/clear", "std_srvs/Empty")
        kernel.sleep(0.05)
        assert turtle.colour == (150, 86, 255)
        assert turtle.log()[-1] == "Clearing turtlesim."

    def test_clear_leaves_turtles_alone(self, turtle):
        turtle.teleport(8, 8)
        before = turtle.pose
        turtle.call("/clear", "std_srvs/Empty")
        kernel.sleep(0.05)
        assert turtle.pose == before
        assert turtle.simulator.canvas.rgb() == bytes(GROUND) * 250_000

    def test_spawning_outside_clamps_at_the_first_update(self, turtle, watch):
        turtle.call("/spawn", "turtlesim/Spawn", x=12, y=2, name="far")
        probe = watch(turtle.simulator, "far")
        kernel.sleep(0.05)
        assert "[x=12.000000, y=9.088889]" in turtle.log()[-1]
        assert probe.pose[0] == 11.088889122009277


def test_two_simulators_in_namespaces_are_independent(watch):
    kernel.start()
    first, second = start_turtlesim("sim", "a"), start_turtlesim("sim", "b")
    probe = watch(first, "a/turtle1")
    probe.drive(1)
    kernel.sleep(1.5)
    assert probe.pose[0] > 6
    assert second.turtles["turtle1"].pose()[0] == 5.544444561004639
    assert {"/a/turtle1/pose", "/b/turtle1/pose"} <= set(graph.active().topics)


def test_a_late_subscriber_gets_the_next_pose_and_nothing_older(turtle, watch):
    late = watch(turtle.simulator)
    assert not late.poses
    kernel.sleep(0.017)
    assert len(late.poses) == 1


class TestTeleop:
    def test_an_arrow_key_is_one_command(self, turtle):
        teleop = Teleop()
        assert teleop.press("up")
        kernel.sleep(1.5)
        assert turtle.pose[0] == pytest.approx(5.544445 + 2.016, abs=1e-5)

    def test_keys_are_known_by_their_last_byte(self, turtle):
        received = []
        turtle.node.subscribe("/turtle1/cmd_vel", turtle.twist, received.append)
        teleop = Teleop()
        assert teleop.feed(b"\x1b[A\x1b[B\x1b[C\x1b[D x")
        assert [(message.linear.x, message.angular.z) for message in received] == [(2.0, 0.0), (-2.0, 0.0), (0.0, -2.0), (0.0, 2.0)]

    def test_the_scale_is_a_parameter_of_the_namespace(self, turtle):
        graph.active().parameters.set("/scale_linear", 1.0)
        teleop = Teleop()
        teleop.press("A")
        kernel.sleep(0.05)
        assert turtle.pose[3] == 1.0

    def test_q_leaves(self, turtle):
        teleop = Teleop()
        teleop.press("q")
        assert not teleop.press("up")
        assert "/teleop_turtle" not in graph.active().nodes
