"""The lines that a REPL of Hy reads: GNU readline edits them, as Hy has set it up. Ctrl-C and the Tab key are ours.

Ctrl-C at a prompt was sometimes missed. Python lets readline print the prompt, and then waits for a key; a signal that comes between the
two does not end the wait, so nothing happened until the next key. (Pressed as soon as the prompt was there, up to eleven of fifty were
missed.) So at our prompts Ctrl-C makes no signal. It is a key, for which readline writes the character into the line and enters it, and
we take such a line for one that was broken off.
"""

from __future__ import annotations

import sys

from cramhy_runtime.kernel.terminals import INTERRUPT, ctrl_c_as_a_key
from cramhy_runtime.languages.commonlisp.streams import streams

from .hy_completion import Tab
from .line_input import BROKEN_OFF, PlainLines

_INSERT, _ENTER = r"\e[cramhy-insert", r"\e[cramhy-enter"  # keys that no keyboard has, since users may have given others another meaning
_CTRL_C = (f'"{_INSERT}": quoted-insert', f'"{_ENTER}": accept-line', rf'"\C-c": "{_INSERT}\C-c{_ENTER}"')
_BINDINGS = ("$if mode=vi", "set keymap vi-command", *_CTRL_C, "set keymap vi-insert", "$endif", *_CTRL_C)


class HyLines(PlainLines):
    """Lines that a REPL of Hy reads, with Hy's own line editing. in_lisp: a function that says whether the REPL reads Lisp now. typed: one
    that gives the lines before this one of the form that is being typed.

    Two lines are edited by the terminal, in a wait that can be woken: one for the debugger of a plan's task, which may run in a thread of
    its own, and one of which READ-LINE of a form has read the beginning, as when many lines were pasted.
    """

    def __init__(self, repl, in_lisp, typed):
        super().__init__()
        self.repl = repl
        self._tab = Tab(repl, in_lisp, typed)
        self._bound = None  # the readline that knows our key

    def wait(self, prompt):
        self.ended = False
        if self.can_be_woken:
            return super().wait(prompt)
        streams.CONSOLE_OUTPUT.column = 0
        readline = _readline()
        try:
            if readline is None:
                return type(self.repl).raw_input(self.repl, prompt)
            return self._edited(readline, prompt)
        except EOFError:
            return None

    def _edited(self, readline, prompt):
        """The next line by way of ``readline``, Python's module."""
        before = readline.get_completer(), readline.get_completer_delims()
        readline.set_completer(self._tab.complete)
        readline.set_completer_delims(self._tab.delimiters())
        try:
            if "libedit" in (readline.__doc__ or ""):  # it has no macros; there Ctrl-C stays a signal
                return type(self.repl).raw_input(self.repl, prompt)
            if self._bound is not readline:
                self._bound = readline
                for line in _BINDINGS:
                    readline.parse_and_bind(line)
            with ctrl_c_as_a_key(sys.stdin.fileno()):  # before the prompt stands there
                line = type(self.repl).raw_input(self.repl, prompt)
        finally:
            readline.set_completer(before[0])
            readline.set_completer_delims(before[1])
        if INTERRUPT not in line:
            return line
        last = readline.get_current_history_length()
        if last and readline.get_history_item(last) == line:
            readline.remove_history_item(last - 1)
        self.ended = True
        return BROKEN_OFF


def _readline():
    """Python's module, if it edits the lines of the terminal: Hy has loaded it, and ``input`` uses it only between two terminals."""
    try:
        on_a_terminal = sys.stdin.isatty() and sys.stdout.isatty() and sys.stdin.fileno() == 0 and sys.stdout.fileno() == 1
    except (AttributeError, OSError, ValueError):
        return None
    return sys.modules.get("readline") if on_a_terminal else None


__all__ = ["HyLines"]
