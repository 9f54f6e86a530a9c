"""Strings: comparison, case, trimming, and which can be changed in place."""

import copy
import pickle

import pytest
from hypothesis import given
from hypothesis import strategies as st
from sbcl_answers import answer, recorded

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.languages.commonlisp.collections import strings
from cramhy_runtime.lisp_core.data import Character, FreshString, lisp_list
from cramhy_runtime.lisp_core.packages import intern, keyword


@pytest.fixture(autouse=True)
def a_kernel():
    kernel.start(clock="virtual")


@pytest.mark.soak(all_but=11)
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
    text = FreshString("abc")
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


def changed(text):
    """A string that was made with other characters, and has those of ``text`` now."""
    string = FreshString("\u00e4" * len(text))
    string.writable()[:] = text
    return string


OPERATIONS = [name for name in dir(str) if name not in dir(object) and name not in ("__getnewargs__", "maketrans")]


@given(st.text(max_size=6), st.text(max_size=3), st.sampled_from(OPERATIONS))
def test_python_sees_a_changed_string_as_it_is_now(text, other, name):
    def outcome(string):
        for arguments in ((), (other,), (1,)):
            try:
                answer = getattr(string, name)(*arguments)
            except (TypeError, IndexError, LookupError, ValueError) as problem:
                yield type(problem)
            else:
                yield list(answer) if name == "__iter__" else answer

    assert list(outcome(changed(text))) == list(outcome(text))


@given(st.text(max_size=6), st.text(max_size=3))
def test_operators_of_python_see_a_changed_string_as_it_is_now(text, other):
    string = changed(text)
    assert (string + other, other + string, string * 2, f"{string:>4}") == (text + other, other + text, text * 2, f"{text:>4}")
    assert (string == other, other == string, string != other, string < other, other < string) == (
        text == other,
        other == text,
        text != other,
        text < other,
        other < text,
    )
    assert (other in string, len(string), {text: 1}.get(string), repr(string)) == (other in text, len(text), 1, repr(text))


@pytest.mark.parametrize("protocol", [2, 5])
def test_a_string_that_can_be_changed_is_copied_with_its_characters(protocol):
    for string in (FreshString("abc"), changed("abc")):
        for copied in (pickle.loads(pickle.dumps(string, protocol)), copy.copy(string), copy.deepcopy(string)):
            assert copied == "abc"
            copied.writable()[0] = "x"
            assert (copied, string) == ("xbc", "abc")
