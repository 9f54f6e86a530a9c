"""Arrays: which Python object stands for which, fill pointers, displacement, adjusting, bits."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from sbcl_answers import answer, recorded

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.languages.commonlisp.collections import array_making, arrays
from cramhy_runtime.lisp_core.arrays import LispArray, SimpleArray, TypedVector, Vector, array_type, bit_vector
from cramhy_runtime.lisp_core.data import Character, FreshString, lisp_list, list_from, python_list
from cramhy_runtime.lisp_core.packages import sym


@pytest.fixture(autouse=True)
def a_kernel():
    kernel.start(clock="virtual")


@pytest.mark.soak(all_but=17)
@pytest.mark.parametrize("form, expected", recorded("arrays.txt"))
def test_arrays_answer_as_in_sbcl(form, expected):
    assert answer(form) == expected


def test_the_plainest_object_is_chosen():
    assert array_making.make_array(2, initial_element=None).__class__ is list
    assert array_making.make_array(2, element_type=sym("CHARACTER")).__class__ is FreshString
    assert array_making.make_array(2, element_type=sym("DOUBLE-FLOAT")).__class__ is TypedVector
    assert array_making.make_array(2, fill_pointer=0).__class__ is Vector
    assert array_making.make_array(lisp_list(2, 2)).__class__ is SimpleArray
    assert array_making.make_array(lisp_list(2, 2), adjustable=True).__class__ is LispArray


def test_an_index_outside_is_an_error_with_the_text_of_sbcl():
    with pytest.raises(arrays.InvalidArrayIndex) as caught:
        arrays.aref([1, 2], 5)
    assert " ".join(caught.value.report().split()) == "Invalid index 5 for (SIMPLE-VECTOR 2), should be a non-negative integer below 2."


def test_true_is_no_index():
    with pytest.raises(conditions.TypeError_):
        arrays.aref([1, 2], True)


def test_a_vector_with_a_fill_pointer_is_a_python_sequence_of_its_active_elements():
    vector = array_making.make_array(3, fill_pointer=2, initial_contents=[1, 2, 3])
    assert list(vector) == [1, 2]
    assert len(vector) == 2 and vector[-1] == 2
    vector[0] = 9
    assert arrays.aref(vector, 0) == 9 and arrays.aref(vector, 2) == 3


def test_a_full_adjustable_vector_grows():
    vector = array_making.make_array(0, fill_pointer=0, adjustable=True)
    for item in range(100):
        assert arrays.vector_push_extend(item, vector) == item
    assert list(vector) == list(range(100))
    assert arrays.vector_pop(vector) == 99


def test_a_string_with_a_fill_pointer_grows_too():
    text = array_making.make_array(0, element_type=sym("CHARACTER"), fill_pointer=0, adjustable=True)
    for char in "turtle":
        arrays.vector_push_extend(Character(char), text)
    assert str(text) == "turtle"


def test_a_displaced_array_shares_its_elements():
    vector = [1, 2, 3, 4]
    matrix = array_making.make_array(lisp_list(2, 2), displaced_to=vector)
    arrays.SETTERS["AREF"]("x", matrix, 1, 0)
    assert vector == [1, 2, "x", 4]
    inner = array_making.make_array(2, displaced_to=matrix, displaced_index_offset=2)
    assert list(inner) == ["x", 4]
    assert arrays.array_displacement(inner) == (matrix, 2)


def test_floats_of_both_kinds_fit_into_float_arrays_and_integers_do_not():
    vector = array_making.make_array(2, element_type=sym("DOUBLE-FLOAT"))
    assert vector[0].__class__ is float
    arrays.set_aref(1.5, vector, 0)
    with pytest.raises(conditions.TypeError_):
        arrays.set_aref(1, vector, 0)


def test_a_bit_vector_of_the_reader_is_one():
    assert arrays.bit_vector_p(bit_vector([1, 0])) is True
    assert arrays.array_element_type(bit_vector([])) is sym("BIT")
    assert python_list(array_type(bit_vector([1]))) == [sym("SIMPLE-BIT-VECTOR"), 1]


@given(st.lists(st.integers(0, 4), min_size=1, max_size=3), st.data())
def test_subscripts_and_the_row_major_index_name_the_same_element(dimensions, data):
    size = 1
    for dimension in dimensions:
        size *= dimension
    array = array_making.make_array(list_from(dimensions), initial_element=0)
    if size:
        for index in range(size):
            arrays.set_row_major_aref(index, array, index)
        subscripts = [data.draw(st.integers(0, dimension - 1)) for dimension in dimensions]
        assert arrays.aref(array, *subscripts) == arrays.array_row_major_index(array, *subscripts)
    assert arrays.array_total_size(array) == size


@given(st.integers(1, 4), st.integers(1, 4), st.integers(0, 5), st.integers(0, 5))
def test_adjusting_keeps_what_both_shapes_have(rows, columns, new_rows, new_columns):
    array = array_making.make_array(lisp_list(rows, columns), adjustable=True)
    for index in range(rows * columns):
        arrays.set_row_major_aref(index, array, index)
    before = {(row, column): arrays.aref(array, row, column) for row in range(rows) for column in range(columns)}
    assert array_making.adjust_array(array, lisp_list(new_rows, new_columns), initial_element=-1) is array
    for row in range(new_rows):
        for column in range(new_columns):
            assert arrays.aref(array, row, column) == before.get((row, column), -1)
