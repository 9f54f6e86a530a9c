"""What the Tab key offers at a prompt of Hy: what ``roslisp_repl`` offers while it reads Common Lisp, else `completions_in_hy`. In a
string, names of files."""

from __future__ import annotations

import os
import re

from cramhy_runtime.session.hy_completion import completions_in_hy

from .readline_lines import LISP_DELIMITERS, Tab, in_string

HY_DELIMITERS = " \t\n()[]{}`~"

_QUOTES = re.compile(r"(?:#?')*")


class HyTab(Tab):
    """The completer of a REPL of Hy, for ``readline.set_completer``. in_lisp: a function that says whether the REPL reads Lisp now."""

    def __init__(self, repl, in_lisp):
        super().__init__()
        self.repl = repl
        self.in_lisp = in_lisp

    def delimiters(self):
        return LISP_DELIMITERS if self.in_lisp() else HY_DELIMITERS

    def found(self, text, word):
        quotes = _QUOTES.match(word)[0]
        return [quotes + name for name in self.candidates(text, word[len(quotes) :])]

    def candidates(self, text, word):
        """All that ``word``, the last one of ``text``, may become, sorted."""
        if self.in_lisp():
            return super().found(text, word)
        files = in_string(text, word, hy=True, folder=os.getcwd())
        return completions_in_hy(text, word, self.repl.module) if files is None else files


__all__ = ["HY_DELIMITERS", "HyTab"]
