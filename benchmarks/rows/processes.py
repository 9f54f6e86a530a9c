"""Rows of whole processes: the first start ever after an installation, and later starts up to the prompt."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from pathlib import Path

from . import Row

ROOT = Path(__file__).parents[2]
COURSE = ("--load", "cram-my-beginner-tutorial")
FIRST = Row("first start ever, with the course's package", None, goal=1.0, unit="s", cram="2.37")
PROMPT = Row("roslisp_repl until the prompt, and its end", None, goal=0.12, unit="s", cram="0.4")
WITH_COURSE = Row("the same with the course's package", None, goal=0.15, unit="s", cram="2.37")


def seconds(path, cache, *arguments):
    """The processor seconds, of user and system, of one ``roslisp_repl`` with no input, from the code on ``path``."""
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    environment |= {"PYTHONPATH": os.pathsep.join(map(str, path)), "XDG_CACHE_HOME": cache}
    before = os.times()
    subprocess.run(
        [sys.executable, "-m", "cramhy_runtime.cli", "repl", *arguments],
        input="", text=True, capture_output=True, cwd=cache, env=environment, check=True,
    )  # fmt: skip
    after = os.times()
    return after.children_user - before.children_user + after.children_system - before.children_system


def measured(only=""):
    """Yield (row, figures of the rounds)."""
    if only in FIRST.name:
        yield FIRST, first_starts()
    for row, arguments in ((PROMPT, ()), (WITH_COURSE, COURSE)):
        if only in row.name:
            with tempfile.TemporaryDirectory() as cache:
                path = (ROOT / "src", ROOT / "hy_src")
                yield row, [seconds(path, cache, *arguments) for _ in range(9)][2:]


def first_starts():
    """Starts from a wheel that pip has just installed, each with nothing kept."""
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run(
            [sys.executable, "-m", "build", "--wheel", "--no-isolation", "--outdir", folder, str(ROOT)], capture_output=True, check=True
        )
        wheel = next(Path(folder).glob("*.whl"))
        figures = []
        for number in range(3):
            target = os.path.join(folder, f"installed{number}")
            pip = [sys.executable, "-m", "pip", "install", "--quiet", "--no-deps", "--target", target, str(wheel)]
            subprocess.run(pip, capture_output=True, check=True)
            with tempfile.TemporaryDirectory() as cache:
                figures.append(seconds([target], cache, *COURSE))
        return figures
