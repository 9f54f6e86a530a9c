"""``make tutorial`` as a whole: it ends with the tree of the tasks of a plan, while two branches and two modules work."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PLANS = "tutorials/cram_my_beginner_tutorial/src/simple-plans.hy"


@pytest.mark.soak
@pytest.mark.parametrize("backend", ["threads", "greenlet"])
def test_the_tutorial_shows_what_a_plan_is_doing(backend, tmp_path):
    environment = {key: value for key, value in os.environ.items() if key != "ROS_PACKAGE_PATH"}
    environment["PYTHONPATH"] = os.pathsep.join(str(ROOT / folder) for folder in ("src", "hy_src"))
    done = subprocess.run(
        [sys.executable, "tutorials/lectures.py", "--backend", backend, "--png", str(tmp_path / "turtle.png")],
        cwd=ROOT,
        env=environment,
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=120,
    )
    assert done.returncode == 0 and not done.stderr
    tree = done.stdout[done.stdout.index("[TOP-LEVEL]") :].splitlines()
    names = [line.partition("  running for 1 s, ")[0] for line in tree]
    assert names[:7] == [
        "[TOP-LEVEL]",
        "├─ [PAR-CHILD-#1/2]",
        "└─ [PAR-CHILD-#2/2]",
        "[PROCESS-MODULES]",
        "├─ [TURTLESIM-NAVIGATION]",
        "│  ├─ [PURSUE-CHILD-#1/2]",
        "│  └─ [PURSUE-CHILD-#2/2]",
    ]
    assert "waits for process module TURTLESIM-NAVIGATION at <repl " in tree[1]
    assert f"waits for the branches of PURSUE at {PLANS}:" in tree[4] and f"(sleep 0.1) at {PLANS}:" in tree[6]
    assert tree[7].endswith("waits for a request to process module TURTLESIM-PEN-CONTROL") and tree[8] == "T"
