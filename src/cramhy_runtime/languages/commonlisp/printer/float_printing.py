"""Floats as text: the shortest digits that read back as the same float, and digits up to a given place.

A Python float is a double-float and has 53 bits, a `SingleFloat` has 24. The law is that of Steele and White: free-format
output reads back as the same number and has as few digits as that allows. `digits` is the algorithm of Burger and Dybvig with
SBCL's extension for a cut-off place (SBCL, ``src/code/print.lisp``), on which ``~F``, ``~E``, ``~G`` and ``~$`` build; `shortest`
is the quick way to the same digits where no place is given.
"""

from __future__ import annotations

import math

from cramhy_runtime.lisp_core.floats import SingleFloat, to_float32
from cramhy_runtime.lisp_core.dynamic import special
from cramhy_runtime.lisp_core.packages import sym
from cramhy_runtime.lisp_core.printing import NUMBERS_OF_PYTHON

READ_DEFAULT_FLOAT_FORMAT = special("*READ-DEFAULT-FLOAT-FORMAT*", sym("SINGLE-FLOAT"))
_DOUBLE_NAMES = (sym("DOUBLE-FLOAT"), sym("LONG-FLOAT"))
_SMALLEST_SINGLE = 2.0**-126
_SMALLEST_DOUBLE = 2.0**-1022


def shortest(x):
    """(digits, k) of the positive float ``x``: 0.DIGITS times ten to the k, as short as reading back allows."""
    if x.__class__ is SingleFloat:
        if x < _SMALLEST_SINGLE:
            return digits(x)
        value = float(x)
        for precision in (5, 6, 7, 8):  # a decimal of 6 digits survives the way through a single, 9 tell all singles apart
            text = f"{value:.{precision}e}"
            if to_float32(float(text)) == value:
                break
        if precision > 6:  # a tie in the last digit goes up in Lisp, to even in Python
            return digits(x)
    elif x < _SMALLEST_DOUBLE:
        return digits(x)
    else:
        text = repr(float(x))
        if len(text) > 16:
            return digits(x)
        if "e" not in text:
            whole, _, fraction = text.partition(".")
            figures = (whole + fraction).lstrip("0")
            k = len(whole) if whole != "0" else len(figures) - len(fraction)
            return figures.rstrip("0") or "0", k
    mantissa, _, exponent = text.partition("e")
    return mantissa.replace(".", "").rstrip("0") or "0", int(exponent) + 1


def digits(x, position=None, relative=False):
    """(digits, k) of ``x`` >= 0: 0.DIGITS times ten to the k, rounded at the place ten to the ``position``.

    With ``relative`` the place counts from the first digit: ``position`` digits are wanted. Source: SBCL's
    FLONUM-TO-DIGITS.
    """
    precision, least = (24, -149) if x.__class__ is SingleFloat else (53, -1074)
    mantissa, exponent = math.frexp(x)
    f, e = (int(math.ldexp(mantissa, precision)), exponent - precision) if x else (0, least)
    low_ok = high_ok = f % 2 == 0
    edge = f == 1 << (precision - 1)
    if e >= 0:
        below = 1 << e
        above = below * 2 if edge else below
        r, s = f * 2 * above, 4 if edge else 2
    elif e == least or not edge:
        r, s, above, below = f * 2, 1 << (1 - e), 1, 1
    else:
        r, s, above, below = f * 4, 1 << (2 - e), 2, 1
    if position is not None:
        if relative:
            k, power = 0, 1
            while s * power < r + above:
                k, power = k + 1, power * 10
            # compare r + s * 10^(k - position) / 2 with s * power, in integers
            scale = 10 ** max(0, position - k)
            half = s * 10 ** max(0, k - position)
            position = k - position if 2 * r * scale + half < 2 * s * power * scale else k - position - 1
        scale = 2 * 10 ** max(0, -position)
        r, s, above, below = r * scale, s * scale, above * scale, below * scale
        place = s * 10**position // 2 if position >= 0 else s // (2 * 10**-position)
        below, above = max(below, place), max(above, place)
        low_ok = high_ok = True
    k = 0
    while r + above > s or (high_ok and r + above == s):
        s, k = s * 10, k + 1
    while r > below and ((r + above) * 10 < s or (not high_ok and (r + above) * 10 == s)):
        r, above, below, k = r * 10, above * 10, below * 10, k - 1
    figures = []
    while True:
        digit, r = divmod(r * 10, s)
        above, below = above * 10, below * 10
        low = r < below or (low_ok and r == below)
        high = r + above > s or (high_ok and r + above == s)
        if low or high:
            figures.append(digit + 1 if not low or (high and r * 2 >= s) else digit)
            return "".join(map(str, figures)), k
        figures.append(digit)


