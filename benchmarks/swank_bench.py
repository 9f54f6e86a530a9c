"""What a form costs over SLIME's protocol beside ``cramhy eval``: round trips between two processes, in milliseconds.

Both evaluate in virtual time without the turtle. Three figures are printed: the best round trip, which is what the code needs, the median,
which is what the machine gave it meanwhile, and the processor time that the server took for a round trip on the average. Goal: Swank adds
less than 1 ms; completion and arglists, which Emacs asks for at each key, take less than 50 ms.

Swank costs more than ``cramhy eval`` because a call wakes two threads one after the other, that of the socket and that of the plans, and
because it runs in a task of its own.
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


def processor(pid):
    """Milliseconds of the processor that the process has taken so far; ``None`` where the system does not tell so exactly."""
    try:
        return sum(int(path.read_text().split()[0]) for path in Path(f"/proc/{pid}/task").glob("*/schedstat")) / 1e6
    except (OSError, ValueError, IndexError):
        return None


def milliseconds(round_trip, pid):
    """(best, median, processor time) of `ROUNDS` round trips, after some that are not counted. pid: of the server."""
    for _ in range(50):
        round_trip()
    times, used = [], processor(pid)
    for _ in range(ROUNDS):
        begin = perf_counter()
        round_trip()
        times.append(1000 * (perf_counter() - begin))
    return min(times), statistics.median(times), (processor(pid) - used) / ROUNDS if used else None


def of_eval(folder, form):
    """A form over ``cramhy eval``."""
    served = process("eval", *COMMON, folder=folder)
    line = json.dumps({"form": form}) + "\n"

    def round_trip():
        served.stdin.write(line)
        served.stdin.flush()
        served.stdout.readline()

    found = milliseconds(round_trip, served.pid)
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
        secret = (Path(folder) / ".slime-secret").read_bytes().rstrip()
        self.socket.sendall(b"%06x" % len(secret) + secret)

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
    calls = {
        "the same over Swank": f'(swank:interactive-eval "{form}")',
        "completion in CL-USER": '(swank:completions "mult" "CL-USER")',
        "fuzzy completion in CL-USER": '(swank:fuzzy-completions "mvb" "CL-USER")',
        "arglist with the argument marked": '(swank:autodoc \'("mapcar" "f" "" swank::%cursor-marker%))',
    }
    with tempfile.TemporaryDirectory() as folder:
        plain = of_eval(folder, form)
        emacs = Swank(folder)
        swank, *others = (milliseconds(lambda call=call: emacs.call(call), emacs.process.pid) for call in calls.values())
        emacs.end()
    added = [None if one is None else two - one for one, two in zip(plain, swank, strict=True)]
    names = list(calls)
    rows = [("(list 1 2 3) over cramhy eval", plain, "-"), (names[0], swank, "-"), ("what Swank adds", added, "1")]
    rows += [(name, figures, "50") for name, figures in zip(names[1:], others, strict=True)]
    print(f"{'round trip between processes, ms':40} {'best':>9} {'median':>9} {'processor':>9} {'goal':>6}")
    for name, figures, goal in rows:
        print(f"{name:40} {' '.join(f'{each:9.3f}' if each is not None else f'{chr(45):>9}' for each in figures)} {goal:>6}")


if __name__ == "__main__":
    main()
