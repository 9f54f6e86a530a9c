"""Commands that make no sense: what is said, with the exit status, and nothing is lost."""

from __future__ import annotations

from dataclasses import replace

import pytest

from cramhy_runtime import kernel

TWIST = "rostopic pub -1 /turtle1/cmd_vel geometry_msgs/Twist"


def usage(words, problem):
    tool = words.split()[0]
    return f"Usage: {words}\n\n{tool}: error: {problem}\n"


@pytest.mark.soak(all_but=13)
@pytest.mark.parametrize(
    ("words", "complaint", "status"),
    [
        (["rostopic", "echo"], usage("rostopic echo [options] /topic", "topic name must be specified"), 2),
        (["rostopic", "echo", "/a", "/b"], usage("rostopic echo [options] /topic", "you may only specify one topic name"), 2),
        (["rostopic", "echo", "-n"], usage("rostopic echo [options] /topic", "-n option requires 1 argument"), 2),
        (["rostopic", "echo", "-n", "x", "/a"], usage("rostopic echo [options] /topic", "option -n: invalid count value: 'x'"), 2),
        (["rostopic", "echo", "-n", "0", "/a"], usage("rostopic echo [options] /topic", "option -n: invalid count value: '0'"), 2),
        (["rostopic", "echo", "-z", "/a"], usage("rostopic echo [options] /topic", "no such option: -z"), 2),
        (["rostopic", "echo", "/turtle1/pose/z"], "ERROR: there is no field [z] in /turtle1/pose\n", 1),
        (["rostopic", "echo", "/turtle1/pose/x/y"], "ERROR: there is no field [x/y] in /turtle1/pose\n", 1),
        (["rostopic", "echo", "/turtle1/pose/x[0]"], "ERROR: there is no field [x[0]] in /turtle1/pose\n", 1),
        (["rostopic", "list", "/nope"], "ERROR: Unknown topic /nope\n", 1),
        (["rostopic", "list", "-p", "-s"], usage("rostopic list [options] [namespace]", "you may only specify one of -p, -s"), 2),
        (["rostopic", "pub"], usage("rostopic pub [options] /topic type [args...]", "topic name must be specified"), 2),
        (["rostopic", "pub", "/a"], usage("rostopic pub [options] /topic type [args...]", "topic type must be specified"), 2),
        (
            ["rostopic", "pub", "-r", "0", "/a", "std_msgs/Empty"],
            usage("rostopic pub [options] /topic type [args...]", "option -r: invalid rate value: '0'"),
            2,
        ),
        (
            ["rostopic", "pub", "/a", "std_msgs/String"],
            usage("rostopic pub [options] /topic type [args...]", "Please specify message values"),
            2,
        ),
        (
            ["rostopic", "pub", "/a", "std_msgs/String", "[1"],
            usage("rostopic pub [options] /topic type [args...]", "Argument error: line 1, column 1: the [ is never closed"),
            2,
        ),
        (
            ["rostopic", "pub", "-f", "/no/file", "/a", "std_msgs/String"],
            usage(
                "rostopic pub [options] /topic type [args...]",
                "the file /no/file cannot be read: [Errno 2] No such file or directory: '/no/file'",
            ),
            2,
        ),
        (
            ["rostopic", "pub", "/a", "nope/Nope", "1"],
            "ERROR: invalid message type: nope/Nope.\nIf this is a valid message type, perhaps you need to type 'rosmake nope'\n",
            1,
        ),
        (
            ["rostopic", "pub", "-1", "/a", "std_msgs/UInt8", "300"],
            "ERROR: Unable to publish message. One of the fields has an incorrect type:\n  field data exceeds specified width [uint8]\n\n"
            "msg file:\nuint8 data\n\n",
            1,
        ),
        (
            ["rostopic", "pub", "-1", "/a", "std_msgs/Bool", "2"],
            "ERROR: Unable to publish message. One of the fields has an incorrect type:\n  field data is not a bool\n\n"
            "msg file:\nbool data\n\n",
            1,
        ),
        (
            [*TWIST.split(), "[1, 2]", "[0, 0, 0]"],
            "ERROR: Not enough arguments:\n * Given: [1, 2]\n * Expected: ['x', 'y', 'z']\n\n"
            "Args are: [linear.x linear.y linear.z angular.x angular.y angular.z]\n",
            1,
        ),
        (
            [*TWIST.split(), "{linear: {x: fast}}"],
            "ERROR: Unable to publish message. One of the fields has an incorrect type:\n  field linear.x must be float type\n\nmsg file:\n"
            "geometry_msgs/Vector3 linear\n  float64 x\n  float64 y\n  float64 z\ngeometry_msgs/Vector3 angular\n  float64 x\n  float64 y\n"
            "  float64 z\n\n",
            1,
        ),
        (
            [*TWIST.split(), "{linear: 5}"],
            "ERROR: Field [linear] must be a mapping or a list of the values of geometry_msgs/Vector3, not int\n\n"
            "Args are: [linear.x linear.y linear.z angular.x angular.y angular.z]\n",
            1,
        ),
        (
            ["rostopic", "pub", "-1", "/turtle1/pose", "std_msgs/String", "x"],
            "ERROR: the topic /turtle1/pose has the type turtlesim/Pose, so a std_msgs/String would reach nobody.\n",
            1,
        ),
        (["rostopic", "fly"], None, 64),
        (["rostopic"], None, 64),
        (["rosservice", "call"], usage("rosservice call /service [args...]", "service name must be specified"), 2),
        (["rosservice", "call", "/clr"], "ERROR: Service [/clr] is not available.\nDid you mean /clear?\n", 2),
        (["rosservice", "type", "/rset"], "Unknown service [/rset]\nDid you mean /reset?\n", 1),
        (
            ["rosservice", "call", "/spawn", "{x: 1, speed: 2}"],
            "ERROR: Incompatible arguments to call service:\nNo field name [speed]\n"
            "Provided arguments are:\n * {'x': 1, 'speed': 2} (type dict)\n\n"
            "Service arguments are: [x y theta name]\n",
            2,
        ),
        (
            ["rosservice", "call", "/spawn", "1", "2", "{", "x"],
            usage("rosservice call /service [args...]", "Argument error: line 1, column 1: the { is never closed"),
            2,
        ),
        (["rosnode", "info"], usage("rosnode info node1 [node2...]", "You must specify at least one node name"), 2),
        (["rosnode", "kill", "/a", "/turtlesim"], "ERROR: Unknown node(s):\n * /a\n", 1),
        (["rosparam", "set", "/a"], usage("rosparam set [options] parameter value", "you must specify a parameter value"), 2),
        (
            ["rosparam", "set", "/a", "1", "2"],
            usage("rosparam set [options] parameter value", "too many arguments; a value with spaces needs quotes"),
            2,
        ),
        (
            ["rosparam", "set", "/a", "{b: ]"],
            usage("rosparam set [options] parameter value", "Argument error: line 1, column 5: a value or } is missing"),
            2,
        ),
        (["rosparam", "set", "/", "1"], "ERROR: cannot set root of parameter tree to non-dictionary\n", 1),
        (["rosparam", "set", "/a", "null"], "ERROR: a parameter cannot be null. To remove it: rosparam delete /a\n", 1),
        (["rosparam", "load", "/no/file"], "ERROR: file [/no/file] does not exist\n", 1),
        (
            ["rosmsg", "show", "turtlesim/Posed"],
            "Unable to load msg [turtlesim/Posed]: Cannot locate message [Posed] in package [turtlesim]; it has "
            "turtlesim/Color, turtlesim/Pose\n",
            1,
        ),
        (["rossrv", "show", "Nope"], "Unable to load srv [Nope]: Cannot locate service [Nope] in any package\n", 1),
    ],
)
def test_what_makes_no_sense_is_told(shell, simulator, words, complaint, status):
    before = simulator.graph.nodes.keys() | set(), list(simulator.graph.topics), simulator.graph.parameters.names()
    shell(words)
    assert (shell.out, shell.status) == ("", status)
    assert complaint is None or shell.errors == complaint
    assert (simulator.graph.nodes.keys() | set(), list(simulator.graph.topics), simulator.graph.parameters.names()) == before


