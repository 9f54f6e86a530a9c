"""Where the forms and symbols of a text stand.

A list that was read is a fresh object, so its identity is the key of its place. A symbol is the same object wherever it is
written; its places are those of the cells whose elements it is. Only offsets are noted while reading; line and column are
counted when an error or a warning needs them.
"""

from __future__ import annotations

from collections import deque

from ..data import Cons
from .backquote import Comma

_FAR = 2000
"""So many cells are searched for a symbol; then the place of the form around it must do."""


class FormPlaces(dict):
    """``id(form)`` → (line, column, end line, end column) of every list of a text. ``place`` makes line and column of an offset.

    ``symbols``: the offset of the symbol that is the first element of a cell, by ``id`` of the cell; for ``,x``, of the comma.
    """

    def __init__(self, place=None):
        super().__init__()
        self.place = place
        self.symbols = {}
        self._sources = {}
        self._kept = []  # ids are only unique among living objects

    def inherit(self, expansion, form):
        """Let ``expansion``, if it has no place, have that of ``form``, from which it was made."""
        if isinstance(expansion, Cons) and id(expansion) not in self and id(form) in self:
            self._kept.append(expansion)
            self[id(expansion)] = self[id(form)]
            self._sources[id(expansion)] = self.source(form)

    def source(self, form):
        """The form that was read from which ``form`` has its place."""
        return self._sources.get(id(form), form)

    def of_symbol(self, symbol, form):
        """(line, column) of ``symbol`` in the list ``form``: where it stands least deep, the first of these; ``None`` if nowhere."""
        symbols, waiting, left = self.symbols, deque([form]), _FAR
        while waiting and left:
            cell = waiting.popleft()
            while isinstance(cell, Cons) and left:
                left -= 1
                item = cell.car
                if item is symbol and id(cell) in symbols:
                    return self.place(symbols[id(cell)])
                if isinstance(item, Cons):
                    waiting.append(item)
                elif isinstance(item, Comma):
                    if item.form is symbol and id(item) in symbols:
                        return self.place(symbols[id(item)])
                    waiting.append(item.form)
                cell = cell.cdr
        return None
