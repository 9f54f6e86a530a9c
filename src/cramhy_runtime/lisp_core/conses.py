"""Conses, the pairs of which Lisp's lists are made, and how Python sees such lists.

A list is iterated, measured and compared as a sequence of Python, and what is not computed yet of a lazy one is computed then.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from itertools import islice
from operator import index as as_index

from cramhy_runtime.kernel.active import checkpoint
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any, overload

from .ports import PORTS

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator


class _Marker:
    """A named object that is nothing but itself."""

    __slots__ = ("name",)

    def __init__(self, name):
        self.name = name

    def __repr__(self):
        return self.name

    def __reduce__(self):
        return self.name.strip("#<>").upper()


UNBOUND = _Marker("#<unbound>")
"""The value of a symbol or slot that has none."""
UNSUPPLIED = _Marker("#<unsupplied>")
"""Default of an &optional or &key parameter where ``nil`` and "not given" differ."""


STRETCH = range(256)
"""So many elements of a list a loop passes between two checkpoints: a circular list must not keep Ctrl-C from its plan."""

LONG = 20_000
"""A list of more elements is made in parts, with a checkpoint before each."""


class LazyRest:
    """The end of a list whose rest is not computed yet, which Python's loops have computed: see `utilities.lazy_lists`."""

    __slots__ = ()

    def computed(self) -> Any:
        """What comes in its place: a list, or ``None``."""
        raise NotImplementedError


ENDLESS = 1_000_000
"""A lazy list that has given so many elements for ``len`` alone counts as endless."""


class Cons:
    """A pair, and to Python the sequence of the elements of the list that starts here; a dotted tail ends it.

    Who iterates has the elements of a lazy list computed, one after the other; who asks for the length, all of them. A list is equal to a
    list or tuple of Python with equal elements. Lisp does not compare by that, and as a key a list is itself, since it can be changed.
    """

    __slots__ = ("car", "cdr")

    def __init__(self, car: Any, cdr: Any = None):
        self.car = car
        self.cdr = cdr

    def __iter__(self) -> Iterator[Any]:
        cell = self
        while True:
            for _ in STRETCH:
                yield cell.car
                cell = cell.cdr
                if cell.__class__ is not Cons and (cell is None or (cell := _computed(cell)) is None):
                    return
            checkpoint()

    def _computed_rest(self) -> Cons | None:
        rest = self.cdr
        if isinstance(rest, LazyRest):
            rest = self.cdr = rest.computed()
        return rest if isinstance(rest, Cons) else None

    # For Python code that gets a list from Lisp. A list is never empty (that is None), so it is true whatever its length.

    def __bool__(self) -> bool:
        return True

    def __len__(self) -> int:
        """The number of elements. A circular list has none, an OverflowError, and neither has a lazy one that does not end."""
        count, cell, lazy = 1, self, 0
        while True:
            for _ in STRETCH:
                cell = cell.cdr
                if cell.__class__ is not Cons:
                    if cell is None or (cell := _computed(cell)) is None:
                        return count
                    lazy += 1
                    if lazy > ENDLESS:
                        raise OverflowError(
                            f"This lazy list has given {ENDLESS} elements and goes on, so it has no length. "
                            "Take as many as you need: itertools.islice(answers, 10)."
                        )
                count += 1
            checkpoint()
            if count > ENDLESS > count - len(STRETCH) - 1 and isinstance(list_end(self), Cons):
                raise OverflowError("This list is circular, so it has no length.")

    def __getitem__(self, index: Any) -> Any:
        """The element at ``index``, which may be negative; a slice gives a Python list."""
        if isinstance(index, slice):
            bounds = [part for part in (index.start, index.stop) if part is not None]
            if index.stop is not None and all(part >= 0 for part in bounds) and (index.step is None or index.step > 0):
                return list(islice(self, index.start, index.stop, index.step))  # an endless list has a beginning
            return list(self)[index]
        index = as_index(index)
        if index < 0:
            return list(self)[index]
        for item in self:
            if not index:
                return item
            index -= 1
        raise IndexError("list index out of range")

    def __eq__(self, other: object) -> bool:
        kind = other.__class__
        if kind is Cons:
            return self is other or _same_lists(self, other)
        if kind is tuple or isinstance(other, list):
            theirs = iter(other)  # type: ignore[call-overload]
            for item in self:
                if not _same_elements(item, next(theirs, UNSUPPLIED)):
                    return False
            return next(theirs, UNSUPPLIED) is UNSUPPLIED and _computed_end(self) is None
        return NotImplemented

    __hash__ = object.__hash__

    def __reversed__(self) -> Iterator[Any]:
        return reversed(list(self))

    def index(self, value: object, start: int = 0, stop: int | None = None) -> int:
        """Where ``value`` stands, as of a list of Python; a ValueError if it does not."""
        return list(self).index(value, start, sys.maxsize if stop is None else stop)

    def count(self, value: object) -> int:
        """How often ``value`` stands in the list."""
        return list(self).count(value)

    def __repr__(self):
        parts, cell, limit = [], self, 50
        while isinstance(cell, Cons) and limit:
            parts.append(repr(cell.car) if cell.car is not None else "NIL")
            cell, limit = cell.cdr, limit - 1
        if cell is not None:
            parts += [".", "..." if isinstance(cell, Cons) else repr(cell)]
        return "(" + " ".join(parts) + ")"


