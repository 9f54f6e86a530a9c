"""The value that a choice of the debugger asks for, in ``cramhy learn``: a command of the course is not taken for it, and ``q`` leads back.

Elsewhere each text is a form there, as in SBCL: ``:next`` would be the value, and ``q`` a variable.
"""

from __future__ import annotations

import contextlib

from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.lisp_core.packages import symbol_name
from cramhy_runtime.lisp_core.ports import PORTS
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any
from cramhy_runtime.repl import prompt_words
from cramhy_runtime.repl.line_input import BROKEN_OFF

from . import guide

if TYPE_CHECKING:
    from collections.abc import Iterator

LEFT = "; No value was given. The debugger is left."


class _Asking:
    """The port ``user`` as it was, but for the forms that the student is asked for."""

    def __init__(self, before: Any, listener: Any, read_line: Any):
        self.before, self.listener, self.read_line = before, listener, read_line

    def __getattr__(self, name):
        return getattr(self.before, name)

    def form(self, prompt):
        """The value of the form that is typed behind ``prompt``."""
        from cramhy_runtime.languages.commonlisp.reader.reader import incomplete

        text = ""
        while not text.strip() or incomplete(text):
            line = self.read_line(prompt if not text else "")
            word = guide.command_in_form(line) if isinstance(line, str) else None
            if line is None or line is BROKEN_OFF or (not text and prompt_words.word(line, prompt_words.OUT)):
                self._leave()
            elif word is not None:
                self.listener.tell(f"; A value is wanted here, so :{word} has to wait. Type a form, or q to leave the debugger.")
            else:
                text = f"{text}{line}\n"
        values = self.listener.session.evaluate_text(text, typed=False)
        return values[0] if values else None

    def _leave(self):
        self.listener.tell(LEFT)
        aborts = [restart for restart in conditions.compute_restarts() if symbol_name(restart.name) == "ABORT"]
        conditions.invoke_restart(aborts[-1])


@contextlib.contextmanager
def by(listener: Any, read_line: Any) -> Iterator[None]:
    """In the block ``listener``, a `Guided`, asks for the values of choices. read_line: gives a line of the student's for a prompt."""
    before = PORTS.user
    PORTS.install(user=_Asking(before.before if isinstance(before, _Asking) else before, listener, read_line))
    try:
        yield
    finally:
        PORTS.install(user=before)


__all__ = ["by"]
