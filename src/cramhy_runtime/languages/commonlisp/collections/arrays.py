"""Arrays: reading, writing and describing them.

A subscript list is turned into one index into the storage by `_place`, the only function that knows how the four kinds of
array (list, string, `TypedVector`, `LispArray`) keep their elements; ``aref``, ``svref``, ``char``, ``bit`` and their setters
go through it. Arrays are made in ``array_making.py``.

Law: a subscript that is no index of its axis is SBCL's ``invalid-array-index-error``, also for a fill-pointer vector, whose
elements beyond the fill pointer can still be reached by ``aref``. Source: ANSI chapter 15; texts are SBCL's.
"""

from __future__ import annotations

import math

from cramhy_runtime.lisp_core.condition_types import SimpleTypeError
from cramhy_runtime.lisp_core.conditions import error, type_error
from cramhy_runtime.lisp_core.data import WRITABLE_STRINGS, Character, LispString, MultipleValues, list_from
from .element_types import FLOAT_CLASSES, LIMITS, check_element, upgraded_element_type
from .sequence_types import char_of, constant_changed
from cramhy_runtime.lisp_core.arrays import InvalidArray, InvalidArrayIndex, followers_moved, wrong_rank
from cramhy_runtime.lisp_core.arrays import (
    SharedCharacters,
    BIT,
    LispArray,
    SimpleArray,
    SimpleBitVector,
    TypedVector,
    Vector,
    dimensions,
    element_type,
    is_bit_vector,
    is_simple,
)

LISP_NAMES = """
aref svref row-major-aref bit sbit array-dimensions array-dimension array-rank array-total-size array-in-bounds-p
array-row-major-index array-element-type array-displacement array-has-fill-pointer-p adjustable-array-p
upgraded-array-element-type fill-pointer vector-push vector-push-extend vector-pop
arrayp vectorp simple-vector-p bit-vector-p simple-bit-vector-p
bit-and bit-ior bit-xor bit-eqv bit-nand bit-nor bit-andc1 bit-andc2 bit-orc1 bit-orc2 bit-not
"""


CONSTANTS = VARIABLES = {"ARRAY-DIMENSION-LIMIT": 2**62 - 3, "ARRAY-TOTAL-SIZE-LIMIT": 2**62 - 3, "ARRAY-RANK-LIMIT": 129}


# --------------------------------------------------------------------------------------------------------- what is an array


def arrayp(thing):
    """``arrayp``: whether ``thing`` is an array; vectors and strings are."""
    return True if isinstance(thing, (list, str, LispString, LispArray)) else None


def vectorp(thing):
    """``vectorp``: whether ``thing`` is a one-dimensional array."""
    return True if isinstance(thing, (list, str, LispString, Vector)) else None


def simple_vector_p(thing):
    """``simple-vector-p``: whether ``thing`` is a vector of elements of any type, without fill pointer, not adjustable."""
    return True if isinstance(thing, list) and getattr(thing, "element_type", True) is True else None


def bit_vector_p(thing):
    """``bit-vector-p``: whether ``thing`` is a vector of bits."""
    return True if is_bit_vector(thing) else None


def simple_bit_vector_p(thing):
    """``simple-bit-vector-p``: a bit vector without fill pointer, not adjustable."""
    return True if isinstance(thing, SimpleBitVector) else None


def not_an_array(thing, context="\nwhen binding ARRAY"):
    return type_error(thing, "ARRAY", context)


def dimensions_of(array, context="\nwhen binding ARRAY"):
    """The dimensions as a Python tuple, fill pointers ignored; a non-array is a type-error."""
    return dimensions(array) if isinstance(array, (list, str, LispArray, LispString)) else not_an_array(array, context)


# ---------------------------------------------------------------------------------------------------- reading and writing


def _place(array, subscripts):
    """(storage, index) of the element of ``array`` at ``subscripts``."""
    if not isinstance(array, LispArray):
        storage = array.chars if array.__class__ is LispString else array if isinstance(array, (list, str)) else not_an_array(array)
        if len(subscripts) != 1:
            wrong_rank(subscripts, 1)
        return storage, _check(subscripts[0], len(storage), array)
    return array.storage, array.offset + _row_major(array, subscripts)


