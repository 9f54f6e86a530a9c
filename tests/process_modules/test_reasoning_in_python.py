"""The example and the page for reasoning and acting in Python: what stands there runs, prints what it says, and is typed.

Rules, generators and modules that they define are for the whole process, so each runs in a process of its own.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

import cramhy_runtime

ROOT = Path(__file__).parents[2]
SOURCE = ROOT / "src" / "cramhy_runtime"
PAGE = ROOT / "docs" / "reasoning-in-python.md"
EXAMPLE = ROOT / "tutorials" / "reasoning_in_python.py"
STORY = """\
  0.0 s  drives 3.4 m to (3.4, 0)
  7.8 s  the gripper slips
  9.3 s  holds the plate
  9.3 s  drives 2.8 m to (0.6, 0)
 14.9 s  puts the plate on the table
 14.9 s  drives 2.8 m to (3.4, 0)
 20.5 s  sees no cup at the shelf
 20.5 s  drives 4.8 m to (1.6, 3)
 31.1 s  holds the cup
 31.1 s  drives 4.0 m to (0.6, 0)
 39.1 s  puts the cup on the table
 39.1 s  the table is laid with cup and plate
 39.1 s  the spoon is still in the drawer
"""
RUNS = f"""
import runpy
from cramhy_runtime import cpl
for backend in ("threads", "greenlet"):
    for seed in (None, *range(6)):
        example = runpy.run_path({str(EXAMPLE)!r}, run_name="example")
        cpl.run(example["main"], clock="virtual", backend=backend, seed=seed)
"""


@pytest.fixture(autouse=True)
def fresh_kernel():
    """None is needed here."""


def python(*arguments, **options):
    """What another Python prints, and what it says on standard error."""
    path = os.pathsep.join([str(SOURCE.parent), str(ROOT / "hy_src")])
    done = subprocess.run(
        [sys.executable, *map(str, arguments)],
        capture_output=True,
        text=True,
        **options,
        env={**os.environ, "PYTHONWARNINGS": "error", "PYTHONPATH": path},
    )
    return done.stdout, done.stderr


def examples(text):
    """Each block of Python in ``text``, with the block of what it prints, or "" where there is none below it."""
    return re.findall(r"```python\n(.*?)```(?:\n\n```text\n(.*?)```)?", text, re.S)


def test_the_example_is_a_script():
    assert python(EXAMPLE) == (STORY, "")


@pytest.mark.soak
def test_the_example_tells_the_same_story_on_both_back_ends_and_with_any_seed():
    assert python("-c", RUNS) == (STORY * 14, "")


def test_the_examples_of_the_page_run_and_print_what_stands_there():
    blocks = examples(PAGE.read_text())
    assert len(blocks) >= 8 and all(output for _, output in blocks)
    marked = "".join(f"{code}\nprint('-----')\n" for code, _ in blocks)
    printed, problems = python("-c", marked)
    assert not problems, problems
    for (code, wanted), given in zip(blocks, printed.split("-----\n"), strict=False):
        assert given == wanted, code


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("room, printed", [("prolog", "tom\n"), ("designators", "['drive', 1.5]\n"), ("process_modules", "there\n")])
def test_the_example_of_a_room_runs(room, printed):
    text = __import__(f"{cramhy_runtime.__name__}.{room}", fromlist=["x"]).__doc__
    code = "\n".join(line.removeprefix("    ") for line in text.splitlines() if line.startswith("    ") or not line)
    code = re.sub(r"^((?:reference|cpl\.run)\(.*\))  .*$", r"print(\1)", code, flags=re.M)
    assert python("-c", code) == (printed, "")
