"""Which texts were answered in this image, and how far: typed at a prompt, in a cell of a notebook, in a tab, sent by Emacs, or loaded.

A check of the course asks for the form that somebody has typed, and not only for its value: 16 is 16, whether it was computed or not. The
functions that answer a text note it here, whatever the door was through which it came. `Session.forms` and `Session.evaluate` do it for
Lisp, the loader for files, and the prompt and the cells of Hy for themselves. Nothing is read a second time until somebody asks.
"""

from __future__ import annotations

from collections import deque

from cramhy_runtime.kernel.images import per_image

MOST = 300
"""Texts that are kept."""


class Answered:
    """A text, of the file ``name`` or of ``None``. ``upto``: where the forms end that were answered. ``failed``: whether the next one has
    failed, so that the rest was not taken. ``language``: "lisp" or "hy"."""

    __slots__ = ("text", "language", "name", "upto", "failed")

    def __init__(self, text: str, language: str, name: str | None):
        self.text, self.language, self.name = text, language, name
        self.upto, self.failed = 0, False

    def end(self, good: bool = True) -> None:
        """All forms were answered, if it is ``good``. Otherwise the form behind ``upto`` has failed."""
        if good:
            self.upto = len(self.text)
        else:
            self.failed = True


_texts: deque[Answered] = per_image(deque(maxlen=MOST))


def note(text: str, language: str = "lisp", name: str | None = None) -> Answered:
    """The `Answered` of a text whose forms are going to be evaluated, in its place among the others."""
    noted = Answered(text, language, name)
    _texts.append(noted)
    return noted


def texts() -> list[Answered]:
    """All that is known, from the oldest to the newest."""
    return list(_texts)


def forget() -> None:
    """Another session begins, in which nothing was answered."""
    _texts.clear()


__all__ = ["Answered", "forget", "note", "texts"]
