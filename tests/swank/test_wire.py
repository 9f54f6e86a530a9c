"""Frames and S-expressions."""

from __future__ import annotations

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from cramhy_runtime.swank import wire
from cramhy_runtime.swank.wire import Name

VALUES = st.recursive(
    st.none() | st.just(True) | st.integers() | st.text(max_size=8) | st.sampled_from([Name(":ok"), Name("a:b")]),
    lambda inner: st.lists(inner, min_size=1),
    max_leaves=8,
)


@settings(deadline=None, suppress_health_check=[HealthCheck.too_slow])  # the machine may be busy
@given(VALUES)
def test_what_is_written_is_read_again(value):
    assert wire.read(wire.text_of(wire.frame(wire.write(value))[wire.LENGTH :])) == value


def test_a_frame_begins_with_the_number_of_its_bytes():
    assert wire.frame("(é)") == b"000004(\xc3\xa9)"
    assert wire.length_of(b"00001A") == 26


@pytest.mark.parametrize("digits", [b"00000g", b"0000 1", b"+00001", b"-00001", b"\x00\x00\x00\x00\x00\x05", b"GET / ", b"1_0000"])
def test_a_length_that_is_no_number_is_an_error(digits):
    with pytest.raises(wire.FrameError, match="six hexadecimal digits"):
        wire.length_of(digits)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("nil", None),
        ("()", None),
        ("t", True),
        ("-12", -12),
        ("3.", 3),
        ("1.5e3", 1500.0),
        ('"a\\"b\\\\c\n"', 'a"b\\c\n'),
        ("swank::%cursor-marker%", Name("swank::%cursor-marker%")),
        ("a\\.b", Name("a.b")),
        ('\'(1 "x")', [Name("quote"), [1, "x"]]),
        ("('a 'b)", [[Name("quote"), Name("a")], [Name("quote"), Name("b")]]),
        ("(a . b)", [Name("a"), Name("."), Name("b")]),
        ("?x", Name("?x")),
    ],
)
def test_what_emacs_writes_is_read(text, value):
    assert wire.read(text) == value


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("", "The message is empty."),
        ("  ", "The message is empty."),
        ("(a", "The message ends inside of a list."),
        ("'", "The message ends inside of a list."),
        (")", "A parenthesis closes nothing at character 1 of the message."),
        ("(')", "A parenthesis closes nothing at character 3 of the message."),
        ("(a) (b)", "Behind the message stands more, from its character 4 on."),
        ('(a "b)', "The message cannot be read at its character 3."),
        ("(" * 300, "The message has more than 200 lists in one another."),
        ("'" * 300, "The message has more than 200 lists in one another."),
        ("9" * 5000, "The message has a number of more than 4000 digits."),
    ],
)
def test_what_is_no_expression_is_told(text, why):
    with pytest.raises(wire.TextError) as told:
        wire.read(text)
    assert str(told.value) == why


def test_reading_interns_nothing():
    from cramhy_runtime.lisp_core.packages import COMMON_LISP_USER

    before = len(COMMON_LISP_USER.internal)
    wire.read("(:emacs-rex (swank:interactive-eval never-heard-of-this) nil t 1)")
    assert len(COMMON_LISP_USER.internal) == before


def test_a_message_too_long_for_a_frame_is_refused():
    with pytest.raises(wire.FrameError, match="16 MB"):
        wire.frame("x" * (1 << 24))


def test_half_a_pair_of_surrogates_becomes_a_question_mark():
    assert wire.frame("\ud800") == b"000001?"
