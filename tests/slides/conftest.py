"""The student's machine: a workspace made by the slides' commands, the slides' files in it, and a REPL to type into."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
TUTORIAL = ROOT / "tutorials" / "cram_my_beginner_tutorial" / "src"
NAME = "cram_my_beginner_tutorial"


class Workspace:
    """``~/workspace/ros`` of a student."""

    def __init__(self, folder, slides):
        self.folder, self.slides = folder, slides
        (folder / "src").mkdir(parents=True)

    @property
    def package(self):
        return self.folder / "src" / NAME

    def shell(self, *words, where="."):
        """Run a ROS command as the shims do; its output."""
        done = subprocess.run(
            [sys.executable, "-m", "cramhy_runtime.cli", "ros", *words],
            cwd=self.folder / where,
            text=True,
            capture_output=True,
            env=environment(),
            timeout=120,
        )
        assert done.returncode == 0, done.stderr
        return done.stdout

    def copy(self, slide, target=None):
        """Put a file of the slides into the package, byte for byte."""
        source = self.slides / slide
        path = self.package / (target or source.name)
        path.write_bytes(source.read_bytes())

    def write(self, target, text):
        (self.package / target).write_text(text)

    def repl(self, *lines, backend="threads", seed=None, package=None):
        """Type lines into a fresh roslisp_repl; its transcript, a list of (prompt, answer) pairs after the first prompt."""
        options = ["--time", "virtual", "--backend", backend, *(["--seed", str(seed)] if seed is not None else [])]
        done = subprocess.run(
            [sys.executable, "-m", "cramhy_runtime.cli", "repl", *options],
            cwd=self.folder,
            text=True,
            input="\n".join(lines) + "\n",
            capture_output=True,
            env=environment(),
            timeout=120,
        )
        assert done.returncode == 0, done.stdout + done.stderr
        assert done.stderr == ""
        return Transcript(done.stdout)


class Transcript:
    """What the REPL printed. ``answers`` are the texts between prompts, with stamps and addresses made equal."""

    PROMPT = re.compile(r"(?:^|(?<=\] ))([A-Z-]+> |\d+\] )", re.M)

    def __init__(self, text):
        self.text = text
        parts = self.PROMPT.split(text)
        self.prompts = [prompt.rstrip() for prompt in parts[1::2]]
        self.answers = [stable(answer.rstrip("\n")) for answer in parts[2::2]]


def stable(text):
    text = re.sub(r"\b\d{10}\.\d{3}\b", "TIME", text)
    return re.sub(r"\{[0-9A-F]{10}\}", "{ADDR}", text)


def environment():
    keep = {key: value for key, value in os.environ.items() if key not in ("ROS_PACKAGE_PATH", "PYTHONDONTWRITEBYTECODE")}
    return {**keep, "PYTHONPATH": f"{ROOT / 'src'}{os.pathsep}{ROOT / 'hy_src'}"}


@pytest.fixture
def workspace(tmp_path, shared):
    return Workspace(tmp_path / "workspace" / "ros", shared / "slides")


@pytest.fixture
def between_lectures():
    """What the lectures between 34 and 38 add to the package: simple plans and the structures of the motions."""
    plans = (TUTORIAL / "simple-plans.hy").read_text().replace("(require cramhy *)\n", "")
    motions = (TUTORIAL / "motion-designators.hy").read_text().replace("(require cramhy *)\n", "")
    start = motions.index("(def-fact-group turtle-motion-designators")
    end = motions.index("(defstruct pen-motion")
    return {"simple-plans.lisp": plans, "motions before the slide": motions[:start], "motions after the slide": motions[end:]}
