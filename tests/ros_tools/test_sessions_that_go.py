"""Tools in terminals of their own, when their session goes and another comes: those that follow join the next one, others say what happened
and end with a status. Sessions and tools are processes of their own; sessions end in order, are killed, or are cut off."""

from __future__ import annotations

import os
import pty
import queue
import signal
import subprocess
import sys
import threading
from pathlib import Path

import pytest

from cramhy_runtime import kernel

sys.path.append(str(Path(__file__).parents[1] / "rosbridge"))
from bridge_clients import Wire  # noqa: E402
from processes_of_sessions import SessionProcess, wait_until  # noqa: E402

pytestmark = pytest.mark.soak

PATIENCE = 60


class Tool:
    """A command in a process of its own, whose lines are read as they come."""

    def __init__(self, folder, *words, stdin=subprocess.DEVNULL, program=("-m", "cramhy_runtime.cli")):
        self.process = subprocess.Popen(
            [sys.executable, *program, *words],
            stdin=stdin,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            env={**os.environ, "XDG_RUNTIME_DIR": str(folder)},
        )
        self.out, self.errors = queue.Queue(), queue.Queue()
        for stream, lines in ((self.process.stdout, self.out), (self.process.stderr, self.errors)):
            threading.Thread(target=self._read, args=(stream, lines), daemon=True).start()

    @staticmethod
    def _read(stream, lines):
        for line in stream:
            lines.put(line)
        lines.put("")

    def says(self, text, lines=None):
        """The next line with this text in it."""
        read = []
        while True:
            line = (lines or self.out).get(timeout=PATIENCE)
            read.append(line)
            if text in line:
                return line
            assert line, f"It has ended without {text!r}: {''.join(read)}"

    def complains(self, text):
        return self.says(text, self.errors)

    def end(self, number=signal.SIGINT):
        """Its exit status after a signal."""
        self.process.send_signal(number)
        return self.process.wait(PATIENCE)

    def close(self):
        self.process.kill()
        self.process.wait()


@pytest.fixture
def start(tmp_path):
    pytest.importorskip("uvicorn")
    made = []

    def begin(**keywords):
        made.append(SessionProcess(tmp_path, **keywords))
        return made[-1]

    yield begin
    for one in made:
        one.end()


@pytest.fixture
def tool(tmp_path):
    made = []

    def begin(*words, **keywords):
        made.append(Tool(tmp_path, *words, **keywords))
        return made[-1]

    yield begin
    for one in made:
        one.close()


ENDS = {"in order": lambda session: session.end(), "killed": lambda session: session.signal(signal.SIGKILL)}


@pytest.mark.parametrize("ends", ENDS)
def test_echo_goes_on_with_the_next_session(start, tool, ends):
    session = start()
    echo = tool("ros", "rostopic", "echo", "/turtle1/pose")
    echo.says("x: 5.54")
    ENDS[ends](session)
    line = echo.complains("; ")
    assert line == "; The session has ended. Waiting for a session to join; Ctrl-C ends.\n"
    following = start()
    assert echo.complains("; ") == f"; Joined the session of process {following.pid}.\n"
    while not echo.out.empty():
        echo.out.get()
    echo.says("x: 5.54")
    assert echo.end() == 0


def test_hz_begins_to_count_anew_with_the_next_session(start, tool):
    session = start()
    rate = tool("ros", "rostopic", "hz", "/turtle1/pose")
    rate.says("average rate: ")
    session.signal(signal.SIGKILL)
    rate.complains("; The session has ended.")
    start()
    rate.says("subscribed to [/turtle1/pose]")
    rate.says("average rate: ")
    gap = float(rate.says("max: ").partition("max: ")[2].partition("s")[0])
    assert gap < 1.0  # the time between the sessions is not counted
    assert rate.end() == 0


def test_a_session_whose_connection_breaks_is_joined_again(far_shell):
    server = far_shell.server

    def cut():
        for connection in list(server.connections):
            connection._protocol.abandon()

    kernel.call_at(kernel.now() + 1.0, lambda: server.company.call(cut))
    out = far_shell("rostopic echo -n 100 /turtle1/pose")
    assert out.count("---") == 100 and far_shell.status == 0
    assert far_shell.errors == (
        f"; The session has ended. Waiting for a session to join; Ctrl-C ends.\n; Joined the session of process {os.getpid()}.\n"
    )


