"""Functions on lists, vectors and strings alike."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from sbcl_answers import answer, recorded

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.languages.commonlisp.collections import sequence_change as change
from cramhy_runtime.languages.commonlisp.collections import sequence_mapping as mapping
from cramhy_runtime.languages.commonlisp.collections import sequence_search as searching
from cramhy_runtime.languages.commonlisp.collections import sequence_sort as sorting
from cramhy_runtime.languages.commonlisp.collections import sequences
from cramhy_runtime.languages.commonlisp.collections.sequence_types import to_sequence_type
from cramhy_runtime.lisp_core.data import Character, LispString, MultipleValues, lisp_list, list_from, python_list
from cramhy_runtime.lisp_core.equality import equal
from cramhy_runtime.lisp_core.keyword_calls import lispify
from cramhy_runtime.lisp_core.packages import keyword, sym

integers = st.lists(st.integers(-5, 5), max_size=12)
a = Character("a")


def less(x, y):
    return True if x < y else None


@pytest.fixture(autouse=True)
def a_kernel():
    kernel.start(clock="virtual")


@pytest.mark.soak(all_but=19)
@pytest.mark.parametrize("form, expected", recorded("sequences.txt"))
def test_sequences_answer_as_in_sbcl(form, expected):
    assert answer(form) == expected


@pytest.mark.soak(all_but=24)
@pytest.mark.parametrize("form, expected", recorded("sequences_at_random.txt"))
def test_forms_made_at_random_answer_as_in_sbcl(form, expected):
    assert answer(form) == expected


def test_a_lisp_caller_gives_keywords_and_a_python_caller_keyword_arguments():
    assert lispify(searching.position)(3, lisp_list(3, 1, 3), keyword("FROM-END"), True) == 2
    assert searching.position(3, lisp_list(3, 1, 3), from_end=True) == 2


def test_true_is_not_found_as_one_nor_one_as_one_point_zero():
    assert searching.find(1, [True, 1.0]) is None
    assert searching.position(1.0, [True, 1, 1.0]) == 2


def test_the_elements_of_a_string_are_characters():
    assert searching.find(a, "banana") is a
    assert mapping.map_(sym("LIST"), lambda character: character, "aa").car is a
    assert mapping.map_(sym("STRING"), lambda character: character, lisp_list(a, a)) == "aa"


def test_some_returns_the_first_true_value_even_zero():
    assert mapping.some(lambda x: x if x < 1 else None, [2, 0, -1]) == 0
    assert mapping.some(lambda x: MultipleValues((None, x)), [1, 2]) is None


def test_a_copy_of_a_string_can_be_filled_and_the_string_itself_cannot():
    assert str(sequences.fill(sequences.copy_seq("abc"), a)) == "aaa"
    with pytest.raises(conditions.SimpleError) as caught:
        sequences.fill("abc", a)
    assert caught.value.report() == 'The string "abc" is a constant and cannot be changed in place. Change a copy of it: (copy-seq "abc").'


def test_sort_keeps_the_conses_so_an_ignored_result_does_no_harm():
    lst = lisp_list(3, 1, 2)
    assert sorting.sort(lst, less) is lst
    assert python_list(lst) == [1, 2, 3]


def test_a_predicate_that_fails_leaves_the_sequence_as_it_was():
    def fails(x, y):
        return conditions.error("no")

    vector = [3, 1, 2]
    with pytest.raises(conditions.SimpleError):
        sorting.sort(vector, fails)
    assert vector == [3, 1, 2]


def test_delete_takes_conses_out_of_the_list_itself():
    lst = lisp_list(1, 2, 3)
    change.delete(2, lst)
    assert python_list(lst) == [1, 3]


def test_foreign_python_sequences_can_be_read():
    assert searching.find(2, (1, 2)) == 2
    assert sequences.length(b"abc") == 3
    assert python_list(mapping.map_(sym("LIST"), lambda x: x, range(3))) == [0, 1, 2]


def test_mapping_over_a_list_that_grows_meanwhile_sees_the_new_elements():
    lst = lisp_list(1)

    def grow(x):
        if x < 3:
            lst_end = lst
            while lst_end.cdr is not None:
                lst_end = lst_end.cdr
            lst_end.cdr = lisp_list(x + 1)

    mapping.map_(None, grow, lst)
    assert python_list(lst) == [1, 2, 3]


def test_coerce_leaves_a_sequence_of_the_wanted_type_alone():
    lst, vector, string = lisp_list(1), [1], LispString("a")
    assert to_sequence_type(lst, sym("LIST")) is lst
    assert to_sequence_type(vector, sym("VECTOR")) is vector
    assert to_sequence_type(string, sym("STRING")) is string
    assert to_sequence_type(lst, sym("SIMPLE-VECTOR")) == [1]
    assert python_list(to_sequence_type("ab", sym("LIST"))) == [Character("a"), Character("b")]


def test_setters_store_in_place():
    vector = [1, 2, 3]
    assert sequences.SETTERS["ELT"](9, vector, 0) == 9
    sequences.SETTERS["SUBSEQ"](lisp_list(7, 8), vector, 1)
    assert vector == [9, 7, 8]


@given(integers)
def test_reversing_twice_gives_the_sequence_again(items):
    for sequence in (list_from(items), list(items)):
        assert equal(sequences.reverse(sequences.reverse(sequence)), sequence) or sequences.reverse(sequences.reverse(sequence)) == items
    assert python_list(sequences.nreverse(list_from(items))) == items[::-1]


@given(integers)
def test_sort_is_pythons_sort(items):
    assert sorting.sort(list(items), less) == sorted(items)
    assert python_list(sorting.sort(list_from(items), less, key=lambda x: -x)) == sorted(items, reverse=True)


@given(st.lists(st.tuples(st.integers(0, 3), st.integers())))
def test_sort_keeps_the_order_of_equals(pairs):
    assert sorting.sort(list(pairs), less, key=lambda pair: pair[0]) == sorted(pairs, key=lambda pair: pair[0])


@given(integers)
def test_remove_duplicates_keeps_the_last_of_equals_and_from_end_the_first(items):
    assert change.remove_duplicates(items, from_end=True) == list(dict.fromkeys(items))
    assert python_list(change.remove_duplicates(list_from(items))) == list(dict.fromkeys(reversed(items)))[::-1]
    assert change.remove_duplicates(items, test=lambda x, y: x == y) == change.remove_duplicates(items)


@given(integers, st.integers(-5, 5))
def test_what_is_removed_and_what_is_counted_make_up_the_whole(items, item):
    lst = list_from(items)
    assert sequences.length(change.remove(item, lst)) + searching.count(item, lst) == len(items)
    assert searching.position(item, lst) == (items.index(item) if item in items else None)


@given(st.text("ab", max_size=8), st.text("ab", max_size=3))
def test_search_is_pythons_find(text, pattern):
    place = text.find(pattern)
    assert searching.search(pattern, text) == (None if place < 0 else place)
    place = text.rfind(pattern)
    assert searching.search(pattern, text, from_end=True) == (None if place < 0 else place)


@given(integers, integers)
def test_merge_of_two_sorted_sequences_is_sorted(first, second):
    assert sorting.merge(sym("VECTOR"), sorted(first), sorted(second), less) == sorted(first + second)
