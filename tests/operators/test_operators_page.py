"""The page of operators says what the tables and the examples say."""

import page
import pytest
from examples import EXAMPLES, hy_of


def test_the_page_is_what_the_tables_say():
    assert page.PAGE.read_text(encoding="utf-8") == page.text(), "make docs writes it anew"


@pytest.mark.soak(all_but=21)
@pytest.mark.parametrize("name", EXAMPLES)
def test_its_lines_are_the_examples(name):
    for text in (EXAMPLES[name].lisp, hy_of(EXAMPLES[name])):
        assert page.pretty(text).replace(" ", "").replace("\n", "") == text.replace(" ", "").replace("\n", "")
