"""The grader's side of the processes: it starts a watcher with its fork server, gives jobs, and waits no longer than a job may take."""

from __future__ import annotations

import contextlib
import json
import os
import select
import signal
import subprocess
import sys
import tempfile
import time

from . import messages
from .problems import ExerciseError

MORE = 20.0
"""Seconds that the watcher gets beside those of a job, before it counts as lost."""
START = 120.0
END = 10.0
"""Seconds in which a watcher ends what it has started, when nobody wants more of it."""
KEPT_VARIABLES = ("HOME", "XDG_CACHE_HOME", "ROS_PACKAGE_PATH", "LD_LIBRARY_PATH", "TMPDIR")
"""What a fork server gets of the environment: where kept code, packages and libraries are. Submissions can see it."""


class ForkServer:
    """A process from which those of submissions come, with its watcher. `ask` gives it a job, and `answers` waits for what came of it.

    choice: "bubblewrap", "locks", or ``None`` for bubblewrap where it works.
    """

    def __init__(self, systems, choice=None):
        if not hasattr(os, "fork"):
            raise ExerciseError("This system cannot fork processes, so submissions cannot be graded apart. Grade on Linux or macOS.")
        self.systems, self.choice = systems, choice
        self.process = None
        self.folder = None
        self.latest = 0.0  # when it is lost if it has not answered
        self.coming = 0  # answers

    def _start(self):
        from .sandbox import folders

        self.folder = tempfile.mkdtemp(prefix="cramhy-grading-")
        environment = {name: os.environ[name] for name in KEPT_VARIABLES if name in os.environ}
        environment |= {"PATH": "/usr/bin:/bin", "LANG": "C.UTF-8"}
        environment["PYTHONPATH"] = os.pathsep.join(dict.fromkeys(os.path.dirname(package) for package in folders.packages()))
        self.process = subprocess.Popen(
            [sys.executable, "-P", "-m", f"{__package__}.watcher"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            cwd=self.folder,
            env=environment,
            start_new_session=True,
        )
        self.latest = time.monotonic() + START
        self._send({"prepare": self.systems, "choice": self.choice})

    def close(self):
        """End it, with all that it has started."""
        from .sandbox import removal

        if self.process is None:
            return
        with contextlib.suppress(OSError):
            self.process.stdin.close()
        try:
            self.process.wait(END)
        except subprocess.TimeoutExpired:
            with contextlib.suppress(OSError):
                os.killpg(self.process.pid, signal.SIGKILL)
            self.process.wait()
        self.process.stdout.close()
        self.process = None
        removal.remove(self.folder)

    def ask(self, job):
        """Give it a job; one at a time. If it has been lost since the last one, another one is started."""
        if self.process is None:
            self.coming = 0
            self._start()
        self.latest = max(self.latest, time.monotonic()) + job["wall"] + MORE
        self._send(job)

    def _send(self, message):
        self.coming += 1
        with contextlib.suppress(OSError):  # it is gone, which `take` will notice
            messages.send(self.process.stdin.fileno(), message)

    def take(self):
        """The answer that has begun to come, or ``None`` if the fork server is lost.

        Raises `StillComing` after the answer of its preparation.
        """
        try:
            found = self._received()
        except (OSError, ValueError, _Lost):
            self.close()
            return None
        self.coming -= 1
        if self.coming:
            if self.choice == "bubblewrap" and found["bubblewrap"] is not None:
                self.close()
                raise ExerciseError(f"Submissions shall run in bubblewrap, and cannot: {found['bubblewrap']}")
            raise StillComing
        self.latest = 0.0
        return found

    def _received(self):
        source = self.process.stdout.fileno()
        data, wanted = bytearray(), 8
        while len(data) < wanted:
            if not select.select([source], (), (), max(self.latest - time.monotonic(), 0))[0]:
                raise _Lost
            piece = os.read(source, wanted - len(data))
            if not piece:
                raise _Lost
            data += piece
            if wanted == 8 and len(data) == 8:
                wanted = 8 + int.from_bytes(data, "big")
        return json.loads(bytes(data[8:]))


class StillComing(Exception):
    """The fork server has prepared itself, and now does its job."""


class _Lost(Exception):
    """The fork server is gone, or says nothing."""


def answers(asked):
    """Wait for the first of some fork servers; a pair of a fork server and its answer for each that has one.

    ``None`` as answer: it was lost. asked: fork servers, each with a job; or objects that have the answer at once, such as `Here`.
    """
    found = [(each, each.take()) for each in asked if not isinstance(each, ForkServer)]
    while not found:
        now = time.monotonic()
        ready = select.select([each.process.stdout for each in asked], (), (), max(min(each.latest for each in asked) - now, 0))[0]
        for each in asked:
            if each.process.stdout in ready or each.latest <= time.monotonic():
                with contextlib.suppress(StillComing):
                    found.append((each, each.take()))
    return found
