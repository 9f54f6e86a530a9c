"""Where programs print and read while somebody is connected: in the REPL buffer of the Emacs whose request they belong to.

What a task prints that no request has started, a node's callback say, goes where it went before; if the session has no prompt of its own,
to the Emacs that connected last.
"""

from __future__ import annotations

from cramhy_runtime.languages.commonlisp.streams import streams
from cramhy_runtime.session.requests import request_of

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


def route(server, alone):
    """Let the standard streams lead to whoever asked, from now on. alone: whether the session has no prompt of its own."""
    for variable in VARIABLES:
        if not isinstance(variable.value, RoutedOutput) or variable.value.server.closed:
            variable.value = RoutedOutput(server, before(variable.value), alone)
    if not isinstance(streams.STANDARD_INPUT.value, RoutedInput):
        output = streams.STANDARD_OUTPUT.value
        streams.STANDARD_INPUT.value = RoutedInput(output, streams.STANDARD_INPUT.value)
        streams.TERMINAL_IO.value = streams.TwoWayStream(streams.STANDARD_INPUT.value, output)


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
