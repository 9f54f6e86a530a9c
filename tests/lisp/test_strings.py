"""Strings: comparison, case, trimming, and which can be changed in place."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from sbcl_answers import answer, recorded

from cramhy_runtime import kernel
from cramhy_runtime.ground import conditions
from cramhy_runtime.languages.commonlisp.collections import strings
from cramhy_runtime.ground.data import Character, LispString, lisp_list
from cramhy_runtime.ground.packages import intern, keyword


@pytest.fixture(autouse=True)
def a_kernel():
    kernel.start(clock="virtual")


@pytest.mark.parametrize("form, expected", recorded("strings.txt"))
def test_strings_answer_as_in_sbcl(form, expected):
    assert answer(form) == expected


def test_symbols_and_characters_stand_for_strings():
    assert strings.string_eq(keyword("ABC"), "ABC") is True
    assert strings.string_equal(intern("DRIVE", "COMMON-LISP-USER"), "drive") is True
    assert strings.string_upcase(Character("a")) == "A"
    assert strings.string(None) == "NIL"


def test_a_made_string_can_be_changed_and_a_constant_says_how():
    made = strings.make_string(2, initial_element=Character("x"))
    assert strings.SETTERS["CHAR"](Character("y"), made, 0) is Character("y")
    assert str(made) == "yx"
    with pytest.raises(conditions.SimpleError) as caught:
        strings.set_char(Character("y"), "abc", 0)
    assert caught.value.report() == 'The string "abc" is a constant and cannot be changed in place. Change a copy of it: (copy-seq "abc").'


def test_the_destructive_case_functions_change_what_can_be_changed():
    text = LispString("abc")
    assert strings.nstring_upcase(text) is text
    assert str(text) == "ABC"
    assert strings.nstring_upcase("abc") == "ABC"


def test_trimming_with_an_empty_bag_trims_nothing():
    assert strings.string_trim(None, " a ") == " a "
    assert strings.string_trim("", " a ") == " a "
    assert strings.string_trim(lisp_list(Character(" ")), " a ") == "a"


@given(st.text(), st.text())
def test_string_order_is_the_order_of_the_codes(first, second):
    assert (strings.string_lt(first, second) is not None) == (first < second)
    assert (strings.string_ge(first, second) is not None) == (first >= second)
    assert (strings.string_eq(first, second) is not None) == (first == second)


@given(st.text())
def test_changing_the_case_never_changes_the_length(text):
    for change in (strings.string_upcase, strings.string_downcase, strings.string_capitalize):
        assert len(change(text)) == len(text)


@given(st.text(), st.text())
def test_strings_of_different_lengths_are_never_string_equal(first, second):
    if len(first) != len(second):
        assert strings.string_equal(first, second) is None
