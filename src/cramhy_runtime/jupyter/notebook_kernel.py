"""The messages of Jupyter, answered by a session.

ipykernel reads and writes the messages, in the main thread, which is outside of the plans' kernel meanwhile (`kernel.run_blocking`). What a
message asks for is posted into the kernel and runs there as a `session.requests.Request`, a task of its own (law 4). So the turtle
drives on in wall time while nobody asks for anything. What the tasks have to say is handed to the main thread's loop, in its order.

SIGINT, which Jupyter's stop button sends, interrupts the cell that runs: its plan ends through its cleanup (law 2).
"""

from __future__ import annotations

import signal
import sys

from ipykernel.kernelbase import Kernel
from traitlets import Any as AnyTrait
from zmq.eventloop.zmqstream import ZMQStream

from cramhy_runtime import __version__
from cramhy_runtime.ground.dynamic import binding
from cramhy_runtime.languages.commonlisp.printer.print_controls import PACKAGE
from cramhy_runtime.session import requests
from cramhy_runtime.session.requests import Mailbox, Request

from . import asking, rich, streams
from .cells import Aborted, Notebook
from .failures import CellDebugger, told_of
from .pictures import Watcher


class CramhyKernel(Kernel):
    """See the top of this file. plans: the session's `kernel.Kernel`; made: the `Session`."""

    implementation = "cramhy"
    implementation_version = __version__
    banner = f"cramhy {__version__}: CRAM's plan language, in Common Lisp and Hy"
    language_info = {
        "name": "common-lisp",
        "mimetype": "text/x-common-lisp",
        "file_extension": ".lisp",
        "pygments_lexer": "common-lisp",
        "codemirror_mode": "commonlisp",
    }
    help_links = [{"text": "Common Lisp", "url": "https://www.lispworks.com/documentation/HyperSpec/Front/"}]

    plans: AnyTrait = AnyTrait()
    made: AnyTrait = AnyTrait()

    # ------------------------------------------------------------------------------------------------------------ beginning

    def serve(self, loop):
        """Answer messages of the asyncio ``loop`` from now on. To be called with the baton, before the loop runs."""
        self.loop = loop
        self.notebook, self.watcher = Notebook(self.made), Watcher()
        self.cell = None  # the Request of the cell that runs
        self.asks = False  # whether an error asks what to do (%debugger on)
        self.parent_of_cell = {}
        self._may_ask = False
        self._printed = []  # (stream, text) that the loop has not sent
        self._reads = None  # the Mailbox of a task that reads a line
        self._stdin = ZMQStream(self.stdin_socket)
        self._stdin.on_recv(self._line_came)
        requests.ask_whoever_asked()
        streams.route(self.write, self.read_line)
        sys.stdout, sys.stderr = streams.PythonOutput("stdout", self.write), streams.PythonOutput("stderr", self.write)
        signal.signal(signal.SIGINT, lambda number, frame: self.stop_cell())

    def pre_handler_hook(self):
        """SIGINT is ours all the time."""

    post_handler_hook = pre_handler_hook

    def stop_cell(self):
        """Interrupt the cell that runs. May be called in a signal handler or another thread."""
        self.plans.post(lambda: self.cell.interrupt() if self.cell is not None else None)

    def ask(self, work, name, debugger=None, cell=False):
        """Do ``work()`` in a task of the session; a future of the finished `Request`. To be called in the loop."""
        future = self.loop.create_future()

        def finished(request):
            if self.cell is request:
                self.cell = None
            self.loop.call_soon_threadsafe(lambda: future.done() or future.set_result(request))

        def begin():
            request = Request(work, finished, debugger=debugger or (lambda condition: None), name=name, owner=self)
            if cell:
                self.cell = request

        self.plans.post(begin)
        return future

    # --------------------------------------------------------------------------------------------------------------- output

    def say(self, kind, content):
        """Send a message of the cell to all who look on. May be called in any thread."""
        parent = self.parent_of_cell
        self.loop.call_soon_threadsafe(lambda: self._say(kind, content, parent))

    def _say(self, kind, content, parent):
        self.session.send(self.iopub_socket, kind, content, parent, ident=self._topic(kind))

    def write(self, name, text):
        """Send ``text``, which a program prints, to the stream ``name``. What is printed in one go is one message."""
        first = not self._printed
        self._printed.append((name, text))
        if first:
            parent = self.parent_of_cell
            self.loop.call_soon_threadsafe(lambda: self._send_printed(parent))

    def _send_printed(self, parent):
        printed, self._printed = self._printed, []
        while printed:
            name, texts = printed[0][0], []
            while printed and printed[0][0] == name:
                texts.append(printed.pop(0)[1])
            if text := "".join(texts):
                self._say("stream", {"name": name, "text": text.encode("utf-8", "replace").decode()}, parent)

    # ---------------------------------------------------------------------------------------------------------------- input

    def read_line(self, prompt=""):
        """A line that the user types, with its newline; ``""`` where the front end has no input. Called in a task of the session."""
        if not self._may_ask:
            return ""
        mailbox, request = Mailbox(), requests.request_of()
        self.loop.call_soon_threadsafe(lambda: self._ask_line(prompt, mailbox))
        try:
            return request.wait(mailbox) if request is not None else mailbox.take()
        finally:
            self._reads = None

    def _ask_line(self, prompt, mailbox):
        self._reads = mailbox
        ident, header = self.identity_of_cell, self.parent_of_cell
        self.session.send(self.stdin_socket, "input_request", {"prompt": prompt, "password": False}, header, ident=ident)

    def _line_came(self, parts):
        try:
            _, parts = self.session.feed_identities(parts)
            value = self.session.deserialize(parts)["content"]["value"]
        except Exception as problem:  # whatever a client sends
            self.log.error("A line of input was not understood: %s", problem)
            return
        mailbox, self._reads = self._reads, None
        if mailbox is not None:
            self.plans.post(lambda: mailbox.put(f"{value}\n"))

    # ---------------------------------------------------------------------------------------------------------------- cells

    async def do_execute(self, code, silent, store_history=True, user_expressions=None, allow_stdin=False, *, cell_meta=None, cell_id=None):
        """``execute_request``"""
        self.parent_of_cell, self.identity_of_cell = self.get_parent("shell"), self._shell_parent_ident.get()
        self._may_ask = bool(allow_stdin)
        code = _text(code)
        if (said := self._setting(code)) is not None:
            return self._setting_reply(said, silent)
        ask = (lambda prompt: self.read_line(prompt)) if self.asks and allow_stdin else None
        debugger = CellDebugger(self.made, lambda text: self.write("stderr", text), ask)
        request = await self.ask(lambda: self._evaluated(code, silent), "a cell", debugger, cell=True)
        self._send_printed(self.parent_of_cell)
        if request.outcome == requests.DONE:
            return self._ok(await self._expressions(user_expressions))
        if request.outcome == requests.INTERRUPTED:
            return self._error("Interrupted", "The cell was interrupted. Its plan has been cleaned up.", [], silent)
        if isinstance(request.failure, Aborted):
            return self._error("Aborted", "The cell was left by its restart.", [], silent)
        told = debugger.told if debugger.told is not None else await self._told(request.failure)
        return self._error(told.name, told.text, told.lines, silent)

    async def _told(self, failure):
        return (await self.ask(lambda: told_of(failure), "the report of an error")).result

    def _evaluated(self, code, silent):
        self.watcher.begin()
        try:
            values = self.notebook.evaluate(code)
            with binding(PACKAGE, self.notebook.package):
                shown = None if silent else rich.bundle(values, self.notebook.shown)
        finally:
            if not silent:
                for picture in self.watcher.pictures():
                    self.say("display_data", {"data": picture, "metadata": {}, "transient": {}})
        if shown is not None:
            self.say("execute_result", {"execution_count": self.execution_count, "data": shown, "metadata": {}})

    def _ok(self, expressions):
        return {"status": "ok", "execution_count": self.execution_count, "payload": [], "user_expressions": expressions}

    def _error(self, name, text, lines, silent):
        content = {"ename": name, "evalue": text, "traceback": lines or [f"; {text}"]}
        if not silent:
            self._say("error", content, self.parent_of_cell)
        return {"status": "error", "execution_count": self.execution_count, **content}

    async def _expressions(self, wanted):
        """The answers to ``user_expressions``: forms beside a cell."""
        answers = {}
        for name, form in (wanted or {}).items():
            request = await self.ask(lambda form=form: rich.bundle(self.notebook.evaluate(str(form)), self.notebook.shown), "an expression")
            if request.outcome == requests.DONE:
                answers[name] = {"status": "ok", "data": request.result or {}, "metadata": {}}
            else:
                told = await self._told(request.failure or Aborted("interrupted"))
                answers[name] = {"status": "error", "ename": told.name, "evalue": told.text, "traceback": told.lines}
        return answers

    # ------------------------------------------------------------------------------------------------------------- settings

    def _setting(self, code):
        """The words of a cell that is a setting, ``%debugger on`` or ``%time wall``; else ``None``."""
        words = code.split()
        return words if len(words) == 2 and words[0] in SETTINGS and words[1] in SETTINGS[words[0]] else None

    def _setting_reply(self, words, silent):
        if words[0] == "%debugger":
            self.asks = words[1] == "on"
        else:
            from cramhy_runtime import kernel

            self.plans.post(lambda: kernel.set_clock(words[1]))
        return self._ok({})

    # ------------------------------------------------------------------------------------------------------------- the keys

    async def do_complete(self, code, cursor_pos):
        """``complete_request``"""
        code = _text(code)
        cursor = len(code) if not isinstance(cursor_pos, int) else max(0, min(cursor_pos, len(code)))
        request = await self.ask(lambda: asking.completed(self.notebook, code, cursor), "completion")
        names, known, start = request.result or ([], [], cursor)
        kinds = [
            {"start": start, "end": cursor, "text": name, "type": "operator" if what else "", "signature": what}
            for name, what in zip(names, known)
        ]
        found = {"matches": names, "cursor_start": start, "cursor_end": cursor, "status": "ok"}
        return {**found, "metadata": {"_jupyter_types_experimental": kinds}}

    async def do_inspect(self, code, cursor_pos, detail_level=0, omit_sections=()):
        """``inspect_request``"""
        code = _text(code)
        cursor = len(code) if not isinstance(cursor_pos, int) else max(0, min(cursor_pos, len(code)))
        request = await self.ask(lambda: asking.inspected(self.notebook, code, cursor), "inspection")
        told = request.result
        return {"status": "ok", "found": bool(told), "data": {"text/plain": told} if told else {}, "metadata": {}}

    async def do_is_complete(self, code):
        """``is_complete_request``"""
        request = await self.ask(lambda: self.notebook.completeness(_text(code)), "a look at parentheses")
        status = request.result or "unknown"
        return {"status": status, "indent": "  "} if status == "incomplete" else {"status": status}

    # -------------------------------------------------------------------------------------------------------------- the end

    async def do_shutdown(self, restart):
        """``shutdown_request``: the plans end through their cleanup when the loop has stopped."""
        self.stop_cell()
        return {"status": "ok", "restart": restart}


def _text(code):
    """The text of a cell; what a client sends instead of one counts as an empty cell."""
    return code if isinstance(code, str) else ""


SETTINGS = {"%debugger": ("on", "off"), "%time": ("virtual", "wall")}
"""Cells that set something, and the words behind them."""

__all__ = ["SETTINGS", "CramhyKernel"]
