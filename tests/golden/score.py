"""``make golden``: the score of every golden file, in the order of their names.

Prints what the comparing tool prints; the README shows these lines. Exit status 0 whatever the score: the tests hold the files
that must pass.
"""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]
SHARED = ROOT.parent / "shared"


def command():
    """The evaluator with the tutorial loaded, as the comparing tool starts it."""
    return f"{sys.executable} -m cramhy_runtime.cli eval --load cram-my-beginner-tutorial --package tut"


def score(files, show=0):
    """The tool's output for golden ``files``."""
    done = subprocess.run([sys.executable, str(SHARED / "tools" / "golden.py"), "--cmd", command(), "--show", str(show), *map(str, files)],
                          capture_output=True, text=True, cwd=ROOT, env={**os.environ, "PYTHONDONTWRITEBYTECODE": ""})
    return done.stdout + done.stderr


if __name__ == "__main__":
    print(score(sorted((SHARED / "golden").glob("*.jsonl")), show=int(sys.argv[1]) if len(sys.argv) > 1 else 0))
