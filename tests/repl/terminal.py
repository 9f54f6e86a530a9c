"""A terminal with a REPL in it, for what only a terminal can do: Ctrl-C."""

from __future__ import annotations

import fcntl
import os
import pty
import re
import select
import signal
import struct
import subprocess
import sys
import termios
import time
from pathlib import Path

ROOT = Path(__file__).parents[2]
PATIENCE = 30  # s; only a test that fails waits so long


class Terminal:
    """``cramhy`` with ``arguments`` in a pseudo-terminal of its own, or ``program`` with them. A context manager.

    editor: with prompt_toolkit, which echoes what is typed in its own way; without, the terminal's line editing is used, or that of
    readline where ``variables`` have a TERM that draws. variables: of the
    environment, ``None`` for one that is not set. size: (lines, columns) of the terminal. wrapped: the terminal is kept open by this
    process, too, as a shell does, so that its modes can be looked at (`slave`); `begin` starts the program.
    """

    def __init__(self, *arguments, editor=False, variables=None, size=None, wrapped=False, program=None):
        self.text = ""
        self.raw = b""  # with what moves the cursor and gives colours
        self.seen = 0
        self.slave = None
        environment = {
            **os.environ,
            "PYTHONPATH": f"{ROOT / 'src'}{os.pathsep}{ROOT / 'hy_src'}",
            "TERM": "xterm" if editor else "dumb",
            "CRAMHY_HISTORY": "",
            "PROMPT_TOOLKIT_NO_CPR": "1",
            **(variables or {}),
        }
        environment = {name: value for name, value in environment.items() if value is not None}
        hide = "" if editor else "sys.modules['prompt_toolkit'] = None; "
        cramhy = f"import sys; {hide}from cramhy_runtime.cli import main; sys.exit(main(sys.argv[1:]))"
        self.command = [*([sys.executable, "-c", cramhy] if program is None else program), *arguments]
        self.environment = environment
        if wrapped:
            self.pid = None
            self.master, self.slave = pty.openpty()
            return
        self.pid, self.master = pty.fork()
        if self.pid == 0:
            if size is not None:
                fcntl.ioctl(0, termios.TIOCSWINSZ, struct.pack("HHHH", *size, 0, 0))
            os.execve(self.command[0], self.command, environment)

    def begin(self):
        """Start the program in a terminal that is ``wrapped``."""
        self.process = subprocess.Popen(
            self.command, env=self.environment, stdin=self.slave, stdout=self.slave, stderr=self.slave, start_new_session=True
        )
        self.pid = self.process.pid

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.pid is not None:
            os.kill(self.pid, signal.SIGKILL)
            os.waitpid(self.pid, 0)
        if self.master is not None:
            os.close(self.master)
        if self.slave is not None:
            os.close(self.slave)

    def hang_up(self):
        """Close the terminal, as its window is closed."""
        os.close(self.master)
        self.master = None

    def type(self, line):
        """Type a line and Enter."""
        os.write(self.master, line.encode() + b"\n")

    def press(self, keys):
        """Press keys, without Enter."""
        os.write(self.master, keys.encode())

    def control_c(self):
        """Press Ctrl-C; the moment, for `since`."""
        os.write(self.master, b"\x03")
        return time.monotonic()

    def end(self):
        """Press Ctrl-D and wait for the end: the exit status."""
        os.write(self.master, b"\x04")
        return self.status()

    def status(self):
        """Wait for the end: the exit status."""
        if self.slave is not None:
            status = self.process.wait(PATIENCE)
            self.pid = None
            return status
        while self.master is not None and self._more(PATIENCE):
            pass
        until = time.monotonic() + PATIENCE
        while True:
            found, status = os.waitpid(self.pid, os.WNOHANG)
            if found:
                break
            assert time.monotonic() < until, f"it does not end; it said {self.text!r}"
            time.sleep(0.01)
        self.pid = None
        return os.waitstatus_to_exitcode(status)

    def expect(self, pattern):
        """Read until ``pattern``, a regular expression, appears after what was expected before: the text up to its end."""
        until = time.monotonic() + PATIENCE
        while True:
            match = re.search(pattern, self.text[self.seen :])
            if match:
                part = self.text[self.seen : self.seen + match.end()]
                self.seen += match.end()
                return part
            if not self._more(until - time.monotonic()):
                raise AssertionError(f"{pattern!r} never came; after {self.text[: self.seen]!r} came {self.text[self.seen :]!r}")

    def _more(self, seconds):
        ready, _, _ = select.select([self.master], [], [], max(0, seconds))
        if not ready:
            return False
        try:
            data = os.read(self.master, 65536)
        except OSError:  # Linux's way to say that the other end is closed
            return False
        self.raw += data
        shown = re.sub(r"\x1b\[(\d+)D\x1b\[(\d+)C", lambda moves: " " * (int(moves[2]) - int(moves[1])), data.decode())
        self.text += re.sub(r"\x1b\[[0-9;?]*[A-Za-z]|\r", "", shown)
        return bool(data)