def _computed(rest):
    """The cons that ``rest``, the end of what is computed of a list, stands for; ``None`` if the list ends there."""
    if isinstance(rest, LazyRest):
        rest = rest.computed()
    return rest if isinstance(rest, Cons) else None


def _computed_end(cell):
    """What ends the list ``cell``, which has been iterated."""
    while (rest := cell._computed_rest()) is not None:
        cell = rest
    return cell.cdr


Sequence.register(Cons)  # for ``match``, and for who asks whether something is a sequence


class EmptyList(list[Any]):
    """The empty list that Hy code gets where Lisp gives ``nil``, so that a loop over the answers of a query has no turns.

    It is a new list each time. To plans it is false, as ``nil`` is.
    """

    __slots__ = ()


new_object = object.__new__


def _same_lists(one_list, other):
    """Whether two lists have equal elements and the same end, for Python."""
    while isinstance(one_list, Cons) and isinstance(other, Cons):
        for _ in STRETCH:
            if one_list is other:
                return True
            if not _same_elements(one_list.car, other.car):
                return False
            here, there = one_list._computed_rest(), other._computed_rest()
            if here is None or there is None:
                return one_list.cdr is other.cdr or not (here or there) and bool(one_list.cdr == other.cdr)
            one_list, other = here, there
        checkpoint()
    return False


def _same_elements(ours, theirs):
    """Whether an element of a list is equal to one of Python's; ``nil`` is the empty list, too."""
    return ours is theirs or bool(ours == theirs) or ours is None and theirs.__class__ in (list, tuple) and not theirs


@overload
def lisp_list() -> None: ...
@overload
def lisp_list(first: object, /, *more: object) -> Cons: ...
def lisp_list(*items: object) -> Cons | None:
    """The list of ``items``; ``None`` when there are none."""
    head = None
    for item in reversed(items):
        cell = new_object(Cons)
        cell.car, cell.cdr = item, head
        head = cell
    return head


def list_from(iterable: Iterable[object], tail: Any = None) -> Any:
    """The list of the elements of ``iterable``, ending in ``tail``."""
    head, items = tail, iterable if isinstance(iterable, (list, tuple)) else list(iterable)
    if len(items) > LONG:
        rest = len(items) % LONG
        for start in range(len(items) - LONG, rest - 1, -LONG):
            checkpoint()
            head = list_from(items[start : start + LONG], head)
        items = items[:rest]
    for item in reversed(items):
        cell = new_object(Cons)  # made without its constructor, which would be a call of a Python function
        cell.car, cell.cdr = item, head
        head = cell
    return head


def python_list(lst: Any) -> list[Any]:
    """The elements of the Lisp list ``lst`` as a Python list."""
    if lst.__class__ is not Cons:
        return [] if lst is None else list(_iterator(lst))
    return list_parts(lst)[0]


def _iterator(thing):
    try:
        return iter(thing)
    except TypeError:
        return PORTS.signals.type_error(thing, "LIST")


def list_parts(cell):
    """(the elements of the list ``cell`` as a Python list, what stands behind its last cons)"""
    items = []
    while True:
        for _ in STRETCH:
            if cell.__class__ is not Cons:
                return items, cell
            items.append(cell.car)
            cell = cell.cdr
        checkpoint()


def conses(lst):
    """The conses of the list ``lst``, one after the other, whatever it ends in."""
    while True:
        for _ in STRETCH:
            if lst.__class__ is not Cons:
                return
            yield lst
            lst = lst.cdr
        checkpoint()


def list_end(lst):
    """What ends the list ``lst``: ``None`` for a proper one, else the last ``cdr``; of a circular list a cons, for it has no end."""
    slow, steps = lst, 0
    while isinstance(lst, Cons):
        lst, steps = lst.cdr, steps + 1
        if not steps % 2:
            slow = slow.cdr
            if slow is lst and isinstance(lst, Cons):
                return lst
    return None if lst is False else lst
