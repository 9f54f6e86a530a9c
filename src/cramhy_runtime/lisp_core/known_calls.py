"""What compiled code knows of the functions of a symbol, so that it need not call them, or calls their methods at once.

A symbol has such tables (`KnownCalls`) from the first time that compiled code asks for them, and tells them when its functions change.
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
    it, as ``symbol.calls.reads.of_speed``. `Symbol.function_changed` keeps the sets right, and so do generic functions.
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


class KnownCalls:
    """The tables of one symbol.

    reads, writes: from which objects its ``function`` and its ``setf_function`` just read or write an attribute. unary, binary: for calls
    with one and two arguments, if ``function`` is generic, the function to call by the class of the first argument.
    """

    __slots__ = ("symbol", "reads", "writes", "_kept", "_tables")

    def __init__(self, symbol):
        self.symbol, self._kept = symbol, {}
        self.reads, self.writes = SlotClasses(symbol, "function"), SlotClasses(symbol, "setf_function")
        self._tables = {}

    @property
    def unary(self):
        return self._table(1)

    @property
    def binary(self):
        return self._table(2)

    def _table(self, count):
        if count not in self._tables:
            self._tables[count] = effective_functions(self.symbol.function, count)
        return self._tables[count]

    def kept(self, key, make):
        """What stands for ``key`` among that which wants to know when the functions change, by its ``refresh``; ``make()`` the first time.

        key: for calls with keywords, their number of other arguments and the keywords (`lisp_core.keyword_calls`).
        """
        found = self._kept.get(key)
        if found is None:
            found = self._kept[key] = make()
        return found

    def function_changed(self):
        """Find out anew what the functions do."""
        self.more_known()
        for each in self._kept.values():
            each.refresh()

    def more_known(self):
        """Find out anew which methods the functions call."""
        for accesses in (self.reads, self.writes):
            if accesses:
                accesses.refresh()
        for count, table in self._tables.items():
            table.clear()
            table.update(effective_functions(self.symbol.function, count))
