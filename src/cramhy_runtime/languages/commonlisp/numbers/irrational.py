"""Roots, powers, logarithms, trigonometry, floats taken apart, and complex numbers.

An integer, ratio or single-float argument gives a single-float, a double-float gives a double, and where the real line ends
(``(sqrt -4)``, ``(acos 2)``) the result is complex. Source: ANSI 12.1.3 and 12.2.
"""

from __future__ import annotations

import cmath
import math
from fractions import Fraction

from cramhy_runtime.ground.conditions import ArithmeticError_, DivisionByZero, FloatingPointOverflow, error, type_error
from cramhy_runtime.ground.data import UNSUPPLIED, DoubleFloat, MultipleValues, lisp_list
from cramhy_runtime.ground.packages import sym
from .arithmetic import (
    division_by_zero,
    is_integer,
    is_rational,
    is_real,
    mul2,
    need_integer,
    need_number,
    need_real,
    normal,
    overflow,
    single,
)
from .complex_numbers import DoubleComplex, ExactComplex, exact, exact_power, parts

LISP_NAMES = """sqrt isqrt exp expt log sin cos tan asin acos atan sinh cosh tanh asinh acosh atanh float rational rationalize
complex realpart imagpart conjugate phase cis decode-float integer-decode-float scale-float float-digits float-precision
float-radix float-sign"""


class ArgumentsOutOfDomain(ArithmeticError_):
    """A function has no value for these arguments, as ``(expt 0 0.0)``."""

    lisp_name = "SB-INT::ARGUMENTS-OUT-OF-DOMAIN-ERROR"


_SINGLES_END = 2.0**128
PI = DoubleFloat(math.pi)


def result_kind(*numbers):
    """The float class of a function of ``numbers``: `DoubleFloat` if one of them is a double, else ``float``."""
    return DoubleFloat if any(number.__class__ is DoubleFloat for number in numbers) else float


def complex_kind(*numbers):
    """The complex class of a function of ``numbers``, likewise."""
    doubles = (DoubleFloat, DoubleComplex)
    return DoubleComplex if any(number.__class__ in doubles for number in numbers) else complex


def _float(number):
    """``number`` as a Python float; too large an integer is a floating-point-overflow."""
    try:
        return float(number)
    except OverflowError:
        return too_large_for(number, "SINGLE-FLOAT")


def too_large_for(number, kind):
    return error(FloatingPointOverflow(sym("FLOAT"), lisp_list(number, sym(kind))))


def _apply(name, real, complex_, number, domain=None):
    need_number(number)
    if isinstance(number, complex):
        return complex_kind(number)(complex_(number))
    argument = _float(number)
    if domain is not None and not domain(argument):
        return complex_kind(number)(complex_(complex(argument, 0.0)))
    try:
        return result_kind(number)(real(argument))
    except OverflowError:
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
exp = _function("exp")
acosh = _function("acosh", lambda x: x >= 1)
atanh = _function("atanh", lambda x: -1 <= x <= 1)


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
    return result_kind(number, x)(math.atan2(number, x))


def sqrt(number):
    """``cl:sqrt``: complex for negative arguments."""
    need_number(number)
    if isinstance(number, complex):
        return complex_kind(number)(cmath.sqrt(number))
    kind = result_kind(number)
    if number < 0:
        return complex_kind(number)(0.0, math.sqrt(_float(-number)))
    return kind(math.sqrt(_float(number)))


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
    return result_kind(number)(_natural_log(number))


def _natural_log(number):
    if isinstance(number, Fraction):
        return math.log(number.numerator) - math.log(number.denominator)
    return math.log(number)


def _log_base(number, base):
    if isinstance(number, complex) or isinstance(base, complex) or number <= 0 or base <= 0:
        top, bottom = log(number), log(base)
        return top / bottom
    kind = result_kind(number, base)
    if base == 2 and is_integer(number):
        return kind(math.log2(number))
    if base == 10 and is_integer(number):
        return kind(math.log10(number))
    bottom = _natural_log(base)
    if bottom == 0:
        return division_by_zero("/", kind(_natural_log(number)), kind(0))
    quotient = _natural_log(number) / bottom
    return kind(single(quotient) if kind is float else quotient)


def expt(base, power):
    """``cl:expt``: exact for rational ``base`` and integer ``power``."""
    need_number(base)
    need_number(power)
    if is_integer(power):
        return _integer_power(base, power)
    if base == 0:
        if isinstance(power, complex) or power > 0:
            return mul2(base, power)
        return error(ArgumentsOutOfDomain(sym("EXPT"), lisp_list(base, power)))
    kind = result_kind(base, power)
    if isinstance(base, complex) or isinstance(power, complex) or base < 0:
        result = complex(base) ** (complex(power) if isinstance(power, complex) else float(power))
        return complex_kind(base, power)(result)
    try:
        return kind(math.pow(float(base), float(power)))
    except OverflowError:
        return overflow("EXPT", base, power)


def _integer_power(base, power):
    if power == 0:
        return 1 if is_rational(base) or isinstance(base, ExactComplex) else base.__class__(1)
    if base == 0 and power < 0:
        return division_by_zero("EXPT", base, power)
    try:
        if is_rational(base):
            return base**power if power > 0 and base.__class__ is int else normal(Fraction(base) ** power)
        if isinstance(base, ExactComplex):
            return exact_power(base, power)
        if isinstance(base, complex):
            return complex_kind(base)(complex(base) ** power)
        return base.__class__(float(base) ** power)
    except OverflowError:
        return overflow("EXPT", base, power)