def test_help_is_no_error(shell):
    shell("rostopic -h")
    assert shell.status == 0 and "\trostopic echo\tprints the messages of a topic, or one field of them\n" in shell.out
    shell("rostopic echo -h")
    assert shell.status == 0 and shell.out.startswith("Usage: rostopic echo [options] /topic\n\nprints the messages")


def test_a_message_as_completion_in_a_shell_leaves_it(shell, simulator):
    shell([*TWIST.split(), "linear:\n  x: 2.0\n  y: 0.0\n  z: 0.0\nangular:\n  x: 0.0\n  y: 0.0\n  z: 1.8"])
    assert shell.said == ("publishing and latching message for 3.0 seconds\n", "", 0)
    assert simulator.turtles["turtle1"].pose()[:3] == pytest.approx((6.602816582, 6.938989639, 1.8144), abs=0.04)


def test_parameters_go_to_a_file_and_come_back(shell, tmp_path):
    shell(["rosparam", "set", "/robot", "{name: 'it''s', limits: [1, 2.5, [x]], ok: yes}"])
    shell(["rosparam", "dump", str(tmp_path / "all.yaml"), "/robot"])
    shell("rosparam delete /robot")
    shell(["rosparam", "load", str(tmp_path / "all.yaml"), "/again"])
    assert shell("rosparam get /again") == "limits:\n- 1\n- 2.5\n- - x\nname: it's\nok: true\n\n"


