"""REPLs of Hy in which plans go on: `hy.REPL` with methods that ask the prompt of ``hy_prompt.py``.

``cramhy repl --hy`` makes a `REPL`. The one that ``hy`` itself has made becomes one of a class of `Attended` when somebody requires
cramhy there (`languages/hy/patches.py` `change_class`).
"""

from __future__ import annotations

import functools

import hy


class Attended:
    """What stands before the class of a REPL of Hy. ``lisp``: the `hy_prompt.HyPrompt` that it asks; ``None``: all is as Hy has it."""

    lisp = None

    @property
    def of_hy(self):
        """The REPL with Hy's own methods."""
        return super()

    def raw_input(self, prompt=""):
        return (self.lisp or super()).raw_input(prompt)

    def runsource(self, source, filename="<stdin>", symbol="exec"):
        return (self.lisp or super()).runsource(source, filename, symbol)

    def runcode(self, code):
        return (self.lisp or super()).runcode(code)

    def showtraceback(self):
        return (self.lisp or super()).showtraceback()

    def showsyntaxerror(self, *places, **texts):
        return (self.lisp or super()).showsyntaxerror(*places, **texts)

    def write(self, text):
        return (self.lisp or super()).write(text)


class REPL(Attended, hy.REPL):
    """A REPL of ours; Python's console says the name of the class at the end.

    begins: its first lines, or ``None`` for Hy's. loop: called with the REPL and these, or ``None`` for Hy's loop.
    """

    def __init__(self, begins=None, loop=None):
        self.begins, self.loop = begins, loop
        super().__init__()

    def banner(self):
        return super().banner() if self.begins is None else self.begins

    def interact(self, banner=None, exitmsg=None):
        return super().interact(banner, exitmsg) if self.loop is None else self.loop(self, banner)


@functools.cache
def attended(kind):
    """The class of REPLs of the class ``kind``, `hy.REPL` or made of it, in which plans go on."""
    return type(kind.__name__, (Attended, kind), {"__module__": kind.__module__, "__doc__": kind.__doc__})


__all__ = ["Attended", "REPL", "attended"]