def _check(index, bound, array, axis=None):
    if index.__class__ is not int or not 0 <= index < bound:
        error(InvalidArray(array) if hasattr(array, "lost") else InvalidArrayIndex(index, array, axis, bound))
    return index


def _row_major(array, subscripts):
    dimensions = dimensions_of(array)
    if len(subscripts) != len(dimensions):
        wrong_rank(subscripts, len(dimensions))
    index = 0
    for axis, (subscript, dimension) in enumerate(zip(subscripts, dimensions, strict=True)):
        index = index * dimension + _check(subscript, dimension, array, axis if len(dimensions) > 1 else None)
    return index


def _read(array, storage, index):
    element = storage[index]
    return Character(element) if isinstance(array, (str, LispString)) else element


def _write(array, storage, index, value):
    if storage.__class__ is list and not isinstance(array, (LispString, LispArray)):
        storage[index] = value
    elif isinstance(array, (str, LispString)):
        char = char_of(value)
        if array.__class__ not in WRITABLE_STRINGS:
            constant_changed(array)
        array.writable()[index] = char
    else:
        storage[index] = check_element(value, array.element_type)
    return value


def aref(array, *subscripts):
    """``aref``: the element at ``subscripts``."""
    if (array.__class__ is list or array.__class__ is TypedVector) and len(subscripts) == 1:
        index = subscripts[0]
        if index.__class__ is int and 0 <= index < len(array):
            return array[index]
    return _read(array, *_place(array, subscripts))


def set_aref(value, array, *subscripts):
    """``(setf aref)``."""
    if array.__class__ is TypedVector and len(subscripts) == 1:
        index = subscripts[0]
        if index.__class__ is int and 0 <= index < len(array):
            limits = LIMITS.get(id(array.element_type)) if value.__class__ is int else None
            if value.__class__ is FLOAT_CLASSES.get(array.element_type) or limits is not None and limits[0] <= value <= limits[1]:
                array[index] = value
                return value
    return _write(array, *_place(array, subscripts), value)


def svref(vector, index):
    """``svref``: the element of a simple general vector."""
    if simple_vector_p(vector) is None:
        type_error(vector, "SIMPLE-VECTOR", "\nwhen binding SIMPLE-VECTOR")
    return vector[_check(index, len(vector), vector)]


def set_svref(value, vector, index):
    """``(setf svref)``."""
    svref(vector, index)
    vector[index] = value
    return value


def row_major_aref(array, index):
    """``row-major-aref``: element number ``index`` in row-major order."""
    return _read(array, *_row_major_place(array, index))


def set_row_major_aref(value, array, index):
    """``(setf row-major-aref)``."""
    return _write(array, *_row_major_place(array, index), value)


def _row_major_place(array, index):
    if not isinstance(array, LispArray):
        return _place(array, (index,))
    return array.storage, array.offset + _check(index, array.total_size, array)


def bit(array, *subscripts):
    """``bit``: the bit at ``subscripts`` of a bit array."""
    return aref(_bit_array(array), *subscripts)


def set_bit(value, array, *subscripts):
    """``(setf bit)``."""
    return set_aref(value, _bit_array(array), *subscripts)


def sbit(array, *subscripts):
    """``sbit``: the bit at ``subscripts`` of a simple bit array."""
    return aref(_simple_bit_array(array), *subscripts)


def set_sbit(value, array, *subscripts):
    """``(setf sbit)``."""
    return set_aref(value, _simple_bit_array(array), *subscripts)


def _simple_bit_array(array):
    return array if is_simple(_bit_array(array)) else type_error(array, "(SIMPLE-ARRAY BIT)", "\nwhen binding ARRAY")


def _bit_array(array, context="\nwhen binding ARRAY"):
    if getattr(array, "element_type", True) is not BIT:
        type_error(array, "(ARRAY BIT)", context)
    return array


# ------------------------------------------------------------------------------------------------------------- description


def array_dimensions(array):
    """``array-dimensions``: the list of the dimensions."""
    return list_from(dimensions_of(array, ""))


def array_rank(array):
    """``array-rank``: the number of dimensions."""
    return len(dimensions_of(array))


