"""Roots, powers, logarithms, trigonometry, floats taken apart, and complex numbers.

An integer, ratio or single-float argument gives a single-float, computed in doubles and rounded; a double-float gives a double. Where
the real line ends (``(sqrt -4)``, ``(acos 2)``) the result is complex. Source: ANSI 12.1.3 and 12.2.
"""

from __future__ import annotations

import cmath
import math
from fractions import Fraction

from cramhy_runtime.lisp_core.conditions import ArithmeticError_, DivisionByZero, FloatingPointOverflow, error, type_error
from cramhy_runtime.lisp_core.data import UNSUPPLIED, MultipleValues, lisp_list
from cramhy_runtime.lisp_core.floats import SingleFloat
from cramhy_runtime.lisp_core.floats import result_class
from cramhy_runtime.lisp_core.numbers import FIXNUM_LIMIT
from cramhy_runtime.lisp_core.packages import sym
from .float_traps import OVERFLOW, is_masked
from .arithmetic import (
    abs_,
    division_by_zero,
    is_integer,
    is_rational,
    is_real,
    add2,
    div2,
    mul2,
    sub2,
    need_integer,
    need_number,
    need_real,
    normal,
    overflow,
    single_of,
    too_large_for,
)
from .complex_numbers import ExactComplex, SingleComplex, of_parts, parts

LISP_NAMES = """sqrt isqrt exp expt log sin cos tan asin acos atan sinh cosh tanh asinh acosh atanh float rational rationalize
complex realpart imagpart conjugate phase cis decode-float integer-decode-float scale-float float-digits float-precision
float-radix float-sign"""


class ArgumentsOutOfDomain(ArithmeticError_):
    """A function has no value for these arguments, as ``(expt 0 0.0)``."""

    lisp_name = "SB-INT::ARGUMENTS-OUT-OF-DOMAIN-ERROR"


PI = math.pi
_LOG_OF_TWO = math.log(2.0)
MOST_POSITIVE_FIXNUM = FIXNUM_LIMIT - 1


def complex_kind(*numbers):
    """The complex class of a function of ``numbers``, likewise."""
    return complex if any(number.__class__ in (float, complex) for number in numbers) else SingleComplex


def _float(number):
    """``number`` as a Python float; too large an integer is a floating-point-overflow."""
    try:
        return float(number)
    except OverflowError:
        return too_large_for(number, "SINGLE-FLOAT")


def _of_kind(kind, result, *operands):
    """The float ``result`` of a function of ``operands`` as a float of ``kind``; an overflow where singles end."""
    if kind is float:
        return result
    found = SingleFloat(result)
    if found - found != 0.0 and result - result == 0.0:
        return too_large_for(result, "SINGLE-FLOAT")
    return found


def _apply(name, real, complex_, number, domain=None):
    need_number(number)
    if isinstance(number, complex):
        return complex_kind(number)(complex_(number))
    argument = _float(number)
    if domain is not None and not domain(argument):
        return complex_kind(number)(complex_(complex(argument, 0.0)))
    try:
        return _of_kind(result_class(number), real(argument))
    except OverflowError:
        if is_masked(OVERFLOW):
            return result_class(number)(-math.inf if name == "sinh" and argument < 0 else math.inf)
        return error(FloatingPointOverflow())
    except ValueError:
        return error(DivisionByZero()) if math.isfinite(argument) else error(FloatingPointOverflow())


def _function(name, domain=None):
    real, complex_ = getattr(math, name), getattr(cmath, name)

    def function(number):
        return _apply(name, real, complex_, number, domain)

    function.__name__ = function.__qualname__ = name
    function.__doc__ = f"``cl:{name}``"
    return function


sin, cos, tan = _function("sin"), _function("cos"), _function("tan")
sinh, cosh, tanh, asinh = _function("sinh"), _function("cosh"), _function("tanh"), _function("asinh")
_exp = _function("exp")
_acosh = _function("acosh", lambda x: x >= 1)
atanh = _function("atanh", lambda x: -1 <= x <= 1)


def exp(number):
    """``cl:exp``; of a complex number in SBCL's two steps, which say something of the last digit."""
    if isinstance(number, complex):
        real, imaginary = parts(number)
        return mul2(exp(real), cis(imaginary))
    return _exp(number)


