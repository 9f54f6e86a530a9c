"""On a desktop the page opens in a browser when the turtle appears, as the original's window does; nowhere else, and not when it is switched
off. The browser is a script that writes down what it is to show."""

from __future__ import annotations

import re
import subprocess
import sys
import time
from pathlib import Path

import pytest

from .terminal import PATIENCE, Terminal

pytest.importorskip("uvicorn")
pytest.importorskip("websockets")

UNATTENDED = ("CI", "PYTEST_CURRENT_TEST", "PYTEST_VERSION", "JPY_PARENT_PID", "CRAMHY_VIEW", "WAYLAND_DISPLAY")
ADDRESS = r"http://127\.0\.0\.1:\d+/#[\w-]+"
SIMULATOR = "ros", "rosrun", "turtlesim", "turtlesim_node"
NODE = '(roslisp:start-ros-node "a")'


class Desktop:
    """Variables of the environment of somebody who sits at a desktop, and what the browser was asked to show."""

    def __init__(self, folder):
        self.log = folder / "shown"
        self.log.touch()
        browser = folder / "browser"
        browser.write_text(f'#!/bin/sh\ncat "${{1#file://}}" >> {self.log}\n')
        browser.chmod(0o755)
        self.variables = {**dict.fromkeys(UNATTENDED), "DISPLAY": ":99", "BROWSER": f"{browser} %s"}

    def shown(self, address, times=1):
        """Wait until the browser was led to ``address`` so often."""
        until = time.monotonic() + PATIENCE
        while self.log.read_text().count(f"url={address}") < times:
            assert time.monotonic() < until, f"{address} was never opened: {self.log.read_text()}"
            time.sleep(0.01)
        assert self.log.read_text().count("url=") == self.log.read_text().count(f"url={address}") == times


@pytest.fixture
def desktop(tmp_path, private):
    return Desktop(tmp_path)


def address_in(text):
    return re.search(ADDRESS, text)[0]


@pytest.mark.soak
@pytest.mark.parametrize("words", [(), ("--serve",), ("--time", "virtual")])
def test_the_page_opens_when_the_turtle_appears_at_the_prompt(desktop, words):
    with Terminal("repl", *words, variables=desktop.variables) as repl:
        repl.expect("CL-USER> ")
        repl.type(NODE)
        address = address_in(repl.expect(f"; The page: {ADDRESS}\n"))
        repl.expect("startup complete")
        repl.expect("CL-USER> ")
        desktop.shown(address)
        repl.type('(roslisp:start-ros-node "b")')
        repl.expect("startup complete")
        if "virtual" in words:  # a page that nobody has asked for leaves time as it is
            repl.type("(progn (cpl:sleep 30000) (list 'slept))")
            repl.expect(r"\(SLEPT\)")
        repl.type("(list 1 (turtlesim:view))")  # whoever asks gets it once more
        repl.expect(f'\\(1 "{address}"\\)')
        desktop.shown(address, times=2)
        assert repl.end() == 0
        assert repl.text.count("; The page: ") == 1


OFF = {
    "by the option": (("--no-view",), {}),
    "by the variable": ((), {"CRAMHY_VIEW": "no"}),
    "in CI": ((), {"CI": "true"}),
    "in a test": ((), {"PYTEST_VERSION": "9"}),
    "over SSH": ((), {"DISPLAY": None}),
}


@pytest.mark.soak
@pytest.mark.parametrize("way", OFF)
def test_no_page_opens_by_itself(desktop, way):
    words, variables = OFF[way]
    with Terminal("repl", *words, variables={**desktop.variables, **variables}) as repl:
        repl.expect("CL-USER> ")
        repl.type(NODE)
        repl.expect("startup complete")
        repl.expect("CL-USER> ")
        repl.type("(+ 1 2)")
        repl.expect("3\n")
        assert repl.end() == 0
        assert "http://" not in repl.text and "turtlesim:view" not in repl.text  # the prompt answers as the slides show
    assert desktop.log.read_text() == ""


def test_where_lines_come_from_a_pipe_nothing_opens_and_nothing_is_said(desktop):
    import os

    environment = {**os.environ, **desktop.variables}
    done = subprocess.run(
        [sys.executable, "-m", "cramhy_runtime.cli", "repl"],
        input=f"{NODE}\n",
        capture_output=True,
        text=True,
        env={name: value for name, value in environment.items() if value is not None},
        timeout=120,
    )
    assert (done.returncode, done.stderr) == (0, "") and "startup complete" in done.stdout
    assert desktop.log.read_text() == ""


