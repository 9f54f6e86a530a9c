"""Keywords of Hy are equal to those of Lisp with the same name, and have equal hashes.

So ``=``, ``match``, ``case``, ``in`` and look-ups in dictionaries and sets find ``:driving`` in what a designator or a task gives. Lisp
compares objects and never asks here; all the work is done by Hy's class, since a keyword of Lisp is the key of many tables.
"""

from __future__ import annotations

from hy import models

from cramhy_runtime.ground.data import Keyword
from cramhy_runtime.ground.packages import keyword


def _equal(self, other):
    if isinstance(other, Keyword):
        return self.name.upper() == other.name
    return self.name == other.name if isinstance(other, models.Keyword) else NotImplemented


def _unequal(self, other):
    same = _equal(self, other)
    return same if same is NotImplemented else not same


def _hash(self):
    """That of Lisp's keyword, so names that differ by case only have one hash."""
    return hash(keyword(self.name.upper()))


def install():
    """Let Hy's keywords compare so, in the whole process."""
    models.Keyword.__eq__, models.Keyword.__ne__, models.Keyword.__hash__ = _equal, _unequal, _hash
