"""Division with rest: ``floor``, ``ceiling``, ``truncate``, ``round`` and their float cousins.

Each returns two values, quotient and rest, with ``quotient * divisor + rest = number``. For floats the quotient is computed
first and then rounded, as SBCL does it; a quotient of singles is rounded to a single before, so ``(floor 1.0 0.1)`` is 10
although a double would have it at 9.99. Source: ANSI 12.2 (FLOOR).
"""

from __future__ import annotations

import math
from fractions import Fraction

from cramhy_runtime.ground.data import DoubleFloat, MultipleValues
from .arithmetic import division_by_zero, need_real, normal, overflow, single

LISP_NAMES = "floor ceiling truncate round ffloor fceiling ftruncate fround"

_EXACT_SINGLES = 2.0**24


def _quotient(number, divisor):
    """number / divisor, exact for rationals; of floats rounded to a single unless one is a double."""
    if isinstance(number, float) or isinstance(divisor, float):
        if divisor == 0:
            kind = DoubleFloat if DoubleFloat in (number.__class__, divisor.__class__) else float
            return division_by_zero("/", kind(number), kind(divisor))
        quotient = number / divisor
        if quotient.__class__ is float and abs(quotient) < _EXACT_SINGLES and divisor != 1:
            quotient = single(quotient)
        return quotient
    if divisor == 0:
        return division_by_zero("/", number, divisor)
    return Fraction(number, divisor)


def _whole(rounding, number, divisor):
    quotient = _quotient(number, divisor)
    try:
        return rounding(quotient)
    except (OverflowError, ValueError):  # infinity, or not a number
        return overflow("/", number, divisor)


def _rest(number, quotient, divisor):
    rest = number - quotient * divisor
    if rest.__class__ is Fraction:
        return normal(rest)
    return rest


def _rounder(name, rounding):
    def function(number, divisor=1):
        need_real(number)
        need_real(divisor)
        quotient = _whole(rounding, number, divisor)
        return MultipleValues((quotient, _rest(number, quotient, divisor)))

    function.__name__ = function.__qualname__ = name
    function.__doc__ = f"``cl:{name.rstrip('_')}``: quotient and rest."
    return function


_general_floor = _rounder("floor", math.floor)
_general_truncate = _rounder("truncate", math.trunc)
ceiling = _rounder("ceiling", math.ceil)
round_ = _rounder("round_", round)


def floor(number, divisor=1):
    """``cl:floor``: quotient rounded towards minus infinity, and rest."""
    if number.__class__ is int and divisor.__class__ is int and divisor:
        return MultipleValues(divmod(number, divisor))
    return _general_floor(number, divisor)


def truncate(number, divisor=1):
    """``cl:truncate``: quotient rounded towards zero, and rest."""
    return _general_truncate(number, divisor)


def _float_rounder(name, rounder):
    def function(number, divisor=1):
        quotient, rest = rounder(number, divisor)
        kind = DoubleFloat if DoubleFloat in (number.__class__, divisor.__class__) else float
        result = kind(quotient)
        # Minus zero is kept: (fceiling -0.5) is -0.0.
        if quotient == 0 and (number < 0) != (divisor < 0) and number != 0:
            result = kind(-0.0)
        return MultipleValues((result, rest))

    function.__name__ = function.__qualname__ = name
    function.__doc__ = f"``cl:{name}``: as the function without f, the quotient as a float."
    return function


ffloor = _float_rounder("ffloor", floor)
fceiling = _float_rounder("fceiling", ceiling)
ftruncate = _float_rounder("ftruncate", truncate)
fround = _float_rounder("fround", round_)
