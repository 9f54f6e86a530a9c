"""Accessors: which generic functions just read or write an attribute, and the calls that do so themselves.

Compiled code takes a slot from an object itself where the function that is called would do nothing else. It asks the symbol of the
function from which classes' objects it may (`known_calls.SlotClasses`), and the symbol asks the function.
"""

from __future__ import annotations

from operator import attrgetter

from ..data import Cons, Symbol


class ReachedSlots:
    """The part of a generic function that tells the calls in compiled code what it does with slots.

    by_object: whether the function is called with one object, or a new value and an object, and chooses by the object's class alone.
    by_first_of: with how many arguments it is called, if it chooses by the class of the first one alone and there are one or two.
    """

    by_object = False
    by_first_of: int | None = None

    def slot_accesses(self):
        """The pairs (class, attribute) for which a call just reads or writes that attribute of an object of that class."""
        if not self.by_object:
            return []
        found = [(cls, attribute_of(effective)) for cls, effective in self.cache.items()]
        return [(cls, attribute) for cls, attribute in found if attribute is not None]

    def slot_attribute(self):
        """The attribute that all methods read or write; ``None`` if they do anything else."""
        if not self.by_object:
            return None
        (position,) = self.positions
        found = {
            method.function.attribute_in(method.specializers[position]) if hasattr(method.function, "attribute_in") else None
            for method in self.methods
        }
        return found.pop() if len(found) == 1 else None

    def tell_callers(self, found=False):
        """Let calls that find methods and slots themselves know what this function does now. found: only that it knows one call more."""
        name = self.__lisp_name__
        symbol = name.cdr.car if isinstance(name, Cons) else name
        if isinstance(symbol, Symbol):
            symbol.more_known() if found else symbol.function_changed()


def attribute_of(effective):
    """The attribute that an effective function just reads or writes, or ``None``."""
    if effective.__class__ is attrgetter:
        return effective.__reduce__()[1][0]
    return getattr(effective, "writes_attribute", None)


def _attribute(function):
    """The attribute of its argument that ``function`` just reads or writes, for the usual argument; ``None`` if it does more."""
    known = getattr(function, "__dict__", None)
    if not known:
        return None
    if "slot_of" in known:
        return None if "traced" in known else function.attribute
    return function.slot_attribute() if hasattr(function, "slot_attribute") else None


def read_attribute(symbol):
    """The attribute that the function ``symbol`` just reads, or ``None``."""
    return _attribute(symbol.function) if isinstance(symbol, Symbol) else None


def written_attribute(symbol):
    """The attribute that the function ``(setf symbol)`` just writes, or ``None``."""
    return _attribute(symbol.setf_function) if isinstance(symbol, Symbol) else None


__all__ = ["ReachedSlots", "attribute_of", "read_attribute", "written_attribute"]
