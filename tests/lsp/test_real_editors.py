"""Real editors with their own clients: Emacs with eglot, and Neovim. Each opens a file of the course with a mistake in it."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from .mistakes import COURSE

EDITORS = Path(__file__).parent / "editors"
CRAMHY = Path(sys.executable).parent / "cramhy"
EGLOT = list(Path("/usr/share/emacs/site-lisp/elpa-src").glob("eglot-*"))


@pytest.fixture
def file(tmp_path):
    """A copy of the course with a misspelt name in line 31 of its plans."""
    folder = tmp_path / "course"
    shutil.copytree(COURSE, folder)
    (folder / ".git").mkdir()
    found = folder / "src" / "simple-plans.hy"
    found.write_text(found.read_text(encoding="utf-8").replace("(calculate-angular-cmd goal 8)", "(calculate-angular-cdm goal 8)"), "utf-8")
    return found


TOLD = [
    "diagnostic 31 undefined function: CRAM-MY-BEGINNER-TUTORIAL::CALCULATE-ANGULAR-CDM",
    "definition control-turtlesim.hy",
    "hover (send-vel-cmd lin ang)",
]


def lines(words, **variables):
    done = subprocess.run(words, capture_output=True, text=True, timeout=300, env={**os.environ, **variables})
    output = done.stdout + done.stderr
    return [
        line.strip().replace(" cramhy: ", " ") for line in output.splitlines() if line.startswith(("diagnostic", "definition", "hover"))
    ], output


@pytest.mark.soak
@pytest.mark.skipif(not shutil.which("emacs"), reason="emacs is missing")
@pytest.mark.skipif(not EGLOT, reason="eglot is missing")
def test_emacs_with_eglot(file):
    found, output = lines(["emacs", "--batch", "-Q", "-l", EDITORS / "eglot.el", CRAMHY, file])
    assert found == TOLD, output[-2000:]


@pytest.mark.soak
@pytest.mark.skipif(not shutil.which("nvim"), reason="nvim is missing")
def test_neovim(file):
    words = ["nvim", "--headless", "-u", "NONE", "-i", "NONE", "-c", f"luafile {EDITORS / 'neovim.lua'}"]
    found, output = lines(words, CRAMHY_PROGRAM=str(CRAMHY), CRAMHY_FILE=str(file))
    assert found == TOLD, output[-2000:]
