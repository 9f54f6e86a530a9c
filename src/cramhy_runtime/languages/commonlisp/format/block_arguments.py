"""The arguments of the directives in a logical block ``~<...~:>``: the elements of its list, which may be circular."""

from __future__ import annotations

import sys

from cramhy_runtime.lisp_core.data import Cons


class Ring:
    """The elements of a circular list as arguments: ``first``, then ``again`` for ever. The block ends them (``pprint-pop``)."""

    def __init__(self, first, again):
        self.first, self.again = first, again

    def __len__(self):
        return sys.maxsize

    def __getitem__(self, index):
        if index.__class__ is slice:
            return [*self.first, *self.again][index]
        return self.first[index] if index < len(self.first) else self.again[(index - len(self.first)) % len(self.again)]


def arguments_of(lst):
    """The elements of ``lst`` up to its end, which need not be nil."""
    items, cells, cell = [], {}, lst
    while isinstance(cell, Cons):
        if id(cell) in cells:
            turn = cells[id(cell)]
            return Ring(items[:turn], items[turn:])
        cells[id(cell)] = len(items)
        items.append(cell.car)
        cell = cell.cdr
    return items
