"""The examples of docs/ros-bridge.md run as they stand there, and print what the page says."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from cramhy_runtime import kernel

PAGE = (Path(__file__).parents[2] / "docs" / "ros-bridge.md").read_text()


def example(word, language="python"):
    """The example with WORD in it, and what the page says that it prints."""
    return next(
        (code, shown)
        for code, shown in re.findall(rf"```{language}\n(.*?)```(?:\n\nprints.*?\n\n```\n(.*?)```)?", PAGE, re.S)
        if word in code
    )


@pytest.fixture
def robot(tmp_path):
    """The address of a session that was started as the page says, in a process of its own."""
    code, _ = example("rosbridge.start()")
    code = code.replace("print(server.address)", "print(server.address, flush=True)") + "import sys\nkernel.run_blocking(sys.stdin.read)\n"
    process = subprocess.Popen(
        [sys.executable, "-c", code],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
        env={**os.environ, "XDG_RUNTIME_DIR": str(tmp_path)},
    )
    yield process.stdout.readline().strip()
    process.communicate("", timeout=60)


@pytest.mark.soak
def test_the_example_of_roslibpy(robot):
    pytest.importorskip("roslibpy")
    code, shown = example("import roslibpy")
    code = code.replace("ws://127.0.0.1:PORT/TOKEN", robot)
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60)
    assert (done.returncode, done.stdout) == (0, shown), done.stderr


def test_the_example_of_roslib(robot, roslib_folder):
    code, shown = example("Ros({", "js")
    (roslib_folder / "page.js").write_text(code.replace("ws://127.0.0.1:PORT/TOKEN", robot))
    done = subprocess.run(["node", "page.js"], cwd=roslib_folder, capture_output=True, text=True, timeout=60)
    assert (done.returncode, done.stdout) == (0, shown), done.stderr


@pytest.mark.soak
@pytest.mark.parametrize("options", [["--serve"], ["--serve", "--time", "virtual", "--origin", "https://app.foxglove.dev"]])
def test_the_repl_tells_its_address(tmp_path, options):
    process = subprocess.Popen(
        [sys.executable, "-m", "cramhy_runtime.cli", "repl", *options],
        stdin=subprocess.PIPE,
        text=True,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        env={**os.environ, "XDG_RUNTIME_DIR": str(tmp_path)},
    )
    try:
        told = process.stderr.readline()
        address = re.fullmatch(r"; Clients of rosbridge: (ws://127\.0\.0\.1:\d+/[\w-]{32})\n", told).group(1)
        from bridge_clients import Wire

        def client():
            with Wire(address) as wire:
                assert wire.call("/rosapi/nodes")["result"]
            if "--origin" in options:
                with Wire(address, origin="https://app.foxglove.dev") as wire:
                    assert wire.call("/rosapi/nodes")["result"]

        kernel.run_blocking(client)
    finally:
        process.communicate("", timeout=60)
    assert process.returncode == 0


@pytest.mark.soak
def test_what_cannot_be_joined_is_told():
    done = subprocess.run(
        [sys.executable, "-m", "cramhy_runtime.cli", "repl", "--time", "virtual", "--ros", "ws://robot:9090"],
        input="",
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert done.returncode == 2
    assert (
        "A session in virtual time cannot join ws://robot:9090: the robot there lives in wall time. Start it with --time wall."
        in done.stderr
    )
