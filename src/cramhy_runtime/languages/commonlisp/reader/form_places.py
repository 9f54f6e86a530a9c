"""Where the lines, forms and symbols of a text stand.

A list that was read is a fresh object, so its identity is the key of its place. A symbol is the same object wherever it is
written; its places are those of its indices in lists. Only offsets are noted while reading; line and column are
counted when an error or a warning needs them.
"""

from __future__ import annotations

from bisect import bisect_right
from collections import deque

from cramhy_runtime.lisp_core.data import Cons
from ..syntax.backquote import Comma

_FAR = 2000
"""So many cells are searched for a symbol; then the place of the form around it must do."""


class LineIndex:
    """Lines and columns of the offsets of a text that starts at ``line`` and ``column``."""

    def __init__(self, text, line=1, column=1):
        self.text, self.line, self.column = text, line, column
        self.starts = [0]
        position = text.find("\n")
        while position >= 0:
            self.starts.append(position + 1)
            position = text.find("\n", position + 1)

    def place(self, offset):
        """(line, column) of ``offset``, counted from 1."""
        index = bisect_right(self.starts, offset) - 1
        column = offset - self.starts[index] + (self.column if index == 0 else 1)
        return self.line + index, column

    def excerpt(self, offset):
        """The line around ``offset`` and below it a caret; a long line is cut."""
        index = bisect_right(self.starts, offset) - 1
        start = self.starts[index]
        end = self.text.find("\n", start)
        line = self.text[start : len(self.text) if end < 0 else end].rstrip("\r").replace("\t", " ")
        column = offset - start
        if len(line) > 100:
            cut = max(0, column - 50)
            line, column = line[cut : cut + 100], column - cut
        return f"{line}\n{' ' * column}^"


class FormPlaces(dict):
    """``id(form)`` → (line, column, end line, end column) of every list of a text. ``place`` makes line and column of an offset.

    ``symbols``: the index and the offset of each symbol in a list, by ``id`` of the list; for ``,x``, of the comma.
    """

    def __init__(self, place=None):
        super().__init__()
        self.place = place
        self.symbols = {}
        self._sources = {}
        self._kept = []  # ids are only unique among living objects
        self.doubts = []  # pairs of offsets
        self.left_out = False  # whether the reader went past forms with a warning, so that what was compiled is not the whole text

    def doubt(self, start, end):
        """Note that the parentheses from one offset to another are wrong."""
        self.doubts.append((start, end))

    def in_doubt(self, line, column):
        """Whether (line, column) is in a part of the text whose parentheses are wrong."""
        return any(self.place(start) <= (line, column) <= self.place(end) for start, end in self.doubts)

    def inherit(self, expansion, form):
        """Let ``expansion``, if it has no place, have that of ``form``, from which it was made."""
        if isinstance(expansion, Cons):
            key, outer = id(expansion), id(form)
            place = self.get(outer)
            if place is not None and key not in self:
                self._kept.append(expansion)
                self[key] = place
                self._sources[key] = self._sources.get(outer, form)

    def source(self, key, form):
        """The form that was read from which ``form``, whose ``id`` is ``key``, has its place."""
        return self._sources.get(key, form)

    def of_symbol(self, symbol, form):
        """(line, column) of ``symbol`` in the list ``form``: where it stands least deep, the first of these; ``None`` if nowhere."""
        symbols, waiting, left = self.symbols, deque([form]), _FAR
        while waiting and left:
            cell = waiting.popleft()
            offsets, index = dict(symbols.get(id(cell), ())), 0
            while cell.__class__ is Cons and left:
                left -= 1
                item = cell.car
                if item is symbol and index in offsets:
                    return self.place(offsets[index])
                if item.__class__ is Cons:
                    waiting.append(item)
                elif item.__class__ is Comma:
                    if item.form is symbol and id(item) in symbols:
                        return self.place(symbols[id(item)][0][1])
                    waiting.append(item.form)
                cell, index = cell.cdr, index + 1
        return None
