"""What a student types in two terminals: the simulator in one, the REPL in the other, the keys and the commands in a third."""

from __future__ import annotations

import os
import signal
import termios
from contextlib import ExitStack

import pytest

from cramhy_runtime.cli import shims
from cramhy_runtime.ros_tools import remote_graph

from .terminal import Terminal

pytest.importorskip("uvicorn")
pytest.importorskip("websockets")


def nodes():
    """The nodes of the session of this machine, as another terminal sees them."""
    graph = remote_graph.current()
    try:
        return graph.nodes()
    finally:
        graph.close()


@pytest.mark.soak
def test_the_simulator_goes_to_the_repl_and_comes_back(private, tool):
    simulator = "ros", "rosrun", "turtlesim", "turtlesim_node"
    with Terminal(*simulator) as first:
        first.expect(r"\[ INFO\] \[\d+\.\d{9}\]: Starting turtlesim with node name /turtlesim\n")
        first.expect(r"\[ INFO\] \[\d+\.\d{9}\]: Spawning turtle \[turtle1\] at x=\[5.544445\], y=\[5.544445\], theta=\[0.000000\]\n")
        assert tool("rosservice", "call", "/spawn", "2", "2", "0", "")[0] == 'name: "turtle2"\n'
        first.expect(r"Spawning turtle \[turtle2\]")
        with Terminal("repl", "--serve") as repl:
            repl.expect("CL-USER> ")
            repl.type('(roslisp:start-ros-node "a")')
            repl.expect("startup complete")
            first.expect("; A session has started: the turtle lives there now.")
            first.expect(r"Spawning turtle \[turtle1\]")
            with Terminal(*simulator) as second:
                second.expect(f"; /turtlesim runs in the session of process {repl.pid} already. This is its log; Ctrl-C leaves it alone.")
                assert tool("rosservice call /clear")[0] == "\n"
                first.expect(r"\]: Clearing turtlesim.\n")
                second.expect(r"\]: Clearing turtlesim.\n")
                first.control_c()
                assert first.status() == 0
                assert nodes() == ["/a", "/rosout", "/turtlesim"]
                assert repl.end() == 0
                second.expect("; The session has ended: the turtle lives here again.")
                second.expect(r"Spawning turtle \[turtle1\]")
                os.kill(second.pid, signal.SIGTERM)
                assert second.status() == 0
    assert not list(private.rglob("session*"))


@pytest.mark.soak
def test_the_arrow_keys_drive_the_turtle_and_leave_the_terminal_as_it_was(private):
    with Terminal("repl", "--serve") as repl:
        repl.expect("CL-USER> ")
        repl.type('(roslisp:start-ros-node "a")')
        repl.expect("startup complete")
        graph = remote_graph.current()
        for end in ("q", "ctrl-c", "sigterm"):
            with Terminal("teleop") as keys:
                before = termios.tcgetattr(keys.master)
                keys.expect("Use arrow keys to move the turtle. 'q' to quit.\n")
                while termios.tcgetattr(keys.master)[3] & (termios.ICANON | termios.ECHO):
                    pass
                with graph.listen("/turtle1/pose", "turtlesim/Pose") as poses:
                    os.write(keys.master, b"x\x1b[D")
                    while poses.take()[1]["angular_velocity"] != 2.0:
                        pass
                assert "/teleop_turtle" in graph.nodes()
                if end == "q":
                    os.write(keys.master, b"q")
                elif end == "ctrl-c":
                    keys.control_c()
                else:
                    os.kill(keys.pid, signal.SIGTERM)
                assert keys.status() == 0
                assert termios.tcgetattr(keys.master) == before
            assert "/teleop_turtle" not in graph.nodes()
            graph.call("/reset", "std_srvs/Empty", {})
        graph.close()
        assert repl.end() == 0


def test_a_session_in_virtual_time_answers_at_the_prompt(private, tool):
    with Terminal("repl", "--serve", "--time", "virtual") as repl:
        repl.expect("CL-USER> ")
        repl.type('(roslisp:start-ros-node "a")')
        repl.expect("startup complete")
        repl.expect("CL-USER> ")
        graph = remote_graph.current()
        try:
            assert graph.call("/spawn", "turtlesim/Spawn", {"x": 2, "y": 2, "theta": 0, "name": "mimi"}) == {"name": "mimi"}
            assert graph.parameter("/turtlesim/background_r") == 69
            assert "/mimi/pose" in graph.topics()
            core = tool("roscore")[0]
            assert (
                core
                == f"""\
No master is needed: the ROS graph lives in the process of roslisp_repl.
It runs already, as process {repl.pid}, and serves at {graph.address}.

SUMMARY
========

PARAMETERS
 * /rosdistro: noetic
 * /rosversion: 1.15.15
 * /run_id: {graph.parameter("/run_id")[:17]}...
 * /turtlesim/background_b: 255
 * /turtlesim/background_g: 86
 * /turtlesim/background_r: 69

NODES
  /
    a
    rosout
    turtlesim

"""
            )
        finally:
            graph.close()
        repl.type("(+ 1 2)")
        repl.expect("3\n")
        assert repl.end() == 0


