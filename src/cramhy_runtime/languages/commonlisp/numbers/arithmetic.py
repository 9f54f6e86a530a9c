"""Arithmetic and comparison of numbers: ``+ - * / = < max``, and the tests of a number's kind.

The numeric tower is Python's: `int`, `Fraction` for ratios (a ratio with denominator 1 becomes an integer), `float` for double-
floats, `SingleFloat` for singles, and three kinds of `complex`. An operation with singles is done in doubles and rounded to 24 bits,
which gives what IEEE's operation of singles gives. ``t``, ``nil`` and strings are no numbers, although Python's ``True`` is.

The compiler calls `add2`, `sub2`, `mul2`, `div2`, `lt2`, `gt2`, `le2`, `ge2`, `num_eq2` and `num_ne2` for two arguments.
They test for the two common classes first, so ordinary numbers pay for one set lookup each. Source: ANSI chapter 12; texts
are SBCL's.
"""

from __future__ import annotations

import math
import sys
from fractions import Fraction

from cramhy_runtime.lisp_core.conditions import DivisionByZero, FloatingPointInvalidOperation, FloatingPointOverflow, error, type_error
from cramhy_runtime.lisp_core.data import MultipleValues, lisp_list, one
from cramhy_runtime.lisp_core.floats import LARGEST_SINGLE, SPLITTER, SingleFloat, new_single, rational_to_float32, to_float32
from cramhy_runtime.lisp_core.packages import sym
from .float_traps import DIVIDE_BY_ZERO, INVALID, OVERFLOW, infinity, is_masked, quotient_by_zero
from .complex_numbers import ExactComplex, SingleComplex, of_parts, parts

LISP_NAMES = """max min abs gcd lcm signum mod rem numberp realp rationalp integerp floatp complexp zerop plusp minusp evenp oddp
numerator denominator"""

_PLAIN = frozenset((int, float))
_REALS = frozenset((int, float, SingleFloat, Fraction))
_MACHINE = frozenset((int, float, SingleFloat))
_NUMBERS = _REALS | {complex}

_LARGEST = sys.float_info.max
_SMALL_INTEGERS = 2**24
"""Integers up to here are single-floats, exactly."""
_add_floats, _subtract_floats, _multiply_floats = float.__add__, float.__sub__, float.__mul__
"""They compute without a look at the classes, and give a plain float."""


# ---------------------------------------------------------------------------------------------------------------- the kinds


def is_number(obj):
    """Whether ``obj`` is a Lisp number; as Python truth value. Subclasses of Python's numbers count, ``bool`` does not."""
    return obj.__class__ in _NUMBERS or (isinstance(obj, (int, float, Fraction, complex)) and obj.__class__ is not bool)


def is_real(obj):
    return obj.__class__ in _REALS or (isinstance(obj, (int, float, Fraction)) and obj.__class__ is not bool)


def is_rational(obj):
    return isinstance(obj, (int, Fraction)) and obj.__class__ is not bool


def is_integer(obj):
    return obj.__class__ is int or (isinstance(obj, int) and obj.__class__ is not bool)


def need_number(obj):
    return obj if is_number(obj) else _first_value(obj, is_number, "NUMBER")


def need_real(obj):
    return obj if is_real(obj) else _first_value(obj, is_real, "REAL")


def _first_value(obj, accepts, wanted):
    # compiled code leaves it to the generic functions to take the first of several values
    first = one(obj)
    return first if accepts(first) else type_error(first, sym(wanted))


def need_integer(obj):
    return obj if is_integer(obj) else type_error(obj, sym("INTEGER"))


def need_rational(obj):
    return obj if is_rational(obj) else type_error(obj, sym("RATIONAL"))


def numberp(object):
    return True if is_number(object) else None


def realp(object):
    return True if is_real(object) else None


def rationalp(object):
    return True if is_rational(object) else None


def integerp(object):
    return True if is_integer(object) else None


def floatp(object):
    return True if isinstance(object, float) else None


def complexp(object):
    return True if isinstance(object, complex) else None


# --------------------------------------------------------------------------------------------------------------- arithmetic


def normal(value):
    """``value``, a Fraction turned into an int when it is whole."""
    if value.__class__ is Fraction and value.denominator == 1:
        return value.numerator
    return value