def array_dimension(array, axis):
    """``array-dimension``: the size of axis number ``axis``."""
    dimensions = dimensions_of(array)
    if axis.__class__ is int and 0 <= axis < len(dimensions):
        return dimensions[axis]
    if axis.__class__ is not int or axis < 0:
        return type_error(axis, "(MOD 4611686018427387901)", "\nwhen binding SB-KERNEL:AXIS-NUMBER")
    if len(dimensions) == 1:
        return error("Vector axis is not zero: ~S", axis)
    return error("Axis number ~W is too big; ~S only has ~D dimension~:P.", axis, array, len(dimensions))


def array_total_size(array):
    """``array-total-size``: the number of elements, those beyond a fill pointer included."""
    return math.prod(dimensions_of(array, ""))


def array_in_bounds_p(array, *subscripts):
    """``array-in-bounds-p``: whether the subscripts are valid."""
    dimensions = dimensions_of(array)
    if len(subscripts) != len(dimensions):
        wrong_rank(subscripts, len(dimensions))
    return (
        True
        if all(
            subscript.__class__ is int and 0 <= subscript < dimension for subscript, dimension in zip(subscripts, dimensions, strict=True)
        )
        else None
    )


def array_row_major_index(array, *subscripts):
    """``array-row-major-index``: the index of `row_major_aref` for ``subscripts``."""
    return _row_major(array, subscripts)


def array_element_type(array):
    """``array-element-type``: the upgraded element type."""
    dimensions_of(array)
    return element_type(array)


def upgraded_array_element_type(specifier, environment=None):
    """``upgraded-array-element-type``: the element type that an array made for ``specifier`` has."""
    return upgraded_element_type(specifier)


def array_displacement(array):
    """``array-displacement``: two values, the target of a displaced array (or nil) and the offset into it."""
    dimensions_of(array)
    shared = getattr(array, "chars", getattr(array, "storage", None))
    if isinstance(shared, SharedCharacters):
        return MultipleValues((shared.target, shared.offset - getattr(shared.target, "offset", 0)))
    target = getattr(array, "displaced_to", None)
    if target is None:
        return MultipleValues((None, 0))
    return MultipleValues((target, array.offset - getattr(target, "offset", 0)))


def array_has_fill_pointer_p(array):
    """``array-has-fill-pointer-p``: whether the array has a fill pointer."""
    dimensions_of(array)
    return True if getattr(array, "fill_pointer", None) is not None else None


def adjustable_array_p(array):
    """``adjustable-array-p``: whether ``adjust-array`` changes the array itself. As in SBCL, non-simple arrays are."""
    dimensions_of(array)
    return None if is_simple(array) else True


# ------------------------------------------------------------------------------------------------------------ fill pointers


def without_fill_pointer(vector):
    """Signal that ``vector`` has no fill pointer."""
    return error(
        SimpleTypeError(
            "~S is not an array with a fill pointer.",
            vector,
            datum=vector,
            expected_type="(AND VECTOR (SATISFIES ARRAY-HAS-FILL-POINTER-P))",
        )
    )


def _filled(vector):
    if getattr(vector, "fill_pointer", None) is None:
        without_fill_pointer(vector)
    return vector


def _items(vector):
    # The whole storage list that is the vector's own, elements beyond the fill pointer included.
    return vector.chars if isinstance(vector, LispString) else vector.storage


def _size(vector):
    return len(vector.chars) if isinstance(vector, LispString) else vector.dimensions[0]


def fill_pointer(vector):
    """``fill-pointer``: the number of active elements."""
    return _filled(vector).fill_pointer


def set_fill_pointer(value, vector):
    """``(setf fill-pointer)``."""
    _filled(vector)
    if value.__class__ is not int or value < 0:
        type_error(value, "(MOD 4611686018427387901)")
    if value > _size(vector):
        error(
            SimpleTypeError(
                "The new fill pointer, ~S, is larger than the length of the vector (~S.)",
                value,
                _size(vector),
                datum=value,
                expected_type=f"(INTEGER 0 {_size(vector)})",
            )
        )
    vector.fill_pointer = value
    return value


