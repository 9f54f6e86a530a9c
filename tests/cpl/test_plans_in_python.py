"""The example and the page for plans in Python: what stands there runs, prints what it says, and is typed."""

from __future__ import annotations

import contextlib
import importlib.util
import io
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from cramhy_runtime import cpl, kernel

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "plans-in-python.md"
EXAMPLE = ROOT / "tutorials" / "plans_in_python.py"
STORY = """\
  0.0 s  drives to 4 m
  4.1 s  the motor is off at 2.0 m
  4.1 s  something is in the way at 2.0 m: gives way
  4.1 s  drives to 1.5 m
  5.1 s  the motor is off at 1.5 m
  7.0 s  - somebody takes the chair away
  7.1 s  drives to 4 m
 10.1 s  - somebody wants to pass: the robot is told to stand still
 10.1 s  the motor is off at 3.0 m
 14.1 s  - the corridor is free again
 16.1 s  the motor is off at 4.0 m
 21.1 s  the door is closed: rings the bell
 24.1 s  the door is open
 24.1 s  waits for the machine
 27.1 s  brings tea
"""


def printed(function, *arguments, **options):
    out = io.StringIO()
    with contextlib.redirect_stdout(out):
        function(*arguments, **options)
    return out.getvalue()


@pytest.mark.soak(all_but=4)
@pytest.mark.parametrize("backend", ["threads", "greenlet"])
@pytest.mark.parametrize("seed", [None, *range(8)])
def test_the_example_tells_the_same_story_each_time(backend, seed):
    spec = importlib.util.spec_from_file_location("plans_in_python", EXAMPLE)
    example = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(example)
    assert printed(cpl.run, example.main, clock="virtual", backend=backend, seed=seed) == STORY


def test_the_example_is_a_script():
    done = subprocess.run([sys.executable, str(EXAMPLE)], capture_output=True, text=True, env={**os.environ, "PYTHONWARNINGS": "error"})
    assert (done.stdout, done.stderr) == (STORY, "")


def examples():
    """Each block of Python on the page, with the block of what it prints, if there is one below it."""
    return re.findall(r"```python\n(.*?)```(?:\n\n```text\n(.*?)```)?", PAGE.read_text(), re.S)


def test_the_examples_of_the_page_run_and_print_what_stands_there():
    names = {"__name__": "page"}
    assert len(examples()) > 10
    with kernel.aside():
        for code, output in examples():
            assert printed(exec, code, names) == output, code
