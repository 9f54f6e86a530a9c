"""What a student has typed on a page, kept so that it can be typed again: each page, and each run of the course, has a session of its own.

A text is kept once it has been answered. One that led into the debugger, or was ended by Ctrl-C, is not kept.
"""

from __future__ import annotations

import re

MOST = 300
"""Texts that are kept for a page."""
LONGEST = 20_000
"""Characters of a text that is kept."""


class Replay:
    """texts: those of this page so far, to which what is typed is added. ``earlier``: those of earlier sessions, until they come again."""

    def __init__(self, texts: list[str]):
        self.texts, self.earlier = texts, list(texts)
        self._coming: list[str] = []
        self._again = False  # whether the line that was read last is of an earlier session
        self._read: str | None = None

    def type(self, text: str) -> None:
        """Let the lines of ``text`` come, as if the student typed them."""
        self._coming = text.split("\n")

    def begin(self) -> int:
        """Let the lines of the earlier texts come; the number of these texts."""
        texts, self.earlier = self.earlier, []
        self.type("\n".join(texts))
        self._again = True
        return len(texts)

    def line(self) -> str | None:
        """The next line of an earlier text; ``None`` if the student is to type one."""
        self._again = self._again and bool(self._coming)
        return self._coming.pop(0) if self._coming else None

    def was_read(self, text: str) -> None:
        """A whole text was read, and is answered now."""
        self._read = None if self._again or len(text) > LONGEST else text

    def failed(self) -> None:
        """The text that was read last is not to be kept, and no other one is to come."""
        self._read = None
        self._coming.clear()

    def was_answered(self) -> bool:
        """The prompt is there again. Whether ``texts`` has changed: a text was added, or a function has another definition."""
        text, self._read = self._read, None
        if text is None:
            return False
        defined = _defined(text)
        places = [place for place, other in enumerate(self.texts) if defined and _defined(other) == defined]
        if places:
            self.texts[places[0]] = text
        elif len(self.texts) < MOST:
            self.texts.append(text)
        return bool(places) or self.texts[-1] is text


def _defined(text):
    """The name of the function that ``text`` defines, or ``None``."""
    match = re.match(r"\s*\((?:defun|defn)\s+([^\s()\[\]]+)", text, re.I)
    return match and match[1].lower()
