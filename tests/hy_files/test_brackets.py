"""Which brackets of a Hy text are open at its end."""

import pytest

from cramhy_runtime.languages.hy.brackets import explanation, open_brackets


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("(a [b] {c})", []),
        ("(a\n  [b", [("(", 1, 1), ("[", 2, 3)]),
        ('(a ")" ; )\n b"\\")"', [("(", 1, 1)]),
        ("(a #[[ ) ]] #[x[ ) ]] ]x]", [("(", 1, 1)]),
        ('(a "never', [("(", 1, 1)]),
        ("(a] b", [("(", 1, 1)]),
        ("", []),
    ],
)
def test_brackets_in_strings_and_comments_do_not_count(text, found):
    assert open_brackets(text) == found


def test_they_are_told_in_the_words_of_the_lisp_reader():
    assert explanation("(a)") is None
    assert explanation("(a") == "The ( at line 1, column 1 is never closed."
    assert explanation("(a\n {b") == (
        "The ( at line 1, column 1 is never closed. 2 are open at the end; the innermost begins at line 2, column 2."
    )
