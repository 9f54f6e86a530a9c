"""The executables of the package with their command lines, loggers, launch file, and what ``draw_square`` and ``mimic`` do."""

import math
import re

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.cli import launch
from cramhy_runtime.lisp_core.condition_types import SimpleError
from cramhy_runtime.ros import graph
from cramhy_runtime.ros.messages import message_class_exact
from cramhy_runtime.ros.services import Refusal
from cramhy_runtime.ros.wire import NEGATIVE_INFINITY, POSITIVE_INFINITY
from cramhy_runtime.turtlesim import executables, teleop
from cramhy_runtime.turtlesim.node import each_simulator, running_simulator, simulators, start_turtlesim
from cramhy_runtime.ros.roscpp import MOST_LINES


def texts(program):
    return [line.split("]: ", 1)[1] for line in program.lines]


class TestCommandLine:
    def test_the_default_names_are_the_originals(self, simulator):
        started = [executables.start(name) for name in ("turtle_teleop_key", "draw_square", "mimic")]
        assert [program.node.name for program in started] == ["/teleop_turtle", "/draw_square", "/turtle_mimic"]
        assert simulator.node.name == "/turtlesim"

    def test_name_and_name_space_count_wherever_they_stand(self, simulator):
        program = executables.start("turtlesim_node", ["turtle1/pose:=where", "__name:=sim", "__ns:=/left/"])
        assert program.node.name == "/left/sim"
        assert {"/left/where", "/left/turtle1/cmd_vel"} <= set(program.node.publications) | set(program.node.subscriptions)
        assert graph.active().parameters.get("/left/sim/background_b") == 255

    def test_one_string_is_split_at_spaces(self, simulator):
        assert executables.start("turtlesim_node", "__name:=sim __ns:=b").node.name == "/b/sim"

    def test_private_parameters_are_set_before_the_program_looks(self, simulator):
        words = ["__name:=sim", "_background_r:=10", "_background_b:=0", "_half:=0.5", "_on:=True", "_path:=~/x", "_colour:=#f00"]
        assert executables.start("turtlesim_node", words).canvas.background == (10, 86, 0)
        assert graph.active().parameters.get("/sim") == {
            "background_r": 10,
            "background_g": 86,
            "background_b": 0,
            "half": 0.5,
            "on": True,
            "path": "~/x",
            "colour": "#f00",
        }

    def test_services_are_remapped_too(self, simulator):
        program = executables.start("turtlesim_node", ["__ns:=b", "clear:=wipe"])
        assert "/b/wipe" in program.node.services and "/b/clear" not in program.node.services

    def test_teleop_drives_another_turtle_when_its_topic_is_remapped(self, simulator, watch):
        simulator.spawn("turtle2", 2.0, 2.0, 0.0)
        kernel.sleep(0.1)
        keys = executables.start("turtle_teleop_key", ["turtle1/cmd_vel:=turtle2/cmd_vel"])
        keys.feed(b"\x1b[A")
        kernel.sleep(1.5)
        assert simulator.turtles["turtle2"].pose()[0] == pytest.approx(2 + 2.016, abs=1e-5)
        assert simulator.turtles["turtle1"].pose()[0] == 5.544444561004639

    def test_a_private_scale_has_no_effect(self, simulator):
        keys = executables.start("turtle_teleop_key", ["_scale_linear:=9"])
        assert keys.linear == 2.0

    @pytest.mark.parametrize("value", ["fast", "3", True, [1.0], {"x": 1}])
    def test_a_scale_that_is_no_number_is_left_alone(self, simulator, value):
        graph.active().parameters.set("/scale_angular", value)
        assert executables.start("turtle_teleop_key").angular == 2.0

    def test_an_illegal_name_is_an_error_that_says_why(self, simulator):
        with pytest.raises(SimpleError) as error:
            executables.start("turtlesim_node", ["__name:=my turtle"])
        assert error.value.report() == (
            "A node cannot be called /my turtle. Character [ ] at element [3] is not valid in Graph Resource Name [/my turtle].  "
            "Valid characters are a-z, A-Z, 0-9, / and _."
        )

    def test_an_executable_that_does_not_exist_is_an_error_that_names_those_that_do(self, simulator):
        with pytest.raises(SimpleError) as error:
            executables.start("turtle_teleop")
        assert error.value.report() == (
            "The package turtlesim has no executable turtle_teleop. Executables: draw_square mimic turtle_teleop_key turtlesim_node."
        )

    def test_a_node_of_the_same_name_takes_the_place_of_the_one_before(self, simulator):
        second = start_turtlesim()
        assert not simulator.alive and running_simulator() is second
        lines = len(simulator.lines)
        kernel.sleep(0.1)
        assert len(simulator.lines) == lines


