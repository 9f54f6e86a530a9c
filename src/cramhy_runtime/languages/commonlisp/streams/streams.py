"""Streams made of other streams, the console, and the variables that hold the standard ones.

A Lisp program prints to a stream, and ``*standard-output*`` may be bound to another one for the extent of a form. So
the runtime's own printing never touches ``sys.stdout``; it writes to an output stream. `ConsoleOutput` looks its Python file
up at every write, because pytest and REPLs replace ``sys.stdout``. Source: ANSI chapter 21.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.equality import equal
from cramhy_runtime.lisp_core.condition_types import UnboundVariable
from cramhy_runtime.lisp_core.conditions import error
from cramhy_runtime.lisp_core.conditions import type_error
import sys
import weakref

from cramhy_runtime.kernel import standard_input
from cramhy_runtime.kernel.reports import write_shown
from cramhy_runtime.kernel.terminals import readable

from cramhy_runtime.lisp_core.data import UNBOUND, lisp_list
from cramhy_runtime.lisp_core.dynamic import special
from cramhy_runtime.lisp_core.packages import is_symbol, sym
from .basic_streams import (
    FdStream,
    FileOutput,
    InputStream,
    OutputStream,
    Stream,
    StringInputStream,
    StringOutputStream,
    StringStream,
    complain_closed,
    misused,
)

__all__ = ["FdStream", "FileOutput", "InputStream", "OutputStream", "Stream", "StringInputStream", "StringOutputStream", "StringStream"]


class ConsoleOutput(FileOutput):
    """``sys.stdout`` or ``sys.stderr``, whatever it is at the moment. ``copies``: streams that get everything, too (``dribble``)."""

    def __init__(self, name, label):
        super().__init__(None, label)
        self.name = name
        self.copies = []

    def emit(self, text):
        if self.closed:
            complain_closed(self)
        if self.file is not None:
            write_shown(self.file, text)
        self.record(text)

    def record(self, text):
        """Write only to the copies: what the user typed stands on the terminal already."""
        for stream in self.copies:
            stream.write(text)

    @property
    def file(self):
        return getattr(sys, self.name)

    def close(self, abort=False):
        self.flush()


def write_byte(byte, stream):
    """Write ``byte`` to a stream of which another stream made of it is part; a character stream takes none."""
    if not hasattr(stream, "write_byte"):
        return misused(stream, "binary output")
    return stream.write_byte(byte)


class BroadcastStream(OutputStream):
    """Writes everything to each of ``streams``; to nowhere when there are none."""

    lisp_name = "BROADCAST-STREAM"

    def __init__(self, *streams):
        self.streams = streams

    @property
    def column(self):
        return self.streams[-1].column if self.streams else 0

    def write(self, text):
        for stream in self.streams:
            stream.write(text)

    def fresh_line(self):
        return any([stream.fresh_line() for stream in self.streams])

    def flush(self):
        for stream in self.streams:
            stream.flush()

    def close(self, abort=False):
        self.closed, self.write = True, lambda text: complain_closed(self)

    def element_type(self):
        return self.streams[-1].element_type() if self.streams else True

    def external_format(self):
        return self.streams[-1].external_format() if self.streams else sym(":DEFAULT")

    def position(self):
        return self.streams[-1].position() if self.streams else 0

    def write_byte(self, byte):
        for stream in self.streams:
            write_byte(byte, stream)


class ConsoleInput(InputStream, FdStream):
    """``sys.stdin``, whatever it is at the moment. Other tasks run while it waits for a line."""

    label = "standard input"

    @property
    def is_interactive(self):
        return sys.stdin is not None and sys.stdin.isatty()

    def more(self):
        if sys.stdin is None:
            return ""
        return standard_input.read_line(sys.stdin)

    def listen(self):
        if super().listen():
            return True
        if isinstance(sys.stdin, standard_input.StandardInput):
            return self.is_interactive and sys.stdin.ready()
        return self.is_interactive and bool(readable(sys.stdin, 0))

    def close(self, abort=False):
        """The console stays open: the prompt needs it."""

    def external_format(self):
        return sym(":UTF-8")


class ConcatenatedStream(InputStream):
    """Reads ``streams`` one after the other."""

    lisp_name = "CONCATENATED-STREAM"

    def __init__(self, *streams):
        super().__init__()
        self.streams = list(streams)

    def more(self):
        while self.streams:
            character = self.streams[0].read_char()
            if character:
                return character
            self.streams.pop(0)
        return ""

    def listen(self):
        while not super().listen() and self.streams:
            if self.streams[0].listen():
                return True
            if self.streams[0].is_interactive or self.streams[0].peek_char():
                return False
            self.streams.pop(0)
        return super().listen()

    def read_byte(self):
        while self.streams:
            byte = self.streams[0].read_byte()
            if byte is not None:
                return byte
            self.streams.pop(0)
        return None

    def element_type(self):
        return self.streams[0].element_type() if self.streams else None


class _Delegate(OutputStream, InputStream):
    """A stream that hands everything on to the streams ``sink`` and ``source``."""

    def __init__(self):
        pass

    @property
    def column(self):
        return self.sink.column

    @property
    def line_length(self):
        return self.sink.line_length

    def write(self, text):
        self.sink.write(text)

    def fresh_line(self):
        return self.sink.fresh_line()

    def flush(self):
        self.sink.flush()

    def read_char(self):
        return self.source.read_char()

    def peek_char(self):
        return self.source.peek_char()

    def unread_char(self, character):
        self.source.unread_char(character)

    def read_line(self):
        return self.source.read_line()

    def listen(self):
        return self.source.listen()

    def clear(self):
        self.source.clear()

    def read_byte(self):
        return self.source.read_byte()

    def write_byte(self, byte):
        write_byte(byte, self.sink)


class TwoWayStream(_Delegate):
    """Reads from ``source``, writes to ``sink``."""

    lisp_name = "TWO-WAY-STREAM"

    def __init__(self, source, sink):
        self.source, self.sink = source, sink

    @property
    def is_interactive(self):
        return self.source.is_interactive

    def element_type(self):
        mine, other = self.source.element_type(), self.sink.element_type()
        return mine if equal(mine, other) else lisp_list(sym("AND"), mine, other)

    def close(self, abort=False):
        # the streams behind it stay open
        self.closed = True
        self.write = self.read_char = self.peek_char = self.read_line = lambda *rest: complain_closed(self)


class EchoStream(TwoWayStream):
    """As a two-way stream; what is read appears in the output too."""

    lisp_name = "ECHO-STREAM"

    returned = False

    def read_char(self):
        character = self.source.read_char()
        if self.returned:  # it was echoed when it was read first
            self.returned = False
        else:
            self.sink.write(character)
        return character

    def unread_char(self, character):
        self.returned = True
        self.source.unread_char(character)

    def read_line(self):
        line, ended = self.source.read_line()
        shown = line if ended else line + "\n"
        self.sink.write(shown[1:] if self.returned else shown)
        self.returned = False
        return line, ended

    def read_byte(self):
        byte = self.source.read_byte()
        if byte is not None:
            self.sink.write_byte(byte)
        return byte


class SynonymStream(_Delegate):
    """Stands for the stream that is the value of ``symbol`` at the moment."""

    lisp_name = "SYNONYM-STREAM"

    def __init__(self, symbol):
        self.symbol = symbol

    @property
    def sink(self):
        return output_stream(self.stream)

    @property
    def source(self):
        return input_stream(self.stream)

    @property
    def stream(self):
        value = getattr(self.symbol, "value", self.symbol)  # NIL and T are their own values
        if not isinstance(value, Stream):
            return type_error(value, "STREAM") if value is not UNBOUND else error(UnboundVariable(self.symbol))
        return value

    def element_type(self):
        return self.stream.element_type()

    def external_format(self):
        return self.stream.external_format()

    def position(self):
        return self.stream.position()

    def set_position(self, position):
        return self.stream.set_position(position)

    @property
    def pathname(self):
        return self.stream.pathname

    @property
    def is_input(self):
        return self.stream.is_input

    @property
    def is_output(self):
        return self.stream.is_output

    @property
    def is_interactive(self):
        return self.stream.is_interactive


CONSOLE_OUTPUT = ConsoleOutput("stdout", "standard output")
CONSOLE_ERROR = ConsoleOutput("stderr", "standard error")
CONSOLE_INPUT = ConsoleInput()


STANDARD_OUTPUT = special("*STANDARD-OUTPUT*", CONSOLE_OUTPUT)
STANDARD_INPUT = special("*STANDARD-INPUT*", CONSOLE_INPUT)
ERROR_OUTPUT = special("*ERROR-OUTPUT*", CONSOLE_ERROR)
TRACE_OUTPUT = special("*TRACE-OUTPUT*", CONSOLE_OUTPUT)
TERMINAL_IO = special("*TERMINAL-IO*", TwoWayStream(CONSOLE_INPUT, CONSOLE_OUTPUT))
QUERY_IO = special("*QUERY-IO*", SynonymStream(TERMINAL_IO))
DEBUG_IO = special("*DEBUG-IO*", SynonymStream(TERMINAL_IO))

_wrapped: weakref.WeakKeyDictionary = weakref.WeakKeyDictionary()


def output_stream(designator):
    """The output stream that ``designator`` stands for: nil is ``*standard-output*``, t is ``*terminal-io*``.

    A Python text file is wrapped, once, so that its column is known.
    """
    if isinstance(designator, OutputStream):
        return designator
    if designator is None or designator is True:
        stream = STANDARD_OUTPUT.value if designator is None else TERMINAL_IO.value
        if isinstance(stream, OutputStream):
            return stream
        return type_error(stream, "STREAM") if is_symbol(stream) else output_stream(stream)
    if isinstance(designator, Stream):
        return misused(designator, "character output")
    if hasattr(designator, "write"):
        if designator not in _wrapped:
            _wrapped[designator] = FileOutput(designator)
        return _wrapped[designator]

    return type_error(designator, "STREAM")


def input_stream(designator):
    """The input stream that ``designator`` stands for: nil is ``*standard-input*``, t is ``*terminal-io*``."""
    if isinstance(designator, InputStream):
        return designator
    if designator is None or designator is True:
        stream = STANDARD_INPUT.value if designator is None else TERMINAL_IO.value
        if isinstance(stream, InputStream):
            return stream
        return type_error(stream, "STREAM") if is_symbol(stream) else input_stream(stream)
    if isinstance(designator, Stream):
        return misused(designator, "character input")
    return type_error(designator, "STREAM")


def standard_output():
    """The stream that is the value of ``*standard-output*`` now."""
    return output_stream(STANDARD_OUTPUT.value)
