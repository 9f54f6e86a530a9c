"""The classes behind arrays that are more than a Python list.

A simple general vector is a Python ``list`` and a string a ``str`` or `LispString`; that covers nearly all vectors of plans.
The rest of ANSI chapter 15 needs three classes: `TypedVector`, a list that knows its element type (bit vectors are these);
`LispArray`, a storage in row-major order seen through dimensions; and `Vector`, a one-dimensional one that may have a fill
pointer and may grow. A displaced array shares the storage of its target, and follows it when the target gets another one
(`take_storage`).
"""

from __future__ import annotations

import math
from weakref import ref

from .condition_types import TypeError_, formatted
from .conditions import error
from .data import WRITABLE_STRINGS, Character, LispString, lisp_list, list_from
from .packages import sym

BIT = sym("BIT")
CHARACTER = sym("CHARACTER")
BASE_CHAR = sym("BASE-CHAR")
STRING_KINDS = frozenset((CHARACTER, BASE_CHAR, None))
"""The element types of the vectors that are strings; ``None`` is the type nil."""


class SharedCharacters:
    """The characters of a string that is displaced to the string ``target``, ``size`` of them from ``offset`` on: its ``chars``.

    It is read and written as a list of this length; to add something to it gives a list of its own.
    """

    __slots__ = ("target", "offset", "size")

    def __init__(self, target, offset, size):
        self.target, self.offset, self.size = target, offset, size

    def _chars(self):
        return self.target.writable() if self.target.__class__ in WRITABLE_STRINGS else self.target

    def __len__(self):
        return max(0, min(self.size, len(self._chars()) - self.offset))

    def __iter__(self):
        return iter(self[:])

    def __getitem__(self, index):
        if index.__class__ is int:
            return self._chars()[self.offset + index]
        return list(self._chars()[self.offset : self.offset + self.size])[index]

    def __setitem__(self, index, value):
        if self.target.__class__ not in WRITABLE_STRINGS:
            error(
                "The string ~S is a constant and cannot be changed in place. Change a copy of it: (copy-seq ~S).", self.target, self.target
            )
        if index.__class__ is int:
            self._chars()[self.offset + index] = value
        else:
            start, stop, _ = index.indices(len(self))
            self._chars()[self.offset + start : self.offset + stop] = list(value)[: stop - start]

    def __iadd__(self, more):
        return [*self, *more]


class CharactersOfArray(SharedCharacters):
    """As `SharedCharacters`, of an array of more dimensions, whose storage has Lisp's characters."""

    __slots__ = ()

    def _chars(self):
        return self.target.storage

    def __getitem__(self, index):
        found = self.target.storage[self.offset + index] if index.__class__ is int else super().__getitem__(index)
        return found.char if index.__class__ is int else [item.char for item in found]

    def __setitem__(self, index, value):
        start, stop = (index, index + 1) if index.__class__ is int else index.indices(len(self))[:2]
        self.target.storage[self.offset + start : self.offset + stop] = [Character(char) for char in value][: stop - start]


class SharedCharacterObjects(SharedCharacters):
    """As `SharedCharacters`, but of Lisp's characters: the storage of an array that is displaced to a string."""

    __slots__ = ()

    def __getitem__(self, index):
        found = super().__getitem__(index)
        return Character(found) if index.__class__ is int else [Character(char) for char in found]

    def __setitem__(self, index, value):
        super().__setitem__(index, value.char if index.__class__ is int else [item.char for item in value])


class TypedVector(list):
    """A simple vector whose elements are all of one type, such as BIT or DOUBLE-FLOAT."""

    __slots__ = ("element_type", "__weakref__")
    __hash__ = object.__hash__

    def __new__(cls, elements=(), element_type=True):
        return super().__new__(SimpleBitVector if element_type is BIT else cls)

    def __init__(self, elements=(), element_type=True):
        super().__init__(elements)
        self.element_type = element_type

    def active(self):
        return self

    def __reduce__(self):
        return TypedVector, (list(self), self.element_type)


class SimpleBitVector(TypedVector):
    """A simple vector of bits: a class of its own, because methods are found by the class of their argument."""

    __slots__ = ()