def test_multisim_starts_two_simulators(simulator, watch):
    asked = launch.load(["turtlesim", "multisim.launch"], {}).programs
    first, second = [executables.start(program.executable, program.arguments) for program in asked]
    assert [first.node.name, second.node.name] == ["/turtlesim1/sim", "/turtlesim2/sim"]
    assert simulators() == [simulator, first, second] and running_simulator() is simulator
    probe = watch(first, "turtlesim1/turtle1")
    executables.start("mimic", ["input:=turtlesim1/turtle1", "output:=turtlesim2/turtle1"])
    probe.drive(1, 0.5)
    kernel.sleep(1.5)
    ahead, behind = first.turtles["turtle1"].pose(), second.turtles["turtle1"].pose()
    assert ahead[0] > 6
    assert behind[:3] == pytest.approx(ahead[:3], abs=1e-5)


def test_who_expects_simulators_hears_of_those_that_run_and_of_those_that_start(simulator):
    seen = []
    each_simulator(seen.append)
    other = start_turtlesim("sim")
    assert seen == [simulator, other]


def test_the_log_is_echoed_where_one_wants_it(simulator, capsys):
    lines = []
    start_turtlesim("one", echo=lines.append)
    assert re.fullmatch(r"\[ INFO\] \[\d+\.\d{9}\]: Starting turtlesim with node name /one", lines[0])
    start_turtlesim("two", echo=True)
    assert capsys.readouterr().err.count("/two") == 1


def test_the_log_is_bounded(simulator):
    for number in range(MOST_LINES + 10):
        simulator.log(2, str(number))
    assert MOST_LINES // 2 <= len(simulator.lines) <= MOST_LINES
    assert texts(simulator)[-1] == str(MOST_LINES + 9)


class TestLoggers:
    def test_they_are_those_of_a_node_in_c(self, turtle):
        loggers = turtle.call("/turtlesim/get_loggers", "roscpp/GetLoggers").loggers
        assert [(logger.name, logger.level) for logger in loggers] == [
            ("ros", "info"),
            ("ros.roscpp", "info"),
            ("ros.roscpp.roscpp_internal", "info"),
            ("ros.roscpp.superdebug", "warn"),
            ("ros.turtlesim", "info"),
        ]

    def test_a_node_that_debugs_tells_every_tick_in_screen_coordinates(self, turtle):
        turtle.call("/turtlesim/set_logger_level", "roscpp/SetLoggerLevel", logger="ros.turtlesim", level="Debug")
        turtle.simulator.lines.clear()
        kernel.sleep(0.032)
        assert re.sub(r"[\d.]{20,}", "TIME", turtle.simulator.lines[-1]) == (
            "[DEBUG] [TIME]: [/turtle1]: pos_x: 5.544445 pos_y: 5.544445 theta: 0.000000"
        )
        assert len(turtle.simulator.lines) == 2

    def test_a_node_that_tells_only_errors_does_not_tell_of_walls(self, turtle):
        turtle.call("/turtlesim/set_logger_level", "roscpp/SetLoggerLevel", logger="ros.turtlesim", level="error")
        before = turtle.log()
        turtle.teleport(20, 5)
        turtle.call("/clear", "std_srvs/Empty")
        assert turtle.log() == before
        with pytest.raises(Refusal):
            turtle.call("/kill", "turtlesim/Kill", name="nobody")
        assert turtle.log()[-1] == "Tried to kill turtle [nobody], which does not exist"

    def test_a_level_that_does_not_exist_is_refused(self, turtle):
        with pytest.raises(Refusal):
            turtle.call("/turtlesim/set_logger_level", "roscpp/SetLoggerLevel", logger="ros.turtlesim", level="loud")


class TestTeleop:
    def test_escape_and_other_keys_publish_nothing(self, turtle):
        keys = teleop.Teleop()
        heard = []
        turtle.node.subscribe("/turtle1/cmd_vel", turtle.twist, heard.append)
        assert keys.feed(b"\x1b[x \x00\xff")
        assert not heard
        assert keys.feed(b"A") and keys.feed(b"\x1b") and keys.feed(b"[") and keys.feed(b"D")
        assert [(message.linear.x, message.angular.z) for message in heard] == [(2.0, 0.0), (0.0, 2.0)]

    def test_q_ends_it_and_what_is_typed_after_it_does_nothing(self, turtle):
        keys = teleop.Teleop()
        heard = []
        turtle.node.subscribe("/turtle1/cmd_vel", turtle.twist, heard.append)
        assert not keys.feed(b"qA")
        assert not keys.alive and not heard

    def test_the_banner(self):
        assert teleop.BANNER == ("Reading from keyboard\n---------------------------\nUse arrow keys to move the turtle. 'q' to quit.\n")


