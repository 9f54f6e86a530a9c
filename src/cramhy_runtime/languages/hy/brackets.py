"""Which brackets of a Hy text are open at its end: what is wrong with a form that is never closed, in the words of our Lisp reader.

Hy's reader says where the text ends, and that is seldom where the bracket is missing.
"""

from __future__ import annotations

import re

_TOKEN = re.compile(
    r""";[^\n]*                          # a comment
    | [bfrt]*"(?:\\.|[^"\\])*(?:"|\Z)    # a string
    | \#\[(?P<mark>[^\[\]]*)\[           # the beginning of a bracket string
    | [(\[{] | [)\]}]""",
    re.X | re.S,
)
_CLOSE = {"(": ")", "[": "]", "{": "}"}


def open_brackets(text):
    """The brackets that are never closed, as (bracket, line, column), the outermost first. A wrong closing one ends the search."""
    found, at = [], 0
    while match := _TOKEN.search(text, at):
        at = match.end()
        token = match[0]
        if match["mark"] is not None:
            end = text.find(f"]{match['mark']}]", at)
            at = len(text) if end < 0 else end + len(match["mark"]) + 2
        elif token in _CLOSE:
            found.append((token, match.start()))
        elif token in ")]}":
            if not found or _CLOSE[found[-1][0]] != token:
                break
            found.pop()
    return [(token, text.count("\n", 0, start) + 1, start - text.rfind("\n", 0, start)) for token, start in found]


def explanation(text):
    """A sentence or two about the brackets that are open at the end of ``text``; ``None`` if there are none."""
    still_open = open_brackets(text)
    if not still_open:
        return None
    (bracket, line, column), (_, inner_line, inner_column) = still_open[0], still_open[-1]
    told = f"The {bracket} at line {line}, column {column} is never closed."
    if len(still_open) > 1:
        told += f" {len(still_open)} are open at the end; the innermost begins at line {inner_line}, column {inner_column}."
    return told


__all__ = ["explanation", "open_brackets"]
