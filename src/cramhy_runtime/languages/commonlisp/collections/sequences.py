"""Sequences: length, elements and parts; copying, reversing, filling, joining, making.

The functions work on lists, vectors and strings alike; what these are stands in ``sequence_types.py``. Mapping, searching,
removing and sorting have modules of their own.

Law: a function that is not named destructive leaves its arguments alone, and its result has the argument's own kind. Source:
ANSI chapter 17; texts are SBCL's.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.conditions import error, type_error
from cramhy_runtime.lisp_core.data import STRETCH, TEXTS, UNSUPPLIED, Character, Cons, FreshString, LispString, list_from
from cramhy_runtime.lisp_core.heap import CONS, POINTER, check_room
from cramhy_runtime.kernel.active import checkpoint
from cramhy_runtime.lisp_core.packages import sym
from .element_types import check_element
from .element_types import initial_element as default_element
from .lists import items_of, not_a_list
from .sequence_types import (
    DIMENSION_LIMIT,
    INDEX_TYPE,
    IndexTooLarge,
    bounds,
    elements,
    not_a_sequence,
    part,
    same_kind,
    string_like,
    sequence_type,
    store_all,
)
from cramhy_runtime.lisp_core.arrays import LispArray, TypedVector, Vector

STRING = sym("STRING")
LISP_NAMES = "length elt subseq copy-seq reverse nreverse concatenate make-sequence fill replace"


def length(sequence):
    """``length``: the number of elements, up to the fill pointer if there is one."""
    if isinstance(sequence, (list, str, LispString, Vector, tuple, bytes, bytearray, range)):
        return len(sequence)
    if isinstance(sequence, Cons):
        count, cell = 0, sequence
        while True:
            for _ in STRETCH:
                if cell.__class__ is not Cons:
                    return count if cell is None or cell is False else not_a_list(cell)
                count += 1
                cell = cell.cdr
            checkpoint()
    return 0 if sequence is None or sequence is False else not_a_sequence(sequence)


def elt(sequence, index):
    """``elt``: element number ``index``, counted from 0."""
    _check_index(index)
    if isinstance(sequence, Cons):
        cell, left = sequence, index
        while left and isinstance(cell, Cons):
            cell = cell.cdr
            left -= 1
            if not left & 255:
                checkpoint()
        if isinstance(cell, Cons):
            return cell.car
        return not_a_list(cell) if cell is not None else error(IndexTooLarge(index, sequence, length(sequence)))
    if sequence.__class__ is list and index < len(sequence):
        return sequence[index]
    size = length(sequence)
    if index >= size:
        error(IndexTooLarge(index, sequence, size))
    if isinstance(sequence, (str, LispString)):
        return Character(sequence[index])
    return sequence[index]


def _check_index(index):
    if index.__class__ is not int or index < 0:
        type_error(index, INDEX_TYPE, "\nwhen binding SB-INT:INDEX")


def set_elt(value, sequence, index):
    """``(setf elt)``."""
    elt(sequence, index)
    store_all(sequence, index, [value])
    return value


def subseq(sequence, start, end=None):
    """``subseq``: a copy of the part from ``start`` up to ``end``."""
    if isinstance(sequence, (str, LispString)):
        string = sequence if sequence.__class__ in TEXTS else str(sequence)
        start, end = bounds(start, end, len(string))
        return string_like(sequence, string[start:end])
    items = part(sequence, start, end)
    return same_kind(sequence, items)


def set_subseq(value, sequence, start, end=None):
    """``(setf subseq)``: replace the part by the elements of ``value``, as far as they reach."""
    replace(sequence, value, start1=start, end1=end)
    return value


def copy_seq(sequence):
    """``copy-seq``: a new sequence with the same elements."""
    if isinstance(sequence, (str, LispString)):
        return string_like(sequence, str(sequence))
    return same_kind(sequence, elements(sequence))


def reverse(sequence):
    """``reverse``: a new sequence with the elements in reverse order."""
    if isinstance(sequence, Cons):
        return list_from(items_of(sequence)[::-1])
    if isinstance(sequence, (str, LispString)):
        return string_like(sequence, str(sequence)[::-1])
    return same_kind(sequence, elements(sequence)[::-1])


def nreverse(sequence):
    """``nreverse``: as `reverse`, using up the argument."""
    if sequence.__class__ is Cons:
        length(sequence)  # a dotted end is found before anything is changed
        result, cell = None, sequence
        while cell.__class__ is Cons:
            following, cell.cdr = cell.cdr, result
            result, cell = cell, following
        return result
    if sequence.__class__ is str:
        return FreshString(sequence[::-1])
    store_all(sequence, 0, elements(sequence)[::-1])
    return sequence


def concatenate(result_type, *sequences):
    """``concatenate``: a new sequence of type ``result_type`` with the elements of all arguments."""
    if result_type is STRING and all([sequence.__class__ in TEXTS for sequence in sequences]):
        return FreshString("".join(sequences))
    wanted = sequence_type(result_type)
    items = []
    for sequence in sequences:
        items += elements(sequence)
    return wanted.make(items)


def make_sequence(result_type, size, *, initial_element=UNSUPPLIED):
    """``make-sequence``: a new sequence of type ``result_type`` with ``size`` elements."""
    wanted = sequence_type(result_type)
    if size.__class__ is not int or not 0 <= size < DIMENSION_LIMIT:
        type_error(size, INDEX_TYPE, "\nwhen binding LENGTH")
    wanted.check_length(size)
    check_room(size, POINTER if wanted.element_type is not None else CONS)
    if wanted.element_type is None:
        return list_from([None if initial_element is UNSUPPLIED else initial_element] * size)
    if initial_element is UNSUPPLIED:
        initial_element = default_element(wanted.element_type)
    check_element(initial_element, wanted.element_type, "")
    return wanted.make([initial_element] * size)


def fill(sequence, item, *, start=0, end=None):
    """``fill``: set the elements from ``start`` up to ``end`` to ``item``, in place; returns the sequence."""
    start, end = bounds(start, end, length(sequence))
    if isinstance(sequence, (TypedVector, LispArray)):
        check_element(item, sequence.element_type, "\nwhen binding SB-C::ITEM")
    store_all(sequence, start, [item] * (end - start))
    return sequence


def replace(sequence, source, *, start1=0, end1=None, start2=0, end2=None):
    """``replace``: copy elements of ``source`` into ``sequence``, in place; returns ``sequence``."""
    start, end = bounds(start1, end1, length(sequence))
    items = part(source, start2, end2)
    store_all(sequence, start, items[: end - start])
    return sequence


SETTERS = {"ELT": set_elt, "SUBSEQ": set_subseq}
