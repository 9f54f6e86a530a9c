"""Whether a ``.hy`` file stays Hy, or goes on in Common Lisp, as its text says, for code that does not load it."""

from __future__ import annotations

import re
from pathlib import Path


def goes_on_in_lisp(path: Path) -> bool:
    """Whether the file at ``path`` has a form ``(in-package ...)`` or ``(defpackage ...)`` at the beginning of a line."""
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError):
        return False
    return re.search(r"^[ \t]*\((in-package|defpackage)\b", text, re.M) is not None
