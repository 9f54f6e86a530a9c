"""What the tables of examples consist of: one operator in three languages."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Example:
    """An operator in Lisp, Hy and Python; the value of the last form, and what ``note`` was called with, are the same in all three.

    lisp: its text. hy: the Hy text, where none can be made from the Lisp text by `lisp_to_hy.hy_text`. python: statements and a last
    expression. only: why it has no spelling in Hy or in Python.
    """

    lisp: str
    python: str | None = None
    hy: str | None = None
    only: str = ""
