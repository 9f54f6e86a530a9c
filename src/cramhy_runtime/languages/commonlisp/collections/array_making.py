"""Making arrays and changing their size: ``make-array``, ``vector``, ``adjust-array``.

``make-array`` chooses the plainest Python object that can do what was asked for: a ``list`` for a simple general vector, a
`LispString` for characters, a `TypedVector` for other element types, and a `Vector` or `LispArray` for fill pointers,
adjustability, displacement and more than one dimension.

Source: ANSI 15.2; texts are SBCL's.
"""

from __future__ import annotations

import math
from itertools import product

from cramhy_runtime.lisp_core.conditions import error, type_error
from cramhy_runtime.lisp_core.data import UNSUPPLIED, Character, Cons, KindString, LispString
from cramhy_runtime.lisp_core.heap import check_room
from .arrays import array_element_type, dimensions_of, without_fill_pointer
from .element_types import check_element, upgraded_element_type
from .element_types import initial_element as default_element
from .lists import items_of
from .sequence_types import DIMENSION_LIMIT, INDEX_TYPE, char_of, elements, text
from cramhy_runtime.lisp_core.arrays import (
    CHARACTER,
    STRING_KINDS,
    CharactersOfArray,
    LispArray,
    SharedCharacterObjects,
    SharedCharacters,
    SimpleArray,
    TypedVector,
    Vector,
    take_storage,
)

LISP_NAMES = "make-array vector adjust-array"


def vector(*items):
    """``vector``: a simple vector of the arguments."""
    return list(items)


def _dimensions(designator):
    if designator is None:
        return ()
    if isinstance(designator, Cons):
        dimensions = tuple(items_of(designator))
        for dimension in dimensions:
            if dimension.__class__ is not int or not 0 <= dimension < DIMENSION_LIMIT:
                type_error(dimension, INDEX_TYPE)
        return dimensions
    if designator.__class__ is not int or not 0 <= designator < DIMENSION_LIMIT:
        type_error(designator, f"(OR LIST {INDEX_TYPE})", "\nwhen binding SB-VM::DIMENSIONS")
    return (designator,)


def _fill_pointer(pointer, size):
    if pointer is None or pointer is False:
        return None
    if pointer is True:
        return size
    if pointer.__class__ is not int or pointer < 0:
        type_error(pointer, f"(OR {INDEX_TYPE} BOOLEAN)", "\nwhen binding FILL-POINTER")
    if pointer > size:
        error("Can't supply a value for :FILL-POINTER (~S) that is larger than the size of the vector (~S)", pointer, size)
    return pointer


def make_array(
    dimensions,
    *,
    element_type=True,
    initial_element=UNSUPPLIED,
    initial_contents=UNSUPPLIED,
    adjustable=None,
    fill_pointer=None,
    displaced_to=None,
    displaced_index_offset=0,
):
    """``make-array``: a new array. ``dimensions`` is an integer or a list of integers.

    The elements are ``initial_element``, or those of the nested sequences ``initial_contents``, or those of the array
    ``displaced_to`` from ``displaced_index_offset`` on, whose storage is then shared; else zeros of the type.
    """
    dimensions = _dimensions(dimensions)
    element_type = upgraded_element_type(element_type)
    adjustable = adjustable is not None and adjustable is not False
    size = math.prod(dimensions)
    if size >= DIMENSION_LIMIT:
        type_error(size, INDEX_TYPE)
    if displaced_to is None or displaced_to is False:
        check_room(size)
    if len(dimensions) != 1 and fill_pointer is not None and fill_pointer is not False:
        error("Only vectors can have fill pointers.")
    fill_pointer = _fill_pointer(fill_pointer, size)
    if displaced_to is not None and displaced_to is not False:
        if initial_element is not UNSUPPLIED or initial_contents is not UNSUPPLIED:
            error("Neither :INITIAL-ELEMENT nor :INITIAL-CONTENTS can be specified along with :DISPLACED-TO")
        return _displaced(dimensions, size, element_type, adjustable, fill_pointer, displaced_to, displaced_index_offset)
    items = _contents(dimensions, size, element_type, initial_element, initial_contents)
    if len(dimensions) != 1:
        return (LispArray if adjustable else SimpleArray)(dimensions, items, element_type, adjustable)
    if element_type in STRING_KINDS:
        if element_type is CHARACTER and fill_pointer is None and not adjustable:
            return text(items)
        return _string(items, element_type, fill_pointer, adjustable)
    if fill_pointer is not None or adjustable:
        return Vector(items, fill_pointer, element_type, adjustable)
    return items if element_type is True else TypedVector(items, element_type)