class LispArray:
    """An array of any rank.

    ``storage`` holds the elements in row-major order from ``offset`` on; ``displaced_to`` is the array whose storage it is, if
    it is another's. ``element_type`` is an upgraded type specifier (``True`` for T). ``followers`` are weak references to the
    arrays that are displaced to this one, and ``lost`` is the type that this one had before the array below it became too small;
    they are unset in most arrays.
    """

    __slots__ = ("dimensions", "storage", "offset", "element_type", "adjustable", "displaced_to", "followers", "lost", "__weakref__")

    def __init__(self, dimensions, storage, element_type=True, adjustable=False, displaced_to=None, offset=0):
        self.dimensions = tuple(dimensions)
        self.storage = storage
        self.element_type = element_type
        self.adjustable = adjustable
        self.displaced_to = displaced_to
        self.offset = offset
        if isinstance(displaced_to, LispArray):
            displaced_to.followers = [*living_followers(displaced_to), ref(self)]

    @property
    def total_size(self):
        return math.prod(self.dimensions)

    def active(self):
        """The elements as a Python list, in row-major order."""
        return self.storage[self.offset : self.offset + self.total_size]

    def shape(self):
        """The dimensions as far as elements are active."""
        return self.dimensions


class SimpleArray(LispArray):
    """An array of any rank but one that is neither adjustable nor displaced: a class of its own, since methods are found by class.

    Its dimensions and its storage stay what they are. ``rows`` and ``columns`` are the dimensions of an array with two axes, 0 in others:
    compiled code finds an element by them.
    """

    __slots__ = ("rows", "columns")

    def __init__(self, dimensions, storage, element_type=True, adjustable=False):
        super().__init__(dimensions, storage, element_type, adjustable)
        self.rows, self.columns = self.dimensions if len(self.dimensions) == 2 else (0, 0)


class Vector(LispArray):
    """A vector with a fill pointer (or ``None``), or one that is adjustable or displaced. Python sees the active elements."""

    __slots__ = ("fill_pointer",)

    def __new__(cls, storage, fill_pointer=None, element_type=True, *_, **__):
        return super().__new__(BitVector if element_type is BIT else cls)

    def __init__(self, storage, fill_pointer=None, element_type=True, adjustable=False, displaced_to=None, offset=0, size=None):
        super().__init__((len(storage) if size is None else size,), storage, element_type, adjustable, displaced_to, offset)
        self.fill_pointer = fill_pointer

    def __len__(self):
        return self.dimensions[0] if self.fill_pointer is None else self.fill_pointer

    def __bool__(self):
        return True

    def active(self):
        return self.storage[self.offset : self.offset + len(self)]

    def shape(self):
        return (len(self),)

    def __iter__(self):
        return iter(self.active())

    def __getitem__(self, index):
        return self.active()[index]

    def __setitem__(self, index, value):
        size = len(self)
        if not -size <= index < size:
            raise IndexError(index)
        self.storage[self.offset + index % size] = value


class BitVector(Vector):
    """A vector of bits that is not simple."""

    __slots__ = ()


def living_followers(array):
    """The weak references to the arrays displaced to ``array`` that are still alive."""
    return [follower for follower in getattr(array, "followers", ()) if follower() is not None]


def take_storage(array, new):
    """Make ``array`` look like ``new``, and let the arrays that are displaced to it see that, and those displaced to these.

    One that ``array`` has become too small for loses its elements: its dimensions are zeros from then on, as in SBCL.
    """
    before = array.offset
    array.dimensions, array.storage, array.offset = new.dimensions, new.storage, new.offset
    if new.displaced_to is not array.displaced_to:
        if isinstance(array.displaced_to, LispArray):
            array.displaced_to.followers = [other for other in living_followers(array.displaced_to) if other() is not array]
        array.displaced_to = new.displaced_to
        if isinstance(array.displaced_to, LispArray):
            array.displaced_to.followers = [*living_followers(array.displaced_to), ref(array)]
    followers_moved(array, before)


