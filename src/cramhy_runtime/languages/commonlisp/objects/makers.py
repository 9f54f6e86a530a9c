"""``make-instance`` with a quoted class and named initargs: a function for such calls, which knows the slots of the class.

A `Maker` stands in compiled code for all calls with the same class and initargs. Its function is written when it is first called
(`instances.constructor_for`). It is forgotten when a class or a method of the protocol changes, when a function of the protocol is traced,
and when another image comes. Where the protocol of ANSI 7.1 has more to do than to fill slots, `make_instance` itself is called.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.classes import find_class_or_error
from cramhy_runtime.lisp_core.packages import sym
from .class_objects import StandardObject
from .instances import constructor_for, when_plans_change

MAKE_INSTANCE = sym("MAKE-INSTANCE")


class Maker:
    """Calls of ``make-instance`` for the class ``name`` with the initargs ``keys``: ``make`` takes their values."""

    __slots__ = ("name", "keys", "make")

    def __init__(self, name, keys):
        self.name, self.keys = name, keys
        self.refresh()

    def refresh(self):
        """Forget the function that was written."""
        self.make = self._make

    def _make(self, *values):
        written = self._written()
        if written is None:
            return self._make_any(*values)
        self.make = written
        _in_use.append(self)
        return written(*values)

    def _make_any(self, *values):
        return MAKE_INSTANCE.function(self.name, *[part for pair in zip(self.keys, values, strict=True) for part in pair])

    def _written(self):
        """The function, or ``None`` if there is more to do than to fill slots."""
        function = MAKE_INSTANCE.function
        if function.methods != function.own_methods or function.watcher is not None:
            return None
        cls = find_class_or_error(self.name)
        return constructor_for(cls, self.keys) if issubclass(cls, StandardObject) else None


_in_use: list[Maker] = []
"""Those whose function was written."""


def maker(name, *keys):
    """The `Maker` for the class that the symbol ``name`` names and the keywords ``keys``, one for all calls."""
    return MAKE_INSTANCE.calls.kept((name, keys), lambda: Maker(name, keys))


@when_plans_change
def _forget():
    for each in _in_use:
        each.refresh()
    _in_use.clear()


__all__ = ["Maker", "maker"]
