"""``roslisp_repl``: the loop of the prompt, and how a program that fails is reported.

What is done with a text is in ``listener.py``. On a terminal, prompt_toolkit edits the form if it is installed, else readline; from a
pipe, lines are read and nothing is echoed but prompts and answers.
"""

from __future__ import annotations

import sys

from cramhy_runtime import kernel
from cramhy_runtime.languages.commonlisp.streams import streams
from cramhy_runtime.languages.commonlisp.tools.error_reports import condition_of, report
from cramhy_runtime.lisp_core.conditions import Condition

from .line_input import standard_lines
from .listener import Listener
from cramhy_runtime.session.session import Interruption


def exit_status(leaving):
    """The exit status that a SystemExit asks for, as Python understands it: a text is printed, and is a failure."""
    code = leaving.code
    if code is None or isinstance(code, int):
        return code or 0
    print(code, file=sys.stderr)
    return 1


class Console(Listener):
    """The read-eval-print loop. ``make_session`` is called once the prompt is needed. banner: the lines to begin with, or ``""``."""

    def __init__(self, make_session, lines=None, banner=""):
        super().__init__(lines=lines)
        self.make_session = make_session
        self.banner = banner

    def run(self):
        """Until the end of input or ``(quit)``. Returns the exit status."""
        if self.banner:
            streams.CONSOLE_OUTPUT.write(f"{self.banner}\n")
            streams.CONSOLE_OUTPUT.flush()  # it is read while the session is made
        try:
            self.session = self.make_session()
        except (Exception, Condition) as problem:
            report(condition_of(problem))
            return 1
        self.input = self.input or standard_lines()
        try:
            with self.listening():
                self.converse()
            return 0
        except SystemExit as leaving:
            return exit_status(leaving)
        finally:
            kernel.stop()

    def over(self):
        """Whether no more texts are wanted."""
        return False

    def converse(self):
        """Answer one text after the other until the end of input, or until it is `over`."""
        interrupted = False
        while not self.over():
            try:
                if interrupted:  # told here, where another interrupt is heard
                    self.interrupted()
                    interrupted = False
                text = self.read_text(self.session.prompt())
                if text is None:
                    if self.input.interactive:
                        streams.CONSOLE_OUTPUT.write("\n")
                    return
                self.respond(text)
            except kernel.Terminated:
                raise
            except (KeyboardInterrupt, kernel.Abandoned, Interruption):  # between two steps of ours, as while values are printed
                interrupted = True