class TestDrawSquare:
    def test_a_lap_is_the_recorded_one(self, turtle):
        turtle.teleport(2, 2, 1)
        square = executables.start("draw_square")
        kernel.sleep(24.5)
        goals = [tuple(map(float, re.findall(r"-?\d+\.\d+", text))) for text in texts(square) if text.startswith("New goal")]
        assert goals[0] == (7.544445, 5.544445, 0.0)
        corners = goals[1::2]  # where the turtle stands when it begins to turn
        assert [corner[:2] for corner in corners[:4]] == [
            pytest.approx(corner, abs=1e-4) for corner in ((7.4484, 5.5444), (7.4660, 7.4484), (5.5623, 7.4834), (5.5098, 5.5801))
        ]
        assert goals[2][2] == pytest.approx(1.5616, abs=1e-4)
        assert goals[8][2] == pytest.approx(-0.0368, abs=1e-4)

    def test_it_says_what_it_reaches(self, turtle):
        square = executables.start("draw_square")
        kernel.sleep(2.2)
        assert texts(square) == ["New goal [7.544445 5.544445, 0.000000]", "Reached goal", "New goal [7.448444 5.544445, 1.570796]"]

    def test_a_pose_that_is_infinite_stops_nothing(self, simulator, watch, capsys):
        simulator.shutdown()
        other = watch(simulator)
        square = executables.start("draw_square")
        poses = other.node.advertise("/turtle1/pose", message_class_exact("turtlesim/Pose"))
        message = poses.type()
        message.x, message.theta = NEGATIVE_INFINITY, POSITIVE_INFINITY
        poses.publish(message)
        kernel.sleep(0.1)
        assert capsys.readouterr().err == "" and square.alive

    def test_it_commands_every_tick(self, turtle):
        heard = []
        turtle.node.subscribe("/turtle1/cmd_vel", turtle.twist, heard.append)
        executables.start("draw_square")
        kernel.sleep(0.1)
        heard.clear()
        kernel.sleep(8.0)
        assert len(heard) == 500
        assert {(message.linear.x, message.angular.z) for message in heard} == {(1.0, 0.0), (0.0, 0.0), (0.0, 0.4)}

    def test_it_ends_with_its_node_and_the_turtle_stops(self, turtle):
        square = executables.start("draw_square")
        kernel.sleep(1)
        square.shutdown()
        kernel.sleep(1.1)
        before = turtle.pose
        kernel.sleep(1)
        assert turtle.pose == before and before[3] == 0.0

    def test_without_a_simulator_it_waits_for_a_pose(self):
        kernel.start()
        square = executables.start("draw_square")
        kernel.sleep(1)
        assert square.goal is None
        start_turtlesim()
        kernel.sleep(1)
        assert texts(square) == ["New goal [7.544445 5.544445, 0.000000]"]


class TestMimic:
    def test_a_pose_is_a_command(self, turtle):
        heard = []
        executables.start("mimic", ["input:=turtle1", "output:=elsewhere"])
        turtle.node.subscribe("/elsewhere/cmd_vel", turtle.twist, heard.append)
        turtle.drive(-1, 0.5)
        kernel.sleep(0.16)
        assert len(heard) == 10
        assert (heard[-1].linear.x, heard[-1].angular.z) == (1.0, 0.5)
        kernel.sleep(1.1)
        assert (heard[-1].linear.x, heard[-1].angular.z) == (0.0, 0.0)

    def test_topics_may_be_remapped_by_themselves(self, turtle):
        program = executables.start("mimic", ["input/pose:=turtle1/pose", "output/cmd_vel:=x"])
        assert list(program.node.subscriptions) == ["/turtle1/pose"]
        assert "/x" in program.node.publications

    def test_a_leader_that_is_nowhere_does_not_end_it(self, turtle):
        heard = []
        executables.start("mimic", ["input:=turtle1", "output:=elsewhere"])
        turtle.node.subscribe("/elsewhere/cmd_vel", message_class_exact("geometry_msgs/Twist"), heard.append)
        turtle.drive(math.nan)
        kernel.sleep(0.1)
        assert heard[-1].linear.x.name == "NOT-A-NUMBER"
        turtle.drive(1)
        kernel.sleep(0.1)
        assert heard[-1].linear.x == 1.0
