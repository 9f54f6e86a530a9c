"""What a student has typed on a page, kept so that it can be typed again: each page, and each run of the course, has a session of its own.

A text is kept once it has been answered. One that led into the debugger, or was ended by Ctrl-C, is not kept.
"""

from __future__ import annotations

MOST = 300
"""Texts that are kept for a page."""
LONGEST = 20_000
"""Characters of a text that is kept."""


class Replay:
    """texts: those of this page so far, to which what is typed is added. ``earlier``: those of earlier sessions, until they come again."""

    def __init__(self, texts: list[str]):
        self.texts, self.earlier = texts, list(texts)
        self._coming: list[str] = []
        self._typed_again = False  # whether the line that was read last came from here
        self._read: str | None = None

    def begin(self) -> int:
        """Let the lines of the earlier texts come; the number of these texts."""
        count, self.earlier, texts = len(self.earlier), [], self.earlier
        self._coming = [line for text in texts for line in text.split("\n")]
        return count

    def line(self) -> str | None:
        """The next line of an earlier text; ``None`` if the student is to type one."""
        self._typed_again = bool(self._coming)
        return self._coming.pop(0) if self._coming else None

    def was_read(self, text: str) -> None:
        """A whole text was read, and is answered now."""
        self._read = None if self._typed_again or len(text) > LONGEST else text

    def failed(self) -> None:
        """The text that was read last is not to be kept, and no other one is to come."""
        self._read = None
        self._coming.clear()

    def was_answered(self) -> bool:
        """The prompt is there again. Whether a text was added to ``texts``."""
        text, self._read = self._read, None
        if text is None or len(self.texts) >= MOST:
            return False
        self.texts.append(text)
        return True
