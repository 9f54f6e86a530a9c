"""Cells that set something, as ``%time wall``: a line of its own that begins with a word of `WORDS`."""

from __future__ import annotations

WORDS = {"debugger": ("on", "off"), "time": ("virtual", "wall"), "live": ("on", "off"), "watch": None, "pace": ("",)}
"""The settings, and the words that may stand behind each; ``None``: anything."""
NO_WIDGETS = "The controls of %pace are made with ipywidgets, which is not installed here: pip install ipywidgets, and begin a new kernel."


class Refused(Exception):
    """A setting cannot be made. Its text says why."""


def parsed(code):
    """(the name of the setting, what stands behind it) of a cell that is one; else ``None``."""
    word, _, more = code.strip().partition(" ")
    return (word[1:], more.strip()) if word.startswith("%") and word[1:] in WORDS else None


def check(name, more):
    """Raise `Refused` if ``more`` cannot stand behind the setting ``name``."""
    allowed = WORDS[name]
    if allowed is not None and more not in allowed:
        if allowed == ("",):
            raise Refused(f"%{name} stands alone, without {more}.")
        raise Refused(f"Behind %{name} stands {' or '.join(allowed)}, not {more or 'nothing'}.")
