"""Where programs print and read while a notebook is open: below the cell that they run for.

What a task prints that no cell has started, a node's callback say, goes below the cell that ran last.
"""

from __future__ import annotations

import functools
import sys

from cramhy_runtime import kernel
from cramhy_runtime.languages.commonlisp.streams import streams
from cramhy_runtime.languages.commonlisp.streams.python_files import InputFile, OutputFile


class CellOutput(streams.OutputStream):
    """Output for a notebook. name: ``"stdout"`` or ``"stderr"``. write: a function of that name and a text. show: a function that shows
    a value as more than its text, if it can, and returns whether it has."""

    label = "the notebook"

    def __init__(self, name, write, show):
        self.name, self._write, self.show = name, write, show

    def emit(self, text):
        self._write(self.name, text)

    def flush(self):
        """What is printed is sent as it comes."""


class CellInput(streams.InputStream):
    """Input for a notebook: a line that its user types. read_line: a function that gives it with its newline, ``""`` if none comes."""

    label = "the notebook"
    is_interactive = True

    def __init__(self, read_line):
        super().__init__()
        self.more = read_line


def route(write, read_line, show):
    """Let the standard streams of Lisp, and the standard files of Python, lead to a notebook, from now on."""
    output = CellOutput("stdout", write, show)
    streams.STANDARD_OUTPUT.value = streams.TRACE_OUTPUT.value = output
    streams.ERROR_OUTPUT.value = CellOutput("stderr", write, show)
    streams.STANDARD_INPUT.value = CellInput(read_line)
    streams.TERMINAL_IO.value = streams.TwoWayStream(streams.STANDARD_INPUT.value, output)
    sys.stdout, sys.stderr = (OutputFile(functools.partial(write, name)) for name in ("stdout", "stderr"))
    sys.stdin = InputFile(lambda: read_line() if kernel.holds_baton() else "")
