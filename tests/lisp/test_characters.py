"""Characters: names, case, kinds, comparison."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from sbcl_answers import answer, recorded

from cramhy_runtime import kernel
from cramhy_runtime.languages.commonlisp.collections import characters
from cramhy_runtime.lisp_core.data import Character

any_character = st.characters().map(Character)


@pytest.fixture(autouse=True)
def a_kernel():
    kernel.start(clock="virtual")


@pytest.mark.soak(all_but=24)
@pytest.mark.parametrize("form, expected", recorded("characters.txt"))
def test_characters_answer_as_in_sbcl(form, expected):
    assert answer(form) == expected


def test_a_character_is_one_object():
    assert characters.code_char(97) is Character("a")


@given(any_character)
def test_a_name_leads_back_to_its_character(character):
    assert characters.name_char(characters.char_name(character)) is character


@given(any_character)
def test_a_character_with_case_comes_back_from_the_other_case(character):
    if characters.both_case_p(character):
        assert character in (
            characters.char_upcase(characters.char_downcase(character)),
            characters.char_downcase(characters.char_upcase(character)),
        )
    else:
        assert characters.char_upcase(character) is characters.char_downcase(character) is character


@given(st.integers(0, 35))
def test_digits_and_weights_belong_together(weight):
    assert characters.digit_char_p(characters.digit_char(weight, 36), 36) == weight