def _string(items, kind, fill_pointer=None, adjustable=False):
    """A string of the characters ``items``, of the element type ``kind``."""
    if fill_pointer is None and not adjustable:
        return text(items) if kind is CHARACTER else KindString(text(items), kind)
    made = LispString(map(char_of, items), fill_pointer, adjustable)
    if kind is not CHARACTER:
        made.kind = kind
    return made


def _contents(dimensions, size, element_type, element, contents):
    """The elements of a new array in row-major order, a new Python list."""
    if contents is not UNSUPPLIED:
        if element is not UNSUPPLIED:
            error("Can't specify both :INITIAL-ELEMENT and :INITIAL-CONTENTS")
        return [check_element(item, element_type) for item in _flattened(dimensions, contents)]
    if element is UNSUPPLIED:
        element = default_element(element_type)
    else:
        check_element(element, element_type, "\nwhen binding SB-C::ITEM")
    return [element] * size


def _flattened(dimensions, contents):
    if not dimensions:
        return [contents]
    if len(dimensions) == 1:
        items = elements(contents)
        if len(items) != dimensions[0]:
            error("There are ~W elements in the :INITIAL-CONTENTS, but the vector length is ~W.", len(items), dimensions[0])
        return list(items)
    result = []

    def collect(part, axis):
        if not _is_sequence(part):
            error("malformed :INITIAL-CONTENTS: ~S is not a sequence, but ~W more layer~:P needed.", part, len(dimensions) - axis)
        items = elements(part)
        if len(items) != dimensions[axis]:
            error("malformed :INITIAL-CONTENTS: Dimension of axis ~W is ~W, but ~S is ~W long.", axis, dimensions[axis], part, len(items))
        if axis == len(dimensions) - 1:
            result.extend(items)
        else:
            for item in items:
                collect(item, axis + 1)

    collect(contents, 0)
    return result


def _is_sequence(thing):
    return thing is None or isinstance(thing, (Cons, list, str, LispString, Vector, tuple))


def _displaced(dimensions, size, element_type, adjustable, fill_pointer, target, offset):
    dimensions_of(target) if isinstance(target, (list, str, LispString, LispArray)) else type_error(
        target, "(OR ARRAY NULL)", "\nwhen binding SB-VM::DISPLACED-TO"
    )
    if array_element_type(target) != element_type and not isinstance(element_type, Cons):
        error("Can't displace an array of type ~S into another of type ~S", element_type, array_element_type(target))
    if offset.__class__ is not int or offset < 0:
        type_error(offset, INDEX_TYPE, "\nwhen binding SB-VM::DISPLACED-INDEX-OFFSET")
    if isinstance(target, (str, LispString)):
        return _displaced_string(dimensions, size, fill_pointer, target, offset)
    storage = target.storage if isinstance(target, LispArray) else target
    available = target.total_size if isinstance(target, LispArray) else len(target)
    if offset + size > available:
        error("The :DISPLACED-TO array is too small.")
    start = offset + (target.offset if isinstance(target, LispArray) else 0)
    if len(dimensions) != 1:
        return LispArray(dimensions, storage, element_type, adjustable, target, start)
    if element_type in STRING_KINDS:
        made = _string((), element_type, fill_pointer, adjustable=True)
        made.chars = CharactersOfArray(target, start, size)
        return made
    return Vector(storage, fill_pointer, element_type, adjustable, target, start, size)