@pytest.mark.soak
def test_two_simulators_from_a_launch_file(private):
    with Terminal("ros", "roslaunch", "turtlesim", "multisim.launch") as terminal:
        terminal.expect(
            r"NODES\n  /turtlesim1/\n    sim \(turtlesim/turtlesim_node\)\n  /turtlesim2/\n    sim \(turtlesim/turtlesim_node\)\n"
        )
        terminal.expect(r"process\[turtlesim1/sim-1\]: started with pid \[\d+\]\n")
        terminal.expect(r"process\[turtlesim2/sim-2\]: started with pid \[\d+\]\n")
        terminal.expect("node name /turtlesim2/sim")
        assert nodes() == ["/rosout", "/turtlesim1/sim", "/turtlesim2/sim"]
        terminal.control_c()
        terminal.expect(
            r"\[turtlesim2/sim-2\] killing on exit\n\[turtlesim1/sim-1\] killing on exit\nshutting down processing monitor...\n"
            r"... shutting down processing monitor complete\ndone\n"
        )
        assert terminal.status() == 0


FOLLOW = """<launch>
  <include file="$(find turtle_tf)/launch/turtle_tf_demo.launch"/>
  <node pkg="rviz" type="rviz" name="window"/>
  <node pkg="tf" type="static_transform_publisher" name="short" args="0 0 map world"/>
</launch>
"""


@pytest.mark.soak
@pytest.mark.parametrize("elsewhere", [False, True])
def test_a_launch_file_with_keys_and_a_turtle_that_follows_and_programs_that_do_not_start(private, tmp_path, elsewhere):
    (tmp_path / "follow.launch").write_text(FOLLOW)
    with ExitStack() as closings:
        if elsewhere:
            repl = closings.enter_context(Terminal("repl", "--serve", "--no-turtlesim"))
            repl.expect("CL-USER> ")
            repl.type('(roslisp:start-ros-node "a")')
            repl.expect("startup complete")
        with Terminal("ros", "roslaunch", str(tmp_path / "follow.launch")) as terminal:
            before = termios.tcgetattr(terminal.master)
            terminal.expect(
                r"ERROR: cannot launch node of type \[rviz/rviz\]: cramhy has no executable "
                r"rviz/rviz. Packages with executables: .*turtlesim.\n"
            )
            terminal.expect(
                r"ERROR: cannot launch node of type \[tf/static_transform_publisher\]: static_transform_publisher takes 9 or 10 words"
            )
            terminal.expect("Use arrow keys to move the turtle. 'q' to quit.\n")
            while termios.tcgetattr(terminal.master)[3] & (termios.ICANON | termios.ECHO):
                pass
            graph = remote_graph.current()
            with graph.listen("/turtle2/pose", "turtlesim/Pose") as poses:
                while poses.take()[1]["x"] < 4.5:
                    pass
                os.write(terminal.master, b"\x1b[A")
                while poses.take()[1]["x"] < 5.8:  # the first turtle was at 5.54
                    pass
            graph.close()
            terminal.control_c()
            terminal.expect(r"\[sim-1\] killing on exit\n(.|\n)*done\n")
            assert terminal.status() == 0
            if terminal.master is not None:
                assert termios.tcgetattr(terminal.master) == before


@pytest.mark.soak(all_but=2)
@pytest.mark.parametrize(
    ("words", "output", "complaint", "status"),
    [
        (
            "rosrun",
            "Usage: rosrun PACKAGE EXECUTABLE [ARGS]\n"
            "  rosrun starts EXECUTABLE of PACKAGE with ARGS, such as __name:=x, __ns:=/y, a:=b and _parameter:=value.\n",
            "",
            0,
        ),
        ("rosrun turtlsim turtlesim_node", "", "[rospack] Error: package 'turtlsim' not found\nDid you mean turtlesim?\n", 2),
        ("rosrun nope nope", "", "[rospack] Error: package 'nope' not found\n", 2),
        ("rospack find nope", "", "[rospack] Error: package 'nope' not found\n", 1),
        ("rosversion -d", "noetic\n", "", 0),
        ("rosversion turtlesim", "0.10.2\n", "", 0),
        ("rosversion nope", "", "Cannot locate [nope]\n", 1),
        ("roscd nope", "", "roscd: No such package/stack 'nope'\n", 1),
        ("roscd a b", "", "usage: roscd package\n", 1),
        ("rosls turtlesim/launch", "multisim.launch\n", "", 0),
        ("rosls turtle_tf/launch", "turtle_tf_demo.launch\n", "", 0),
        ("rosls turtle_tf2/launch", "turtle_tf2_demo.launch\n", "", 0),
        ("rosrun turtle_tff x", "", "[rospack] Error: package 'turtle_tff' not found\nDid you mean turtle_tf?\n", 2),
        ("roslaunch nope.launch", "", "RLException: [nope.launch] is not a launch file name\n", 1),
        ("turtlesim", "", None, 2),
    ],
)
def test_commands_that_need_no_session(capsys, words, output, complaint, status):
    name, *arguments = words.split()
    assert shims.tool(name, arguments) == status
    said = capsys.readouterr()
    assert said.out == output and (complaint is None or said.err == complaint)