def acosh(number):
    """``cl:acosh``; imaginary between -1 and 1, in SBCL's way (Kahan's), which says something of the last digit."""
    if not is_real(number) or not -1 < number < 1:
        return _acosh(number)
    kind = result_class(number)
    angle = atan(div2(sqrt(sub2(1, number)), sqrt(add2(1, number))))
    return complex_kind(number)(0.0, mul2(kind(2.0), angle))


def asin(number):
    """``cl:asin``; complex outside -1 to 1, on the branch that the standard gives."""
    if isinstance(number, float) or is_real(number):
        value = float(number)
        if not -1 <= value <= 1:
            result = cmath.asin(complex(abs(value), 0.0)).conjugate()
            return complex_kind(number)(result if value > 0 else -result)
    return _apply("asin", math.asin, cmath.asin, number)


def acos(number):
    """``cl:acos``; complex outside -1 to 1, on the branch that the standard gives."""
    if is_real(number):
        value = float(number)
        if not -1 <= value <= 1:
            return complex_kind(number)(cmath.acos(complex(value, -0.0 if value > 0 else 0.0)))
    return _apply("acos", math.acos, cmath.acos, number)


def atan(number, x=UNSUPPLIED):
    """``(atan y x)`` is the angle of the point (x, y) in radians, from -pi to pi."""
    if x is UNSUPPLIED:
        return _apply("atan", math.atan, cmath.atan, number)
    need_real(number)
    need_real(x)
    return result_class(number, x)(math.atan2(_float(number), _float(x)))


def sqrt(number):
    """``cl:sqrt``: complex for negative arguments."""
    need_number(number)
    if isinstance(number, complex):
        return complex_kind(number)(cmath.sqrt(number))
    if number < 0:
        return complex_kind(number)(0.0, math.sqrt(_float(-number)))
    return result_class(number)(math.sqrt(_float(number)))


def isqrt(natural):
    """The whole part of the square root."""
    if not is_integer(natural) or natural < 0:
        return type_error(natural, sym("UNSIGNED-BYTE"))
    return math.isqrt(natural)


def log(number, base=UNSUPPLIED):
    """The natural logarithm, or that to ``base``. Of negative numbers complex, of zero a division-by-zero."""
    need_number(number)
    if base is not UNSUPPLIED:
        return _log_base(number, need_number(base))
    if number == 0:
        return error(DivisionByZero())
    if isinstance(number, complex):
        return complex_kind(number)(cmath.log(number))
    if number < 0:
        return complex_kind(number)(_natural_log(-number), math.pi)
    return result_class(number)(_natural_log(number))


def _natural_log(number):
    if isinstance(number, Fraction):
        return math.log(number.numerator) - math.log(number.denominator)
    return math.log(number)


def _log_base(number, base):
    # As SBCL goes: between integers and doubles by way of the binary logarithm, else each logarithm in its own kind of floats.
    if base == 0:
        return result_class(number, base)(0.0)
    if is_integer(number) and is_integer(base) and max(number, base) > MOST_POSITIVE_FIXNUM and min(number, base) > 0:
        return SingleFloat(_natural_log(number) / _natural_log(base))
    if number.__class__ is float and is_integer(base):
        return div2(div2(log(number), _LOG_OF_TWO), div2(log(to_double(base)), _LOG_OF_TWO))
    if is_integer(number) and base.__class__ is float:
        return div2(div2(log(to_double(number)), _LOG_OF_TWO), div2(log(base), _LOG_OF_TWO))
    return div2(log(number), log(base))


def expt(base, power):
    """``cl:expt``: exact for rational ``base`` and integer ``power``."""
    need_number(base)
    need_number(power)
    if is_integer(power):
        return _integer_power(base, power)
    if base == 0:
        if isinstance(power, complex) or power > 0:
            return mul2(base, power) if isinstance(power, complex) else result_class(base, power)(0.0)
        if not isinstance(power, complex) and power < 0:
            return error(DivisionByZero())
        return error(ArgumentsOutOfDomain(sym("EXPT"), lisp_list(base, power)))
    if isinstance(base, complex) or isinstance(power, complex):
        return _complex_power(base, power)
    kind = result_class(base, power)
    try:
        if base < 0 and power != math.floor(power):
            size, angle = math.pow(-base, power), power * math.pi
            return complex_kind(base, power)(size * math.cos(angle), size * math.sin(angle))
        return _of_kind(kind, math.pow(float(base), float(power)))
    except OverflowError:
        return overflow("EXPT", base, power)


