"""Division with rest: ``floor``, ``ceiling``, ``truncate``, ``round`` and their float cousins.

Each returns two values, quotient and rest, with ``quotient * divisor + rest = number``. Floats go SBCL's way: both become floats of one
kind, their quotient is truncated, the rest computed from that, and then both are moved by one where another rounding asks for it. So
``(floor 1.0 0.1)`` is 10 although a double would have it at 9.99. Source: ANSI 12.2 (FLOOR).
"""

from __future__ import annotations

import math

from cramhy_runtime.lisp_core.data import MultipleValues
from cramhy_runtime.lisp_core.floats import SingleFloat, result_class
from .arithmetic import div2, mul2, need_real, overflow, single_of, sub2
from .irrational import to_double

LISP_NAMES = "floor ceiling truncate round ffloor fceiling ftruncate fround"


def _truncated(number, divisor):
    """(quotient, rest, divisor as it was used) of the division that rounds towards zero."""
    if isinstance(number, float) or isinstance(divisor, float):
        convert = single_of if result_class(number, divisor) is SingleFloat else to_double
        number, divisor = convert(number), convert(divisor)
    try:
        quotient = math.trunc(div2(number, divisor))
        return quotient, sub2(number, mul2(quotient, divisor)), divisor
    except (OverflowError, ValueError):  # infinity, or not a number
        return overflow("/", number, divisor), 0, divisor


def truncate(number, divisor=1):
    """``cl:truncate``: quotient rounded towards zero, and rest."""
    quotient, rest, _ = _truncated(need_real(number), need_real(divisor))
    return MultipleValues((quotient, rest))


def floor(number, divisor=1):
    """``cl:floor``: quotient rounded towards minus infinity, and rest."""
    if number.__class__ is int and divisor.__class__ is int and divisor:
        return MultipleValues(divmod(number, divisor))
    quotient, rest, divisor = _truncated(need_real(number), need_real(divisor))
    if rest and (number < 0) != (divisor < 0):  # the rest may have lost its sign
        quotient, rest = quotient - 1, rest + divisor
    return MultipleValues((quotient, rest))


def ceiling(number, divisor=1):
    """``cl:ceiling``: quotient rounded towards infinity, and rest."""
    quotient, rest, divisor = _truncated(need_real(number), need_real(divisor))
    if rest and (number < 0) == (divisor < 0):
        quotient, rest = quotient + 1, rest - divisor
    return MultipleValues((quotient, rest))


def round_(number, divisor=1):
    """``cl:round``: quotient rounded to the nearest integer, from the middle to the even one, and rest."""
    quotient, rest, divisor = _truncated(need_real(number), need_real(divisor))
    rest_beyond = sub2(abs(divisor), abs(rest))  # half of the divisor may be too small for a float; this is exact near the middle
    if abs(rest) > rest_beyond or abs(rest) == rest_beyond and quotient % 2:
        step = 1 if (rest < 0) == (divisor < 0) else -1
        quotient, rest = quotient + step, rest - step * divisor
    return MultipleValues((quotient, rest))


def _float_rounder(name, rounder):
    def function(number, divisor=1):
        quotient, rest = rounder(number, divisor)
        kind = result_class(number, divisor)
        # Minus zero is kept: (fceiling -0.5) is -0.0. Rationals, and fround, know none. Of minus zero nothing is left.
        if number == 0 and rounder is not round_:
            rest = abs(rest)
        if quotient == 0 and rounder is not round_ and isinstance(rest, float) and _negative(number) != _negative(divisor):
            return MultipleValues((kind(-0.0), rest))
        return MultipleValues((kind(quotient), rest))

    function.__name__ = function.__qualname__ = name
    function.__doc__ = f"``cl:{name}``: as the function without f, the quotient as a float."
    return function


def _negative(number):
    return math.copysign(1.0, number) < 0 if isinstance(number, float) else number < 0


ffloor = _float_rounder("ffloor", floor)
fceiling = _float_rounder("fceiling", ceiling)
ftruncate = _float_rounder("ftruncate", truncate)
fround = _float_rounder("fround", round_)
