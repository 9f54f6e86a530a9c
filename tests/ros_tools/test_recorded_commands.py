"""golden/ros-command-line.txt, line by line: what the tools print, with each difference named.

The recorded commands run in their order on one simulator, at the prompt of its process and from outside through the server, together
with the node that was there in the recording.
"""

from __future__ import annotations

import contextlib
import difflib
import io
import re
import shlex
from pathlib import Path

import pytest

from cramhy_runtime.cli import shims
from cramhy_runtime.ros_tools import running

RECORDED = Path(__file__).resolve().parents[3] / "shared" / "golden" / "ros-command-line.txt"
COMPANION = "/facts_29607_1795220347749"
"""The node of the recording, which published commands and heard poses and colours."""

MASKS = [
    (r"127\.0\.0\.1:\d+", "HOST:PORT", "ports are given by the system"),
    (r"\t?time=\d+\.\d+ms", " time=MS", "how long a reply takes"),
    (r"ping average: \d+\.\d+ms", "ping average: MS", "how long a reply takes"),
    (r"Pid: \d+", "Pid: N", "numbers of processes"),
    (r"average rate: 62\.\d+", "average rate: 62.N", "the recorded machine trembled"),
    (r"min: 0\.0\d\ds max: 0\.0\d\ds std dev: 0\.\d+s", "min: N max: N std dev: N", "the recorded machine trembled"),
    (r"^/\S+/definitions/turtlesim$", "FOLDER", "where cramhy is installed"),
    (r"^run_id: [0-9a-f-]{36}$", "run_id: UUID", "every run has its own"),
    (r"window: 6\d$", "window: 6N", "of the first second"),
]
"""What may be any number, and why."""

DIFFERENCES = {
    "rosnode info /turtlesim": (
        [
            "-    * direction: outbound (54387 - HOST:PORT) [12]",
            "+    * direction: outbound",
            "-    * transport: TCPROS",
            "+    * transport: INTRAPROCESS",
            "+ * topic: /turtle1/color_sensor",
            f"+    * to: {COMPANION}",
            "+    * direction: outbound",
            "+    * transport: INTRAPROCESS",
            "+ * topic: /turtle1/pose",
            f"+    * to: {COMPANION}",
            "+    * direction: outbound",
            "+    * transport: INTRAPROCESS",
            "+ * topic: /turtle1/cmd_vel",
            f"+    * to: {COMPANION}",
            "+    * direction: inbound",
            "+    * transport: INTRAPROCESS",
        ],
        "a connection is no socket and has no number; the recorded one had not been told of the companion's connections yet",
    ),
    "rostopic list -v": (
        [
            "+ * /rosout [rosgraph_msgs/Log] 1 publisher",
            "- * /rosout [rosgraph_msgs/Log] 2 publishers",
            "+ * /turtle1/color_sensor [turtlesim/Color] 1 publisher",
            "- * /turtle1/color_sensor [turtlesim/Color] 1 publisher",
            "+ * /turtle1/cmd_vel [geometry_msgs/Twist] 1 subscriber",
            "+ * /turtle1/color_sensor [turtlesim/Color] 1 subscriber",
            "- * /turtle1/color_sensor [turtlesim/Color] 1 subscriber",
            "- * /turtle1/cmd_vel [geometry_msgs/Twist] 1 subscriber",
        ],
        "topics are sorted by name, where the original keeps them in a dictionary; the companion of the test has no log",
    ),
    "rostopic find turtlesim/Pose": (
        ["-/t2/pose", "-/turtle2/pose", "-/turtle3/pose", "-/far/pose"],
        "the original's master keeps the types of topics that are gone; here they go with their last node",
    ),
    "rosmsg show nope/Nope": (
        ["+Unable to load msg [nope/Nope]: Cannot locate message [Nope]: unknown package [nope] on ROS_PACKAGE_PATH"],
        "the recorded tool failed without a word",
    ),
    "rosservice list": (
        [f"-{COMPANION}/get_loggers", f"-{COMPANION}/set_logger_level"],
        "the companion of the test is no node of roscpp, which has services for the levels of its log",
    ),
    "rosparam list": (["-/roslaunch/uris/host_127_0_0_1__46543"], "no server of roslaunch has run"),
    "rosparam get /": (
        ["-rosdistro: 'Debian", "+rosdistro: 'noetic", "-roslaunch:", "-  uris:", "-    host_127_0_0_1__46543: http://HOST:PORT/"],
        "the recorded ROS came with Debian; no server of roslaunch has run",
    ),
    "rospack find turtlesim": (["+FOLDER"], "the recorded machine had no such package, yet the exit status 0; here it is part of cramhy"),
}
"""The lines that differ, ``-`` recorded and ``+`` ours, and why."""


def recorded():
    """The recorded commands in their order: (line, text, exit status)."""
    if not RECORDED.exists():
        return []
    blocks = RECORDED.read_text().split("======== $ ")[1:]
    return [
        (block.partition("\n")[0], *re.fullmatch(r"(.*?)-------- exit (\d+)\s*", block.partition("\n")[2], re.S).groups())
        for block in blocks
    ]


def words_of(line):
    """The words as the shell passed them on: the recording does not show the quotes around lists and mappings."""
    head, brace, rest = line.partition(" {")
    head, bracket, lists = head.partition(" [")
    words = shlex.split(head)
    if bracket:
        words += re.findall(r"\[.*?\]", bracket + lists)
    return words + [brace.strip() + rest] if brace else words


def masked(text):
    for pattern, replacement, _ in MASKS:
        text = re.sub(pattern, replacement, text, flags=re.M)
    return [line.rstrip() for line in text.splitlines()]


def differences(text, status, ours, our_status):
    lines = difflib.ndiff([*masked(text), f"exit {status}"], [*masked(ours), f"exit {our_status}"])
    return [line[0] + line[2:] for line in lines if line[0] in "+-"]


def keep_company():
    from cramhy_runtime import kernel
    from cramhy_runtime.ros import graph
    from cramhy_runtime.ros.messages import message_class_exact

    node = graph.active().node(COMPANION)
    node.advertise("/turtle1/cmd_vel", message_class_exact("geometry_msgs/Twist"))
    node.subscribe("/turtle1/pose", message_class_exact("turtlesim/Pose"), lambda message: None)
    node.subscribe("/turtle1/color_sensor", message_class_exact("turtlesim/Color"), lambda message: None)
    kernel.sleep(0.1)


def shim(words):
    """(text, exit status) of a command that needs no graph."""
    output = io.StringIO()
    with contextlib.redirect_stdout(output), contextlib.redirect_stderr(output):
        status = shims.tool(words[0], words[1:])
    return output.getvalue(), status


def compare(shell, left_out=()):
    """Run every recorded command and compare what differs with the table."""
    table = recorded()
    if not table:
        pytest.skip("the recorded commands are not here")
    keep_company()
    found = {}
    for line, text, status in table:
        words = words_of(line)
        if set(words) & set(left_out):
            continue
        if words[0] in running.TOOLS:
            shell(words, patience=6.5 if "hz" in words else None)
            ours = shell.out + shell.errors, 124 if shell.status is None else shell.status
        else:
            ours = shim(words)
        seen = differences(text, status, *ours)
        if seen:
            found[line] = seen
    assert found == {line: seen for line, (seen, _) in DIFFERENCES.items()}


def test_every_recorded_command_at_the_prompt(shell):
    compare(shell)


def test_every_recorded_command_from_another_terminal(far_shell):
    compare(far_shell, left_out=["hz"])  # which has no end: see test_other_terminals