def division_by_zero(operation, *operands):
    """Signal that ``operation`` (the name of a CL function) divided by zero; floats give infinity where that trap is masked.

    Zero by zero, one of them a float, is an invalid operation, which has a trap of its own.
    """
    undefined = all(operand == 0 for operand in operands) and not all(isinstance(operand, int) for operand in operands)
    kind, trap = (FloatingPointInvalidOperation, INVALID) if undefined else (DivisionByZero, DIVIDE_BY_ZERO)
    if is_masked(trap) and any(isinstance(operand, float) for operand in operands):
        return quotient_by_zero(*operands) if operation == "/" else infinity(operation, operands)
    return error(kind(sym(operation), lisp_list(*operands)))


def overflow(operation, *operands):
    """Signal that the result of ``operation`` is too large for a float; it is infinite where that trap is masked."""
    if is_masked(OVERFLOW):
        return infinity(operation, operands)
    return error(FloatingPointOverflow(sym(operation), lisp_list(*operands)))


def _finite(operation, result, *operands):
    """``result``, or an overflow when it is infinite though no operand was."""
    if math.isinf(result) and all(math.isfinite(operand) for operand in operands):
        return overflow(operation, *operands)
    return result


def _single(operation, exact, a, b):
    """The single-float nearest to ``exact``, the result of ``operation`` in doubles; an overflow where singles end."""
    result = to_float32(exact)
    if result - result != 0.0:
        _finite(operation, result, a, b)
    return new_single(result)


def single_of(number):
    """The real ``number`` as a single-float; too large a number is a floating-point-overflow."""
    if number.__class__ is SingleFloat:
        return number
    try:
        value = to_float32(number) if isinstance(number, float) else rational_to_float32(number)
    except OverflowError:
        return too_large_for(number, "SINGLE-FLOAT")
    if value - value != 0.0 and (not isinstance(number, float) or math.isfinite(number)):
        return too_large_for(number, "SINGLE-FLOAT")
    return new_single(value)


def too_large_for(number, kind):
    """Signal that ``number`` does not fit into the kind of float that ``kind`` names; an infinite one where that trap is masked."""
    if is_masked(OVERFLOW):
        return (SingleFloat if kind == "SINGLE-FLOAT" else float)(math.copysign(math.inf, number))
    operation = "COERCE" if isinstance(number, float) else "FLOAT"
    return error(FloatingPointOverflow(sym(operation), lisp_list(number, sym(kind))))


_OPERATIONS = {
    "+": (float.__add__, lambda a, b: a + b),
    "-": (float.__sub__, lambda a, b: a - b),
    "*": (float.__mul__, lambda a, b: a * b),
    "/": (float.__truediv__, lambda a, b: a / b),
}


def _operate(operation, a, b):
    """``operation`` for all classes of numbers and several values, but quotients of integers."""
    if a.__class__ is MultipleValues or b.__class__ is MultipleValues:
        return LISP_FUNCTIONS[operation](one(a), one(b))
    of_floats, function = _OPERATIONS[operation]
    need_number(a)
    need_number(b)
    try:
        if isinstance(a, complex) or isinstance(b, complex):
            return _OF_COMPLEX[operation](a, b)
        if a.__class__ is SingleFloat:
            if b.__class__ is SingleFloat or is_rational(b):
                return _single(operation, of_floats(a, single_of(b)), a, b)
        elif b.__class__ is SingleFloat and is_rational(a):
            return _single(operation, of_floats(single_of(a), b), a, b)
        result = normal(function(a, b))
        return result if result.__class__ is not float else _finite(operation, result, a, b)
    except OverflowError:
        return overflow(operation, a, b)
    except ZeroDivisionError:
        return _zero_division(a, b)


def _complex_sum(a, b):
    (x, y), (u, v) = parts(a), parts(b)
    return of_parts(add2(x, u), add2(y, v))


def _complex_difference(a, b):
    (x, y), (u, v) = parts(a), parts(b)
    return of_parts(sub2(x, u), sub2(y, v))


def _complex_product(a, b):
    (x, y), (u, v) = parts(a), parts(b)
    if not isinstance(a, complex):
        return of_parts(mul2(x, u), mul2(x, v))
    if not isinstance(b, complex):
        return of_parts(mul2(x, u), mul2(y, u))
    return of_parts(sub2(mul2(x, u), mul2(y, v)), add2(mul2(x, v), mul2(y, u)))


