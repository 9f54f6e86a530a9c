"""The messages of Jupyter, answered by a session.

ipykernel reads and writes the messages, in the main thread, which is outside of the plans' kernel meanwhile (`kernel.run_blocking`). What a
message asks for is posted into the kernel and runs there as a `session.requests.Request`, a task of its own (law 4). So the turtle
drives on in wall time while nobody asks for anything. What the tasks have to say is handed to the main thread's loop, in its order.

SIGINT, which Jupyter's stop button sends, interrupts the cell that runs: its plan ends through its cleanup (law 2).
"""

from __future__ import annotations

import asyncio
import getpass
import signal
from fnmatch import fnmatchcase

from traitlets import Any as AnyTrait
from zmq.eventloop.zmqstream import ZMQStream

from cramhy_runtime import __version__, kernel
from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.languages.commonlisp.printer.print_controls import PACKAGE
from cramhy_runtime.session import requests
from cramhy_runtime.session.requests import Mailbox, Request

from . import asking, controls, rich, settings, streams
from .cells import HY, Aborted, Notebook
from .failures import CellDebugger, told_of
from .guard import Guarded, Wrong
from .live import Displays, Live
from .pictures import Watcher
from .plans import Plans
from .plots import Watched

REFUSED = "This kernel has no debugger of Jupyter's. After a cell with %debugger on, an error asks which restart to take."


