"""Where the prompt's lines come from: a terminal, with the editing of prompt_toolkit or of readline where they are installed, or a pipe.

A terminal that cannot draw, such as a buffer of Emacs (``M-x run-lisp``), gets no editor: it would write escape sequences, and echo what
the buffer shows already.

A line that was typed is never lost, whatever Ctrl-C comes when (law 8). So nothing here is broken off by an exception in the middle: an
interrupt wakes the wait (`Lines.wake`), and the wait returns `BROKEN_OFF`. A line that was read is kept until the console has taken it
(`Lines.taken`), since the kernel may raise an interrupt while it is on its way. And what is typed keeps its order: Ctrl-C after a line,
but before the form runs, interrupts the form, and what was typed ahead stays.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from contextlib import nullcontext

from cramhy_runtime.kernel.standard_input import BrokenOff, StandardInput
from cramhy_runtime.kernel.terminals import draws
from cramhy_runtime.languages.commonlisp.streams import streams

BROKEN_OFF = object()
"""What comes instead of a line when the wait for it was ended."""


def standard_lines():
    """The lines of standard input."""
    if sys.stdin is None:
        return NoLines()
    if sys.stdin.isatty() and draws(sys.stdout):
        for editor in (_edited_lines, _readline_lines):
            try:
                return editor()
            except ImportError:
                pass  # the terminal's own line editing will do
    return PlainLines()


def _edited_lines():
    from .edited_lines import EditedLines

    return EditedLines()


def _readline_lines():
    from .readline_lines import LispLines

    return LispLines()


class Lines:
    """A source of lines. ``interactive``: whether a person types them. ``can_be_woken``: whether `wake` ends a wait. ``pressed``: whether
    Ctrl-C was pressed after the line that was read, before the form runs that it is for. ``ended``: whether the terminal has ended the line
    that was broken off, so that the next prompt stands below it. ``shows_open``: whether the prompt of a line that goes on with a form says
    what is open; in a pipe and in Emacs' ``run-lisp`` these prompts would stand in a heap in front of the answer. ``before``: the lines
    before this one of the form that is being typed. ``edits``: whether keys such as TAB do something. ``sent``: the last line, if an editor
    has sent it: its text, the path of the file, and the line and column, from 1, where it begins there. ``heed``: is asked where a form
    stays open at the end of a line: given the lines, it says what to tell, or ``None``, and whether the last line is to be forgotten."""

    interactive = False
    shows_open = False
    before: Sequence[str] = ()
    edits = False
    sent: tuple[str, str, int, int] | None = None
    heed: Callable[[list[str]], tuple[str | None, bool]] | None = None
    can_be_woken = True
    pressed = False
    ended = False

    def __init__(self):
        self._kept = []

    def line(self, prompt):
        """The next line without its end; ``None`` at the end of input, `BROKEN_OFF` when it was woken before."""
        if not self._kept:
            streams.CONSOLE_OUTPUT.fresh_line()
            streams.CONSOLE_OUTPUT.flush()
            found = self.wait(prompt)
            if found is BROKEN_OFF:
                return found
            self._kept.append(found)
        return self._kept[0]

    def taken(self):
        """The console has the line that `line` has returned."""
        self._kept.clear()

    def take_pressed(self):
        """Whether Ctrl-C is meant for the form that comes now; it is dealt with by that."""
        pressed, self.pressed = self.pressed, False
        return pressed

    def press(self):
        """Ctrl-C was pressed after the line that was read."""
        self.pressed = True

    def prepare(self, at_prompt):
        """A wait is about to begin. at_prompt: whether it is that of the prompt, and not that of the debugger of a plan's task."""

    def remember(self, text):
        """Keep ``text``, whole forms, in the history, if there is one."""

    def choosing(self, condition, restarts):
        """A context in which the debugger of ``condition`` asks for lines, one of which may be the number of one of ``restarts``."""
        return nullcontext()

    def wake(self):
        """End the wait that goes on. May be called by a signal handler, and by any thread."""

    def dealt_with(self):
        """The console has dealt with what this was woken for. A line that is being typed is forgotten."""

    def wait(self, prompt):
        """As `line`, for a line that is not there yet."""
        raise NotImplementedError


class NoLines(Lines):
    """Standard input is closed."""

    def wait(self, prompt):
        return None


class PlainLines(Lines):
    """Lines of a pipe or a file, or of a terminal that edits them itself."""

    def __init__(self):
        super().__init__()
        self.interactive = sys.stdin.isatty()
        self.can_be_woken = isinstance(sys.stdin, StandardInput)
        self.shows_open = self.interactive and draws(sys.stdout)

    def wait(self, prompt):
        try:
            with sys.stdin.at_prompt(self.press) if self.can_be_woken else nullcontext():
                sys.stdout.write(prompt)  # and not into the transcript, where it comes with the line
                sys.stdout.flush()
                streams.CONSOLE_OUTPUT.column = 0
                line = sys.stdin.readline()
        except BrokenOff:
            return BROKEN_OFF
        return line.rstrip("\n") if line else None

    def wake(self):
        if self.can_be_woken:
            sys.stdin.wake()

    def dealt_with(self):
        if self.can_be_woken:
            sys.stdin.forget_wake()
            sys.stdin.forget_unfinished_line()