def _complex_power(base, power):
    """``base`` to the power of ``power``, of which one is complex, in SBCL's steps: so the parts have its last digits."""
    if is_rational(power):
        return mul2(expt(abs_(base), power), cis(mul2(power, phase(base))))
    if complex_kind(base, power) is complex:
        base = complex(base) if isinstance(base, complex) else float(base)
    return exp(mul2(power, log(base)))


def _exact_power(base, power):
    """``base``, an `ExactComplex`, to the power of an integer."""
    result, factor = 1, base if power >= 0 else div2(1, base)
    power = abs(power)
    while power:
        if power & 1:
            result = mul2(factor, result)
        factor, power = mul2(factor, factor), power >> 1
    return result


def _integer_power(base, power):
    if power == 0:
        return 1 if is_rational(base) or isinstance(base, ExactComplex) else base.__class__(1.0)
    if base == 0 and power < 0:
        return division_by_zero("EXPT", base, power)
    try:
        if is_rational(base):
            return base**power if power > 0 and base.__class__ is int else normal(Fraction(base) ** power)
        if isinstance(base, ExactComplex):
            return _exact_power(base, power)
        if isinstance(base, complex):
            return _complex_power(base, power)
        return _of_kind(base.__class__, math.pow(base, power))
    except OverflowError:
        return overflow("EXPT", base, power)


# ------------------------------------------------------------------------------------------------------------------- floats


def to_double(number):
    """The real ``number`` as a double-float."""
    try:
        return float(number)
    except OverflowError:
        return too_large_for(number, "DOUBLE-FLOAT")


def float_(number, prototype=UNSUPPLIED):
    """``number`` as a float of the kind of ``prototype``; without one, floats stay and rationals become singles."""
    need_real(number)
    if prototype is UNSUPPLIED:
        return number if isinstance(number, float) else single_of(number)
    _need_float(prototype)
    if prototype.__class__ is number.__class__:
        return number
    return to_double(number) if prototype.__class__ is float else single_of(number)


def _need_float(obj):
    return obj if isinstance(obj, float) else type_error(obj, sym("FLOAT"))


def rational(number):
    """The rational that is exactly the float ``number``."""
    need_real(number)
    return normal(Fraction(float(number))) if isinstance(number, float) else number


def rationalize(number):
    """The simplest rational that reads back as the float ``number``: ``(rationalize 0.1)`` is 1/10."""
    need_real(number)
    if not isinstance(number, float):
        return number
    return _simplest(number)


def _simplest(number):
    """The rational with the least denominator between the two middles of the float ``number`` and its neighbours.

    Both bounds are walked down their continued fractions as long as these agree. The neighbours are taken to be as far as they are above,
    which is SBCL's way.
    """
    digits = float_digits(number)
    significand, exponent = math.frexp(abs(number))
    whole, exponent = int(math.ldexp(significand, digits)), exponent - digits
    if exponent >= 0 or not whole:
        return int(number)
    half = Fraction(1, 2 << -exponent)
    low, high = (2 * whole - 1) * half, (2 * whole + 1) * half
    before, bottom_before, last, bottom_last = 0, 1, 1, 0
    while True:
        least = math.ceil(low)
        if least < high:
            found = Fraction(least * last + before, least * bottom_last + bottom_before)
            return normal(-found if number < 0 else found)
        step = least - 1
        before, bottom_before, last, bottom_last = last, bottom_last, step * last + before, step * bottom_last + bottom_before
        low, high = 1 / (high - step), 1 / (low - step)


def decode_float(number):
    """Three values: significand from 1/2 to below 1, exponent, sign."""
    significand, exponent = math.frexp(abs(_need_float(number)))
    kind = number.__class__
    return MultipleValues((kind(significand), exponent, kind(math.copysign(1.0, number))))


