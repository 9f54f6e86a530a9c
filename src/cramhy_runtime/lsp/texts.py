"""Texts as an editor has them: places in UTF-16, the word at a place, the lists around it, and the tokens of Lisp.

All functions take time in proportion to the text at most, and never look at a text that is longer than `LONGEST`.
"""

from __future__ import annotations

import re
from bisect import bisect_right
from typing import NamedTuple

LONGEST = 2_000_000
"""Characters. A longer text gets one remark and nothing else."""

TOKEN = re.compile(
    r"""(?P<comment>;[^\n]*|\#\|.*?(?:\|\#|\Z))
    | (?P<string>"(?:\\.|[^"\\])*(?:"|\Z))
    | (?P<character>\#\\(?:[\w-]+|.))
    | (?P<open>[(\[{]) | (?P<close>[)\]}])
    | (?P<quote>\#'|,@|['`,])
    | (?P<word>(?:\|[^|]*\||\\.|[^\s()\[\]{}"';`,|\\])+)""",
    re.X | re.S,
)
_NUMBER = re.compile(r"[+-]?(?:\d+/\d+|\d+\.?\d*(?:[esfdl][+-]?\d+)?|\.\d+(?:[esfdl][+-]?\d+)?)\Z", re.I)


class Token(NamedTuple):
    kind: str
    start: int
    end: int
    text: str


class Form:
    """A list in a text. start, end: offsets, ``end`` is behind its closing bracket, or the text's end. items: tokens and `Form`s."""

    __slots__ = ("start", "end", "items", "closed", "parent")

    def __init__(self, start, parent):
        self.start, self.end, self.items, self.closed, self.parent = start, start, [], False, parent

    def word(self, index):
        """The text of the item number ``index`` if it is a word or a string, else ``""``."""
        item = self.items[index] if index < len(self.items) else None
        return item.text if isinstance(item, Token) and item.kind in ("word", "string") else ""


class Text:
    """A text and what is found in it. lines and columns count from 0; columns are UTF-16 units, as in the protocol."""

    def __init__(self, text):
        self.text = text
        self.starts = [0, *(match.end() for match in re.finditer(r"\r\n|\n|\r", text))]
        self._tokens = self._forms = self._starts = None
        self.packages = None  # see `meanings.package_name_at`

    # ------------------------------------------------------------------------------------------------------------ places

    def offset(self, line, column):
        """The offset of a place; a place outside of the text is moved into it."""
        if line < 0:
            return 0
        if line >= len(self.starts):
            return len(self.text)
        start = self.starts[line]
        end = self.starts[line + 1] - 1 if line + 1 < len(self.starts) else len(self.text)
        part = self.text[start:end]
        if part.isascii():
            return start + max(0, min(column, len(part)))
        units = 0
        for index, character in enumerate(part):
            if units >= column:
                return start + index
            units += 2 if ord(character) > 0xFFFF else 1
        return end

    def place(self, offset):
        """(line, column) of an offset."""
        offset = max(0, min(offset, len(self.text)))
        line = bisect_right(self.starts, offset) - 1
        part = self.text[self.starts[line] : offset]
        return line, len(part) if part.isascii() else len(part.encode("utf-16-le", "surrogatepass")) // 2

    def offset_of_reader(self, line, column):
        """The offset of a place as our readers tell it: line and column from 1, in characters."""
        if not 0 < line <= len(self.starts):
            return len(self.text)
        return min(len(self.text), self.starts[line - 1] + max(0, column - 1))

    def end_of_line(self, offset):
        """The end of the line that ``offset`` stands in, without its line end."""
        end = self.text.find("\n", offset)
        return len(self.text) if end < 0 else end

    @property
    def starts_set(self):
        """The offsets at which a line begins."""
        if self._starts is None:
            self._starts = frozenset(self.starts)
        return self._starts

    def end_of_code(self, offset):
        """The end of the last token before ``offset`` that is no comment; 0 if there is none."""
        return next((token.end for token in reversed(self.tokens) if token.end <= offset and token.kind != "comment"), 0)

    # ------------------------------------------------------------------------------------------------------------- tokens

    @property
    def tokens(self):
        if self._tokens is None:
            self._tokens = [Token(match.lastgroup, match.start(), match.end(), match[0]) for match in TOKEN.finditer(self.text)]
        return self._tokens

    @property
    def forms(self):
        """The top-level `Form`s, with those in them."""
        if self._forms is None:
            self._forms, current = [], None
            for token in self.tokens:
                if token.kind == "open":
                    form = Form(token.start, current)
                    (self._forms if current is None else current.items).append(form)
                    current = form
                elif token.kind == "close":
                    if current is not None:
                        current.end, current.closed, current = token.end, True, current.parent
                elif token.kind != "comment" and current is not None:
                    current.items.append(token)
            while current is not None:
                current.end, current = len(self.text), current.parent
        return self._forms

    def word(self, offset):
        """The `Token` of the word at or right before ``offset``, or ``None``."""
        index = bisect_right(self.tokens, offset, key=lambda token: token.start) - 1
        for token in self.tokens[max(0, index - 1) : index + 1][::-1]:
            if token.kind == "word" and token.start <= offset <= token.end:
                return token
        return None

    def around(self, offset):
        """The `Form`s that ``offset`` stands in, the innermost first."""
        found, forms = [], self.forms
        while True:
            inside = next((form for form in forms if isinstance(form, Form) and form.start < offset and _holds(form, offset)), None)
            if inside is None:
                return found
            found.insert(0, inside)
            forms = inside.items

    def quiet(self, offset):
        """Whether ``offset`` stands in a string or a comment."""
        index = bisect_right(self.tokens, offset - 1, key=lambda token: token.start) - 1
        token = self.tokens[index] if index >= 0 else None
        return token is not None and token.kind in ("string", "comment") and token.start < offset < token.end + (token.kind == "comment")

    def end_of_datum(self, offset):
        """Where what begins at ``offset`` ends: a list, or a word; at least one character further."""
        index = bisect_right(self.tokens, offset, key=lambda token: token.start) - 1
        token = self.tokens[index] if index >= 0 else None
        if token is None or token.end <= offset:
            return min(len(self.text), offset + 1)
        if token.kind == "quote" and index + 1 < len(self.tokens):
            return self.end_of_datum(self.tokens[index + 1].start)
        if token.kind == "open":
            form = next((form for form in self.around(offset + 1) if form.start == token.start), None)
            return form.end if form is not None and form.closed else token.end
        return token.end


def _holds(form, offset):
    return offset < form.end or not form.closed


def is_number(word):
    """Whether ``word`` is a number of Lisp."""
    return _NUMBER.match(word) is not None
