"""Where the prompt's lines come from: a terminal, with prompt_toolkit's editing where it is installed, or a pipe.

A line that was typed is never lost, whatever Ctrl-C comes when (law 8). So nothing here is broken off by an exception in the middle: an
interrupt wakes the wait (`Lines.wake`), and the wait returns `BROKEN_OFF`. A line that was read is kept until the console has taken it
(`Lines.taken`), since the kernel may raise an interrupt while it is on its way. And what is typed keeps its order: Ctrl-C after a line,
but before the form runs, interrupts the form, and what was typed ahead stays.
"""

from __future__ import annotations

import sys
from contextlib import contextmanager, nullcontext

from cramhy_runtime.kernel.standard_input import BrokenOff, StandardInput, drop_unfinished
from cramhy_runtime.kernel.terminals import ctrl_c_as_a_key, draws, typed_ahead
from cramhy_runtime.languages.commonlisp.streams import streams

BROKEN_OFF = object()
"""What comes instead of a line when the wait for it was ended."""


def standard_lines():
    """The lines of standard input."""
    if sys.stdin is None:
        return NoLines()
    if sys.stdin.isatty():
        try:
            return EditedLines()
        except ImportError:
            pass  # the terminal's own line editing will do
    return PlainLines()


class Lines:
    """A source of lines. ``interactive``: whether a person types them. ``can_be_woken``: whether `wake` ends a wait. ``pressed``: whether
    Ctrl-C was pressed after the line that was read, before the form runs that it is for. ``ended``: whether the terminal has ended the line
    that was broken off, so that the next prompt stands below it. ``shows_open``: whether the prompt of a line that goes on with a form says
    what is open; in a pipe and in Emacs' ``run-lisp`` these prompts would stand in a heap in front of the answer."""

    interactive = False
    shows_open = False
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

    def remember(self, text):
        """Keep ``text``, whole forms, in the history, if there is one."""

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


class EditedLines(Lines):
    """Lines that prompt_toolkit edits. Raises ImportError when it is not installed."""

    interactive = True

    def __init__(self):
        from prompt_toolkit.history import InMemoryHistory

        from .completion import completer

        super().__init__()
        self._editor = _session_class()(history=InMemoryHistory(), completer=completer(), complete_while_typing=False)
        self._editor.begun = self._begun
        self._woken = False
        self._loop = self._application = None  # in which the editor runs, and what it runs there

    def wait(self, prompt):
        if self._woken:
            self._woken = False
            return BROKEN_OFF
        try:
            with ctrl_c_as_a_key(self._editor.input.fileno()):  # before the prompt stands there
                line = self._editor.prompt(prompt, pre_run=lambda: self._begun(self._editor.app), handle_sigint=False)
        except KeyboardInterrupt:  # the key, or `wake`
            self._woken = False
            return BROKEN_OFF
        except (EOFError, OSError):  # the user ends the session, or the terminal was closed
            return None
        finally:
            self._loop = None
        self._look_for_ctrl_c()
        return line

    def _begun(self, application):
        import asyncio

        self._application, self._loop = application, asyncio.get_running_loop()
        if self._woken:
            self._leave()

    def _leave(self):
        application = self._application
        if application.is_running and application.future is not None and not application.future.done():
            application.exit(exception=KeyboardInterrupt())

    def wake(self):
        self._woken = True
        loop = self._loop
        if loop is not None:
            try:
                loop.call_soon_threadsafe(self._leave)
            except RuntimeError:
                pass  # it is closed: the line was read

    def dealt_with(self):
        self._woken = False

    def _look_for_ctrl_c(self):
        """The editor reads keys in advance, and a key that is pressed before the terminal makes signals again sends none. If Ctrl-C is
        among these keys it is for the form that comes now."""
        from prompt_toolkit.input.typeahead import get_typeahead, store_typeahead
        from prompt_toolkit.keys import Keys

        source = self._editor.input
        keys = get_typeahead(source)
        with typed_ahead(source.fileno()):
            keys += source.read_keys() + source.flush_keys()
        pressed = [index for index, key in enumerate(keys) if key.key == Keys.ControlC]
        if pressed:
            keys = drop_unfinished(keys[: pressed[-1]], lambda key: key.key in (Keys.ControlM, Keys.ControlJ)) + keys[pressed[-1] + 1 :]
            keys = [key for key in keys if key.key != Keys.ControlC]
        store_typeahead(source, keys)
        if pressed:
            self.press()


def _session_class():
    """prompt_toolkit's `PromptSession`, which calls ``begun`` with its application when that has begun to run. A terminal that cannot move
    its cursor gets an application of its own for each line."""
    from prompt_toolkit import PromptSession

    class Session(PromptSession):
        begun = None

        @contextmanager
        def _dumb_prompt(self, *arguments):
            with super()._dumb_prompt(*arguments) as application:
                application.pre_run_callables.append(lambda: self.begun(application))
                yield application

    return Session