# ------------------------------------------------------------------------------------------------------------------- floats


def to_single(number):
    """The real ``number`` as a single-float, that is, a plain Python float."""
    if number.__class__ is float:
        return number
    value = _float(number)
    return value if abs(value) < _SINGLES_END or math.isinf(value) else too_large_for(number, "SINGLE-FLOAT")


def to_double(number):
    """The real ``number`` as a `DoubleFloat`; a single-float brings the 24 bits that it has."""
    if number.__class__ is float:
        return DoubleFloat(single(number))
    try:
        return DoubleFloat(number)
    except OverflowError:
        return too_large_for(number, "DOUBLE-FLOAT")


def float_(number, prototype=UNSUPPLIED):
    """``number`` as a float of the kind of ``prototype``; without one, floats stay and rationals become singles."""
    need_real(number)
    if prototype is UNSUPPLIED:
        return number if isinstance(number, float) else to_single(number)
    _need_float(prototype)
    if prototype.__class__ is number.__class__:
        return number
    return to_double(number) if prototype.__class__ is DoubleFloat else to_single(number)


def _need_float(obj):
    return obj if isinstance(obj, float) else type_error(obj, sym("FLOAT"))


def _exact(number):
    return float(number) if number.__class__ is DoubleFloat else single(number)


def rational(number):
    """The rational that is exactly the float ``number``."""
    need_real(number)
    return normal(Fraction(_exact(number))) if isinstance(number, float) else number


def rationalize(number):
    """The simplest rational that reads back as the float ``number``: ``(rationalize 0.1)`` is 1/10."""
    need_real(number)
    if not isinstance(number, float):
        return number
    if number.__class__ is DoubleFloat:
        return normal(_simplest(float(number), float))
    return normal(_simplest(single(number), lambda value: single(float(value))))


def _simplest(value, back):
    # Walk down the continued fraction of the exact value until a convergent reads back as the same float.
    exact = Fraction(value)
    if exact.denominator == 1:
        return exact
    h0, h1, k0, k1 = 0, 1, 1, 0
    rest = exact
    while True:
        whole = math.floor(rest)
        h0, h1, k0, k1 = h1, whole * h1 + h0, k1, whole * k1 + k0
        candidate = Fraction(h1, k1)
        if back(candidate) == value or rest == whole:
            return candidate
        rest = 1 / (rest - whole)


def decode_float(number):
    """Three values: significand from 1/2 to below 1, exponent, sign."""
    significand, exponent = math.frexp(abs(_need_float(number)))
    kind = number.__class__
    return MultipleValues((kind(significand), exponent, kind(math.copysign(1.0, number))))


def integer_decode_float(number):
    """Three values: significand as an integer of 24 or 53 bits, exponent, sign (1 or -1)."""
    digits = float_digits(number)
    significand, exponent = math.frexp(abs(_exact(number)))
    return MultipleValues((int(significand * 2**digits), exponent - digits if significand else 0, int(math.copysign(1, number))))


def scale_float(number, exponent):
    """``number * 2**exponent``"""
    _need_float(number)
    try:
        return number.__class__(math.ldexp(float(number), need_integer(exponent)))
    except OverflowError:
        return overflow("SCALE-FLOAT", number, exponent)


def float_digits(number):
    return 53 if _need_float(number).__class__ is DoubleFloat else 24


def float_precision(number):
    digits, exponent = float_digits(number), math.frexp(_exact(number))[1]
    least = -1074 if number.__class__ is DoubleFloat else -149
    return max(0, min(digits, exponent - least)) if number else 0


def float_radix(number):
    _need_float(number)
    return 2


def float_sign(number, magnitude=UNSUPPLIED):
    """A float with the sign of the first and the size of the second argument (1 by default)."""
    _need_float(number)
    kind = result_kind(number) if magnitude is UNSUPPLIED else _need_float(magnitude).__class__
    return kind(math.copysign(1.0 if magnitude is UNSUPPLIED else abs(float(magnitude)), number))


# ------------------------------------------------------------------------------------------------------------------ complex


def complex_(realpart, imagpart=0):
    """``cl:complex``; with rational parts and imaginary part 0 just the real part."""
    need_real(realpart)
    need_real(imagpart)
    if is_rational(realpart) and is_rational(imagpart):
        return exact(realpart, imagpart)
    return complex_kind(realpart, imagpart)(realpart, imagpart)


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
        return (DoubleFloat if isinstance(number, DoubleComplex) else float)(cmath.phase(number))
    kind = result_kind(number)
    return kind(math.pi) if number < 0 else kind(0.0)


def cis(radians):
    """``e`` to the power of ``i * radians``"""
    need_real(radians)
    return complex_kind(radians)(math.cos(radians), math.sin(radians))


def _limits():
    table = {}
    for names, kind, largest, normalized, least, epsilon, negative in (
        (
            ("SINGLE-FLOAT", "SHORT-FLOAT"),
            float,
            (2 - 2.0**-23) * 2.0**127,
            2.0**-126,
            2.0**-149,
            2.0**-24 * (1 + 2.0**-23),
            2.0**-25 * (1 + 2.0**-23),
        ),
        (
            ("DOUBLE-FLOAT", "LONG-FLOAT"),
            DoubleFloat,
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


CONSTANTS = {"PI": PI, "MOST-POSITIVE-FIXNUM": 2**62 - 1, "MOST-NEGATIVE-FIXNUM": -(2**62), **_limits()}
"""The constants among the numbers, by Lisp name."""
