"""Quotients and rests of floats are SBCL's where a rest is rounded, overflows, or is zero."""

import pytest

from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string
from cramhy_runtime.repl.session import Session

ANSWERS = {
    "(floor 3e19 98312.66)": "(305148937109504 -2.1990233e12)",
    "(ceiling 3e19 98312.66)": "(305148937109505 -2.1990233e12)",
    "(mod 3e19 98312.66)": "(-2.1990233e12)",
    "(floor 3.4028235e38 -100)": "FLOATING-POINT-OVERFLOW",
    "(rem 3.4028235e38 -100)": "FLOATING-POINT-OVERFLOW",
    "(ffloor 3.4028235e38 -100)": "FLOATING-POINT-OVERFLOW",
    "(ffloor -0d0 3)": "(-0.0d0 0.0d0)",
    "(ftruncate -0.0 2)": "(-0.0 0.0)",
    "(fceiling -0.0)": "(-0.0 0.0)",
    "(fround -0.0 3)": "(0.0 -0.0)",
    "(floor -0.0 3)": "(0 -0.0)",
}


@pytest.fixture(scope="module")
def session():
    return Session(time="virtual", turtlesim=False)


@pytest.mark.parametrize("form", ANSWERS)
def test_a_quotient_and_its_rest_are_sbcls(session, form):
    text = f"(handler-case (multiple-value-list {form}) (error (e) (type-of e)))"
    assert prin1_to_string(session.evaluate_text(text)[0]) == ANSWERS[form]
