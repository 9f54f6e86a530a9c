"""A REPL to type into: the console with scripted lines, in virtual time, in this process or as a program of its own."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


class Script:
    """Input for a console: the lines of a text."""

    interactive = False

    def __init__(self, text):
        self.lines = text.splitlines()

    def line(self, prompt, interrupted=None):
        from cramhy_runtime.languages.commonlisp.streams import streams

        if not self.lines:
            return None
        line = self.lines.pop(0)
        streams.CONSOLE_OUTPUT.fresh_line()
        streams.CONSOLE_OUTPUT.write(f"{prompt}{line}\n")
        return line


@pytest.fixture
def type_in(capsys):
    """``type_in(lines)``: what the console shows, the typed lines included. It begins in CRAM-USER, without the turtle."""
    from cramhy_runtime.languages.commonlisp.streams import streams
    from cramhy_runtime.repl.console import Console
    from cramhy_runtime.repl.session import Session

    def type_in(text, **options):
        def session():
            made = Session(time="virtual", **{"turtlesim": False, **options})
            made.package = "CRAM-USER"
            return made

        errors = streams.ERROR_OUTPUT.value
        streams.CONSOLE_OUTPUT.column = 0  # another file's tests may have left it within a line
        try:
            type_in.status = Console(session, Script(text)).run()
        finally:
            streams.ERROR_OUTPUT.value = errors
        return capsys.readouterr().out

    return type_in


@pytest.fixture
def cramhy(tmp_path):
    """``cramhy("run", "x.lisp")``: the finished process of that command in a folder of its own."""

    def cramhy(*arguments, input="", text=True):
        done = subprocess.run(
            [sys.executable, "-m", "cramhy_runtime.cli", *arguments],
            cwd=tmp_path,
            input=input,
            text=text,
            capture_output=True,
            env=environment(),
            timeout=120,
        )
        return done

    return cramhy


def environment():
    kept = {key: value for key, value in os.environ.items() if key != "ROS_PACKAGE_PATH"}
    return {**kept, "PYTHONPATH": f"{ROOT / 'src'}{os.pathsep}{ROOT / 'hy_src'}"}


@pytest.fixture
def private(tmp_path, monkeypatch):
    """A runtime folder of this test's alone, for it and the programs that it starts."""
    folder = tmp_path / "run"
    folder.mkdir(mode=0o700)
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(folder))
    return folder


@pytest.fixture
def tool(tmp_path, private):
    """``tool("rosservice call /clear")``: (output, complaints, status) of a ROS command."""

    def tool(*words):
        words = words[0].split() if len(words) == 1 else words
        done = subprocess.run(
            [sys.executable, "-m", "cramhy_runtime.cli", "ros", *words],
            cwd=tmp_path,
            text=True,
            capture_output=True,
            env={**environment(), "XDG_RUNTIME_DIR": os.environ["XDG_RUNTIME_DIR"]},
            timeout=60,
            stdin=subprocess.DEVNULL,
        )
        return done.stdout, done.stderr, done.returncode

    return tool
