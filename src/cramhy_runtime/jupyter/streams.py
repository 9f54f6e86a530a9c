"""Where programs print and read while a notebook is open: below the cell that they run for.

What a task prints that no cell has started, a node's callback say, goes below the cell that ran last.
"""

from __future__ import annotations

from cramhy_runtime.languages.commonlisp.streams import streams


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


class PythonOutput:
    """Standard output for code in Python and Hy. write: as for `CellOutput`."""

    encoding, errors = "utf-8", "replace"

    def __init__(self, name, write):
        self.name, self._write = name, write

    def write(self, text):
        if text:
            self._write(self.name, str(text))
        return len(text)

    def writelines(self, lines):
        for line in lines:
            self.write(line)

    def flush(self):
        """What is printed is sent as it comes."""

    def isatty(self):
        return False

    def writable(self):
        return True

    def readable(self):
        return False


def route(write, read_line, show):
    """Let the standard streams of Lisp lead to a notebook, from now on."""
    output = CellOutput("stdout", write, show)
    streams.STANDARD_OUTPUT.value = streams.TRACE_OUTPUT.value = output
    streams.ERROR_OUTPUT.value = CellOutput("stderr", write, show)
    streams.STANDARD_INPUT.value = CellInput(read_line)
    streams.TERMINAL_IO.value = streams.TwoWayStream(streams.STANDARD_INPUT.value, output)
