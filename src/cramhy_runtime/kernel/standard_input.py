"""Standard input whose wait for a line can be ended, by a signal handler or another thread, without loss of input.

Python's own `sys.stdin` waits in a system call, which only an exception can break off; then input that was read already is lost.
This one waits for two things at once, input and a pipe of its own (`wake`), and moves input into its buffer before any code looks. It
takes the place of `sys.stdin` (`install`), so that the prompt and READ-LINE in a form share one buffer.

On a terminal it can keep Ctrl-C in its place among the typed lines (`at_prompt`). Otherwise the terminal makes a signal of the key, which
overtakes lines that were typed before, and throws them away. So at the prompt the key ends a line, as Enter does, and the line says so.

It needs `select` on files. Where only sockets can be selected, as on Windows, Python's own standard input stays.
"""

import codecs
import io
import os
import select
import sys
from contextlib import contextmanager

from .active import run_blocking, woken_by, yield_
from .terminals import INTERRUPT, ctrl_c_as_a_key, readable, typed_ahead

CHUNK = 65536


class BrokenOff(Exception):
    """`StandardInput.wake` ended the wait for a line."""


class StandardInput(io.TextIOBase):
    """A stream of the lines of the text file FILE, which must have a file descriptor."""

    def __init__(self, file):
        self._file = file
        self._fd = file.fileno()
        self._text = ""
        self.reconfigure(file.encoding, file.errors)
        self._ended = self._woken = self._interrupted = False
        self._gone = False  # nothing will ever come again
        self._bell, self._ring = os.pipe()
        for end in (self._bell, self._ring):
            os.set_blocking(end, False)
        select.select([self._fd, self._bell], [], [], 0)  # an error where only sockets can be waited for
        self._keys = False  # whether Ctrl-C comes as a character

    def reconfigure(self, encoding="utf-8", errors="replace"):
        """Decode bytes with ENCODING from now on. A byte that is not valid becomes a replacement character."""
        decoder = codecs.getincrementaldecoder(encoding or "utf-8")("replace" if errors == "strict" else errors)
        self._decoder = io.IncrementalNewlineDecoder(decoder, translate=True)

    encoding = property(lambda self: self._file.encoding)
    errors = property(lambda self: self._file.errors)
    name = property(lambda self: self._file.name)

    def fileno(self):
        return self._fd

    def isatty(self):
        return self._file.isatty()

    def readable(self):
        return True

    def wake(self):
        """End the present wait for a line, or the next one. Safe from signal handlers and from any thread."""
        self._woken = True
        try:
            os.write(self._ring, b"!")
        except OSError:
            pass  # the pipe is full, or closed: it is awake

    def forget_wake(self):
        """Cancel a `wake` that is dealt with already."""
        self._woken = False

    def readline(self, size=-1):
        """The next line with its end, or "" at the end of the input. Raises `BrokenOff` if it is woken before there is one."""
        while True:
            if self._woken:
                self._woken = False
                self._empty_pipe()
                raise BrokenOff
            line = self._take_line(size)
            if line is not None:
                return line
            self._wait()

    def read(self, size=-1):
        """All input that is left, or SIZE characters."""
        while not self._ended and (size < 0 or len(self._text) < size):
            self._wait()
        size = len(self._text) if size < 0 else size
        taken, self._text = self._text[:size], self._text[size:]
        return taken

    def ready(self):
        """Whether input can be read without a wait."""
        return bool(self._text) or self._ended or bool(readable(self._fd, 0))

    def holds_text(self):
        """Whether the buffer holds input. Other readers of the same file would not see it."""
        return bool(self._text)

    def _take_line(self, size):
        end = self._text.find("\n") + 1
        if not end and not self._ended:
            return None
        end = end or len(self._text)
        if 0 <= size < end:
            end = size
        line, self._text = self._text[:end], self._text[end:]
        if not line:
            self._ended = self._gone  # at a terminal the key that ends the input ends one read
        return line

    def _wait(self):
        ready, _, _ = select.select([self._fd, self._bell], [], [])
        if self._bell in ready:
            self._woken = True  # first what was asked, then what was typed
        elif self._fd in ready:
            self._fill()

    def _fill(self):
        try:
            data = os.read(self._fd, CHUNK)
        except BlockingIOError:
            return
        except OSError:  # the terminal was closed
            data, self._gone = b"", True
        self._ended = not data
        self._gone = self._gone or self._ended and not self.isatty()
        self._text += self._decoder.decode(data, self._ended)
        if self._keys and INTERRUPT in self._text:
            before, _, after = self._text.rpartition(INTERRUPT)
            self._text = drop_unfinished(before, "\n".__eq__).replace(INTERRUPT, "") + after
            self._interrupted = self._woken = True

    def _empty_pipe(self):
        try:
            while os.read(self._bell, CHUNK):
                pass
        except OSError:
            pass  # it is empty

    # ------------------------------------------------------------------------------------------------------------ terminals

    @contextmanager
    def at_prompt(self, pressed):
        """While the block waits for a line, Ctrl-C wakes it in the order of the typed lines. If the key was pressed after the line that
        the block has read, but before the terminal makes a signal of it again, PRESSED is called."""
        if not self.isatty():
            yield
            return
        self._keys, self._interrupted = True, False
        try:
            with ctrl_c_as_a_key(self._fd, end_of_line=True):
                yield
        finally:
            self._interrupted = False  # it was for the line
            while not self._ended and readable(self._fd, 0):
                self._fill()
            self._keys = False
            if self._interrupted:
                self._woken = False
                pressed()

    def forget_unfinished_line(self):
        """Throw away an unfinished line on the terminal, because Ctrl-C was pressed."""
        if self.isatty():
            with typed_ahead(self._fd):
                while not self._ended and readable(self._fd, 0):
                    self._fill()
            self._text = drop_unfinished(self._text, "\n".__eq__)


def drop_unfinished(typed, is_end):
    """TYPED, a text or a list of keys, up to the last one that ends a line: at Ctrl-C the rest is forgotten."""
    end = len(typed)
    while end and not is_end(typed[end - 1]):
        end -= 1
    return typed[:end]


def install():
    """Make `sys.stdin` a `StandardInput` if that is possible, and return `sys.stdin`."""
    if not isinstance(sys.stdin, StandardInput):
        try:
            sys.stdin = StandardInput(sys.stdin)
        except (AttributeError, OSError, ValueError):  # there is none, or none of the system's
            pass
    return sys.stdin


def read_line(file):
    """The next line of the text file FILE, or "" at its end. Other tasks run while the current one waits for it. An interrupt ends the
    wait without loss of a line where FILE has a method ``wake``, as a `StandardInput` has."""
    if not hasattr(file, "wake"):
        return run_blocking(file.readline)

    def line():
        try:
            return file.readline()
        except BrokenOff:
            return None

    with woken_by(file.wake):
        while (found := run_blocking(line)) is None:
            yield_()
        return found