def test_echo_that_waits_for_a_topic_waits_for_a_session_too(start, tool):
    session = start()
    echo = tool("ros", "rostopic", "echo", "-n", "1", "/nothing/yet")
    echo.complains("WARNING: topic [/nothing/yet] does not appear to be published yet")
    session.end()
    echo.complains("; The session has ended.")
    following = start()
    echo.complains("; Joined the session")
    with Wire(following.address) as wire:
        wire.send(op="advertise", topic="/nothing/yet", type="std_msgs/String")

        def ended():
            wire.send(op="publish", topic="/nothing/yet", msg={"data": "hello"})
            return echo.process.poll() is not None

        wait_until(ended, "echo has heard one message")
    assert echo.says("hello") == 'data: "hello"\n' and echo.process.returncode == 0


def test_publishing_ends_with_the_session_and_says_so(start, tool):
    session = start()
    pub = tool("ros", "rostopic", "pub", "-r", "10", "/turtle1/cmd_vel", "geometry_msgs/Twist", "[1.0, 0, 0]", "[0, 0, 0]")
    echo = tool("ros", "rostopic", "echo", "-n", "1", "/turtle1/cmd_vel")
    echo.says("linear")
    session.signal(signal.SIGKILL)
    pub.complains("ERROR: The session has ended.")
    assert pub.process.wait(PATIENCE) == 1


def test_a_call_that_waits_ends_with_the_session_and_says_so(start, tool):
    session = start()
    session.signal(signal.SIGSTOP)
    call = tool("ros", "rosservice", "call", "/clear")
    wait_until(lambda: call.process.poll() is not None, "it is given up")
    call.complains("ERROR: Unable to communicate with master!")
    assert "does not let us in: " in call.complains("The session at ")
    assert call.process.returncode == 1


@pytest.mark.parametrize("ends", ENDS)
def test_teleop_ends_with_the_session_and_leaves_the_terminal_as_it_was(start, tool, ends):
    import termios

    session = start()
    master, terminal = pty.openpty()
    before = termios.tcgetattr(terminal)
    teleop = tool("teleop", stdin=terminal)
    teleop.says("Use arrow keys")
    wait_until(lambda: termios.tcgetattr(terminal) != before, "it takes the keys one by one")
    os.write(master, b"\x1b[A")
    ENDS[ends](session)
    teleop.complains("ERROR: The session has ended.")
    assert teleop.process.wait(PATIENCE) == 1
    assert termios.tcgetattr(terminal) == before
    os.close(master)
    os.close(terminal)


@pytest.mark.parametrize("ends", ENDS)
def test_a_program_comes_back_here_and_goes_over_to_the_next_session(start, tool, ends):
    session = start()
    square = tool("ros", "rosrun", "turtlesim", "draw_square")
    square.says("New goal")
    ENDS[ends](session)
    square.complains("; The session has ended: the program runs here again.")
    start()
    square.complains("; A session has started: the program runs there now.")
    square.says("New goal")
    assert square.end() == 0


BLIND_AT_FIRST = """
import sys
from cramhy_runtime.cli import main
from cramhy_runtime.ros_tools import remote_graph
from cramhy_runtime.ros_tools.graph_access import NoSession

looks, current = iter([NoSession]), remote_graph.current


def look():
    for nothing in looks:
        raise nothing
    return current()


remote_graph.current = look
sys.exit(main(sys.argv[1:]))
"""


def test_a_program_joins_a_session_that_began_while_it_began_here(start, tool):
    start()
    square = tool("ros", "rosrun", "turtlesim", "draw_square", program=("-c", BLIND_AT_FIRST))
    square.complains("; A session has started: the program runs there now.")


def test_a_log_that_was_looked_at_is_looked_at_again(start, tool):
    session = start()
    simulator = tool("ros", "rosrun", "turtlesim", "turtlesim_node")
    simulator.complains(f"; /turtlesim runs in the session of process {session.pid} already.")
    session.signal(signal.SIGKILL)
    simulator.complains("; The session has ended: the turtle lives here again.")
    following = start()
    simulator.complains("; A session has started: the turtle lives there now.")
    simulator.complains(f"; /turtlesim runs in the session of process {following.pid} already.")
    assert simulator.end() == 0