@pytest.mark.soak
def test_without_the_extra_the_line_leads_to_what_must_be_installed(desktop, private):
    program = (
        "import sys; sys.modules['uvicorn'] = sys.modules['prompt_toolkit'] = None; from cramhy_runtime.cli import main; main(['repl'])"
    )
    with Terminal(program=[sys.executable, "-c", program], variables=desktop.variables) as repl:
        repl.expect("CL-USER> ")
        repl.type(NODE)
        repl.expect("startup complete")
        repl.type("(turtlesim:view)")
        repl.expect("The page needs uvicorn, websockets, and uvicorn is not installed. Type: ")


@pytest.mark.soak
def test_the_page_of_an_option_opens_once(desktop):
    with Terminal("repl", "--view", variables=desktop.variables) as repl:
        address = address_in(repl.expect(f"; The page: {ADDRESS}\n"))
        desktop.shown(address)
        repl.expect("CL-USER> ")
        repl.type(NODE)
        repl.expect("startup complete")
        repl.type("(+ 1 2)")
        repl.expect("3\n")
        assert repl.end() == 0 and repl.text.count("The page: ") == 1
    desktop.shown(address)


@pytest.mark.soak
def test_rosrun_opens_it_and_a_second_one_gives_the_address_only(desktop):
    with Terminal(*SIMULATOR, variables=desktop.variables) as first:
        first.expect(r"Spawning turtle \[turtle1\]")
        address = address_in(first.expect(f"; The page: {ADDRESS}\n"))
        desktop.shown(address)
        with Terminal(*SIMULATOR, variables=desktop.variables) as second:
            second.expect(f"; /turtlesim runs in the session of process {first.pid} already. This is its log; Ctrl-C leaves it alone.\n")
            assert address_in(second.expect(f"; The page: {ADDRESS}\n")) == address
            second.control_c()
            assert second.status() == 0
        with Terminal("view", variables=desktop.variables) as asked:
            asked.expect(f"The page: {re.escape(address)}\n")
            assert asked.status() == 0
        desktop.shown(address, times=2)  # by the first one, and by the one that asks for it
        first.control_c()
        assert first.status() == 0


@pytest.mark.soak
@pytest.mark.parametrize("turtle_first", [True, False])
def test_rosrun_looks_on_at_the_turtle_of_the_prompt_whatever_comes_first(desktop, tool, turtle_first):
    """The session's own simulator waits for the first node of the prompt; a second terminal that wants it has it start, and does not own it."""
    with Terminal("repl", "--serve", variables=desktop.variables) as repl:
        repl.expect("CL-USER> ")
        if turtle_first:
            repl.type(NODE)
            address = address_in(repl.expect(f"; The page: {ADDRESS}\n"))
            repl.expect("startup complete")
        with Terminal(*SIMULATOR, variables=desktop.variables) as other:
            other.expect(f"; /turtlesim runs in the session of process {repl.pid} already. This is its log; Ctrl-C leaves it alone.\n")
            seen = address_in(other.expect(f"; The page: {ADDRESS}\n"))
            if not turtle_first:
                repl.type(NODE)
                repl.expect("startup complete")
                address = seen
                assert "The page: " not in repl.text  # it would stand in the line that is being typed
            assert seen == address
            desktop.shown(address)
            with Terminal("ros", "rostopic", "echo", "/turtle1/pose", variables=desktop.variables) as echo:
                echo.expect("x: 5.54")
                echo.control_c()
                assert echo.status() == 0
            other.control_c()
            assert other.status() == 0
        assert tool("rosnode list")[0] == "/a\n/rosout\n/turtlesim\n"
        repl.type('(turtlesim:press :up) (roslisp:wait-duration 0.2) (list "driven")')
        repl.expect(r'\("driven"\)')
        pose = tool("rostopic echo -n 1 /turtle1/pose")[0]
        assert float(re.search(r"x: (\S+)", pose)[1]) > 5.55
        assert repl.end() == 0


@pytest.mark.soak
def test_a_browser_of_a_file_in_the_current_folder_is_not_run(desktop, tmp_path, monkeypatch):
    (tmp_path / "here").mkdir()
    (tmp_path / "here" / "webbrowser.py").write_text(f"open({str(tmp_path / 'wrong')!r}, 'w')")
    monkeypatch.chdir(tmp_path / "here")
    with Terminal("repl", "--view", variables=desktop.variables) as repl:
        desktop.shown(address_in(repl.expect(f"; The page: {ADDRESS}\n")))
        assert repl.end() == 0
    assert not Path(tmp_path / "wrong").exists()