def marker(x):
    """The exponent marker that ``x`` needs to be read back: ``e`` when it is of the default format."""
    if READ_DEFAULT_FLOAT_FORMAT.value is NUMBERS_OF_PYTHON:
        return "e"
    double = x.__class__ is not SingleFloat
    if (READ_DEFAULT_FLOAT_FORMAT.value in _DOUBLE_NAMES) == double:
        return "e"
    return "d" if double else "f"


def float_text(x):
    """``x`` as ``prin1`` prints it: ``3.6666667``, ``1.0e7``, ``5.0d0``."""
    if READ_DEFAULT_FLOAT_FORMAT.value is NUMBERS_OF_PYTHON:
        return repr(x)
    if x != x or x in (math.inf, -math.inf):
        return _special_text(x)
    sign = "-" if math.copysign(1.0, x) < 0 else ""
    mark = marker(x)
    if x == 0.0:
        return f"{sign}0.0" if mark == "e" else f"{sign}0.0{mark}0"
    figures, k = shortest(abs(x))
    if -3 < k < 8:
        if k <= 0:
            text = "0." + "0" * -k + figures
        elif k >= len(figures):
            text = figures + "0" * (k - len(figures)) + ".0"
        else:
            text = figures[:k] + "." + figures[k:]
        return sign + text if mark == "e" else f"{sign}{text}{mark}0"
    return f"{sign}{figures[0]}.{figures[1:] or '0'}{mark}{k - 1}"


def _special_text(x):
    kind = "SINGLE" if x.__class__ is SingleFloat else "DOUBLE"
    if x != x:
        return f"#<{kind}-FLOAT quiet NaN>"
    return f"#.SB-EXT:{kind}-FLOAT-{'POSITIVE' if x > 0 else 'NEGATIVE'}-INFINITY"


def _rounded(x, count):
    """The text of `fixed_text` with ``count`` digits after the point, by Python's formatting; ``None`` where `digits` decides.

    It decides where the float has not so many digits, and where its value is halfway between two texts, or nearly so.
    """
    single = x.__class__ is SingleFloat
    x = float(x)
    units = x * 10.0**count
    if not 0.0 < units < (1 << 22 if single else 1 << 50) or abs(units % 1.0 - 0.5) < 1e-3:
        return None
    text = f"{x:.{count}f}"
    return text[1:] if text[0] == "0" else text


def fixed_text(x, width=None, fraction_digits=None, scale=None, least=None):
    """The decimal text of ``x`` >= 0 with a point and no exponent, and perhaps nothing before or after the point.

    ``width``: how many characters are wanted, ``fraction_digits``: how many digits after the point, ``scale``: a
    power of ten to multiply with, ``least``: least number of digits after the point. Source: SBCL's FLONUM-TO-STRING.
    """
    if fraction_digits is not None and scale is None is least and 0 < fraction_digits < 16:
        quick = _rounded(x, fraction_digits)
        if quick is not None:
            return quick
    if fraction_digits is not None:
        figures, e = digits(x, min(-(fraction_digits + (scale or 0)), -(least or 0)))
    elif width is not None and width > 1:
        by_width = digits(x, max(1, width - 1 + (scale if scale is not None and scale < 0 else 0)), True)
        by_fraction = digits(x, -((least or 0) + (scale or 0)))
        figures, e = by_width if len(by_width[0]) >= len(by_fraction[0]) else by_fraction
    else:
        figures, e = shortest(x) if x else ("0", 0)
    if x:
        e += scale or 0
    if e > 0:
        text = figures[:e] + "0" * (e - len(figures)) + "." + figures[e:]
        if fraction_digits is not None:
            text += "0" * (fraction_digits - max(0, len(figures) - e))
        return text
    text = "." + "0" * -e
    if fraction_digits is None:
        return text + figures
    return text + figures[: min(len(figures), max(least or 0, fraction_digits + e))] + "0" * (fraction_digits + e - len(figures))


def scaled(x):
    """(z, e) with 0.1 <= z < 1 and x about z * 10^e for ``x`` >= 0, of the same format; (0.0, 1) for zero.

    Scaling is done in doubles and may lose the last digit of precision, in the very way of SBCL's SCALE-EXPONENT.
    """
    if x == 0.0:
        return x, 1
    single = x.__class__ is SingleFloat
    value = float(x)
    power = round(math.frexp(value)[1] * 0.30102999566398114)  # SBCL's idea of the decimal logarithm of 2
    if power < 0:
        head = 1e16 if value < _SMALLEST_DOUBLE else 10.0
        value = value * head * 10.0 ** (-power - (16 if head == 1e16 else 1))
    else:
        value = value / 10.0 / 10.0 ** (power - 1)
    divisor, quotient = 10.0, value
    while quotient >= 1.0:
        quotient, power, divisor = value / divisor, power + 1, divisor * 10.0
    factor, product = 10.0, quotient
    while product < 0.1:
        product, power, factor = quotient * factor, power - 1, factor * 10.0
    return (SingleFloat(product) if single else product), power
