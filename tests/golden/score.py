"""``make golden``: the score of every golden file, in the order of their names.

Prints what the comparing tool prints; docs/explanation/how-near.md shows these lines. Exit status 0 whatever the score: the tests hold the files
that must pass.
"""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]
SHARED = ROOT.parent / "shared"


STARTED = """--eval '(start-ros-node "turtle1")' --eval '(init-ros-turtle "turtle1")' """


def command(path):
    """The evaluator with the tutorial loaded, as the comparing tool starts it; file 03 was recorded with the turtle running."""
    started = STARTED if path.stem == "03_ros_errors" else ""
    return f"{sys.executable} -m cramhy_runtime.cli eval --load cram-my-beginner-tutorial --package tut {started}"


def score(files, show=0):
    """The tool's output for golden ``files``, and the sum."""
    output, passed, total = "", 0, 0
    for path in files:
        done = subprocess.run(
            [sys.executable, str(SHARED / "tools" / "golden.py"), "--cmd", command(path), "--show", str(show), str(path)],
            capture_output=True,
            text=True,
            cwd=ROOT,
            env={**os.environ, "PYTHONDONTWRITEBYTECODE": ""},
        )
        *lines, last = done.stdout.strip().splitlines() or [""]
        output += "\n".join(lines) + "\n"
        good, _, all_of_them = last.removeprefix("passed ").partition(" of ")
        passed, total = passed + int(good or 0), total + int(all_of_them or 0)
    return f"{output}passed {passed} of {total}"


MISSING = """cramhy: the recorded answers of the original are not here, so there is nothing to compare with.
They are no part of the repository: make golden looks for the folder "shared" beside it, with shared/golden/*.jsonl and
shared/tools/golden.py. What the last comparison gave stands in docs/explanation/how-near.md."""


def main(words):
    """Print the score; the exit status is 1 if there is nothing to compare with."""
    files = sorted((SHARED / "golden").glob("*.jsonl"))
    if not files or not (SHARED / "tools" / "golden.py").exists():
        print(MISSING, file=sys.stderr)
        return 1
    print(score(files, show=int(words[0]) if words else 0))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
