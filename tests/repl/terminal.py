"""A terminal with a REPL in it, for what only a terminal can do: Ctrl-C."""

from __future__ import annotations

import fcntl
import os
import pty
import re
import select
import signal
import struct
import sys
import termios
import time
from pathlib import Path

ROOT = Path(__file__).parents[2]
PATIENCE = 30  # s; only a test that fails waits so long


class Terminal:
    """``cramhy`` with ``arguments`` in a pseudo-terminal of its own. A context manager.

    editor: with prompt_toolkit, which echoes what is typed in its own way; without, the terminal's line editing is used. variables: of the
    environment, ``None`` for one that is not set. size: (lines, columns) of the terminal.
    """

    def __init__(self, *arguments, editor=False, variables=None, size=None):
        self.text = ""
        self.seen = 0
        environment = {**os.environ, "PYTHONPATH": f"{ROOT / 'src'}{os.pathsep}{ROOT / 'hy_src'}", "TERM": "dumb",
                       "PROMPT_TOOLKIT_NO_CPR": "1", **(variables or {})}
        environment = {name: value for name, value in environment.items() if value is not None}
        self.pid, self.master = pty.fork()
        if self.pid == 0:
            if size is not None:
                fcntl.ioctl(0, termios.TIOCSWINSZ, struct.pack("HHHH", *size, 0, 0))
            hide = "" if editor else "sys.modules['prompt_toolkit'] = None; "
            program = f"import sys; {hide}from cramhy_runtime.cli import main; sys.exit(main(sys.argv[1:]))"
            os.execve(sys.executable, [sys.executable, "-c", program, *arguments], environment)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.pid is not None:
            os.kill(self.pid, signal.SIGKILL)
            os.waitpid(self.pid, 0)
        os.close(self.master)

    def type(self, line):
        """Type a line and Enter."""
        os.write(self.master, line.encode() + b"\n")

    def control_c(self):
        """Press Ctrl-C; the moment, for `since`."""
        os.write(self.master, b"\x03")
        return time.monotonic()

    def end(self):
        """Press Ctrl-D and wait for the end: the exit status."""
        os.write(self.master, b"\x04")
        return self.status()

    def status(self):
        while self._more(PATIENCE):
            pass
        _, status = os.waitpid(self.pid, 0)
        self.pid = None
        return os.waitstatus_to_exitcode(status)

    def expect(self, pattern):
        """Read until ``pattern``, a regular expression, appears after what was expected before: the text up to its end."""
        until = time.monotonic() + PATIENCE
        while True:
            match = re.search(pattern, self.text[self.seen:])
            if match:
                part = self.text[self.seen:self.seen + match.end()]
                self.seen += match.end()
                return part
            if not self._more(until - time.monotonic()):
                raise AssertionError(f"{pattern!r} never came; after {self.text[:self.seen]!r} came {self.text[self.seen:]!r}")

    def _more(self, seconds):
        ready, _, _ = select.select([self.master], [], [], max(0, seconds))
        if not ready:
            return False
        try:
            data = os.read(self.master, 65536)
        except OSError:  # Linux's way to say that the other end is closed
            return False
        self.text += re.sub(r"\x1b\[[0-9;?]*[A-Za-z]|\r", "", data.decode())
        return bool(data)