def test_a_table_of_messages(shell):
    assert shell("rostopic echo -n 2 -p /turtle1/color_sensor").splitlines()[0] == "%time,field.r,field.g,field.b"
    assert shell.out.splitlines()[1].endswith(",69,86,255") and shell.status == 0


def test_negative_numbers_need_no_dashes(shell, simulator):
    shell("rosservice call /turtle1/teleport_relative -1 -0.5")
    assert shell.said == ("\n", "", 0)
    kernel.sleep(0.05)
    assert simulator.turtles["turtle1"].pose()[2] == pytest.approx(-0.5)


def test_a_topic_that_looks_misspelled_is_waited_for_and_the_right_one_named(shell):
    shell("rostopic echo /turtle1/pos", patience=1.0)
    assert shell.said == ("", "WARNING: topic [/turtle1/pos] does not appear to be published yet\nDid you mean /turtle1/pose?\n", None)


def test_a_package_that_comes_to_the_path_later_is_found(shell, tmp_path, monkeypatch):
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(tmp_path))
    assert "unknown package [later_msgs]" in shell("rosmsg show later_msgs/Thing") + shell.errors and shell.status == 1
    (tmp_path / "later_msgs" / "msg").mkdir(parents=True)
    (tmp_path / "later_msgs" / "msg" / "Thing.msg").write_text("int8 size\n")
    assert shell("rosmsg show later_msgs/Thing") == "int8 size\n\n"


def test_what_the_session_refuses_is_told_in_one_line(far_shell):
    from cramhy_runtime.rosbridge.server import running

    hub = running().hub
    hub.limits = replace(hub.limits, subscriptions=0)
    far_shell("rostopic echo /turtle1/pose")
    assert far_shell.said == ("", "ERROR: You subscribe to 0 topics; more are not allowed. Unsubscribe from some.\n", 1)


def test_a_session_that_ends_while_it_lets_the_tool_in_is_no_session(far_shell, monkeypatch):
    from cramhy_runtime.ros_tools import graph_access as reach, remote_graph as there

    def gone(graph, **operation):
        raise reach.SessionEnded("The session has ended.")

    monkeypatch.setattr(there.ThereGraph, "_send", gone)
    assert far_shell("rostopic list") == "" and far_shell.status == 1
    assert "does not let us in: The session has ended.\n" in far_shell.errors


def test_nothing_is_promised_before_a_topic_is_refused(far_shell):
    far_shell(["rostopic", "pub", "-1", "/a b", "std_msgs/String", "x"])
    assert far_shell.said == (
        "",
        "ERROR: Character [ ] at element [2] is not valid in Graph Resource Name [/a b].  Valid characters are a-z, A-Z, 0-9, / and _.\n",
        1,
    )
