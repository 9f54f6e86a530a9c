"""Quotients and rests of floats are SBCL's where a rest is rounded, overflows, or is zero, and where zero is divided by zero.

Integers become floats wherever the compiler knows what computes them.
"""

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

WHOLE = "(round x);(floor x 2);(gcd y 4);(ash y 3);(1+ y);(isqrt y);(* y y);(ceiling 1/3)".split(";")
"""Integers of no known size, where ``x`` is 7/3 and ``y`` is 5."""
FLOATED = "2.0 1.0 1.0 40.0 6.0 2.0 25.0 1.0".split()
FUNCTIONS = {"(float ~)": "", "(float ~ 1.0)": "", "(coerce ~ 'single-float)": "", "(float ~ 1d0)": "d0", "(coerce ~ 'double-float)": "d0"}

UNDEFINED = """
(/ 0 0.0d0)
(/ 0.0d0 0)
(/ 0.0 0.0)
(/ 0 0.0)
(/ -0.0 0.0)
(/ 0.0d0 0.0)
(rem 0.0 0.0)
(mod 0.0 0)
(floor 0.0 0.0)
(truncate 0 0.0d0)
(round 0.0 0)
(ceiling 0.0d0 0)
(ffloor 0.0 0.0)
(fround 0.0 0.0)
(/ #c(0.0 0.0) 0.0)
(/ 0 #c(0.0 0.0))
(/ #c(0.0 0.0) #c(0.0 0.0))
(let ((x 0.0)) (/ x x))
(funcall (lambda (a b) (declare (double-float a b)) (/ a b)) 0d0 0d0)
(funcall (lambda (a b) (declare (single-float a b)) (/ a b)) 0.0 0.0)
(reduce #'/ '(0.0 0.0))
(apply #'/ '(0.0 0))
""".strip().splitlines()
BY_ZERO = """
(/ 0 0)
(/ 1.0 0.0)
(/ 1/2 0.0)
(/ 0.0)
(mod 1.0 0.0)
(rem 1.0 0)
(floor 0 0)
(/ 5 0.0 0.0)
(/ #c(1.0 0.0) 0)
(expt 0.0 -1)
""".strip().splitlines()
ANSWERS |= {
    f"(let ((x 7/3) (y 5)) (setf x x y y) {outer.replace('~', inner)})": f"({text}{mark})"
    for outer, mark in FUNCTIONS.items()
    for inner, text in zip(WHOLE, FLOATED, strict=True)
}
ANSWERS |= dict.fromkeys(UNDEFINED, "FLOATING-POINT-INVALID-OPERATION") | dict.fromkeys(BY_ZERO, "DIVISION-BY-ZERO")


@pytest.fixture(scope="module")
def session():
    return Session(time="virtual", turtlesim=False)


@pytest.mark.soak(all_but=18)
@pytest.mark.parametrize("form", ANSWERS)
def test_a_quotient_and_its_rest_are_sbcls(session, form):
    text = f"(handler-case (multiple-value-list {form}) (error (e) (type-of e)))"
    assert prin1_to_string(session.evaluate_text(text)[0]) == ANSWERS[form]
