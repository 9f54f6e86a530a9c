"""cramhy works on every Python of this machine: `portable`'s part of the tests, and the lectures, on each that is not the one of the tests.

``make interpreters`` runs this file and names the Pythons that were skipped. It takes two minutes and a half for each, so that it is no part
of ``make test``, whose time is limited.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
OLDEST, NEWEST = 11, 15
FOLDERS = ("~/.pyenv/versions/*/bin", "~/.local/share/uv/python/*/bin")
"""Where people have Pythons beside those on the path."""


def interpreters():
    """The newest Python of each minor release but the one that runs the tests: a dictionary from its minor number to its path."""
    found = {}
    for folder in FOLDERS:
        for place in sorted(Path("/").glob(os.path.expanduser(folder).lstrip("/")), key=release):
            for program in place.glob("python3.[0-9][0-9]"):
                found[int(program.suffix[1:])] = str(program)
    for minor in range(OLDEST, NEWEST + 1):
        if minor not in found and (program := shutil.which(f"python3.{minor}")):
            found[minor] = program
    return {minor: path for minor, path in sorted(found.items()) if minor >= OLDEST and minor != sys.version_info.minor}


def release(place):
    """The numbers in the name of a folder with a Python, such as ``3.12.1``."""
    return [int(number) for number in re.findall(r"\d+", place.parent.name)]


if not os.environ.get("CRAMHY_INTERPRETERS"):
    pytest.skip("make interpreters runs it", allow_module_level=True)
FOUND = interpreters()
if not FOUND:
    pytest.skip("there is no other Python on this machine", allow_module_level=True)


def run(*words):
    """Run a program without the variables of the tests' own Python; it has to end well."""
    kept = {name: text for name, text in os.environ.items() if not name.startswith(("PYTEST_", "VIRTUAL_ENV", "PYTHONPATH"))}
    done = subprocess.run([str(word) for word in words], cwd=ROOT, env=kept, stdin=subprocess.DEVNULL, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout[-8000:] + done.stderr[-2000:]
    return done.stdout


@pytest.fixture(scope="module", params=FOUND, ids=lambda minor: f"3.{minor}")
def python(request, tmp_path_factory):
    """The path of a Python with cramhy installed, editable, and what its tests need."""
    folder = tmp_path_factory.mktemp(f"python3.{request.param}") / "venv"
    if subprocess.run([FOUND[request.param], "-m", "venv", str(folder)], capture_output=True).returncode:
        pytest.skip(f"{FOUND[request.param]} makes no environment")
    python = folder / "bin" / "python"
    pip = [str(python), "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-compile"]
    needed = ["pytest>=8", "hypothesis>=6", "--editable", f"{ROOT}[repl,fast,web]"]
    fetched = subprocess.run([*pip, *needed], capture_output=True, text=True)
    if fetched.returncode:
        pytest.skip(f"what cramhy needs cannot be had for {FOUND[request.param]}: {fetched.stderr.strip().splitlines()[-1]}")
    return python


def test_the_portable_part_of_the_tests_passes(python):
    run(python, ROOT / "tests" / "portable.py")


def test_the_lectures_are_typed(python, tmp_path):
    printed = run(python, ROOT / "tutorials" / "lectures.py", "--png", tmp_path / "turtle.png")
    assert "debugger invoked" not in printed and printed.rstrip().endswith("\nT")
    assert (tmp_path / "turtle.png").read_bytes().startswith(b"\x89PNG")
