"""What a form costs over SLIME's protocol beside ``cramhy eval``: round trips between two processes, medians of many.

Both evaluate in virtual time without the turtle. Goal: Swank adds less than 1 ms; completion and arglists, which Emacs asks for at each
key, take less than 50 ms.
"""

from __future__ import annotations

import json
import os
import socket
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path
from time import perf_counter

ROOT = Path(__file__).parents[1]
ENVIRONMENT = {key: value for key, value in os.environ.items() if key != "PYTHONDONTWRITEBYTECODE"}
ENVIRONMENT["PYTHONPATH"] = f"{ROOT / 'src'}{os.pathsep}{ROOT / 'hy_src'}"
ROUNDS = 400
COMMON = ("--time", "virtual", "--no-turtlesim")


def process(*words, folder):
    return subprocess.Popen(
        [sys.executable, "-m", "cramhy_runtime.cli", *words],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        cwd=folder,
        env={**ENVIRONMENT, "HOME": folder},
    )


def milliseconds(round_trip):
    """The median of `ROUNDS` round trips, after some that are not counted."""
    times = []
    for number in range(ROUNDS + 50):
        begin = perf_counter()
        round_trip()
        if number >= 50:
            times.append(1000 * (perf_counter() - begin))
    return statistics.median(times)


def of_eval(folder, form):
    """A form over ``cramhy eval``."""
    served = process("eval", *COMMON, folder=folder)
    line = json.dumps({"form": form}) + "\n"

    def round_trip():
        served.stdin.write(line)
        served.stdin.flush()
        served.stdout.readline()

    found = milliseconds(round_trip)
    served.communicate(timeout=20)
    return found


class Swank:
    """A connection to ``cramhy swank``."""

    def __init__(self, folder):
        self.process = process("swank", "--port", "0", *COMMON, folder=folder)
        port = int(self.process.stderr.readline().split()[-2])
        self.socket = socket.create_connection(("127.0.0.1", port))
        self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self.file = self.socket.makefile("rb")

    def call(self, form):
        text = f'(:emacs-rex {form} "COMMON-LISP-USER" t 1)'.encode()
        self.socket.sendall(b"%06x" % len(text) + text)
        while not self.file.read(int(self.file.read(6), 16)).startswith(b"(:return "):
            pass

    def end(self):
        self.process.terminate()
        self.process.communicate(timeout=20)


def main():
    form = "(list 1 2 3)"
    with tempfile.TemporaryDirectory() as folder:
        plain = of_eval(folder, form)
        emacs = Swank(folder)
        swank = milliseconds(lambda: emacs.call(f'(swank:interactive-eval "{form}")'))
        complete = milliseconds(lambda: emacs.call('(swank:completions "mult" "CL-USER")'))
        fuzzy = milliseconds(lambda: emacs.call('(swank:fuzzy-completions "mvb" "CL-USER")'))
        autodoc = milliseconds(lambda: emacs.call('(swank:autodoc \'("mapcar" "f" "" swank::%cursor-marker%))'))
        emacs.end()
    rows = [
        ("(list 1 2 3) over cramhy eval", plain, "-"),
        ("the same over Swank", swank, "-"),
        ("what Swank adds", swank - plain, "1"),
        ("completion in CL-USER", complete, "50"),
        ("fuzzy completion in CL-USER", fuzzy, "50"),
        ("arglist with the argument marked", autodoc, "50"),
    ]
    print(f"{'round trip between processes, median, ms':48} {'cramhy':>8} {'goal':>8}")
    for name, figure, goal in rows:
        print(f"{name:48} {figure:8.3f} {goal:>8}")


if __name__ == "__main__":
    main()
