"""A session in a tab: what the worker of the page calls once Python is there. It runs in Pyodide only.

The prompt is that of `roslisp_repl`. After ``(in-hy)`` it is that of Hy, in which ``(in-package ...)`` leads back. Its lines come from the
page, and what it prints goes there; Ctrl-C is a message. What the page asks besides is answered by `Desk`. `host` is the half of this that
is JavaScript's: `stacks.mjs` of the kernel's back end, with what ``worker.mjs`` adds to it.
"""

from __future__ import annotations

import io
import json
import os
import sys
from contextlib import contextmanager

from .. import chronicle, kernel
from ..lisp_core import conditions
from ..lisp_core.data import Cons, Symbol
from ..kernel.backends.jspi import host, wait_for
from ..kernel.standard_input import BrokenOff
from ..languages.commonlisp.evaluation import evaluator
from ..languages.commonlisp.streams import streams
from ..repl.console import Console
from ..repl.line_input import BROKEN_OFF, Lines
from ..ros import graph
from ..session import requests
from ..session.session import Session, packages_above
from . import debugging
from .desk import Desk
from .port import Port


class PageLines(Lines):
    """The lines that the page sends. They are shown behind their prompts, as on a terminal.

    ``desk``: the `Desk`, which is told the package of the prompt. ``in_hy``: a function that says whether the prompt is Hy's.
    """

    shows_open = True
    edits = True

    def __init__(self):
        super().__init__()
        self.desk = None
        self.in_hy = lambda: False
        self._woken = False
        self._errors = []

    def wait(self, prompt):
        streams.CONSOLE_OUTPUT.flush()
        streams.CONSOLE_OUTPUT.column = 0
        if self._woken:
            return BROKEN_OFF
        package = self.desk.package = evaluator.PACKAGE.value
        host.prompt = json.dumps(
            {
                "text": prompt,
                "language": "hy" if self.in_hy() else "lisp",
                "package": list(package.names),
                "virtual": kernel.active().clock.virtual,
            }
        )
        line = wait_for(host.line)
        if not isinstance(line, str):
            sys.stdout.write(prompt)
            return BROKEN_OFF
        place = json.loads(host.place)
        self.sent = place and (line, os.path.abspath(place["path"]), place["line"], place["column"])
        sys.stdout.write(f"{prompt}{line}\n")
        sys.stdout.flush()
        return line

    @contextmanager
    def choosing(self, condition, restarts):
        self._errors.append(debugging.told(condition, restarts, sys._getframe(1)))
        self._tell_error()
        try:
            yield
        finally:
            self._errors.pop()
            self._tell_error()

    def _tell_error(self):
        host.debug(json.dumps({"level": len(self._errors) - 1, **self._errors[-1]}) if self._errors else "null")

    def wake(self):
        self._woken = True
        host.wake()

    def dealt_with(self):
        self._woken = False


class PageInput(io.TextIOBase):
    """Standard input of programs: ``(read-line)`` reads what is typed into the page."""

    def __init__(self):
        self._woken = False

    def readline(self, size=-1):
        sys.stdout.flush()
        if not self._woken:
            host.prompt = json.dumps({"text": "", "reads": True})
            line = wait_for(host.line)
            if isinstance(line, str):
                sys.stdout.write(f"{line}\n")
                return f"{line}\n"
        self._woken = False
        raise BrokenOff

    def wake(self):
        self._woken = True
        host.wake()


class TabConsole(Console):
    """The prompt of a tab."""

    def __init__(self, make_session, lines):
        super().__init__(make_session, lines)
        self._rest = None  # the text behind (in-hy)

    def leads_away(self, form, reader):
        if isinstance(form, Cons) and isinstance(form.car, Symbol) and form.car.name == "IN-HY" and form.cdr is None:
            self._rest = reader.text[reader.offset :]
        return self._rest is not None

    def over(self):
        return self._rest is not None

    def converse(self):
        super().converse()
        if self._rest is not None:
            conditions.install_debugger(None)
            self._converse_in_hy(self._rest.strip())

    def _converse_in_hy(self, text):
        from ..repl import hy_prompt

        warnings = streams.ERROR_OUTPUT.value
        streams.ERROR_OUTPUT.value = streams.STANDARD_OUTPUT.value
        try:
            hy_prompt.converse(self.session, self.input, text, begun=self._begin_hy)
        finally:
            streams.ERROR_OUTPUT.value = warnings

    def _begin_hy(self, repl):
        self.input.in_hy = lambda: not repl.lisp.in_lisp
        self.input.desk.hy_module = lambda: repl.module


def _define_course():
    from ..course import package

    package.define()


packages_above["COURSE"] = _define_course


def _later(seconds, function):
    from pyodide.ffi import create_once_callable

    host.later(seconds * 1000, create_once_callable(function))


def _interrupt():
    active = kernel.active()
    if active is not None:
        active.interrupt()


def let_import() -> None:
    """Let Hy import what stands in the user's folder, which is the current one, and the packages of the course."""
    from ..course.files import tutorials

    sys.path += [folder for folder in (os.getcwd(), str(tutorials())) if folder not in sys.path]


def main(speed: float | None = 1.0) -> int:
    """Run the prompt until ``(quit)``. Returns the exit status. speed: plan seconds per second at first, ``None`` without a bound."""
    from pyodide.ffi import create_proxy

    kernel.allow_deep_recursion()
    sys.stdout.reconfigure(line_buffering=True)
    sys.stderr.reconfigure(line_buffering=True)
    sys.stdin = PageInput()
    host.interrupt = create_proxy(_interrupt)
    let_import()
    lines = PageLines()

    def make():
        session = Session(time="virtual")
        port = Port(graph.active(), host.say, _later)
        lines.desk = Desk(session, host.answer)
        host.receive, host.ask = create_proxy(port.receive), create_proxy(lines.desk.ask)
        requests.ask_whoever_asked()  # what goes wrong in a check opens no debugger at the prompt
        chronicle.start()
        kernel.pace().set_speed(speed)
        host.ready()
        return session

    return TabConsole(make, lines).run()
