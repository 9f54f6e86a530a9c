"""The ROS tools on the graph of the process (golden/ros-command-line.txt)."""

from pathlib import Path

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.ros import graph
from cramhy_runtime.ros.command_line import run
from cramhy_runtime.ros.yaml_text import read

RECORDED = Path(__file__).resolve().parents[3] / "shared" / "golden" / "ros-command-line.txt"


@pytest.fixture
def simulator(session):
    from cramhy_runtime.turtlesim.node import start_turtlesim

    return start_turtlesim()


def recorded():
    """The recorded commands: words → (text, exit status)."""
    if not RECORDED.exists():
        return {}
    table = {}
    for block in RECORDED.read_text().split("======== $ ")[1:]:
        command, _, rest = block.partition("\n")
        text, _, status = rest.rpartition("-------- exit ")
        table[command] = (text, int(status))
    return table


@pytest.mark.parametrize(
    "command",
    [
        "rostopic type /turtle1/cmd_vel",
        "rostopic info /nope",
        "rostopic type /nope",
        "rosmsg show turtlesim/Pose",
        "rosmsg show geometry_msgs/Twist",
        "rosmsg show nope/Nope",
        "rossrv show turtlesim/SetPen",
        "rossrv show turtlesim/Spawn",
        "rosservice type /spawn",
        "rosservice args /spawn",
        "rosservice info /nope",
        "rostopic echo -n 1 /turtle1/pose",
        "rostopic echo -n 1 /turtle1/color_sensor",
        "rostopic echo -n 1 /turtle1/pose/x",
        "rostopic list",
        "rosservice call /clear",
        'rosservice call /spawn 2 2 0.2 ""',
        "rosservice call /spawn 2 2 0.2 turtle1",
        "rosservice call /kill nope",
        "rosservice call /turtle1/set_pen 255 0 0 5 0",
        "rosservice call /turtle1/set_pen 255 0",
        "rosservice call /turtle1/set_pen 300 0 0 5 0",
        "rosservice call /turtle1/teleport_relative 1 0.5",
        "rosservice call /nope",
        "rosservice call /reset",
        "rosparam get /turtlesim/background_r",
        "rosparam get /nope",
        "rosparam delete /nope",
        "rostopic pub -1 /turtle1/cmd_vel geometry_msgs/Twist {bad: 1}",
    ],
)
def test_a_command_answers_as_recorded(simulator, command):
    table = recorded()
    if not table:
        pytest.skip("the recorded commands are not here")
    words = command.split(" {")
    words = words[0].split() + ["{" + words[1]] if len(words) > 1 else command.split()
    words = ["" if word == '""' else word for word in words]
    expected, status = table[command]
    text, exit_status = run(words)
    assert exit_status == status
    assert [line.rstrip() for line in text.rstrip().splitlines()] == [line.rstrip() for line in expected.rstrip().splitlines()]


def test_setting_a_parameter(simulator):
    assert run("rosparam set /turtlesim/background_r 150".split()) == ("", 0)
    assert graph.active().parameters.get("/turtlesim/background_r") == 150


def test_publishing_moves_the_turtle(simulator):
    kernel.sleep(0.1)
    text, _ = run(["rostopic", "pub", "-1", "/turtle1/cmd_vel", "geometry_msgs/Twist", "--", "[2.0, 0.0, 0.0]", "[0.0, 0.0, 1.8]"])
    assert text == "publishing and latching message for 3.0 seconds\n"
    assert simulator.turtles["turtle1"].pose()[:3] == pytest.approx((6.602816582, 6.938989639, 1.8144), abs=1e-6)


def test_the_rate_of_a_topic(simulator):
    text, _ = run(["rostopic", "hz", "/turtle1/pose"], seconds=1.0)
    assert "average rate: 62.500" in text


def test_a_topic_that_nobody_knows(simulator):
    assert run(["rostopic", "echo", "/nope"]) == ("WARNING: topic [/nope] does not appear to be published yet\n", 1)


def test_nodes(simulator):
    assert run(["rosnode", "list"]) == ("/rosout\n/turtlesim\n", 0)
    text, _ = run(["rosnode", "info", "turtlesim"])
    assert " * /turtle1/pose [turtlesim/Pose]" in text and " * /turtle1/set_pen" in text
    assert run(["rosnode", "kill", "/turtlesim"]) == ("killing /turtlesim\nkilled\n", 0)
    assert run(["rosnode", "info", "/turtlesim"])[1] == 1


def test_an_unknown_command_names_the_known_ones(simulator):
    text, status = run(["rosnode", "fly"])
    assert status and "info kill list" in text


@pytest.mark.parametrize(
    "text, value",
    [
        ("1", 1),
        ("1.5", 1.5),
        ("true", True),
        ('""', ""),
        ("turtle1", "turtle1"),
        ("[1, 2.0]", [1, 2.0]),
        ("{x: 1, y: {z: a}}", {"x": 1, "y": {"z": "a"}}),
        ("x: 1\ny: 2", {"x": 1, "y": 2}),
        ("-3", -3),
        ("/a/b", "/a/b"),
    ],
)
def test_values_on_a_command_line(text, value):
    assert read(text) == value