def vector_push(element, vector):
    """``vector-push``: store ``element`` at the fill pointer; returns its index, or nil when the vector is full."""
    _filled(vector)
    index = vector.fill_pointer
    if index >= _size(vector):
        return None
    if isinstance(vector, LispString):
        vector.chars[index] = char_of(element)
    else:
        vector.storage[vector.offset + index] = check_element(element, vector.element_type)
    vector.fill_pointer = index + 1
    return index


def vector_push_extend(element, vector, min_extension=None):
    """``vector-push-extend``: as `vector_push`, but a full vector grows, by ``min_extension`` elements at least."""
    if vector.__class__ is Vector and vector.element_type is True:
        index = vector.fill_pointer
        if index is not None and index < vector.dimensions[0]:
            vector.storage[vector.offset + index] = element
            vector.fill_pointer = index + 1
            return index
    _filled(vector)
    index, size = vector.fill_pointer, _size(vector)
    if index < size:
        return vector_push(element, vector)
    more = max(min_extension or 0, size, 1)
    if isinstance(vector, LispString):
        vector.chars += [char_of(element)] + ["\0"] * (more - 1)
    else:
        check_element(element, vector.element_type)
        if vector.displaced_to is not None:  # it gets a storage of its own; the target stays as it is
            before = vector.offset
            vector.storage, vector.offset, vector.displaced_to = vector.active(), 0, None
            followers_moved(vector, before)
        vector.storage += [element] + [0] * (more - 1)
        vector.dimensions = (size + more,)
    vector.fill_pointer = index + 1
    return index


def vector_pop(vector):
    """``vector-pop``: lower the fill pointer by one; returns the element there."""
    _filled(vector)
    if vector.fill_pointer == 0:
        error("There is nothing left to pop.")
    vector.fill_pointer -= 1
    return aref(vector, vector.fill_pointer)


# -------------------------------------------------------------------------------------------------------------- bit arrays


def _bit_operation(name, operation):
    def combine(first, second, result=None):
        _bit_array(first, "\nwhen binding SB-VM::BIT-ARRAY-1")
        _bit_array(second, "\nwhen binding SB-VM::BIT-ARRAY-2")
        if dimensions_of(first) != dimensions_of(second):
            error("~S and ~S don't have the same dimensions.", first, second)
        return _bits_into([operation(x, y) & 1 for x, y in zip(_all_bits(first), _all_bits(second), strict=True)], first, result)

    combine.__name__ = combine.__qualname__ = name
    combine.__doc__ = f"``{name.replace('_', '-')}``: the operation bit by bit; into ``result``, or FIRST if it is t."
    return combine


def _all_bits(array):
    return array if isinstance(array, TypedVector) else array.storage[array.offset : array.offset + array.total_size]


def _bits_into(bits, first, result):
    if result is None or result is False:
        if isinstance(first, (TypedVector, Vector)):
            return TypedVector(bits, BIT)
        return SimpleArray(first.dimensions, bits, BIT)
    target = first if result is True else _bit_array(result, "\nwhen binding SB-VM::RESULT-BIT-ARRAY")
    if isinstance(target, TypedVector):
        target[:] = bits
    else:
        target.storage[target.offset : target.offset + len(bits)] = bits
    return target


def bit_not(array, result=None):
    """``bit-not``: every bit inverted; into ``result``, or the array itself if it is t."""
    return _bits_into([1 - one for one in _all_bits(_bit_array(array))], array, result)


for _name, _operation in {
    "bit_and": lambda x, y: x & y,
    "bit_ior": lambda x, y: x | y,
    "bit_xor": lambda x, y: x ^ y,
    "bit_eqv": lambda x, y: ~(x ^ y),
    "bit_nand": lambda x, y: ~(x & y),
    "bit_nor": lambda x, y: ~(x | y),
    "bit_andc1": lambda x, y: ~x & y,
    "bit_andc2": lambda x, y: x & ~y,
    "bit_orc1": lambda x, y: ~x | y,
    "bit_orc2": lambda x, y: x | ~y,
}.items():
    globals()[_name] = _bit_operation(_name, _operation)

SETTERS = {
    "AREF": set_aref,
    "SVREF": set_svref,
    "ROW-MAJOR-AREF": set_row_major_aref,
    "BIT": set_bit,
    "SBIT": set_sbit,
    "FILL-POINTER": set_fill_pointer,
}
