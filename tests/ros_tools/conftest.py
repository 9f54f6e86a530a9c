"""The tools on a simulator in virtual time: at the prompt of its process, or from outside through the server."""

from __future__ import annotations

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.session import boot
from cramhy_runtime.ros_tools import local_graph, running


class Shell:
    """``shell("rostopic list")``: runs a command, given as a line or a list of words, and keeps what it wrote and its status."""

    def __init__(self, reach, carry_out=lambda function: function()):
        self.reach, self.carry_out = reach, carry_out
        self.out = self.errors = ""
        self.status = None

    def __call__(self, words, patience=None):
        out, errors = [], []
        try:
            self.status = self.carry_out(
                lambda: running.run(
                    words.split() if isinstance(words, str) else words,
                    running.Terminal(out.append, errors.append, lambda: self.reach(patience)),
                )
            )
        except local_graph.OutOfTime:
            self.status = None
        self.out, self.errors = "".join(out), "".join(errors)
        return self.out

    @property
    def said(self):
        """What it wrote, complaints and status together."""
        return self.out, self.errors, self.status


@pytest.fixture
def simulator():
    """turtlesim in a kernel in virtual time."""
    kernel.start(clock="virtual")
    boot()
    from cramhy_runtime.turtlesim.node import start_turtlesim

    yield start_turtlesim()
    kernel.stop()


@pytest.fixture
def shell(simulator):
    """Runs commands at the prompt of the process."""
    return Shell(local_graph.HereGraph)


@pytest.fixture
def far_shell(tmp_path, monkeypatch):
    """Runs commands as another terminal does: they reach a session in wall time, with a simulator and a server, through the server."""
    pytest.importorskip("uvicorn")
    pytest.importorskip("websockets")
    folder = tmp_path / "run"
    folder.mkdir(mode=0o700)
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(folder))
    kernel.start(clock="wall")
    boot()
    from cramhy_runtime import rosbridge
    from cramhy_runtime.ros_tools import remote_graph
    from cramhy_runtime.ros_tools.hosting import Host
    from cramhy_runtime.turtlesim.node import start_turtlesim

    server = rosbridge.start()
    host = Host()
    made = Shell(lambda patience: remote_graph.current(), kernel.run_blocking)
    made.server, made.host, made.simulator = server, host, start_turtlesim()
    yield made
    kernel.stop()
