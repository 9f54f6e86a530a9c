"""A graph with the turtle, clients of rosbridge without sockets, and servers with real ones."""

from __future__ import annotations

import os
import shutil
import subprocess
import tempfile
import threading
from pathlib import Path

import pytest

from bridge_clients import Talk
from cramhy_runtime import kernel
from cramhy_runtime.session import boot


JAVASCRIPT = Path(__file__).parent / "js"


@pytest.fixture(autouse=True)
def no_session_of_the_user(tmp_path, monkeypatch):
    """Servers of tests announce themselves in a folder of their own."""
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path))


@pytest.fixture
def graph():
    """The graph of a fresh kernel in virtual time, with the simulator."""
    kernel.start(clock="virtual")
    boot()
    from cramhy_runtime.ros import graph
    from cramhy_runtime.turtlesim.node import start_turtlesim

    start_turtlesim()
    yield graph.active()
    kernel.stop()


@pytest.fixture
def hub(graph):
    from cramhy_runtime.rosbridge.hub import Hub

    return Hub(graph)


@pytest.fixture
def talk(hub):
    """A client."""
    return Talk(hub)


@pytest.fixture
def other(hub):
    """Another client."""
    return Talk(hub)


@pytest.fixture
def serve():
    """A function that starts a kernel with the simulator and a server; all of it ends with the test."""

    def start(time="virtual", backend="threads", turtlesim=True, pages=None, origins=(), **limits):
        from cramhy_runtime import rosbridge
        from cramhy_runtime.rosbridge.guard import Limits
        from cramhy_runtime.turtlesim.node import start_turtlesim

        kernel.start(clock=time, backend=backend)
        boot()
        if turtlesim:
            start_turtlesim()
        return rosbridge.start(pages=pages, origins=origins, limits=Limits(**limits))

    yield start
    kernel.stop()


@pytest.fixture
def outside():
    """Runs a function outside of the kernel, as another program would run, while the prompt waits."""
    return kernel.run_blocking


@pytest.fixture
def beside():
    """Runs a function in a thread of its own, as another program would run while the plan goes on; gives a function that waits for its end
    and raises what ended it."""

    def start(function, *arguments):
        outcome = []

        def run():
            try:
                function(*arguments)
                outcome.append(None)
            except BaseException as problem:
                outcome.append(problem)

        thread = threading.Thread(target=run, daemon=True)
        thread.start()

        def finish(seconds=60):
            kernel.run_blocking(thread.join, seconds)
            assert outcome, "the other program does not end"
            if outcome[0] is not None:
                raise outcome[0]

        return finish

    return start


@pytest.fixture(scope="session")
def roslib_folder():
    """A folder with roslib installed, kept between runs; skipped where Node or the registry are not to be had."""
    node, npm = shutil.which("node"), shutil.which("npm")
    if node is None or npm is None:
        pytest.skip("Node and npm are not installed here")
    if int(subprocess.run([node, "--version"], capture_output=True, text=True).stdout.lstrip("v").partition(".")[0]) < 20:
        pytest.skip("roslib needs Node 20")
    folder = Path(os.environ.get("CRAMHY_NODE_CACHE") or Path(tempfile.gettempdir()) / f"cramhy-node-{os.getuid()}")
    folder.mkdir(mode=0o700, parents=True, exist_ok=True)
    for name in ("package.json", "package-lock.json", "drive.js"):
        shutil.copy(JAVASCRIPT / name, folder / name)
    if not (folder / "node_modules" / "roslib").is_dir():
        done = subprocess.run([npm, "ci", "--no-audit", "--no-fund"], cwd=folder, capture_output=True, text=True, timeout=300)
        if done.returncode:
            pytest.skip(f"npm cannot install roslib here: {done.stderr[-300:]}")
    return folder
