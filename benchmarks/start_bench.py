"""From the shell to the prompt, to the loaded tutorial, and both lectures: whole processes, medians of five runs.

The figures of CRAM on SBCL are those of ``peers.md``, measured on another machine of the same size: they give the order of size.
The first run of each compiles and is not counted.
"""

from __future__ import annotations

import os
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path
from time import perf_counter

ROOT = Path(__file__).parents[1]
ENVIRONMENT = {key: value for key, value in os.environ.items() if key != "PYTHONDONTWRITEBYTECODE"}
ENVIRONMENT["PYTHONPATH"] = f"{ROOT / 'src'}{os.pathsep}{ROOT / 'hy_src'}"


def seconds(*arguments, text=""):
    """The median duration of five runs of ``python arguments``."""
    runs = []
    for _ in range(6):
        begin = perf_counter()
        subprocess.run([sys.executable, *arguments], input=text, text=True, capture_output=True, cwd=ROOT, env=ENVIRONMENT, check=True)
        runs.append(perf_counter() - begin)
    return statistics.median(runs[1:])


def main():
    cli = ("-m", "cramhy_runtime.cli")
    picture = str(Path(tempfile.gettempdir()) / "cramhy-bench.png")
    rows = [
        ("import hy alone", seconds("-c", "import hy"), "-", "0.073"),
        ("roslisp_repl until the prompt, and its end", seconds(*cli, "repl"), "0.4", "0.3"),
        ("the same with the tutorial loaded, unchanged", seconds(*cli, "repl", "--load", "cram-my-beginner-tutorial"), "2.37", "0.5"),
        ("both lectures in virtual time", seconds("tutorials/lectures.py", "--png", picture), "-", "2"),
    ]
    print(f"{'whole process, median of 5, seconds':48} {'cramhy':>8} {'CRAM':>8} {'goal':>8}")
    for name, figure, peer, goal in rows:
        print(f"{name:48} {figure:8.3f} {peer:>8} {goal:>8}")


if __name__ == "__main__":
    main()