def integer_decode_float(number):
    """Three values: significand as an integer of 24 or 53 bits, fewer of a denormal, exponent, sign (1 or -1)."""
    digits, least = float_digits(number), -149 if number.__class__ is SingleFloat else -1074
    significand, exponent = math.frexp(abs(number))
    exponent = max(exponent - digits, least) if significand else 0
    return MultipleValues((int(math.ldexp(abs(number), -exponent)), exponent, int(math.copysign(1, number))))


def scale_float(number, exponent):
    """``number * 2**exponent``"""
    _need_float(number)
    try:
        result = number.__class__(math.ldexp(float(number), need_integer(exponent)))
    except OverflowError:
        return overflow("SCALE-FLOAT", number, exponent)
    return overflow("SCALE-FLOAT", number, exponent) if math.isinf(result) and math.isfinite(number) else result


def float_digits(number):
    return 24 if _need_float(number).__class__ is SingleFloat else 53


def float_precision(number):
    digits, exponent = float_digits(number), math.frexp(number)[1]
    least = -149 if number.__class__ is SingleFloat else -1074
    return max(0, min(digits, exponent - least)) if number else 0


def float_radix(number):
    _need_float(number)
    return 2


def float_sign(number, magnitude=UNSUPPLIED):
    """A float with the sign of the first and the size of the second argument (1 by default)."""
    _need_float(number)
    kind = result_class(number) if magnitude is UNSUPPLIED else _need_float(magnitude).__class__
    return kind(math.copysign(1.0 if magnitude is UNSUPPLIED else abs(float(magnitude)), number))


# ------------------------------------------------------------------------------------------------------------------ complex


def complex_(realpart, imagpart=0):
    """``cl:complex``; with rational parts and imaginary part 0 just the real part."""
    need_real(realpart)
    need_real(imagpart)
    return of_parts(realpart, imagpart)


def realpart(number):
    return parts(number)[0] if isinstance(number, complex) else need_number(number)


def imagpart(number):
    if isinstance(need_number(number), complex):
        return parts(number)[1]
    return number * 0 if isinstance(number, float) else 0


def conjugate(number):
    return need_number(number).conjugate() if isinstance(number, complex) else need_number(number)


def phase(number):
    """The angle of ``number`` in the complex plane, in radians."""
    need_number(number)
    if isinstance(number, complex):
        return (float if number.__class__ is complex else SingleFloat)(cmath.phase(number))
    kind = result_class(number)
    return kind(math.pi) if number < 0 or isinstance(number, float) and math.copysign(1.0, number) < 0 else kind(0.0)


def cis(radians):
    """``e`` to the power of ``i * radians``"""
    need_real(radians)
    return complex_kind(radians)(math.cos(radians), math.sin(radians))


def _limits():
    table = {}
    for names, kind, largest, normalized, least, epsilon, negative in (
        (
            ("SINGLE-FLOAT", "SHORT-FLOAT"),
            SingleFloat,
            (2 - 2.0**-23) * 2.0**127,
            2.0**-126,
            2.0**-149,
            2.0**-24 * (1 + 2.0**-23),
            2.0**-25 * (1 + 2.0**-23),
        ),
        (
            ("DOUBLE-FLOAT", "LONG-FLOAT"),
            float,
            (2 - 2.0**-52) * 2.0**1023,
            2.0**-1022,
            2.0**-1074,
            2.0**-53 * (1 + 2.0**-52),
            2.0**-54 * (1 + 2.0**-52),
        ),
    ):
        for name in names:
            table[f"MOST-POSITIVE-{name}"], table[f"MOST-NEGATIVE-{name}"] = kind(largest), kind(-largest)
            table[f"LEAST-POSITIVE-{name}"], table[f"LEAST-NEGATIVE-{name}"] = kind(least), kind(-least)
            table[f"LEAST-POSITIVE-NORMALIZED-{name}"] = kind(normalized)
            table[f"LEAST-NEGATIVE-NORMALIZED-{name}"] = kind(-normalized)
            table[f"{name}-EPSILON"], table[f"{name}-NEGATIVE-EPSILON"] = kind(epsilon), kind(negative)
    return table


CONSTANTS = {"PI": PI, "MOST-POSITIVE-FIXNUM": MOST_POSITIVE_FIXNUM, "MOST-NEGATIVE-FIXNUM": -(2**62), **_limits()}
"""The constants among the numbers, by Lisp name."""