def followers_moved(array, before):
    """Let the arrays displaced to ``array``, whose elements began at ``before`` of its storage, see the storage that it has now."""
    for follower in [found for found in map(_alive, getattr(array, "followers", ())) if found is not None]:
        start = follower.offset - before
        if start + follower.total_size > array.total_size:
            follower.lost = array_type(follower)
            follower.dimensions = (0,) * len(follower.dimensions)
            if getattr(follower, "fill_pointer", None) is not None:
                follower.fill_pointer = 0
        was, follower.storage, follower.offset = follower.offset, array.storage, array.offset + start
        followers_moved(follower, was)


def _alive(reference):
    return reference()


def bit_vector(bits):
    """The simple bit vector of ``bits``, an iterable of 0 and 1, as the reader makes it of ``#*101``."""
    return TypedVector(bits, BIT)


def is_bit_vector(thing):
    """Whether ``thing`` is a bit vector."""
    return isinstance(thing, (SimpleBitVector, BitVector))


# ------------------------------------------------------------------------------------------------------- what arrays are like


def is_simple(array):
    """Whether ``array`` has no fill pointer, is not adjustable and not displaced."""
    if isinstance(array, LispString):
        return array.fill_pointer is None and not array.adjustable
    return not isinstance(array, Vector) and not getattr(array, "adjustable", False) and getattr(array, "displaced_to", None) is None


def dimensions(array):
    """The dimensions as a Python tuple; of a vector with a fill pointer the whole size."""
    if isinstance(array, LispArray):
        return array.dimensions
    return (len(array.chars) if isinstance(array, LispString) else len(array),)


def element_type(array):
    """The upgraded element type, ``True`` for T. Python's bytes count as a vector of octets."""
    if isinstance(array, (str, LispString)):
        kind = getattr(array, "kind", False)
        return CHARACTER if kind is False else kind
    if isinstance(array, (bytes, bytearray)):
        return lisp_list(sym("UNSIGNED-BYTE"), 8)
    return getattr(array, "element_type", True)


def array_type(array):
    """The type specifier that ``type-of`` gives for an array: ``(SIMPLE-VECTOR 2)``, ``(VECTOR T 3)``."""
    sizes, kind, simple = dimensions(array), element_type(array), is_simple(array)
    if len(sizes) == 1:
        if kind is BIT:
            return lisp_list(sym("SIMPLE-BIT-VECTOR" if simple else "BIT-VECTOR"), *sizes)
        if kind is BASE_CHAR:
            return lisp_list(sym("SIMPLE-BASE-STRING" if simple else "BASE-STRING"), *sizes)
        if not simple:
            return lisp_list(sym("VECTOR"), kind, *sizes)
        if kind is True:
            return lisp_list(sym("SIMPLE-VECTOR"), *sizes)
    return lisp_list(sym("SIMPLE-ARRAY" if simple else "ARRAY"), kind, list_from(sizes))


class InvalidArrayIndex(TypeError_):
    """A subscript outside the array."""

    lisp_name = "SB-INT::INVALID-ARRAY-INDEX-ERROR"

    def __init__(self, index=None, array=None, axis=None, bound=0, **slots):
        super().__init__(index, f"(INTEGER 0 ({bound}))", **slots)
        self.array, self.axis, self.bound = array, axis, bound

    def report(self):
        return formatted(
            "Invalid index ~S for ~@[axis ~S of ~]~S, should be a non-negative integer below ~S.",
            (self.datum, self.axis, array_type(self.array), self.bound),
        )


class InvalidArray(TypeError_):
    """An array displaced to one that has become too small for it."""

    lisp_name = "SB-INT::INVALID-ARRAY-ERROR"

    def __init__(self, array=None, **slots):
        super().__init__(array, getattr(array, "lost", None), **slots)

    def report(self):
        return formatted(
            "Displaced array originally of type ~S has been invalidated due its displaced-to array ~S having become too small to hold "
            "it: the displaced array's dimensions have all been set to zero to trap accesses to it.",
            (self.expected_type, self.datum.displaced_to),
        )


def wrong_rank(subscripts, rank):
    return error("Wrong number of subscripts, ~W, for array of rank ~W.", len(subscripts), rank)
