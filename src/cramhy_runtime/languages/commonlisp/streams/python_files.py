"""Python's standard files in terms of a session's streams: `print` writes, and `input` reads, where Lisp does.

A program in Python or Hy uses ``sys.stdout``, ``sys.stderr`` and ``sys.stdin``, and their ``buffer`` for bytes. An answer that leaves the
session as a message (JSON, SLIME, Jupyter) has to contain what these print, too.
"""

from __future__ import annotations

import codecs
import io

ENCODING = "utf-8"


class OutputFile(io.TextIOBase):
    """A text file to write to. write: a function of a text. descriptor: the number of the system's file behind it, or ``None``."""

    encoding, errors = ENCODING, "replace"

    def __init__(self, write, descriptor=None):
        self._write, self._descriptor = write, descriptor
        self.buffer = _Bytes(self)

    def write(self, text):
        if not isinstance(text, str):
            raise TypeError(f"write() argument must be str, not {type(text).__name__}")
        if text:
            self._write(text)
        return len(text)

    def fileno(self):
        return super().fileno() if self._descriptor is None else self._descriptor

    def writable(self):
        return True

    def close(self):
        """The session goes on printing."""


class _Bytes(io.BufferedIOBase):
    """The binary file below an `OutputFile`."""

    def __init__(self, file):
        self._file = file
        self._decoder = codecs.getincrementaldecoder(ENCODING)("replace")

    def write(self, data):
        self._file.write(self._decoder.decode(bytes(data)))
        return len(data)

    def fileno(self):
        return self._file.fileno()

    def writable(self):
        return True

    def close(self):
        """As above."""


class InputFile(io.TextIOBase):
    """A text file to read from. read_line: a function that gives a line with its newline, ``""`` at the end of the input."""

    encoding, errors = ENCODING, "replace"

    def __init__(self, read_line):
        self._read_line, self._rest = read_line, ""

    def readline(self, size=-1):
        line = self._rest or self._read_line()
        size = len(line) if size is None or size < 0 else size
        self._rest = line[size:]
        return line[:size]

    def read(self, size=-1):
        found = ""
        size = -1 if size is None else size
        while size < 0 or len(found) < size:
            line = self.readline(size - len(found) if size >= 0 else -1)
            if not line:
                break
            found += line
        return found

    @property
    def buffer(self):
        """All that is left, as a binary file."""
        return io.BytesIO(self.read().encode(ENCODING))

    def readable(self):
        return True

    def close(self):
        """The session goes on reading."""
