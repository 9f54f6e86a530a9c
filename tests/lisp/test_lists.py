"""Conses, lists, sets, association and property lists, trees."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from sbcl_answers import answer, recorded

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.languages.commonlisp.collections import list_search, lists
from cramhy_runtime.lisp_core.data import Cons, MultipleValues, lisp_list, list_from, python_list
from cramhy_runtime.lisp_core.packages import intern, keyword

integers = st.lists(st.integers(-5, 5), max_size=12)


@pytest.fixture(autouse=True)
def a_kernel():
    kernel.start(clock="virtual")


@pytest.mark.soak(all_but=22)
@pytest.mark.parametrize("form, expected", recorded("lists.txt"))
def test_lists_answer_as_in_sbcl(form, expected):
    assert answer(form) == expected


def test_car_of_an_atom_is_a_type_error_with_the_text_of_sbcl():
    with pytest.raises(conditions.TypeError_) as caught:
        lists.car(5)
    assert caught.value.report() == "The value\n  5\nis not of type\n  LIST\nwhen binding LIST"


def test_a_handler_sees_the_error_before_anything_unwinds():
    seen = []
    with pytest.raises(conditions.TypeError_):
        conditions.handler_bind(
            [(conditions.TypeError_, lambda condition: seen.append(condition.datum))], lambda: lists.mapcar(lists.car, lisp_list(7))
        )
    assert seen == [7]


def test_python_false_counts_as_the_empty_list():
    assert lists.car(False) is None
    assert lists.null(False) is True
    assert list_search.member(None, lisp_list(1, False)) is not None


def test_mapcar_takes_the_first_of_several_values():
    assert python_list(lists.mapcar(lambda x: MultipleValues((x, "more")), lisp_list(1, 2))) == [1, 2]
    assert python_list(lists.mapcar(lambda x: MultipleValues(), lisp_list(1))) == [None]


def test_the_predicate_of_member_if_may_return_several_values_the_first_of_which_counts():
    assert list_search.member_if(lambda x: MultipleValues((None, True)), lisp_list(1, 2)) is None


def test_zero_is_true_for_a_predicate():
    assert lists.car(list_search.member_if(lambda x: 0, lisp_list(1, 2))) == 1


def test_a_symbol_stands_for_its_function():
    symbol = intern("TWICE-FOR-THE-TEST", "COMMON-LISP-USER")
    symbol.function = lambda x: 2 * x
    assert python_list(lists.mapcar(symbol, lisp_list(1, 2))) == [2, 4]


def test_member_returns_the_very_tail():
    tail = Cons(2, None)
    assert list_search.member(2, Cons(1, tail)) is tail


def test_append_shares_its_last_argument_and_copies_the_others():
    first, last = lisp_list(1, 2), lisp_list(3)
    joined = lists.append(first, last)
    assert lists.nthcdr(2, joined) is last
    assert python_list(first) == [1, 2]


def test_a_circular_list_can_be_searched():
    ring = lisp_list(1, 2)
    ring.cdr.cdr = ring
    assert list_search.member(2, ring) is ring.cdr
    assert lists.list_length(ring) is None


def test_setters_return_the_new_value():
    lst = lisp_list(1, lisp_list(2, 3))
    assert lists.SETTERS["CAADR"](9, lst) == 9
    assert lists.SETTERS["SECOND"]("b", lst) == "b"
    assert lists.SETTERS["NTH"]("c", 1, lst) == "c"
    assert python_list(lst) == [1, "c"]


def test_properties_of_nil_and_t_are_kept():
    list_search.SETTERS["GET"](1, None, keyword("A"))
    assert list_search.get(None, keyword("A")) == 1
    assert list_search.remprop(None, keyword("A")) is not None
    assert list_search.get(None, keyword("A"), 7) == 7


def test_setf_of_getf_changes_a_property_in_place_or_puts_it_in_front():
    plist = lisp_list(keyword("A"), 1)
    assert list_search.with_property(plist, keyword("A"), 2) is plist
    assert python_list(list_search.with_property(plist, keyword("B"), 3)) == [keyword("B"), 3, keyword("A"), 2]


@given(st.lists(integers, max_size=4))
def test_append_joins_as_python_does(parts):
    assert python_list(lists.append(*map(list_from, parts))) == sum(parts, [])
    assert python_list(lists.nconc(*map(list_from, parts))) == sum(parts, [])


@given(integers, integers)
def test_the_set_functions_agree_with_pythons_sets(first, second):
    one, two = list_from(first), list_from(second)
    assert set(python_list(list_search.union(one, two))) == set(first) | set(second)
    assert set(python_list(list_search.intersection(one, two))) == set(first) & set(second)
    assert set(python_list(list_search.set_difference(one, two))) == set(first) - set(second)
    assert set(python_list(list_search.set_exclusive_or(one, two))) == set(first) ^ set(second)
    assert (list_search.subsetp(one, two) is True) == (set(first) <= set(second))


@given(integers, st.integers(0, 15))
def test_butlast_and_last_split_a_list(items, n):
    lst = list_from(items)
    assert python_list(lists.butlast(lst, n)) + python_list(lists.last(lst, n)) == items


@given(integers, integers)
def test_revappend_is_append_of_the_reverse(items, tail):
    assert python_list(lists.revappend(list_from(items), list_from(tail))) == items[::-1] + tail
    assert python_list(lists.nreconc(list_from(items), list_from(tail))) == items[::-1] + tail
