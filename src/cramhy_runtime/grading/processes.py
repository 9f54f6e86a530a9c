"""The grader's side of fork_servers: it starts them, gives them jobs, and waits no longer than a job may take."""

from __future__ import annotations

import contextlib
import os
import select
import signal
import subprocess
import sys
import tempfile
import time

from . import fork_server
from .problems import ExerciseError

MORE = 20.0
"""Seconds that the fork server gets beside those of a job, before it counts as lost."""
START = 120.0


class ForkServer:
    """A process from which those of submissions come. `ask` gives it a job, and `answers` waits for what came of it."""

    def __init__(self, systems):
        if not hasattr(os, "fork"):
            raise ExerciseError("This system cannot fork processes, so submissions cannot be graded apart. Grade on Linux or macOS.")
        self.systems = systems
        self.process = None
        self.folder = None
        self.latest = 0.0  # when it is lost if it has not answered
        self.coming = 0  # answers

    def _start(self):
        self.folder = tempfile.TemporaryDirectory(prefix="cramhy-fork-server-")
        environment = {name: value for name, value in os.environ.items() if not name.startswith("PYTEST") and name != "CRAMHY_BACKTRACE"}
        self.process = subprocess.Popen(
            [sys.executable, "-P", "-m", f"{__package__}.fork_server"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            cwd=self.folder.name,
            env=environment,
            start_new_session=True,
        )
        self.latest = time.monotonic() + START
        self._send({"prepare": self.systems})

    def close(self):
        """End it, with all that it has started."""
        if self.process is None:
            return
        with contextlib.suppress(OSError):
            os.killpg(self.process.pid, signal.SIGKILL)
        self.process.wait()
        self.process.stdin.close()
        self.process.stdout.close()
        self.process = None
        self.folder.cleanup()

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
            fork_server.send(self.process.stdin.fileno(), message)

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
        return fork_server.json.loads(bytes(data[8:]))


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
