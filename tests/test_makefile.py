"""The targets of the Makefile install what they need: a little for the lectures and the page, the rest when tests are asked for."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
LIGHT, ROBOT, REST = "[repl,web,fast]", "[repl,web,fast,robot]", "[dev]"
SMALL = {"pyodide": [], "tutorial": [LIGHT], "view": [LIGHT], "kitchen": [LIGHT, ROBOT], "course": [LIGHT]}
TARGETS = re.search(r"^\.PHONY: (.*)$", (ROOT / "Makefile").read_text(), re.M)[1].split()


@pytest.fixture
def installed(tmp_path):
    """A function that says which extras the target would install in a clone where the stamps ``made`` are."""
    if not shutil.which("make"):
        pytest.skip("make is not installed")
    for name in ("Makefile", "pyproject.toml"):
        shutil.copy(ROOT / name, tmp_path)
    os.utime(tmp_path / "pyproject.toml", (1, 1))

    def installed(target, *made):
        (tmp_path / ".venv").mkdir(exist_ok=True)
        for age, name in enumerate(made):
            (tmp_path / ".venv" / name).touch()
            os.utime(tmp_path / ".venv" / name, (2 + age, 2 + age))
        shown = subprocess.run(["make", "--dry-run", target], cwd=tmp_path, capture_output=True, text=True, check=True).stdout
        return re.findall(r"--editable '\.(\[.*?\])'", shown)

    return installed


@pytest.mark.parametrize("target", [target for target in TARGETS if target != "clean"])
def test_the_lectures_and_the_page_need_little_and_the_rest_comes_with_the_tests(installed, target):
    wanted = SMALL.get(target, [LIGHT, REST])
    assert installed(target) == wanted
    assert installed(target, ".light") == wanted[1:]
    assert installed(target, ".light", ".robot", ".ready") == []


def test_what_an_earlier_version_made_is_made_again(installed):
    assert installed("test", ".ready") == [LIGHT, REST]
    assert installed("tutorial", ".ready") == [LIGHT]


def test_changed_requirements_are_installed(installed):
    assert installed("test", ".light", ".ready") == []
    assert installed("test", ".ready", ".light") == [REST]  # the small environment was made anew after the rest was added


def test_the_course_is_written_once_what_it_needs_is_fetched(tmp_path):
    if not shutil.which("make"):
        pytest.skip("make is not installed")
    shutil.copy(ROOT / "Makefile", tmp_path)
    (tmp_path / "pyproject.toml").touch()
    lines = subprocess.run(["make", "--dry-run", "course"], cwd=tmp_path, capture_output=True, text=True, check=True).stdout.splitlines()
    fetched, written = (next(number for number, line in enumerate(lines) if word in line) for word in ("npm ci", "cramhy browser --out"))
    assert fetched < written
    ignored = (ROOT / ".gitignore").read_text().split()
    assert lines[written].split()[-1] + "/" in ignored
