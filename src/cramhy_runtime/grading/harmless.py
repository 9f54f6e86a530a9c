"""Text of strangers, made harmless: what it does to a terminal or to an encoder becomes visible, and the rest stays as it is.

A submission chooses its names, its errors and its output. Escape sequences would colour, hide or overwrite what a teacher reads; marks of
direction show a text in another order than it has; half surrogates cannot be written into any file. Each such character becomes its escape,
such as ``\\x1b`` or ``\\u202e``. Line ends and tabs stay. A line that GitHub's runner takes for a command (``::error::``) gets a blank.
"""

from __future__ import annotations

import re
import unicodedata

_VISIBLE = re.compile(r"[\n\t -~]+")
_OF_THE_RUNNER = re.compile(r"^(\s*):(?=:)|#(?=#\[)", re.M)
_HARMFUL = {"Cc", "Cf", "Cs", "Zl", "Zp"}
"""Unicode's categories: controls, formats (directions, zero width, tags), half surrogates, ends of lines and of paragraphs."""


def harmless(text: object) -> str:
    """``text`` without what acts: it is shown instead. What is not a text becomes one."""
    text = str(text).replace("\r\n", "\n")
    if not _VISIBLE.fullmatch(text):
        text = "".join(map(_shown, text))
    return _OF_THE_RUNNER.sub(lambda found: f"{found[0]} ", text)


def _shown(character):
    if character in "\n\t":
        return character
    number = ord(character)
    if unicodedata.category(character) not in _HARMFUL and number & 0xFFFE != 0xFFFE and not 0xFDD0 <= number <= 0xFDEF:
        return character
    return f"\\x{number:02x}" if number < 0x100 else f"\\u{number:04x}" if number < 0x10000 else f"\\U{number:08x}"
