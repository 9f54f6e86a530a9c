"""Worker processes, and what they measured: for ``table.py`` and ``compare.py``."""

from __future__ import annotations

import os
import statistics
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).parent
LEAST, MOST, SECONDS = 5, 200, 1.0  # rounds of a row, and how long it is measured


class Failed(Exception):
    """A row that could not be measured: why."""


class Worker:
    """A process with a session on one back end, of the code in ``checkout`` (a folder with ``src`` and ``hy_src``)."""

    def __init__(self, backend, checkout=HERE.parent):
        environment = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
        environment["PYTHONPATH"] = os.pathsep.join(str(Path(checkout) / folder) for folder in ("src", "hy_src"))
        self.process = subprocess.Popen(
            [sys.executable, str(HERE / "worker.py"), backend],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, env=environment, cwd=checkout,
        )  # fmt: skip
        if self.process.stdout.readline() != "ready\n":
            raise Failed(f"no worker for the back end {backend}")

    def measure(self, name):
        """Processor seconds of one unit of a row; for a row beside Python a pair with the peer's."""
        self.process.stdin.write(name + "\n")
        self.process.stdin.flush()
        answer = self.process.stdout.readline()
        if not answer or answer.startswith("failed"):
            raise Failed(answer.removeprefix("failed").strip() or "the worker ended")
        figures = [float(word) for word in answer.split()]
        return figures if len(figures) > 1 else figures[0]

    def close(self):
        self.process.stdin.close()
        self.process.wait()


def spread(figures):
    """The distance between the quarters of ``figures``, as a part of their median."""
    if len(figures) < 4:
        return 0.0
    low, _, high = statistics.quantiles(figures, n=4)
    return (high - low) / statistics.median(figures)