def _displaced_string(dimensions, size, fill_pointer, target, offset):
    chars = target.chars if isinstance(target, LispString) else target
    if offset + size > len(chars):
        error("The :DISPLACED-TO array is too small.")
    kind = array_element_type(target)
    if len(dimensions) != 1:
        return LispArray(dimensions, SharedCharacterObjects(target, offset, size), kind, True)
    made = _string((), kind, fill_pointer, adjustable=True)
    made.chars = SharedCharacters(target, offset, size)
    return made


def adjust_array(
    array,
    dimensions,
    *,
    element_type=UNSUPPLIED,
    initial_element=UNSUPPLIED,
    initial_contents=UNSUPPLIED,
    fill_pointer=UNSUPPLIED,
    displaced_to=None,
    displaced_index_offset=0,
):
    """``adjust-array``: the array with new ``dimensions`` and its old elements where both have them.

    An adjustable array is changed itself; of a simple one a changed copy is returned.
    """
    old_dimensions, dimensions = dimensions_of(array), _dimensions(dimensions)
    if len(old_dimensions) != len(dimensions):
        error("Expected ~D new dimension~:P for array, but received ~D.", len(old_dimensions), len(dimensions))
    kind = array_element_type(array)
    if element_type is not UNSUPPLIED and upgraded_element_type(element_type) != kind and not isinstance(kind, Cons):
        error("The new element type, ~S, is incompatible with old type, ~S.", element_type, kind)
    size = math.prod(dimensions)
    if displaced_to is not None:
        pointer = None if fill_pointer is UNSUPPLIED else _fill_pointer(fill_pointer, size)
        return _became(array, _displaced(dimensions, size, kind, True, pointer, displaced_to, displaced_index_offset))
    pointer = getattr(array, "fill_pointer", None)
    if fill_pointer is not UNSUPPLIED and fill_pointer is not None:
        if pointer is None:
            return without_fill_pointer(array)
        pointer = _fill_pointer(fill_pointer, size)
    elif pointer is not None and pointer > size:
        error("can't adjust vector ~S to a size (~S) smaller than its current fill pointer (~S)", array, size, pointer)
    items = _contents(dimensions, size, kind, initial_element, initial_contents)
    if initial_contents is UNSUPPLIED:
        _keep_old(array, old_dimensions, dimensions, items)
    if isinstance(array, (str, LispString)):
        if isinstance(array, str):
            return _string(items, kind)
        return _became(array, LispString([item.char for item in items], pointer, array.adjustable))
    if isinstance(array, list):
        return TypedVector(items, kind) if isinstance(array, TypedVector) else items
    if len(dimensions) == 1:
        return _became(array, Vector(items, pointer, kind, array.adjustable))
    return _became(array, (LispArray if array.adjustable else SimpleArray)(dimensions, items, kind, array.adjustable))


def _keep_old(array, old_dimensions, dimensions, items):
    if len(dimensions) == 1:
        old = elements_of_storage(array)[: dimensions[0]]
        items[: len(old)] = old
        return
    old = elements_of_storage(array)
    for subscripts in product(*(range(min(pair)) for pair in zip(old_dimensions, dimensions, strict=True))):
        items[_index(subscripts, dimensions)] = old[_index(subscripts, old_dimensions)]


def elements_of_storage(array):
    """All elements of an array in row-major order, those beyond a fill pointer included."""
    if isinstance(array, (str, LispString)):
        return [Character(char) for char in (array.chars if isinstance(array, LispString) else array)]
    if isinstance(array, LispArray):
        return array.storage[array.offset : array.offset + array.total_size]
    return array


def _index(subscripts, dimensions):
    index = 0
    for subscript, dimension in zip(subscripts, dimensions, strict=True):
        index = index * dimension + subscript
    return index


def _became(array, new):
    """Make the non-simple ``array`` look like ``new`` and return it; a simple one is left alone and ``new`` returned."""
    if isinstance(array, LispString) and isinstance(new, LispString) and (array.adjustable or array.fill_pointer is not None):
        array.chars, array.fill_pointer = new.chars, new.fill_pointer
        return array
    if isinstance(array, LispArray) and array.__class__ is new.__class__:
        if isinstance(array, Vector) or array.adjustable:
            take_storage(array, new)
            if isinstance(array, Vector):
                array.fill_pointer = new.fill_pointer
            return array
    return new
