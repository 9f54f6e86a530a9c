"""Rounding in place: the result of an operation with singles, which was computed in doubles, becomes the nearest single-float."""

from __future__ import annotations

import math

from cramhy_runtime.lisp_core.floats import LARGEST_SINGLE, SPLITTER

from .. import nodes
from ..core import expression, word
from ..kinds import INT, SINGLE, bits, kind_of, never_negative

LEAST_SQUARE, LARGEST_SQUARE = 2.0**-252, LARGEST_SINGLE**2
LEAST_EXPONENT = 125
"""Numbers with a binary exponent nearer to 0 than this are singles with all 24 bits."""
RESULT, PRODUCT, SETX = map(word, "Lr Lp setx".split())
IF, BELOW, TIMES_SIGN, MINUS_SIGN = map(word, "if <= * -".split())


def rounded(model, product=True, slow=None, shape=None):
    """The single-float nearest to ``model``, a float that is a result of one operation with singles.

    Veltkamp's splitting rounds what is within the range of singles that have all 24 bits. ``product``: whether the result may be smaller
    than these and yet not be exact, which a sum is not. ``slow``: what computes the result with all that may be said about it.
    ``shape``: what is known about the result (`Shape`).
    """
    shape = shape or ANY_SHAPE
    if shape.exact and shape.in_range:
        return model
    noted = expression(SETX, RESULT, model)
    if shape.in_range:
        split = expression(SETX, PRODUCT, expression(TIMES_SIGN, noted, SPLITTER))
        return expression(MINUS_SIGN, split, expression(MINUS_SIGN, PRODUCT, RESULT))
    if product:
        inside = expression(BELOW, LEAST_SQUARE, expression(TIMES_SIGN, noted, RESULT), LARGEST_SQUARE)
    elif shape.never_negative:
        inside = expression(BELOW, noted, LARGEST_SINGLE)
    else:
        inside = expression(BELOW, -LARGEST_SINGLE, noted, LARGEST_SINGLE)
    nearest = RESULT
    if not shape.exact:
        split = expression(SETX, PRODUCT, expression(TIMES_SIGN, RESULT, SPLITTER))
        nearest = expression(MINUS_SIGN, split, expression(MINUS_SIGN, PRODUCT, RESULT))
    return expression(IF, inside, nearest, slow or expression(word("Lrounded"), RESULT))


class Shape:
    """What is known about the exact result of an operation with singles before it is rounded.

    ``in_range``: it is 0 or a single-float with all 24 bits may stand for it. ``exact``: it has no more than 24 bits, unless it is outside
    of that range.
    """

    __slots__ = ("exact", "in_range", "never_negative")

    def __init__(self, exact=False, in_range=False, never_negative=False):
        self.exact, self.in_range, self.never_negative = exact, in_range, never_negative


ANY_SHAPE = Shape()


def shape_of_product(one, other):
    """The `Shape` of a product of the values of two nodes, of which one may be a constant."""
    for constant, factor in ((one, other), (other, one)):
        if constant.__class__ is nodes.Constant and kind_of(constant) == SINGLE:
            mantissa, exponent = math.frexp(constant.value)
            small = mantissa and kind_of(factor) == INT and abs(exponent) + bits(factor) < LEAST_EXPONENT
            return Shape(exact=abs(mantissa) == 0.5, in_range=bool(small))
    return ANY_SHAPE


def shape_of_sum(one, other):
    """The `Shape` of a sum of the values of two nodes."""
    return Shape(never_negative=never_negative(one) and never_negative(other))
