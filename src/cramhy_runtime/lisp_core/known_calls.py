"""What compiled code may know of the functions of symbols: from which classes' objects they just take a slot.

`lisp_core.data.Symbol` keeps these tables, and generic functions tell it when they change.
"""

from __future__ import annotations


class Classes(set):
    """A set of classes. ``last``: the one that came last, with which compiled code compares first, as that is quicker."""

    __slots__ = ("last",)

    def replace(self, classes):
        """Have ``classes``, in this order, for elements."""
        self.clear()
        self.update(classes)
        self.last = classes[-1] if classes else None


class SlotClasses(dict):
    """For the function of a symbol: attribute → the set of the classes from whose objects compiled code may take the slot itself.

    They are the classes of whose objects the function reads, or writes, just that attribute. A set is made when compiled code asks for
    it, as ``symbol.reads.of_speed``. `Symbol.function_changed` keeps the sets right, and so do generic functions.
    """

    __slots__ = ("symbol", "cell")

    def __init__(self, symbol, cell):
        self.symbol, self.cell = symbol, cell

    def __getattr__(self, name):
        if not name.startswith("of_"):
            raise AttributeError(name)
        return self[name.removeprefix("of_")]

    def __missing__(self, attribute):
        self[attribute] = Classes()
        self.refresh()
        return self[attribute]

    def refresh(self):
        """Find out anew what the function does."""
        accesses = _accesses(getattr(self.symbol, self.cell))
        for attribute, classes in self.items():
            classes.replace([cls for cls, other in accesses if other == attribute])


def effective_functions(function, count):
    """What a call of ``function`` with ``count`` arguments calls, by the class of the first, as far as that is known and decides."""
    return dict(function.cache) if getattr(function, "by_first_of", None) == count else {}


def _accesses(function):
    """The pairs (class, attribute) for which ``function`` just reads or writes that attribute of an object of that class."""
    known = getattr(function, "__dict__", None)
    if known and "slot_of" in known and "traced" not in known:
        return ((function.slot_of, function.attribute),)
    accesses = getattr(function, "slot_accesses", None)
    return () if accesses is None else accesses()
