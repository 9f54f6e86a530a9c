"""Lines that GNU readline edits, form by form in its history. Ctrl-C and the Tab key are ours.

Ctrl-C at a prompt was sometimes missed. Python lets readline print the prompt, and then waits for a key; a signal that comes between the
two does not end the wait, so nothing happened until the next key. (Pressed as soon as the prompt was there, up to eleven of fifty were
missed.) So at our prompts Ctrl-C makes no signal. It is a key, for which readline writes the character into the line and enters it, and
we take such a line for one that was broken off.

One thing is left: Ctrl-C that reaches the terminal together with the Enter before it, as only a program types, is a character for the
terminal still, and waits there until the form has ended. prompt_toolkit lets us look at such keys (`EditedLines`), readline does not.
"""

from __future__ import annotations

import sys
from contextlib import contextmanager

from cramhy_runtime.kernel.patient_calls import own_input
from cramhy_runtime.kernel.standard_input import StandardInput
from cramhy_runtime.kernel.terminals import INTERRUPT, ctrl_c_as_a_key
from cramhy_runtime.languages.commonlisp.streams import streams

from cramhy_runtime.session.completion import completions
from .file_names import begun_string, file_names
from .history import History, place
from .line_input import BROKEN_OFF, PlainLines

LISP_DELIMITERS = " \t\n()`,;"
"""What ends a word for GNU readline. If quotes were among them, it would close them behind a word that it has completed."""

_INSERT, _ENTER = r"\e[cramhy-insert", r"\e[cramhy-enter"  # keys that no keyboard has, since users may have given others another meaning
_CTRL_C = (f'"{_INSERT}": quoted-insert', f'"{_ENTER}": accept-line', rf'"\C-c": "{_INSERT}\C-c{_ENTER}"')
_BINDINGS = ("$if mode=vi", "set keymap vi-command", *_CTRL_C, "set keymap vi-insert", "$endif", *_CTRL_C)


class ReadlineLines(PlainLines):
    """Lines that readline edits. tab: completes them, a `Tab`. ``history``: the `History` that they are kept in, or ``None`` for that of
    readline alone.

    Two lines are edited by the terminal, in a wait that can be woken: one for the debugger of a plan's task, which may run in a thread of
    its own, and one of which READ-LINE of a form has read the beginning, as when many lines were pasted.
    """

    def __init__(self, tab):
        super().__init__()
        self._tab = tab
        tab.lines = self
        self._bound = None  # the readline that knows our key
        self.history = None

    @property
    def edits(self):
        return _readline() is not None

    def prepare(self, at_prompt):
        ours = isinstance(sys.stdin, StandardInput) and sys.stdin.isatty()
        self.can_be_woken = ours and (not at_prompt or sys.stdin.holds_text())

    def ask(self, prompt):
        """The next line, which Python lets readline edit."""
        return own_input(prompt)

    def remember(self, text):
        readline, text = _readline(), text.strip("\n")
        if self.history is not None and not self.history.add(text) or readline is None:
            return
        last = readline.get_current_history_length()
        if text.strip() and not (last and readline.get_history_item(last) == text):
            readline.add_history(text)

    @contextmanager
    def keep(self, history):
        """While the block runs, what is typed is kept in ``history``, and readline brings back its forms and no others."""
        readline = sys.modules["readline"]
        before = [readline.get_history_item(number + 1) for number in range(readline.get_current_history_length())]
        self._recall(readline, history.forms)
        self.history = history
        try:
            yield
        finally:
            self.history = None
            self._recall(readline, before)

    @staticmethod
    def _recall(readline, forms):
        readline.clear_history()
        for form in forms:
            readline.add_history(form)

    def wait(self, prompt):
        self.ended = False
        if self.can_be_woken:
            return super().wait(prompt)
        streams.CONSOLE_OUTPUT.column = 0
        readline = _readline()
        try:
            return self.ask(prompt) if readline is None else self._edited(readline, prompt)
        except EOFError:
            return None

    def _edited(self, readline, prompt):
        """The next line by way of ``readline``, Python's module."""
        before = readline.get_completer(), readline.get_completer_delims()
        readline.set_completer(self._tab.complete)
        readline.set_completer_delims(self._tab.delimiters())
        readline.set_auto_history(False)  # of forms, and not of lines: see `remember`
        try:
            if "libedit" in (readline.__doc__ or ""):  # it has no macros; there Ctrl-C stays a signal
                return self.ask(prompt)
            if self._bound is not readline:
                self._bound = readline
                for line in _BINDINGS:
                    readline.parse_and_bind(line)
            with ctrl_c_as_a_key(sys.stdin.fileno()):  # before the prompt stands there
                line = self.ask(prompt)
        finally:
            readline.set_completer(before[0])
            readline.set_completer_delims(before[1])
            readline.set_auto_history(True)
        if INTERRUPT not in line:
            return line
        self.ended = True
        return BROKEN_OFF


class Tab:
    """The completer of a prompt of Lisp, for ``readline.set_completer``. ``lines``: the `Lines` that it completes."""

    lines = None

    def __init__(self):
        self._found = []

    def delimiters(self):
        return LISP_DELIMITERS

    def complete(self, word, state):
        """The candidate number ``state`` for ``word``, the text before the cursor up to a delimiter; ``None`` behind the last one."""
        if state == 0:
            import readline

            line = readline.get_line_buffer()[: readline.get_endidx()]
            self._found = self.found("\n".join([*self.lines.before, line]), word)
        return self._found[state] if state < len(self._found) else None

    def found(self, text, word):
        """All that ``word``, the last one of ``text``, may become."""
        files = in_string(text, word)
        if files is not None:
            return files
        found, length = completions(text)
        return [name for name, _ in found] if length == len(word) else []


def in_string(text, word, hy=False, folder=None):
    """What ``word``, the last one of ``text``, may become if it stands in a string; else ``None``. hy, folder: as of `file_names`."""
    typed = begun_string(text, hy)
    if typed is None:
        return None
    before = text[: len(text) - len(typed)]
    return [f"{before}{name}"[len(text) - len(word) :] for name in file_names(typed, folder)]


class LispLines(ReadlineLines):
    """Lines of a prompt of Lisp, with the history that all sessions share. Raises ImportError where there is no readline."""

    def __init__(self):
        import readline

        super().__init__(Tab())
        readline.parse_and_bind("tab: complete")
        readline.parse_and_bind("set blink-matching-paren on")
        self.history = History(place("lisp-history"))
        self._recall(readline, self.history.forms)


def _readline():
    """Python's module, if it edits the lines of the terminal: it is loaded, and ``input`` uses it only between two terminals."""
    try:
        on_a_terminal = sys.stdin.isatty() and sys.stdout.isatty() and sys.stdin.fileno() == 0 and sys.stdout.fileno() == 1
    except (AttributeError, OSError, ValueError):
        return None
    return sys.modules.get("readline") if on_a_terminal else None


__all__ = ["LISP_DELIMITERS", "LispLines", "ReadlineLines", "Tab", "in_string"]
