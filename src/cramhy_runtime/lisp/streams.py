"""Streams: where text comes from and where it goes.

A Lisp program prints to a stream, and ``*standard-output*`` may be bound to another one for the extent of a form. So
the runtime's own printing never touches ``sys.stdout``; it writes to an `OutputStream`, which knows the column it is
in: ``fresh-line`` needs it, and so does the pretty printer. `ConsoleOutput` looks its Python file up at every write,
because pytest and REPLs replace ``sys.stdout``. Source: ANSI chapter 21.

Input streams deliver Python strings of one character, and ``""`` at the end. The functions that Lisp programs call
are in ``stream_functions.py``.
"""

from __future__ import annotations

import sys
import weakref

from .dynamic import special
from .late import late
from .packages import Package, find_package, register

for _package, _external in (("SB-SYS", "FD-STREAM"), ("SB-IMPL", ""), ("SB-PRETTY", ""), ("SB-FORMAT", "FORMAT-ERROR")):
    _home = find_package(_package) or register(
        Package(_package)
    )  # SBCL's names of classes, which users see in error messages
    for _name in _external.split():
        _home.export(_home.intern(_name))


class Stream:
    """A source or a sink of characters."""

    lisp_name = "STREAM"
    is_input = False
    is_output = False
    is_pretty = False
    is_interactive = False
    closed = False

    def close(self):
        self.closed = True


class OutputStream(Stream):
    """A sink of text. Subclasses define ``emit(text)``; ``column`` is where the next character goes.

    ``line_length`` is the width of a line in characters, ``None`` when the stream has no opinion.
    """

    is_output = True
    column = 0
    line_length = None

    def write(self, text):
        if not text:
            return
        self.emit(text)
        newline = text.rfind("\n")
        if newline < 0:
            self.column += len(text)
        else:
            self.column = len(text) - newline - 1

    def emit(self, text):
        raise NotImplementedError

    def fresh_line(self):
        """Start a new line unless at the beginning of one; ``True`` when a newline was written."""
        if self.column:
            self.write("\n")
            return True
        return False

    def flush(self):
        """Deliver what was written."""


def _complain_closed(stream):
    condition = late.StreamError(stream)
    condition.report = lambda: f"{late.prin1_to_string(stream)} is closed"
    late.error(condition)


class StringOutputStream(OutputStream):
    """Collects what is written; `take` gives it and starts anew. With ``target``, a string with a fill pointer, it
    goes there.
    """

    lisp_name = "SB-IMPL::STRING-OUTPUT-STREAM"

    def __init__(self, target=None):
        self.parts = []
        self.target = target
        if target is not None:
            text = str(target)
            self.column = len(text) - text.rfind("\n") - 1

    def emit(self, text):
        if self.target is None:
            self.parts.append(text)
            return
        target = self.target
        if target.fill_pointer is not None:
            del target.chars[target.fill_pointer :]
            target.fill_pointer += len(text)
        target.chars.extend(text)

    def text(self):
        """What was written since the last `take`."""
        return "".join(self.parts)

    def take(self):
        text = "".join(self.parts)
        self.parts = []
        self.column = 0
        return text


class FileOutput(OutputStream):
    """Writes to a Python text file (anything with ``write``)."""

    lisp_name = "SB-SYS::FD-STREAM"

    def __init__(self, file, label=None):
        self._file = file
        self.label = label or f"file {getattr(file, 'name', '')}"

    @property
    def file(self):
        return self._file

    def emit(self, text):
        if self.closed:
            _complain_closed(self)
        file = self.file
        if file is not None:
            file.write(text)

    def flush(self):
        file = self.file
        if file is not None and hasattr(file, "flush"):
            file.flush()

    def close(self):
        super().close()
        self.file.close()


class ConsoleOutput(FileOutput):
    """``sys.stdout`` or ``sys.stderr``, whatever it is at the moment."""

    def __init__(self, name, label):
        super().__init__(None, label)
        self.name = name

    @property
    def file(self):
        return getattr(sys, self.name)

    def close(self):
        self.flush()


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


