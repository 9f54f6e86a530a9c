"""What forms of ``cramhy eval`` print and read, in whatever way: through Lisp's streams, Python's files, or the system's.

Standard output has one answer in JSON a line, and nothing else. So while a form is evaluated, the descriptors 1 and 2 lead into a file
without a name, from which the text is taken up in the order in which it was written. That goes for child processes and for libraries in C,
too. A child that lives on writes into the next answer. Between forms both descriptors lead to standard error. Descriptor 0 has nothing to
read at all: the lines of standard input are requests.
"""

from __future__ import annotations

import codecs
import os
import sys
import tempfile
from contextlib import contextmanager

from cramhy_runtime.kernel.standard_input import StandardInput
from cramhy_runtime.languages.commonlisp.streams import streams
from cramhy_runtime.languages.commonlisp.streams.python_files import InputFile, OutputFile


class Descriptors:
    """The descriptors 0, 1 and 2 of this process, turned aside until `restore`. ``requests``: what was standard input."""

    def __init__(self):
        self._file = tempfile.TemporaryFile()
        self._taken = 0
        self._decoder = codecs.getincrementaldecoder("utf-8")("replace")
        for file in (sys.stdout, sys.stderr):
            file.flush()
        self._before = [os.dup(number) for number in range(3)]
        source = open(self._before[0], encoding="utf-8", errors="replace", closefd=False)
        self.requests = StandardInput(source) if isinstance(sys.stdin, StandardInput) else source
        with open(os.devnull, "rb") as nothing:
            os.dup2(nothing.fileno(), 0)
        self.to_errors()

    def to_answer(self):
        """Lead what is written from now on into the answer."""
        os.dup2(self._file.fileno(), 1)
        os.dup2(self._file.fileno(), 2)

    def to_errors(self):
        """Lead what is written from now on to standard error."""
        os.dup2(self._before[2], 1)
        os.dup2(self._before[2], 2)

    def new_text(self):
        """What has been written into the answer since this was asked last."""
        size = os.fstat(self._file.fileno()).st_size
        if size == self._taken:
            return ""
        data = os.pread(self._file.fileno(), size - self._taken, self._taken)
        self._taken += len(data)
        return self._decoder.decode(data)

    @contextmanager
    def answering(self):
        """During the block descriptor 1 is standard output."""
        os.dup2(self._before[1], 1)
        try:
            yield
        finally:
            os.dup2(self._before[2], 1)

    def restore(self):
        """Make all as it was before. What nobody has taken up goes to standard error."""
        for number, before in enumerate(self._before):
            os.dup2(before, number)
            os.close(before)
        if late := self.new_text():
            sys.__stderr__.write(late)
            sys.__stderr__.flush()
        self._file.close()


@contextmanager
def turned_aside():
    """During the block nothing is printed to standard output but answers. Yields the `Descriptors`, ``None`` where the standard files of
    Python are not those of the system."""
    before = sys.stdin, sys.stdout
    try:
        ours = sys.stdin.fileno() == 0 and sys.stdout.fileno() == 1 and hasattr(os, "pread")
    except (AttributeError, OSError, ValueError):
        ours = False
    descriptors = Descriptors() if ours else None
    sys.stdin, sys.stdout = InputFile(lambda: ""), OutputFile(sys.stderr.write, 1)
    try:
        yield descriptors
    finally:
        sys.stdin, sys.stdout = before
        if descriptors is not None:
            descriptors.restore()


class Printed(streams.StringOutputStream):
    """All that is printed while a form is evaluated. descriptors: `Descriptors`, or ``None``."""

    def __init__(self, descriptors=None):
        super().__init__()
        self._descriptors = descriptors
        if descriptors is not None:
            self.write = self._write

    def _write(self, text):
        self._take_up()
        self.parts.append(text)

    def _take_up(self):
        if self._descriptors is not None and (text := self._descriptors.new_text()):
            self.parts.append(text)

    def fresh_line(self):
        self._take_up()
        return super().fresh_line()

    def take(self):
        self._take_up()
        return super().take()

    @contextmanager
    def collecting(self):
        """During the block all that is printed comes here, and nothing can be read."""
        nothing = streams.StringInputStream("")
        wanted = {
            streams.STANDARD_OUTPUT: self,
            streams.ERROR_OUTPUT: self,
            streams.TRACE_OUTPUT: self,
            streams.STANDARD_INPUT: nothing,
            streams.TERMINAL_IO: streams.TwoWayStream(nothing, self),
        }
        lisp = {variable: variable.value for variable in wanted}
        python = sys.stdin, sys.stdout, sys.stderr
        for variable, stream in wanted.items():
            variable.value = stream
        sys.stdin = InputFile(lambda: "")
        sys.stdout, sys.stderr = (OutputFile(self.write, self._descriptors and number) for number in (1, 2))
        if self._descriptors is not None:
            self._descriptors.to_answer()
        try:
            yield
        finally:
            if self._descriptors is not None:
                self._descriptors.to_errors()
            sys.stdin, sys.stdout, sys.stderr = python
            for variable, stream in lisp.items():
                variable.value = stream