class CramhyKernel(Guarded):
    """See the top of this file. plans: the session's `kernel.Kernel`; made: the `Session`; end: a function that stops the loop."""

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
    end: AnyTrait = AnyTrait()
    made: AnyTrait = AnyTrait()

    # ------------------------------------------------------------------------------------------------------------ beginning

    def serve(self, loop):
        """Answer messages of the asyncio ``loop`` from now on. To be called with the baton, before the loop runs."""
        self.loop = loop
        self.notebook, self.watcher = Notebook(self.made), Watcher()
        self.watched, self.tasks = Watched(), Plans()
        self.controls = None  # those of ``%pace``, once a cell has shown them
        self.live = True  # whether cells show what they do while they run (%live)
        self.typed = []  # the cells so far, for ``history_request``: a number and a text
        self.comm_manager = controls.serve_widgets(self.shell_handlers)
        self.control_handlers["execute_request"] = self._not_here
        self.guard()
        self.cell = None  # the Request of the cell that runs
        self.asks = False  # whether an error asks what to do (%debugger on)
        self.parent_of_cell = {}
        self.leaving = None  # the status with which a cell has ended the kernel, see `end`
        self._may_ask = False
        self._printed = []  # (stream, text) that the loop has not sent
        self._reads = None  # the Mailbox of a task that reads a line
        self._stdin = ZMQStream(self.stdin_socket)
        self._stdin.on_recv(self._line_came)
        requests.ask_whoever_asked()
        streams.route(self.write, self.read_line, self.show_value)
        getpass.getpass = self.read_password
        signal.signal(signal.SIGINT, lambda number, frame: self.stop_cell())

    def pre_handler_hook(self):
        """SIGINT is ours all the time."""

    post_handler_hook = pre_handler_hook

    def stop_cell(self):
        """Interrupt the cell that runs. Time that is paused goes on, so that its cleanup can end. May be called in a signal handler or
        another thread."""

        def stop():
            if self.cell is None:
                return
            pace = self.plans.clock.pace
            if pace is not None and pace.virtual and pace.paused:
                pace.resume()
                self.follow()
            self.cell.interrupt()

        self.plans.post(stop)

    def ask(self, work, name, debugger=None, cell=False):
        """Do ``work()`` in a task of the session; a future of the finished `Request`. To be called in a loop."""
        loop = asyncio.get_running_loop()  # the control channel has one of its own
        future = loop.create_future()

        def finished(request):
            if self.cell is request:
                self.cell = None
            loop.call_soon_threadsafe(lambda: future.done() or future.set_result(request))

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

    def show_value(self, value):
        """Show ``value``, which a program prints, below the cell; whether it was more than its text."""
        shown = rich.html(value)
        if shown is not None:
            self.say("display_data", {"data": {"text/html": shown, "text/plain": str(value)}, "metadata": {}, "transient": {}})
        return shown is not None

    # ---------------------------------------------------------------------------------------------------------------- input

    def read_password(self, prompt="Password: ", stream=None):
        """``getpass.getpass``: Python's own would ask at Jupyter's terminal."""
        return self.read_line(prompt, password=True).removesuffix("\n")

    def read_line(self, prompt="", password=False):
        """A line that the user types, with its newline; ``""`` where the front end has no input. Called in a task of the session."""
        if not self._may_ask:
            return ""
        mailbox, request = Mailbox(), requests.request_of()
        self.loop.call_soon_threadsafe(lambda: self._ask_line(prompt, password, mailbox))
        try:
            return request.wait(mailbox) if request is not None else mailbox.take()
        finally:
            self._reads = None

    def _ask_line(self, prompt, password, mailbox):
        self._reads = mailbox
        ident, header = self.identity_of_cell, self.parent_of_cell
        self.session.send(self.stdin_socket, "input_request", {"prompt": prompt, "password": password}, header, ident=ident)

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
        if store_history and not silent:
            self.typed.append((self.execution_count, code))
        if (said := settings.parsed(code)) is not None:
            return await self._set(*said, silent)
        ask = (lambda prompt: self.read_line(prompt)) if self.asks and allow_stdin else None
        debugger = CellDebugger(self.made, lambda text: self.write("stderr", text), ask, self._in_hy)
        live = self.live and self._may_ask and not silent
        request = await self.ask(lambda: self._evaluated(code, silent, live), "a cell", debugger, cell=True)
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
        return (await self.ask(lambda: told_of(failure, self._in_hy()), "the report of an error")).result

    def _in_hy(self):
        return self.notebook.answered_in == HY

    def _evaluated(self, code, silent, looked_at):
        displays = Displays(self.say if not silent else lambda kind, content: None, f"cell-{self.ident}-{self.execution_count}")
        with Live(displays, self.watcher, self.watched, self.tasks, self.follow).during(looked_at):
            try:
                values = self.notebook.evaluate(code)
            except kernel.Terminated:
                raise
            except SystemExit as leaving:
                self.leaving = leaving.code or 0
                values = []
        if not silent:
            with binding(PACKAGE, self.notebook.package):
                shown = rich.bundle(values, self.notebook.shown, self.watched)
            if shown is not None:
                self.say("execute_result", {"execution_count": self.execution_count, "data": shown, "metadata": {}})

    def follow(self):
        if self.controls is not None:
            self.controls.follow()

    def _ok(self, expressions):
        payload = [] if self.leaving is None else [{"source": "ask_exit", "keepkernel": False}]  # as IPython says it
        return {"status": "ok", "execution_count": self.execution_count, "payload": payload, "user_expressions": expressions}

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

    def answered(self):
        """A message has been answered: when a cell has ended the kernel (``(exit)``), the loop stops now, and then the plans end."""
        if self.leaving is not None:
            self.end()

    # ------------------------------------------------------------------------------------------------------------- settings

    async def _set(self, name, rest, silent):
        """A cell that sets something: ``%name rest``."""
        try:
            settings.check(name, rest)
            data = await _SETTERS[name](self, rest)
        except settings.Refused as problem:
            return self._error("WrongSetting", str(problem), [str(problem)], silent)
        if data is not None and not silent:
            self._say("display_data", {"data": data, "metadata": {}, "transient": {}}, self.parent_of_cell)
        return self._ok({})

    async def done(self, work):
        """The result of ``work()``, done in a task of the session. What goes wrong is a `settings.Refused`."""
        request = await self.ask(work, "a setting", cell=True)
        if request.outcome == requests.DONE:
            return request.result
        problem = request.failure or Aborted("The setting was interrupted.")
        raise settings.Refused(str(problem) if isinstance(problem, (ValueError, Aborted)) else (await self._told(problem)).text)

    # ------------------------------------------------------------------------------------------------------------- the keys

    async def do_complete(self, code, cursor_pos):
        """``complete_request``"""
        cursor = max(0, min(cursor_pos, len(code)))
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
        cursor = max(0, min(cursor_pos, len(code)))
        request = await self.ask(lambda: asking.inspected(self.notebook, code, cursor), "inspection")
        told = request.result
        return {"status": "ok", "found": bool(told), "data": {"text/plain": told} if told else {}, "metadata": {}}

    async def do_is_complete(self, code):
        """``is_complete_request``"""
        request = await self.ask(lambda: self.notebook.completeness(code), "a look at parentheses")
        status = request.result or "unknown"
        return {"status": status, "indent": "  "} if status == "incomplete" else {"status": status}

    async def do_history(self, hist_access_type, output, raw, session=None, start=None, stop=None, n=None, pattern=None, unique=False):
        """``history_request``: the cells of this kernel, whose session has the number 0."""
        cells = self.typed
        if hist_access_type == "range":
            cells = [cell for cell in cells if (start or 0) <= cell[0] and (stop is None or cell[0] < stop)]
        elif hist_access_type == "search":
            cells = [cell for cell in cells if fnmatchcase(cell[1], pattern or "*")]
        if unique:
            cells = list({text: (number, text) for number, text in cells}.values())
        if hist_access_type != "range" and n is not None:
            cells = cells[-n:] if n > 0 else []
        return {"status": "ok", "history": [(0, number, (text, None) if output else text) for number, text in cells]}

    # ---------------------------------------------------------------------------------------------------------- other messages

    @property
    def kernel_info(self):
        """What ``kernel_info_request`` is told. Neither subshells nor a debugger of Jupyter's are offered."""
        return {**super().kernel_info, "supported_features": []}

    async def _not_here(self, stream, ident, parent):
        raise Wrong("Cells are run by messages on the shell channel, one after the other.")

    async def interrupt_request(self, stream, ident, parent):
        """``interrupt_request``: as the signal, for front ends that send a message instead."""
        self.stop_cell()
        self.session.send(stream, "interrupt_reply", {"status": "ok"}, parent, ident=ident)

    async def do_debug_request(self, msg):
        """``debug_request``: it is refused, in the form of the Debug Adapter Protocol."""
        command, number = msg.get("command"), msg.get("seq", 0)
        return {"type": "response", "request_seq": number, "success": False, "command": command, "message": REFUSED, "body": {}}

    async def create_subshell_request(self, stream, ident, parent):
        """``create_subshell_request``: one cell runs at a time, so there is one shell."""
        raise Wrong("This kernel has one shell, in which cells run one after the other.")

    delete_subshell_request = list_subshell_request = create_subshell_request

    # -------------------------------------------------------------------------------------------------------------- the end

    async def do_shutdown(self, restart):
        """``shutdown_request``: the plans end through their cleanup when the loop has stopped."""
        self.stop_cell()
        return {"status": "ok", "restart": restart}


