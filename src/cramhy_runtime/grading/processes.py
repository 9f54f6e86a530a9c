"""The grader's side of the nursery: it starts it, gives it jobs, and waits no longer than a job may take."""

from __future__ import annotations

import contextlib
import os
import select
import signal
import subprocess
import sys
import tempfile
import time

from . import nursery
from .problems import ExerciseError

MORE = 20.0
"""Seconds that the nursery gets beside those of a job, before it counts as lost."""
START = 120.0


class Lost(Exception):
    """The nursery is gone in the middle of a job."""


class Nursery:
    """A process from which those of submissions come. ``with Nursery(systems) as nursery: nursery.answer(job)``."""

    def __init__(self, systems):
        if not hasattr(os, "fork"):
            raise ExerciseError("This system cannot fork processes, so submissions cannot be graded apart. Grade on Linux or macOS.")
        self.systems = systems
        self.process = None
        self.folder = None

    def __enter__(self):
        return self

    def __exit__(self, *problem):
        self.close()

    def _start(self):
        self.folder = tempfile.TemporaryDirectory(prefix="cramhy-nursery-")
        environment = {name: value for name, value in os.environ.items() if not name.startswith("PYTEST") and name != "CRAMHY_BACKTRACE"}
        self.process = subprocess.Popen(
            [sys.executable, "-P", "-m", f"{__package__}.nursery"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            cwd=self.folder.name,
            env=environment,
            start_new_session=True,
        )
        self._ask({"prepare": self.systems}, START)

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

    def answer(self, job):
        """What came of a job (see `nursery`). Raises `Lost` if the nursery was ended meanwhile; the next job gets a new one."""
        if self.process is None:
            self._start()
        return self._ask(job, job["wall"] + MORE)

    def _ask(self, message, seconds):
        try:
            nursery.send(self.process.stdin.fileno(), message)
            return self._received(seconds)
        except (OSError, ValueError, Lost):
            self.close()
            raise Lost

    def _received(self, seconds):
        source, latest = self.process.stdout.fileno(), time.monotonic() + seconds
        data, wanted = bytearray(), 8
        while len(data) < wanted:
            if not select.select([source], (), (), max(latest - time.monotonic(), 0))[0]:
                raise Lost
            piece = os.read(source, 1 << 20)
            if not piece:
                raise Lost
            data += piece
            if wanted == 8 and len(data) >= 8:
                wanted = 8 + int.from_bytes(data[:8], "big")
        return nursery.json.loads(bytes(data[8:]))
