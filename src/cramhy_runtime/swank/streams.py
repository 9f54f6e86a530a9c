"""Where programs print and read while somebody is connected: in the REPL buffer of the Emacs whose request they belong to.

What a task prints that no request has started, a node's callback say, goes where it went before; if the session has no prompt of its own,
to the Emacs that connected last. Python's ``sys.stdout``, ``sys.stderr`` and ``sys.stdin`` go the same ways, for `print` and `input`.
What child processes print goes where the session was started.
"""

from __future__ import annotations

import io
import sys

from cramhy_runtime import kernel
from cramhy_runtime.languages.commonlisp.streams import streams
from cramhy_runtime.languages.commonlisp.streams.python_files import InputFile, OutputFile
from cramhy_runtime.session.requests import request_of

FILES = {"stdout": streams.STANDARD_OUTPUT, "stderr": streams.ERROR_OUTPUT, "stdin": streams.STANDARD_INPUT}
VARIABLES = (streams.STANDARD_OUTPUT, streams.ERROR_OUTPUT, streams.TRACE_OUTPUT)


class RoutedOutput(streams.OutputStream):
    """Output for whoever asked. fallback: the stream for all others. server: whose connections are meant."""

    label = "the REPL of Emacs"

    def __init__(self, server, fallback, alone):
        self.server, self.fallback, self.alone = server, fallback, alone

    def target(self):
        """The connection that what is printed now belongs to, or ``None``."""
        request = request_of()
        connection = getattr(request.owner, "connection", None) if request is not None else None
        if connection is not None and not connection.closed:
            return connection
        return self.server.connections[-1] if self.alone and self.server.connections else None

    def emit(self, text):
        connection = self.target()
        if connection is None:
            self.fallback.write(text)
        else:
            connection.write(text)

    def flush(self):
        self.fallback.flush()


class RoutedInput(streams.InputStream):
    """Input from whoever asked: a line that is typed into the REPL buffer."""

    label = "the REPL of Emacs"
    is_interactive = True

    def __init__(self, output, fallback):
        super().__init__()
        self.output, self.fallback = output, fallback

    def more(self):
        connection = self.output.target()
        return self.fallback.more() if connection is None else connection.read_line()


class RoutedFile:
    """``sys.stdout``, ``sys.stderr`` or ``sys.stdin`` for whoever asked. before: the file for all others, which it passes for."""

    def __init__(self, output, before):
        self.output, self.before = output, before

    def connection(self):
        """The connection that the code that runs belongs to, or ``None``. Other threads than that of the plans write to the last one."""
        if kernel.holds_baton():
            return self.output.target()
        server = self.output.server
        return server.connections[-1] if self.output.alone and server.connections else None

    def fileno(self):
        """The number of the file below; none for Emacs, so that Python does not look for a terminal there."""
        if self.connection() is not None:
            raise io.UnsupportedOperation("fileno")
        return self.before.fileno()

    @property
    def buffer(self):
        return self._file().buffer

    @property
    def __class__(self):
        return self.before.__class__

    def __getattr__(self, name):
        return getattr(self.before, name)

    def __iter__(self):
        return iter(self.readline, "")


class RoutedOutputFile(RoutedFile):
    """``sys.stdout`` or ``sys.stderr``. variable: the one of Lisp whose stream it follows where a form of Emacs has bound it."""

    def __init__(self, output, before, variable):
        super().__init__(output, before)
        self.variable = variable

    def _file(self):
        connection = self.connection()
        if connection is None:
            return self.before
        bound = self.variable.value if kernel.holds_baton() else None
        collects = isinstance(bound, streams.OutputStream) and not isinstance(bound, (RoutedOutput, streams.ConsoleOutput))
        return OutputFile(bound.write if collects else connection.write)

    def write(self, text):
        return self._file().write(text)

    def writelines(self, lines):
        self._file().writelines(lines)


class RoutedInputFile(RoutedFile):
    """``sys.stdin``."""

    def _file(self):
        connection = self.output.target() if kernel.holds_baton() else None
        return self.before if connection is None else InputFile(connection.read_line)

    def readline(self, size=-1):
        return self._file().readline(size)

    def read(self, size=-1):
        return self._file().read(size)

    def readlines(self, hint=-1):
        return self._file().readlines(hint)


def route(server, alone):
    """Let the standard streams lead to whoever asked, from now on. alone: whether the session has no prompt of its own."""
    for variable in VARIABLES:
        if not isinstance(variable.value, RoutedOutput) or variable.value.server.closed:
            variable.value = RoutedOutput(server, before(variable.value), alone)
    if not isinstance(streams.STANDARD_INPUT.value, RoutedInput):
        output = streams.STANDARD_OUTPUT.value
        streams.STANDARD_INPUT.value = RoutedInput(output, streams.STANDARD_INPUT.value)
        streams.TERMINAL_IO.value = streams.TwoWayStream(streams.STANDARD_INPUT.value, output)
    for name in FILES:
        file = getattr(sys, name)
        if file is not None and not is_routed(file):
            output = RoutedOutput(server, None, alone)
            setattr(sys, name, RoutedInputFile(output, file) if name == "stdin" else RoutedOutputFile(output, file, FILES[name]))


def is_routed(file):
    """Whether ``file`` is one of ours. It passes for another, so only its type tells."""
    return issubclass(type(file), RoutedFile)


def before(stream):
    """The stream that a routed one stands for, or ``stream`` itself."""
    return stream.fallback if isinstance(stream, (RoutedOutput, RoutedInput)) else stream


def route_no_more(server):
    """Let the standard streams be what they were before the server."""
    for variable in (*VARIABLES, streams.STANDARD_INPUT):
        stream = variable.value
        owner = stream.output.server if isinstance(stream, RoutedInput) else getattr(stream, "server", None)
        if owner is server:
            variable.value = before(stream)
            if variable is streams.STANDARD_INPUT:
                streams.TERMINAL_IO.value = streams.TwoWayStream(streams.CONSOLE_INPUT, streams.CONSOLE_OUTPUT)
    for name in FILES:
        file = getattr(sys, name)
        if is_routed(file) and file.output.server is server:
            setattr(sys, name, file.before)