def _complex_quotient(a, b):
    # Exactly for rationals, for floats in Smith's way, each step as SBCL goes it: so the parts have its last digits.
    (x, y), (u, v) = parts(a), parts(b)
    if not isinstance(b, complex):
        return of_parts(div2(x, u), div2(y, u))
    if b.__class__ is ExactComplex:
        size = add2(mul2(u, u), mul2(v, v))
        return of_parts(div2(add2(mul2(x, u), mul2(y, v)), size), div2(sub2(mul2(y, u), mul2(x, v)), size))
    if abs(u) > abs(v):
        ratio = div2(v, u)
        size = mul2(u, add2(1, mul2(ratio, ratio)))
        if not isinstance(a, complex):
            return of_parts(div2(x, size), div2(-mul2(x, ratio), size))
        return of_parts(div2(add2(x, mul2(y, ratio)), size), div2(sub2(y, mul2(x, ratio)), size))
    ratio = div2(u, v)
    size = mul2(v, add2(1, mul2(ratio, ratio)))
    if not isinstance(a, complex):
        return of_parts(div2(mul2(x, ratio), size), div2(-x, size))
    return of_parts(div2(add2(mul2(x, ratio), y), size), div2(sub2(mul2(y, ratio), x), size))


_OF_COMPLEX = {"+": _complex_sum, "-": _complex_difference, "*": _complex_product, "/": _complex_quotient}


def add2(a, b):
    """``(+ a b)``"""
    kind, other = a.__class__, b.__class__
    if kind in _PLAIN and other in _PLAIN:
        try:
            return a + b
        except OverflowError:
            return overflow("+", a, b)
    if kind is SingleFloat and (other is SingleFloat or other is int and -_SMALL_INTEGERS <= b <= _SMALL_INTEGERS):
        total = _add_floats(a, b)
        if -LARGEST_SINGLE <= total <= LARGEST_SINGLE:  # a sum of singles that is a denormal is exact
            product = total * SPLITTER
            return new_single(product - (product - total))
    elif kind is float and other is SingleFloat or kind is SingleFloat and other is float:
        return float(a) + float(b)
    return _operate("+", a, b)


def sub2(a, b):
    """``(- a b)``"""
    kind, other = a.__class__, b.__class__
    if kind in _PLAIN and other in _PLAIN:
        try:
            return a - b
        except OverflowError:
            return overflow("-", a, b)
    if kind is SingleFloat and (other is SingleFloat or other is int and -_SMALL_INTEGERS <= b <= _SMALL_INTEGERS):
        total = _subtract_floats(a, b)
        if -LARGEST_SINGLE <= total <= LARGEST_SINGLE:
            product = total * SPLITTER
            return new_single(product - (product - total))
    elif kind is float and other is SingleFloat or kind is SingleFloat and other is float:
        return float(a) - float(b)
    return _operate("-", a, b)


def mul2(a, b):
    """``(* a b)``"""
    kind, other = a.__class__, b.__class__
    if kind in _PLAIN and other in _PLAIN:
        try:
            product = a * b
        except OverflowError:
            return overflow("*", a, b)
        if product.__class__ is float and not -_LARGEST <= product <= _LARGEST:
            return _finite("*", product, a, b)
        return product
    if kind is SingleFloat and (other is SingleFloat or other is int and -_SMALL_INTEGERS <= b <= _SMALL_INTEGERS):
        product = to_float32(_multiply_floats(a, b))
        if product - product == 0.0:
            return new_single(product)
    elif kind in _MACHINE and other is SingleFloat and kind is not int or kind is SingleFloat and other is float:
        return _finite("*", float(a) * float(b), a, b)
    return _operate("*", a, b)


def div2(a, b):
    """``(/ a b)``: a ratio when both are rational."""
    kind, other = a.__class__, b.__class__
    if kind in _PLAIN and other in _PLAIN:
        try:
            if kind is int and other is int:
                quotient, rest = divmod(a, b)
                return Fraction(a, b) if rest else quotient
            quotient = a / b
        except ZeroDivisionError:
            return _zero_division(a, b)
        except OverflowError:
            return overflow("/", a, b)
        return quotient if -_LARGEST <= quotient <= _LARGEST else _finite("/", quotient, a, b)
    if kind is MultipleValues or other is MultipleValues:
        return div2(one(a), one(b))
    return _operate("/", a, b)


def _zero_division(a, b):
    # The operands are shown as the operation saw them, that is, after contagion.
    if isinstance(a, float) or isinstance(b, float):
        kind = float if float in (a.__class__, b.__class__) else SingleFloat
        a, b = kind(a), kind(b)
    return division_by_zero("/", a, b)


def add(*numbers):
    """``cl:+``"""
    if not numbers:
        return 0
    total = need_number(numbers[0])
    for number in numbers[1:]:
        total = add2(total, number)
    return total


def subtract(number, *more):
    """``cl:-``"""
    if not more:
        return sub2(0, number) if number.__class__ is int else -need_number(number)
    for other in more:
        number = sub2(number, other)
    return number


def multiply(*numbers):
    """``cl:*``"""
    if not numbers:
        return 1
    product = need_number(numbers[0])
    for number in numbers[1:]:
        product = mul2(product, number)
    return product


