"""A connection: what one Emacs says, and what it is told.

Messages come here in the order in which they were sent, in the scheduler (`receive`), where nothing may wait. Each call becomes a
`session.requests.Request`, a task of its own. Calls of the REPL buffer run one after the other, calls of other buffers at once, and
calls of a debugger's buffer in the task that is in the debugger. A message that is wrong is answered with a reason and told in one line
of the log; nothing else happens (law 8).
"""

from __future__ import annotations

import shutil
from collections import deque

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.conditions import Condition
from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.lisp_core.packages import COMMON_LISP_USER
from cramhy_runtime.languages.commonlisp.printer.print_controls import PACKAGE
from cramhy_runtime.session import requests
from cramhy_runtime.session.requests import Mailbox, Request

from . import wire
from .calls import ALL  # noqa: F401  the table of calls is complete from here on
from .debugger import Debugger
from .packages import package_called
from .reasons import reason_of
from .rpcs import Refused, parse
from .wire import Name

MOST_REQUESTS = 200  # of a connection that have not ended; more are refused
REPL = ":repl-thread"
LONGEST_TOLD = 200  # characters of a message that the log shows


class Call:
    """One call while it runs: its connection, its package, and the debugger whose buffer it came from, or ``None``."""

    def __init__(self, connection, package, debugger=None):
        self.connection, self.package_name, self.debugger = connection, package, debugger
        self.session = connection.server.session

    @property
    def package(self):
        """The package of the buffer that the call came from; where that says nothing, or none that exists, the connection's."""
        return self.named_package or self.connection.package

    @property
    def named_package(self):
        """The package of the buffer that the call came from; ``None`` where that says nothing, or none that exists."""
        return package_called(self.package_name) if isinstance(self.package_name, str) else None


class Connection:
    """See the top of this file. server: its `Server`. line: what sends frames (`send`) and ends (`end`)."""

    def __init__(self, server, line):
        self.server, self.line = server, line
        self.package = COMMON_LISP_USER
        self.closed = False
        self.running = {}  # the requests that have not ended → the number of the call
        self.debuggers = {}  # thread → its Debuggers, the innermost last
        self.readers = {}  # tag → the Mailbox of a task that reads a line
        self.tags = 0
        self.presentations, self.presents = None, False  # see `presentations`; whether Emacs wants them
        self.indentation = {}  # see `indentation`
        self._printed = []  # texts that are not sent yet
        self.folders = []  # with files that are needed as long as the connection
        self.inspector = None  # see `inspector`
        self.saved = []  # the object that is copied into the REPL buffer, see `calls.copying`
        self.images = None  # see `images`
        self.trace_reader = None  # see `calls.tracing`
        self.threads = []  # the tasks that the list of threads shows
        self.repl = None  # the Request of the REPL buffer that runs
        self._repl_calls = deque()

    # --------------------------------------------------------------------------------------------------------------- talking

    def send(self, *message):
        """Send ``message``, an event. Strings for symbols are `Name`s."""
        if self._printed:
            self.flush()
        self._send(message)

    def write(self, text):
        """Send ``text``, which a program prints. What is printed in one go is one message."""
        if not self._printed:
            self.server.kernel.post(self.flush)
        self._printed.append(text)

    def flush(self):
        """Send what was printed."""
        text, self._printed = "".join(self._printed), []
        if text:
            self._send((Name(":write-string"), text))

    def _send(self, message):
        if self.closed:
            return
        try:
            data = wire.frame(wire.write(message))
        except wire.FrameError as problem:
            self.log(str(problem))
            data = wire.frame(wire.write((Name(":write-string"), f"; {problem}\n")))
        self.line.send(data)

    def log(self, text):
        """Tell the user of the session a line about this client."""
        self.server.log(text)

    def answer(self, number, value):
        self.send(Name(":return"), (Name(":ok"), value), number)

    def refuse(self, number, reason):
        self.send(Name(":return"), (Name(":abort"), reason), number)

    # -------------------------------------------------------------------------------------------------------------- listening

    def receive(self, data):
        """The bytes of a frame have come. Called in the scheduler."""
        shown = ""
        try:
            shown = wire.text_of(data)
            message = wire.read(shown)
            if not isinstance(message, list) or not isinstance(message[0], Name):
                raise wire.TextError("A message is a list that begins with a name.")
            handle = _EVENTS.get(message[0])
            if handle is None:
                raise wire.TextError(f"There is no message {message[0]}.")
            function, least = handle
            if len(message) - 1 < least:
                raise wire.TextError(f"{message[0]} takes {least} argument{'s'[: least > 1]}, and {len(message) - 1} came.")
            function(self, *message[1:])
        except wire.TextError as problem:
            shown = shown[:LONGEST_TOLD]
            self.log(f"A message of a client was not understood. {problem}")
            self.send(Name(":reader-error"), shown, str(problem))

    def call(self, form, package, thread, number, *_):
        """``:emacs-rex``"""
        if not isinstance(number, int) or isinstance(number, bool):
            raise wire.TextError("The number of a call is a whole number.")
        if len(self.running) >= MOST_REQUESTS:
            return self.refuse(number, f"{MOST_REQUESTS} calls of this client have not ended.")
        try:
            entry, given, named = parse(form)
        except Refused as problem:
            self.log(f"A call of a client was refused. {problem}")
            return self.refuse(number, str(problem))
        work = _Work(self, entry, given, named, package, number)
        if isinstance(thread, int) and not isinstance(thread, bool):
            stack = self.debuggers.get(thread)
            if stack:
                return stack[-1].mailbox.put(work)
        if thread == REPL and entry.evaluates:
            self._repl_calls.append(work)
            return self.next_of_repl()
        return self.start(work)

    def start(self, work):
        request = Request(work.run, work.finished, debugger=work.debug if work.entry.evaluates else _declines, name=work.name, owner=work)
        self.running[request] = work.number
        return request

    def next_of_repl(self):
        if self.repl is None and self._repl_calls and not self.closed:
            self.repl = self.start(self._repl_calls.popleft())

    def interrupt(self, thread=None, *_):
        """``:emacs-interrupt``"""
        if isinstance(thread, int) and not isinstance(thread, bool):
            chosen = [request for request in self.running if request.task.id == thread]
            if not chosen:
                task = next((task for task in kernel.active().tasks if task.id == thread), None)
                request = requests.request_of(task) if task is not None else None
                chosen = [request] if request in self.running else []
        elif thread == REPL:
            chosen = [self.repl] if self.repl is not None else []
        else:
            chosen = [request for request in self.running if request.owner.entry.evaluates][-1:]
        for request in chosen:
            request.interrupt()

    def line_read(self, thread, tag, text=None, *_):
        """``:emacs-return-string``, ``:emacs-return``"""
        mailbox = self.readers.pop(tag, None) if isinstance(tag, int) else None
        if mailbox is not None:
            mailbox.put(text)

    def nothing(self, *_):
        """``:emacs-pong`` and others that need no answer"""

    # ---------------------------------------------------------------------------------------------------------------- reading

    def read_line(self):
        """A line that the user types into the REPL, with its newline; ``""`` if none will come."""
        if self.closed:
            return ""
        self.tags += 1
        tag, mailbox, thread = self.tags, Mailbox(), kernel.current().id
        self.readers[tag] = mailbox
        self.send(Name(":read-string"), thread, tag)
        request = requests.request_of()
        try:
            found = request.wait(mailbox) if request is not None else mailbox.take()
        except BaseException:
            self.send(Name(":read-aborted"), thread, tag)
            raise
        finally:
            self.readers.pop(tag, None)
        return found if isinstance(found, str) else ""

    # ----------------------------------------------------------------------------------------------------------------- ending

    def lost(self):
        """The client is gone. What it asked for is ended, through cleanup. Called in the scheduler."""
        if self.closed:
            return
        self.closed = True
        self._repl_calls.clear()
        for request in list(self.running):
            request.interrupt()
        for folder in self.folders:
            shutil.rmtree(folder, ignore_errors=True)
        self.server.left(self)

    def keep_until_end(self, folder):
        """Remove ``folder`` when the connection ends."""
        self.folders.append(folder)

    def close(self):
        """End the connection."""
        self.lost()
        self.line.end()


