"""What a sequence is: lists, vectors and strings seen alike, and the types that functions such as ``map`` make.

Sequence functions work on a Python list of the elements (`elements`) and give a result of the argument's own kind
(`same_kind`) or of a requested type (`to_sequence_type`). A string's elements are `Character` objects. Bounding indices are
checked here, in one place.

Law: what is no sequence is a ``type-error`` with SBCL's text, and bounds outside the sequence are SBCL's
``bounding-indices-bad-error``. Source: ANSI chapter 17.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.condition_types import SimpleTypeError, TypeError_, formatted
from cramhy_runtime.lisp_core.conditions import error, program_error, type_error
from cramhy_runtime.lisp_core.data import (
    CHARACTERS,
    WRITABLE_STRINGS,
    Character,
    Cons,
    FreshString,
    KindString,
    LispString,
    Symbol,
    list_from,
)
from cramhy_runtime.lisp_core.packages import sym
from cramhy_runtime.lisp_core.ports import PORTS
from cramhy_runtime.kernel.active import checkpoint
from .element_types import check_element, upgraded_element_type
from .lists import items_of
from cramhy_runtime.lisp_core.arrays import BASE_CHAR, BIT, CHARACTER, STRING_KINDS, LispArray, TypedVector, Vector, array_type, is_simple

DIMENSION_LIMIT = 4611686018427387901
INDEX_TYPE = f"(MOD {DIMENSION_LIMIT})"


class BoundingIndicesBad(TypeError_):
    """``:start`` and ``:end`` that do not lie in the sequence."""

    lisp_name = "SB-KERNEL::BOUNDING-INDICES-BAD-ERROR"

    def __init__(self, start=None, end=None, length=None, **slots):
        super().__init__(Cons(start, end), f"(CONS (INTEGER 0 {length}) (INTEGER 0 {length}))", **slots)
        self.start, self.end, self.length = start, end, length

    def report(self):
        return formatted(
            "The bounding indices ~S and ~S are bad for a sequence of length ~S.\nSee also:\n"
            '  The ANSI Standard, Glossary entry for "bounding index designator"\n'
            "  The ANSI Standard, writeup for Issue SUBSEQ-OUT-OF-BOUNDS:IS-AN-ERROR",
            (self.start, self.end, self.length),
        )


class IndexTooLarge(TypeError_):
    """An index of ``elt`` beyond the end."""

    lisp_name = "SB-KERNEL::INDEX-TOO-LARGE-ERROR"

    def __init__(self, index=None, sequence=None, length=0, **slots):
        super().__init__(index, f"(INTEGER 0 ({length}))", **slots)
        self.sequence, self.length = sequence, length

    def report(self):
        if self.sequence is None or isinstance(self.sequence, Cons):
            return f"The index {self.datum} is too large for a list of length {self.length}."
        pointer = getattr(self.sequence, "fill_pointer", None)
        return formatted(
            "Invalid index ~S for ~S ~@[with fill-pointer ~a~], should be a non-negative integer below ~S.",
            (self.datum, array_type(self.sequence), pointer, self.length),
        )


# ----------------------------------------------------------------------------------------------------------------- elements


TURN = 2000
"""So many elements are handled between two checkpoints: a long vector must not keep Ctrl-C, or other tasks, from their turn."""


def in_turns(items):
    """Iterate over ``items``, a Python list, string or range, with checkpoints. Few items are given as they are."""
    return items if len(items) <= TURN else _turns(items)


def _turns(items):
    for start in range(0, len(items), TURN):
        checkpoint()
        yield from items[start : start + TURN]


def characters(string):
    """The `Character` objects of a Python string."""
    return list(map(CHARACTERS.__getitem__, in_turns(string)))


def elements(sequence, context=""):
    """The elements of any sequence as a Python list, which the caller must not change. Non-sequences are a type-error.

    Python tuples, bytes and ranges, which foreign code may pass in, count as vectors.
    """
    if isinstance(sequence, Cons):
        return items_of(sequence)
    if isinstance(sequence, list):
        return sequence
    if sequence is None or sequence is False:
        return []
    if isinstance(sequence, (str, LispString)):
        return characters(str(sequence))
    if isinstance(sequence, Vector):
        return sequence.active()
    if isinstance(sequence, (tuple, bytes, bytearray, range)):
        return list(sequence)
    return not_a_sequence(sequence, context)


def not_a_sequence(thing, context=""):
    """Signal that ``thing`` is no sequence."""
    return type_error(thing, "SEQUENCE", context)


def is_string(thing):
    """Whether ``thing`` is a Lisp string."""
    return isinstance(thing, (str, LispString))


def char_of(element, element_type="CHARACTER"):
    """The one-character Python string of a character that is stored in a string; anything else is a type-error."""
    if element.__class__ is not Character:
        type_error(element, "CHARACTER", f"\nwhen setting an element of (ARRAY {element_type})")
    return element.char


def text(items):
    """A string of the characters ``items``, a Python list."""
    try:
        return FreshString("".join([item.char for item in items]))
    except AttributeError:
        return FreshString("".join([char_of(item) for item in items]))


def string_of_kind(items, kind):
    """A simple string of the characters ``items``, of the element type ``kind``: BASE-CHAR, or ``None`` for nil."""
    if kind is BASE_CHAR:
        for item in items:
            check_element(item, BASE_CHAR)
    return KindString(text(items), kind)


def string_like(string, text):
    """A new string of the characters of ``text``, of the element type of ``string``."""
    kind = getattr(string, "kind", False)
    return FreshString(text) if kind is False else KindString(text, kind)


def same_kind(sequence, items):
    """A new sequence of ``items`` of the kind of ``sequence``: list, vector with its element type, or string."""
    if sequence is None or isinstance(sequence, Cons):
        return list_from(items)
    if is_string(sequence):
        return text(items) if getattr(sequence, "kind", False) is False else string_of_kind(items, sequence.kind)
    if isinstance(sequence, (TypedVector, Vector)) and sequence.element_type is not True:
        return typed_vector(items, sequence.element_type)
    return list(items)


def typed_vector(items, element_type):
    """A simple vector of ``items``: string, list or `TypedVector`, as the (upgraded) element type demands."""
    if element_type is True:
        return list(items)
    if element_type is CHARACTER:
        return text(items)
    if element_type in STRING_KINDS:
        return string_of_kind(items, element_type)
    for item in items:
        check_element(item, element_type)
    return TypedVector(items, element_type)


# ------------------------------------------------------------------------------------------------------------------- bounds


def bounds(start, end, length):
    """(start, end) as Python integers, end included for nil; bad ones are an error."""
    if start.__class__ is not int or start < 0:
        if start is None:
            start = 0
        else:
            type_error(start, INDEX_TYPE, "\nwhen binding SB-IMPL::START")
    if end is None or end is False:
        if start <= length:
            return start, length
        return error(BoundingIndicesBad(start, None, length))
    if end.__class__ is not int or end < 0:
        type_error(end, f"(OR NULL {INDEX_TYPE})", "\nwhen binding SB-IMPL::END")
    if start <= end <= length:
        return start, end
    return error(BoundingIndicesBad(start, end, length))


def span(sequence, start, end):
    """(all elements, start, end) of the part of ``sequence`` between the bounding indices."""
    items = elements(sequence)
    if start == 0 and end is None and start.__class__ is int:
        return items, 0, len(items)
    return items, *bounds(start, end, len(items))


def part(sequence, start, end):
    """The elements between the bounding indices, as a Python list that the caller must not change."""
    items = elements(sequence)
    if start == 0 and end is None and start.__class__ is int:
        return items
    start, end = bounds(start, end, len(items))
    return items[start:end]


def limit(count):
    """How many elements a ``:count`` argument allows; ``None`` means all."""
    if count is None or count is False:
        return None
    if count.__class__ is not int:
        type_error(count, "(OR NULL INTEGER)", "\nwhen binding COUNT")
    return max(count, 0)


def store_all(sequence, start, items):
    """Store ``items`` into ``sequence`` from index ``start`` on, in place. A constant string is an error."""
    if not items:
        return
    if isinstance(sequence, Cons):
        cell = sequence
        for _ in range(start):
            cell = cell.cdr
        for item in items:
            cell.car = item
            cell = cell.cdr
    elif sequence.__class__ in WRITABLE_STRINGS:
        new = [char_of(item) for item in items]
        sequence.writable()[start : start + len(items)] = new
    elif sequence.__class__ is list:
        sequence[start : start + len(items)] = items
    elif isinstance(sequence, TypedVector):
        for item in items:
            check_element(item, sequence.element_type)
        sequence[start : start + len(items)] = items
    elif isinstance(sequence, LispArray):
        for item in items:
            check_element(item, sequence.element_type)
        start += sequence.offset
        sequence.storage[start : start + len(items)] = items
    else:
        constant_changed(sequence)


def constant_changed(sequence):
    """Signal that a string (or a foreign sequence) cannot be changed in place."""
    what = "string" if is_string(sequence) else "Python sequence"
    return error(f"The {what} ~S is a constant and cannot be changed in place. Change a copy of it: (copy-seq ~S).", sequence, sequence)


# -------------------------------------------------------------------------------------------------- types of new sequences

_LISTS = {"LIST", "CONS", "NULL"}
_STRINGS = {"STRING", "SIMPLE-STRING", "BASE-STRING", "SIMPLE-BASE-STRING"}
_BITS = {"BIT-VECTOR", "SIMPLE-BIT-VECTOR"}
_GENERAL = {"VECTOR", "SIMPLE-VECTOR", "ARRAY", "SIMPLE-ARRAY"}


class SequenceType:
    """A type specifier read as "how to make a sequence": ``element_type`` is ``None`` for lists; ``length`` may be fixed."""

    __slots__ = ("specifier", "element_type", "length", "nonempty", "simple")

    def __init__(self, specifier, element_type, length=None, nonempty=False, simple=False):
        self.specifier, self.element_type, self.simple = specifier, element_type, simple
        self.length, self.nonempty = length, nonempty

    def check_length(self, length):
        if (self.length is not None and length != self.length) or (self.nonempty and not length):
            error(
                SimpleTypeError(
                    "The length requested (~S) does not match the type restriction in ~S.",
                    length,
                    self.specifier,
                    datum=length,
                    expected_type="(INTEGER 1)" if self.length is None else f"(EQL {self.length})",
                )
            )

    def make(self, items):
        """A new sequence of the type with the elements ``items``, a Python list."""
        self.check_length(len(items))
        return list_from(items) if self.element_type is None else typed_vector(items, self.element_type)


_known_types: dict = {}


def sequence_type(specifier):
    """The `SequenceType` of a type specifier; one that names no sequence is a simple-type-error."""
    if isinstance(specifier, Symbol) and specifier in _known_types:
        return _known_types[specifier]
    found = _read_type(specifier, specifier)
    if found is None:
        named = PORTS.types.expand(specifier)
        expected = "(SATISFIES SB-IMPL::IS-A-VALID-SEQUENCE-TYPE-SPECIFIER-P)"
        return error(SimpleTypeError("~S is a bad type specifier for sequences.", named, datum=named, expected_type=expected))
    if isinstance(specifier, Symbol) and specifier.package is sym("LIST").package:
        _known_types[specifier] = found
    return found


def is_sequence_type(specifier):
    """Whether sequences of the type can be made."""
    return isinstance(specifier, (Cons, Symbol, type)) and _read_type(specifier, specifier) is not None


def _read_type(specifier, original):
    if isinstance(specifier, Symbol):
        name, parameters = specifier, []
    elif isinstance(specifier, Cons) and isinstance(specifier.car, Symbol):
        name, *parameters = items_of(specifier)
    else:
        name = PORTS.types.expand(specifier)  # a class
        return None if name is specifier else _read_type(name, name)
    if name.package is sym("LIST").package:
        kind, star = name.name, sym("*")
        simple = kind.startswith("SIMPLE-")
        given = [None if parameter is star else parameter for parameter in parameters] + [None, None]
        if kind in _LISTS and (kind == "CONS" or not isinstance(specifier, Cons)):
            return SequenceType(original, None, _length_of_list(specifier), kind == "CONS")
        if kind in _STRINGS:
            return SequenceType(original, BASE_CHAR if "BASE" in kind else CHARACTER, given[0], simple=simple)
        if kind in _BITS:
            return SequenceType(original, BIT, given[0], simple=simple)
        if kind == "SIMPLE-VECTOR":
            return SequenceType(original, True, given[0], simple=simple)
        if kind in _GENERAL:
            element_type = True if given[0] is None else upgraded_element_type(given[0])
            if element_type is None:  # NIL; here it would mean lists
                element_type = True
            if given[1].__class__ is int and kind in ("ARRAY", "SIMPLE-ARRAY"):  # a rank
                return SequenceType(original, element_type, simple=simple) if given[1] == 1 else None
            if kind in ("ARRAY", "SIMPLE-ARRAY") and not (isinstance(given[1], Cons) and given[1].cdr is None):
                return None  # of any rank, or of another
            return SequenceType(original, element_type, _one_dimension(given[1]), simple=simple)
        if kind in ("AND", "OR"):
            found = [_read_type(parameter, original) for parameter in parameters]
            if kind == "OR" and len({None if one is None else one.element_type is None for one in found}) > 1:
                return None  # lists and vectors: it does not say which to make
            if kind == "OR" and len({one.element_type for one in found if one is not None and one.element_type is not None}) > 1:
                return program_error("~S is too hairy for sequence functions.", original)
            return next((one for one in found if one is not None), None)
    expansion = PORTS.types.expand(specifier)
    return None if expansion is specifier else _read_type(expansion, expansion)


def _length_of_list(specifier):
    """How long the lists of the type are, if it says so: ``null`` and ``(cons a (cons b null))`` do."""
    length = 0
    while isinstance(specifier, Cons) and specifier.car is sym("CONS"):
        parts = items_of(specifier)
        length, specifier = length + 1, parts[2] if len(parts) == 3 else None
    return length if specifier is sym("NULL") else None


def _one_dimension(dimensions):
    if isinstance(dimensions, Cons):
        dimensions = dimensions.car
    return dimensions if dimensions.__class__ is int else None


def to_sequence_type(sequence, specifier):
    """The part of ``coerce`` that makes sequences: ``sequence`` itself if it is of the type, else a new one of the type."""
    wanted = sequence_type(specifier)
    items = elements(sequence)
    if wanted.element_type is None:
        if sequence is None or isinstance(sequence, Cons):
            wanted.check_length(len(items))
            return sequence
    elif wanted.simple and not is_simple(sequence):
        return wanted.make(items)
    elif wanted.element_type is BASE_CHAR and is_string(sequence) and getattr(sequence, "kind", None) is BASE_CHAR:
        wanted.check_length(len(items))
        return sequence
    elif wanted.element_type is CHARACTER:
        if is_string(sequence) and getattr(sequence, "kind", False) is False:
            wanted.check_length(len(items))
            return sequence
    elif (
        not isinstance(sequence, (str, LispString)) and getattr(sequence, "element_type", sequence.__class__ is list) == wanted.element_type
    ):
        wanted.check_length(len(items))
        return sequence
    return wanted.make(items)
