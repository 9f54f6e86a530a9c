"""The real ``hy`` of this installation: in a pseudo-terminal, with a text piped into it, and beside it ``roslisp_repl``."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from repl.terminal import Terminal

ROOT = Path(__file__).parents[2]
HY = Path(sys.executable).with_name("hy")
WIDE = (50, 400)
"""Lines and columns of a terminal in which no typed line is broken."""
REQUIRE = "(require cramhy *)"
PROMPT = r"(?:^|\n)(?:=> |[A-Z-]+> |\d+\] |\.\.\. |Enter a form to be evaluated: )$"


class Door(Terminal):
    """A program with a prompt, in a terminal. ``ask(text)`` types a text and gives the answer. ``continuation``: what comes after a line
    that leaves a form unfinished, a regular expression."""

    def __init__(self, *arguments, time="virtual", **options):
        history = str(ROOT / "nowhere" / "history")  # so that what tests type is not what the user finds with the arrow keys
        variables = {
            "CRAMHY_TIME": time,
            "ROS_PACKAGE_PATH": str(ROOT / "tutorials"),
            "HY_HISTORY": history,
            **options.pop("variables", {}),
        }
        self.continuation = r"\n\.\.\. $" if "program" in options else r"\n$"
        super().__init__(*arguments, size=WIDE, variables=variables, **options)

    def ask(self, text):
        """Type ``text``, line by line: what is printed from its last line to the next prompt, and this prompt."""
        *before, last = text.splitlines()
        for line in before:
            self.type(line)
            self.expect(self.continuation)
        self.type(last)
        self.expect("\n")
        return self.expect(PROMPT)

    def press(self, keys):
        """Press the keys of ``keys``, the last of which need not be Enter."""
        os.write(self.master, keys.encode())

    def begin_hy(self):
        """Wait for the first prompt and require the plan language."""
        self.expect("=> $")
        self.ask(REQUIRE)

    def begin_lisp(self, package=":cl-user"):
        """Go into Lisp; what ``in-package`` answers."""
        self.begin_hy()
        return self.ask(f"(in-package {package})")


@pytest.fixture
def hy_terminal():
    """A function that starts ``hy`` with arguments in a terminal; a context manager."""
    if not HY.exists():
        pytest.skip("hy is not installed beside Python")
    return lambda *arguments, **options: Door(*arguments, program=[str(HY)], **options)


@pytest.fixture
def roslisp_terminal():
    return lambda *arguments, **options: Door("repl", *arguments, **options)


def environment(**variables):
    kept = {name: value for name, value in os.environ.items() if name not in ("CRAMHY_TIME",)}
    path = f"{ROOT / 'src'}{os.pathsep}{ROOT / 'hy_src'}"
    return {**kept, "PYTHONPATH": path, "ROS_PACKAGE_PATH": str(ROOT / "tutorials"), **variables}


def run(words, text, folder, **variables):
    return subprocess.run(words, input=text, cwd=folder, env=environment(**variables), capture_output=True, text=True, timeout=120)


@pytest.fixture
def hy(tmp_path):
    """``hy("-c", "...", input="...")``: the finished process of ``hy`` with these words, in a folder of its own."""
    if not HY.exists():
        pytest.skip("hy is not installed beside Python")
    return lambda *words, input="", **variables: run([str(HY), *words], input, tmp_path, **variables)


@pytest.fixture
def roslisp(tmp_path):
    """``roslisp(text)``: the finished process of ``roslisp_repl`` with that text piped into it, in virtual time."""
    words = [sys.executable, "-m", "cramhy_runtime.cli", "repl", "--time", "virtual"]
    return lambda text: run(words, text, tmp_path)


def stable(text):
    """``text`` without the stamps of a log, the numbers of typed texts and of the fluents that were made, and addresses."""
    text = re.sub(r"<repl \d+>", "<repl>", text)
    text = re.sub(r"FN-FL<\d+>", "FN-FL<N>", text)
    text = re.sub(r"\b\d{10}\.\d{3}\b", "TIME", text)
    return re.sub(r"\{[0-9A-F]{10}\}", "{ADDR}", text)