class _Work:
    """A call that waits for its turn or runs."""

    def __init__(self, connection, entry, given, named, package, number):
        self.connection, self.entry, self.given, self.named = connection, entry, given, named
        self.package, self.number, self.session = package, number, connection.server.session
        self.name = f"Emacs: {entry.name}"
        self.debugged = None  # the condition that opened the debugger last

    def perform(self, debugger=None):
        call = Call(self.connection, self.package, debugger)
        with binding(PACKAGE, call.package):  # names are shown as the buffer reads them
            return self.entry.function(call, *self.given, **self.named)

    def run(self):
        return self.perform()

    def debug(self, condition):
        Debugger(self.connection, condition, kernel.current()).run()

    def finished(self, request):
        connection = self.connection
        connection.running.pop(request, None)
        if request.outcome == requests.DONE:
            self.answer(request.result)
        elif request.outcome == requests.INTERRUPTED:
            connection.refuse(self.number, "interrupted")
        else:
            self.failed(request.failure)
        if connection.repl is request:
            connection.repl = None
            connection.next_of_repl()

    def answer(self, value):
        try:
            self.connection.answer(self.number, value)
        except TypeError as problem:
            self.failed(problem)

    def failed(self, failure):
        """Tell Emacs that the call failed; a defect of ours is told in the log, too."""
        self.connection.refuse(self.number, reason_of(failure))
        if not isinstance(failure, (Refused, Condition)) and not self.entry.evaluates:
            self.connection.log(f"{self.entry.name} failed. {type(failure).__name__}: {failure}")


def _declines(condition):
    """The debugger of calls that evaluate nothing: their errors go to the echo area."""


_EVENTS = {
    Name(":emacs-rex"): (Connection.call, 4),
    Name(":emacs-interrupt"): (Connection.interrupt, 1),
    Name(":emacs-return-string"): (Connection.line_read, 3),
    Name(":emacs-return"): (Connection.line_read, 3),
    Name(":emacs-pong"): (Connection.nothing, 0),
    Name(":emacs-channel-send"): (Connection.nothing, 0),
    Name(":emacs-skipped-packet"): (Connection.nothing, 0),
    Name(":write-done"): (Connection.nothing, 0),
}
"""The messages of a client: what they do, and how many arguments they have at least."""