# ----------------------------------------------------------------------------------------------------------------- settings


async def _set_debugger(notebook_kernel, word):
    notebook_kernel.asks = word == "on"


async def _set_live(notebook_kernel, word):
    notebook_kernel.live = word == "on"


async def _set_time(notebook_kernel, word):
    await notebook_kernel.done(lambda: (kernel.set_clock(word), notebook_kernel.follow()))


async def _set_watch(notebook_kernel, forms):
    if forms == "off":
        return await notebook_kernel.done(notebook_kernel.watched.end)
    await notebook_kernel.done(lambda: notebook_kernel.watched.watch(notebook_kernel.notebook.values_of(forms)))
    return None


async def _set_pace(notebook_kernel, _):
    try:
        if notebook_kernel.controls is None:
            notebook_kernel.controls = controls.Controls(notebook_kernel.plans.post, notebook_kernel.loop.call_soon_threadsafe)
    except ImportError:
        raise settings.Refused(settings.NO_WIDGETS) from None
    await notebook_kernel.done(notebook_kernel.controls.follow)
    return notebook_kernel.controls.bundle()


_SETTERS = {"debugger": _set_debugger, "live": _set_live, "time": _set_time, "watch": _set_watch, "pace": _set_pace}
"""What each setting does: a function of the kernel and of what stands behind the name of the setting."""
