"""The programs that the benchmarks time give the same results in Lisp as in Python."""

import importlib
import re
import subprocess
import sys
from pathlib import Path

import pytest

from cramhy_runtime.repl.session import Session

BENCHMARKS = Path(__file__).parents[1] / "benchmarks"


def _programs():
    sys.path.insert(0, str(BENCHMARKS))
    try:
        return importlib.import_module("programs").programs()
    finally:
        sys.path.remove(str(BENCHMARKS))


@pytest.mark.soak(all_but=9)
@pytest.mark.parametrize("program", _programs(), ids=lambda program: program.function)
def test_a_program_gives_what_its_peer_gives(program):
    session = Session(time="virtual", turtlesim=False)
    session.evaluate_text(program.lisp)
    arguments = [min(argument, 60) for argument in program.arguments]
    text = " ".join(map(str, arguments))
    assert session.evaluate_text(f"({program.function} {text})")[0] == program.python(*arguments)


@pytest.mark.soak
def test_two_commits_are_compared_row_by_row():
    """A few rounds of one row; who is faster is not asked."""
    if subprocess.run(["git", "-C", str(BENCHMARKS), "rev-parse", "--verify", "HEAD"], capture_output=True).returncode:
        pytest.skip("no clone of git")
    command = [sys.executable, str(BENCHMARKS / "compare.py"), "HEAD", "--only", "calls with &optional", "--seconds", "0"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    assert re.search(r"^calls with &optional \(t\) +ms +[\d.]+ +[\d.]+ +[\d.]+ +\d+%", done.stdout, re.M)


@pytest.mark.soak
def test_a_row_that_falls_behind_is_marked():
    command = [sys.executable, str(BENCHMARKS / "table.py"), "--quick", "--only", "cut:pat-match"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    line = next(line for line in done.stdout.splitlines() if line.startswith("cut:pat-match of six pairs"))
    median, goal = float(line.split()[5]), float(line.split()[7])
    assert ("MISSED" in line) == (median > goal)
    assert ("Goals missed: cut:pat-match of six pairs." in done.stdout) == (median > goal)