class InputStream(Stream):
    """A source of characters. Subclasses define ``more()``: the next piece of text, ``""`` at the end."""

    is_input = True

    def __init__(self, text=""):
        self._text = text
        self._position = 0

    def more(self):
        return ""

    def _available(self):
        if self._position < len(self._text):
            return True
        piece = self.more()
        if not piece:
            return False
        self._text, self._position = self._text[-1:] + piece, len(self._text[-1:])
        return True

    def read_char(self):
        """The next character, ``""`` at the end."""
        if not self._available():
            return ""
        character = self._text[self._position]
        self._position += 1
        return character

    def peek_char(self):
        """The next character, which stays; ``""`` at the end."""
        return self._text[self._position] if self._available() else ""

    def unread_char(self, character):
        """Put back the character that was read last."""
        if self._position:
            self._position -= 1
        else:
            self._text = character + self._text

    def read_line(self):
        """(line without its newline, whether the text ended before a newline); ``("", True)`` at the end."""
        parts = []
        while self._available():
            end = self._text.find("\n", self._position)
            if end >= 0:
                parts.append(self._text[self._position : end])
                self._position = end + 1
                return "".join(parts), False
            parts.append(self._text[self._position :])
            self._position = len(self._text)
        return "".join(parts), True

    def listen(self):
        """Whether a character can be read without waiting."""
        return self._position < len(self._text)

    def clear(self):
        """Forget what has arrived and was not read."""
        self._position = len(self._text)


class StringInputStream(InputStream):
    """Reads ``text``; ``position`` is the index of the next character."""

    lisp_name = "SB-IMPL::STRING-INPUT-STREAM"

    def __init__(self, text, start=0):
        super().__init__(text)
        self._position = start

    @property
    def position(self):
        return self._position


class FileInput(InputStream):
    """Reads a Python text file line by line."""

    lisp_name = "SB-SYS::FD-STREAM"

    def __init__(self, file, label=None):
        super().__init__()
        self._file = file
        self.label = label or f"file {getattr(file, 'name', '')}"

    def more(self):
        if self.closed:
            _complain_closed(self)
        return self._file.readline()

    def close(self):
        super().close()
        self._file.close()


class ConsoleInput(InputStream):
    """``sys.stdin``, whatever it is at the moment. Other tasks run while it waits for a line."""

    lisp_name = "SB-SYS::FD-STREAM"
    label = "standard input"
    is_interactive = True

    def more(self):
        from cramhy_runtime import kernel

        if sys.stdin is None:
            return ""
        return kernel.run_blocking(sys.stdin.readline)


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


class TwoWayStream(_Delegate):
    """Reads from ``source``, writes to ``sink``."""

    lisp_name = "TWO-WAY-STREAM"

    def __init__(self, source, sink):
        self.source, self.sink = source, sink

    @property
    def is_interactive(self):
        return self.source.is_interactive


class EchoStream(TwoWayStream):
    """As a two-way stream; what is read appears in the output too."""

    lisp_name = "ECHO-STREAM"

    def read_char(self):
        character = self.source.read_char()
        self.sink.write(character)
        return character

    def read_line(self):
        line, ended = self.source.read_line()
        self.sink.write(line if ended else line + "\n")
        return line, ended


class SynonymStream(_Delegate):
    """Stands for the stream that is the value of ``symbol`` at the moment."""

    lisp_name = "SYNONYM-STREAM"

    def __init__(self, symbol):
        self.symbol = symbol

    @property
    def sink(self):
        return output_stream(self.symbol.value)

    @property
    def source(self):
        return input_stream(self.symbol.value)

    @property
    def is_input(self):
        return self.symbol.value.is_input

    @property
    def is_output(self):
        return self.symbol.value.is_output

    @property
    def is_interactive(self):
        return self.symbol.value.is_interactive


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
    if designator is None:
        return STANDARD_OUTPUT.value
    if designator is True:
        return TERMINAL_IO.value
    if hasattr(designator, "write"):
        if designator not in _wrapped:
            _wrapped[designator] = FileOutput(designator)
        return _wrapped[designator]

    return late.type_error(designator, "STREAM")


def input_stream(designator):
    """The input stream that ``designator`` stands for: nil is ``*standard-input*``, t is ``*terminal-io*``."""
    if isinstance(designator, InputStream):
        return designator
    if designator is None:
        return STANDARD_INPUT.value
    if designator is True:
        return TERMINAL_IO.value

    return late.type_error(designator, "STREAM")


def warning_line(condition):
    """Print ``condition`` to ``*error-output*`` as ``warn`` does: ``WARNING: `` and its report on a line of its own."""

    badness = "STYLE-WARNING" if isinstance(condition, late.StyleWarning) else "WARNING"
    late.format_(ERROR_OUTPUT.value, "~&~@<~A: ~3i~:_~A~:>~%", badness, condition)
    output_stream(ERROR_OUTPUT.value).flush()


def ask_for_form(prompt):
    """Print ``prompt`` to ``*query-io*``, read a form from there and return the value of it."""
    from .data import one

    stream = QUERY_IO.value
    stream.fresh_line()
    stream.write(prompt)
    stream.flush()
    return one(late.evaluate(late.read_from_stream(stream)))


def standard_output():
    """The stream that is the value of ``*standard-output*`` now."""
    return output_stream(STANDARD_OUTPUT.value)
