"""Processes that are sessions: to be started, stopped, killed, and shut into PID namespaces."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

PROGRAM = Path(__file__).with_name("session_process.py")
PATIENCE = 60  # s


def wait_until(condition, what, patience=PATIENCE):
    """Wait until ``condition()`` is true; its value."""
    deadline = time.monotonic() + patience
    while True:
        found = condition()
        if found:
            return found
        assert time.monotonic() < deadline, f"This never happened: {what}"
        time.sleep(0.02)


class SessionProcess:
    """A session in a process of its own. folder: its XDG_RUNTIME_DIR, if it shall have one. before: words before the command."""

    def __init__(self, folder, limits=None, before=(), pages=None, time="wall", **environment):
        self.process = subprocess.Popen(
            [*before, sys.executable, str(PROGRAM), json.dumps(limits or {}), json.dumps(pages or {}), time],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            env={**os.environ, "XDG_RUNTIME_DIR": str(folder), **environment},
        )
        line = self.process.stdout.readline()
        self.told = json.loads(line or '{"problem": "it has ended"}')
        self.problem = self.told.get("problem")
        if self.problem is None:
            self.port, self.token, self.address, self.pid = (self.told[key] for key in ("port", "token", "address", "pid"))
            self.file = Path(self.told["file"])

    def signal(self, number):
        self.process.send_signal(number)

    def kill(self):
        """End it as nobody would wish, and do not ask how it ended: it stays a zombie."""
        self.signal(signal.SIGKILL)
        wait_until(lambda: Path(f"/proc/{self.process.pid}/stat").read_text().rpartition(")")[2].split()[0] == "Z", "it is dead")

    def end(self):
        """End it in order; what it wrote to stderr."""
        if self.process.poll() is None:
            try:
                self.process.send_signal(signal.SIGCONT)
            except ProcessLookupError:
                pass
            _, errors = self.process.communicate("", timeout=PATIENCE)
            return errors
        for pipe in (self.process.stdin, self.process.stdout, self.process.stderr):
            pipe.close()
        return ""