def divide(number, *more):
    """``cl:/``"""
    if not more:
        return div2(1, number)
    for other in more:
        number = div2(number, other)
    return number


def increment(number):
    """``cl:1+``"""
    return number + 1 if number.__class__ in _PLAIN else add2(number, 1)


def decrement(number):
    """``cl:1-``"""
    return number - 1 if number.__class__ in _PLAIN else sub2(number, 1)


# --------------------------------------------------------------------------------------------------------------- comparison


def num_eq2(a, b):
    """``(= a b)``"""
    if a.__class__ in _PLAIN and b.__class__ in _PLAIN:
        return True if a == b else None
    return True if need_number(a) == need_number(b) else None


def num_ne2(a, b):
    """``(/= a b)``"""
    return None if num_eq2(a, b) else True


def lt2(a, b):
    """``(< a b)``"""
    if a.__class__ in _MACHINE and b.__class__ in _MACHINE:
        return True if a < b else None
    return True if need_real(a) < need_real(b) else None


def gt2(a, b):
    """``(> a b)``"""
    if a.__class__ in _MACHINE and b.__class__ in _MACHINE:
        return True if a > b else None
    return True if need_real(a) > need_real(b) else None


def le2(a, b):
    """``(<= a b)``"""
    if a.__class__ in _MACHINE and b.__class__ in _MACHINE:
        return True if a <= b else None
    return True if need_real(a) <= need_real(b) else None


def ge2(a, b):
    """``(>= a b)``"""
    if a.__class__ in _MACHINE and b.__class__ in _MACHINE:
        return True if a >= b else None
    return True if need_real(a) >= need_real(b) else None


def _chain(compare, check):
    def compare_all(number, *more):
        check(number)
        result = True
        for other in more:
            # All arguments are looked at, so that a wrong one is found even after the answer is clear.
            if compare(number, other) is None:
                result = None
            number = other
        return result

    return compare_all


num_eq = _chain(num_eq2, need_number)
lt, gt, le, ge = (_chain(compare, need_real) for compare in (lt2, gt2, le2, ge2))


def num_ne(number, *more):
    """``cl:/=``: whether no two of the arguments are equal."""
    numbers = [need_number(number), *more]
    result = True
    for index, first in enumerate(numbers):
        for second in numbers[index + 1 :]:
            if num_eq2(first, second):
                result = None
    return result


def max_(number, *more):
    need_real(number)
    for other in more:
        if gt2(other, number):
            number = other
    return number


def min_(number, *more):
    need_real(number)
    for other in more:
        if lt2(other, number):
            number = other
    return number


def zerop(number):
    return True if need_number(number) == 0 else None


def plusp(number):
    return True if need_real(number) > 0 else None


def minusp(number):
    return True if need_real(number) < 0 else None


def evenp(integer):
    return True if need_integer(integer) % 2 == 0 else None


def oddp(integer):
    return True if need_integer(integer) % 2 else None


# ------------------------------------------------------------------------------------------------------- functions of integers


def abs_(number):
    size = abs(need_number(number))
    return single_of(size) if isinstance(number, SingleComplex | ExactComplex) else size


def signum(number):
    """-1, 0 or 1 of the kind of ``number``; for a complex number the one of length 1 with its direction."""
    need_number(number)
    if isinstance(number, complex):
        return div2(number, abs_(number)) if number else number
    if number == 0:
        return number
    sign = 1 if number > 0 else -1
    return number.__class__(sign) if isinstance(number, float) else sign


def gcd(*integers):
    return math.gcd(*(need_integer(integer) for integer in integers))


def lcm(*integers):
    return math.lcm(*(need_integer(integer) for integer in integers))


def mod(number, divisor):
    """The rest of ``floor``: has the sign of ``divisor``."""
    if number.__class__ is int and divisor.__class__ is int and divisor:
        return number % divisor
    from .rounding import floor

    return floor(number, divisor)[1]


def rem(number, divisor):
    """The rest of ``truncate``: has the sign of ``number``."""
    from .rounding import truncate

    return truncate(number, divisor)[1]


def numerator(rational):
    return need_rational(rational).numerator


def denominator(rational):
    return need_rational(rational).denominator


LISP_FUNCTIONS = {
    "+": add,
    "-": subtract,
    "*": multiply,
    "/": divide,
    "1+": increment,
    "1-": decrement,
    "=": num_eq,
    "/=": num_ne,
    "<": lt,
    ">": gt,
    "<=": le,
    ">=": ge,
}
"""The operators whose names are no Python names."""
