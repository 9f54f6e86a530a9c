"""The lines that a REPL of Hy reads: GNU readline edits them, as Hy has set it up. Ctrl-C, the Tab key and the history are ours."""

from __future__ import annotations

from .hy_tab import HyTab
from .readline_lines import ReadlineLines


class HyLines(ReadlineLines):
    """Lines that a REPL of Hy reads, as readline edits them. in_lisp: a function that says whether the REPL reads Lisp now."""

    def __init__(self, repl, in_lisp):
        super().__init__(HyTab(repl, in_lisp))


__all__ = ["HyLines"]
