"""A session in a tab: what the worker of the page calls once Python is there. It runs in Pyodide only.

The prompt is that of `roslisp_repl`. Its lines come from the page, and what it prints goes there; Ctrl-C is a message. `host` is the half
of this that is JavaScript's: `stacks.mjs` of the kernel's back end, with what ``worker.mjs`` adds to it.
"""

from __future__ import annotations

import sys

from .. import chronicle, kernel
from ..kernel.backends.jspi import host, wait_for
from ..languages.commonlisp.streams import streams
from ..repl.console import Console
from ..repl.line_input import BROKEN_OFF, Lines
from ..ros import graph
from ..session.session import Session
from .port import Port


class PageLines(Lines):
    """The lines that the page sends. They are shown behind their prompts, as on a terminal."""

    shows_open = True

    def __init__(self):
        super().__init__()
        self._woken = False

    def wait(self, prompt):
        streams.CONSOLE_OUTPUT.flush()
        streams.CONSOLE_OUTPUT.column = 0
        if self._woken:
            return BROKEN_OFF
        host.prompt = prompt
        line = wait_for(host.line)
        if not isinstance(line, str):
            sys.stdout.write(prompt)
            return BROKEN_OFF
        sys.stdout.write(f"{prompt}{line}\n")
        sys.stdout.flush()
        return line

    def wake(self):
        self._woken = True
        host.wake()

    def dealt_with(self):
        self._woken = False


def _later(seconds, function):
    from pyodide.ffi import create_once_callable

    host.later(seconds * 1000, create_once_callable(function))


def _interrupt():
    active = kernel.active()
    if active is not None:
        active.interrupt()


def main(speed: float | None = 1.0) -> int:
    """Run the prompt until ``(quit)``. Returns the exit status. speed: plan seconds per second at first, ``None`` without a bound."""
    from pyodide.ffi import create_proxy

    kernel.allow_deep_recursion()
    sys.stdout.reconfigure(line_buffering=True)
    sys.stderr.reconfigure(line_buffering=True)
    host.interrupt = create_proxy(_interrupt)

    def make():
        session = Session(time="virtual")
        port = Port(graph.active(), host.say, _later)
        host.receive = create_proxy(port.receive)
        chronicle.start()
        kernel.pace().set_speed(speed)
        host.ready()
        return session

    return Console(make, PageLines()).run()
