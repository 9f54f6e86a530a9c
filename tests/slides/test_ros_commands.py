"""``rosservice call /clear`` and ``/reset`` as the slides type them: in another terminal, and at the prompt."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

from .conftest import ROOT, environment


@pytest.fixture
def private(tmp_path):
    """An environment whose runtime folder is this test's alone."""
    folder = tmp_path / "run"
    folder.mkdir(mode=0o700)
    return {**environment(), "XDG_RUNTIME_DIR": str(folder)}


def command(private, *words):
    return subprocess.run([sys.executable, "-m", "cramhy_runtime.cli", "ros", *words], env=private, capture_output=True, text=True)


class OpenRepl:
    """A roslisp_repl in wall time whose input stays open."""

    def __init__(self, private):
        self.process = subprocess.Popen(
            [sys.executable, "-m", "cramhy_runtime.cli", "repl", "--serve"],
            env=private,
            cwd=ROOT,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )

    def type(self, line, until):
        """Type ``line``; what is printed up to and including the line that contains ``until``."""
        self.process.stdin.write(line + "\n")
        self.process.stdin.flush()
        printed = ""
        while until not in printed:
            line = self.process.stdout.readline()
            assert line, f"the REPL ended before it printed {until!r}; it had printed {printed!r}"
            printed += line
        return printed

    def close(self):
        self.process.stdin.close()
        self.process.stdout.read()
        return self.process.wait(20)


def test_another_terminal_commands_the_turtle_of_the_repl(private):
    repl = OpenRepl(private)
    repl.type('(roslisp:start-ros-node "a")', "Node startup complete")
    assert command(private, "rosservice", "call", "/clear").stdout == "\n"
    assert command(private, "rosservice", "call", "/reset").returncode == 0
    spawned = command(private, "rosservice", "call", "/spawn", "2", "2", "0", "mimi")
    assert spawned.stdout.startswith("name: ")
    assert "/mimi/pose" in command(private, "rostopic", "list").stdout
    missing = command(private, "rosservice", "call", "/nope")
    assert (missing.returncode, missing.stderr) == (2, "ERROR: Service [/nope] is not available.\n")
    assert repl.close() == 0
    assert not os.listdir(os.path.join(private["XDG_RUNTIME_DIR"], f"cramhy-{os.getuid()}"))


def test_without_a_repl_the_command_says_what_to_start(private):
    answer = command(private, "rosservice", "call", "/clear")
    assert answer.returncode == 1
    assert answer.stderr == (
        "ERROR: Unable to communicate with master!\nNo session serves here. Start one with: roslisp_repl --serve "
        '(after eval "$(cramhy ros-shims)" plain roslisp_repl does it).\n'
    )


@pytest.mark.soak
def test_the_prompt_takes_ros_commands_too(workspace):
    commands = "rosservice call /clear", "rosservice type /spawn", "rosnode list"
    transcript = workspace.repl('(roslisp:start-ros-node "a")', *commands, "(+ 1 2)")
    assert transcript.answers[2] == "turtlesim/Spawn"
    assert "/turtlesim" in transcript.answers[3]
    assert transcript.answers[4] == "3"
