"""Numbers in ``format``: integers with commas, words, Roman numerals, and floats in fixed, exponential and money
notation.

Source: ANSI 22.3.2 and 22.3.3; roundings and widths as in SBCL 2.2.9 (``src/code/target-format.lisp``).
"""

from __future__ import annotations

import math
from fractions import Fraction

from cramhy_runtime.lisp_core.conditions import error
from cramhy_runtime.lisp_core.floats import SingleFloat
from ..printer.float_printing import fixed_text, marker, scaled
from ..printer.print_controls import PRINT_BASE, PRINT_RADIX, bound
from ..printer.print_names import digits_in_base
from ..printer.printer import prin1, princ_to_string


_SHORT = 10**18
"""Python prints smaller integers without a limit."""


def pad(stream, text, mincol, colinc, minpad, padchar, padleft):
    """Write ``text`` in a field at least ``mincol`` wide, filled up in steps of ``colinc``."""
    padding = padchar * minpad
    if mincol is not None and colinc is not None:
        missing = mincol - len(text) - max(minpad, 0)
        if missing > 0:
            padding += padchar * (-(-missing // colinc) * colinc)
    stream.write(padding + text if padleft else text + padding)


# ------------------------------------------------------------------------------------------------------------- integers


def write_integer(stream, number, base, commas=False, sign=False, mincol=0, padchar=" ", commachar=",", interval=3):
    if number.__class__ is not int and (not isinstance(number, int) or isinstance(number, bool)):
        with bound(PRINT_BASE, base, PRINT_RADIX, None):
            stream.write(princ_to_string(number))
        return
    stream.write(integer_field(number, base, commas, sign, mincol, padchar, commachar, interval))


def integer_field(number, base, commas, sign, mincol, padchar, commachar, interval):
    """The text of an integer in a field, with a character after each ``interval`` digits if ``commas``."""
    text = str(abs(number)) if base == 10 and -_SHORT < number < _SHORT else digits_in_base(abs(number), base)
    if commas:
        head = (len(text) - 1) % interval + 1
        text = commachar.join([text[:head], *(text[index : index + interval] for index in range(head, len(text), interval))])
    text = ("-" if number < 0 else "+" if sign else "") + text
    return text.rjust(mincol, padchar) if mincol else text


_ONES = "? one two three four five six seven eight nine".split()
_TEENS = "ten eleven twelve thirteen fourteen fifteen sixteen seventeen eighteen nineteen".split()
_TENS = "? ? twenty thirty forty fifty sixty seventy eighty ninety".split()
_PERIODS = (
    "? thousand million billion trillion quadrillion quintillion sextillion septillion octillion nonillion decillion "
    "undecillion duodecillion tredecillion quattuordecillion quindecillion sexdecillion septendecillion octodecillion "
    "novemdecillion vigintillion"
).split()
_ORDINAL_ONES = "? first second third fourth fifth sixth seventh eighth ninth".split()
_ORDINAL_TENS = "? tenth twentieth thirtieth fortieth fiftieth sixtieth seventieth eightieth ninetieth".split()


def _small_cardinal(number):
    words = []
    hundreds, rest = divmod(number, 100)
    if hundreds:
        words += [_ONES[hundreds], "hundred"]
    tens, ones = divmod(rest, 10)
    if tens > 1:
        words.append(_TENS[tens] + ("-" + _ONES[ones] if ones else ""))
    elif tens:
        words.append(_TEENS[ones])
    elif ones:
        words.append(_ONES[ones])
    return " ".join(words)


def cardinal(number):
    """``number`` in English: ``one hundred twenty-three``."""
    if number == 0:
        return "zero"
    words, rest, period = [], abs(number), 0
    while rest:
        rest, here = divmod(rest, 1000)
        if period >= len(_PERIODS):
            return error("Number too large to print in English: ~:D", number)
        if here:
            words.insert(0, _small_cardinal(here) + (" " + _PERIODS[period] if period else ""))
        period += 1
    return ("negative " if number < 0 else "") + " ".join(words)


def ordinal(number):
    """``number`` as an English ordinal: ``twenty-third``."""
    size = abs(number)
    rest = size % 100
    text = "negative " if number < 0 else ""
    if size - rest:
        text += cardinal(size - rest) + (" " if rest else "")
    tens, ones = divmod(rest, 10)
    if rest == 12:
        return text + "twelfth"
    if tens == 1 and ones:
        return text + _TEENS[ones] + "th"
    if ones:
        return text + (_TENS[tens] + "-" if tens else "") + _ORDINAL_ONES[ones]
    if tens:
        # SBCL says "tenth" as "ten" and "th", which is the same
        return text + _ORDINAL_TENS[tens]
    return text + ("th" if size else "zeroth")


_ROMAN = [
    (1000, "M"),
    (900, "CM"),
    (500, "D"),
    (400, "CD"),
    (100, "C"),
    (90, "XC"),
    (50, "L"),
    (40, "XL"),
    (10, "X"),
    (9, "IX"),
    (5, "V"),
    (4, "IV"),
    (1, "I"),
]


def roman(number, old=False):
    """``number`` in Roman numerals; in the ``old`` way without subtraction."""
    if not 0 < number < (5000 if old else 4000):
        return error(f"Number too large to print in {'old ' if old else ''}Roman numerals: ~:D", number)
    text = ""
    for value, letters in _ROMAN:
        if len(letters) == 1 or not old:
            count, number = divmod(number, value)
            text += letters * count
    return text


# --------------------------------------------------------------------------------------------------------------- floats


def as_float(number):
    """``number`` as the float that the float directives print; ``None`` when it is no real."""
    if isinstance(number, float):
        return number
    if isinstance(number, Fraction) or (isinstance(number, int) and not isinstance(number, bool)):
        return SingleFloat(number)
    return None


def _write_non_real(stream, number, width):
    if isinstance(number, complex):
        pad(stream, princ_to_string(number), width, 1, 0, " ", True)
        return
    with bound(PRINT_BASE, 10):
        text = princ_to_string(number)
    pad(stream, text, width, 1, 0, " ", False)


def _is_special(number):
    return math.isnan(number) or math.isinf(number)


def _negative(number):
    return math.copysign(1.0, number) < 0


def _magnitude(number):
    return abs(number)


def write_fixed(stream, number, width=None, digits=None, scale=None, overflow=None, padchar=" ", sign=False):
    """``~F``."""
    value = as_float(number)
    if value is None:
        _write_non_real(stream, number, width)
    else:
        _fixed(stream, value, width, digits, scale, overflow, padchar, sign)


def _fit(text, space, no_fraction):
    """(text with the zeros that there is room for, space left over) for digits ``text`` in ``space`` columns, or
    ``None``.
    """
    leading = text[0] == "."
    trailing = text[-1] == "." and not no_fraction
    if space is not None:
        space -= len(text)
        if leading:
            if space > 0 or trailing:
                space -= 1
            else:
                leading = False
        if trailing:
            if space > 0:
                space -= 1
            else:
                trailing = False
    return ("0" if leading else "") + text + ("0" if trailing else ""), space


def _fixed(stream, number, width, digits, scale, overflow, padchar, sign):
    """Print in fixed notation; ``True`` when the field was too narrow and filled with ``overflow``."""
    if _is_special(number):
        prin1(number, stream)
        return False
    negative = _negative(number)
    space = None if width is None else width - (1 if sign or negative else 0)
    text, space = _fit(fixed_text(_magnitude(number), space, digits, scale), space, digits == 0)
    if width is not None and space < 0 and overflow is not None:
        stream.write(overflow * width)
        return True
    stream.write((padchar * space if width is not None else "") + ("-" if negative else "+" if sign else "") + text)
    return False


def write_exponential(stream, number, width, digits, exponent_digits, scale, overflow, padchar, mark, sign):
    """``~E``."""
    value = as_float(number)
    if value is None:
        _write_non_real(stream, number, width)
    else:
        _exponential(stream, value, width, digits, exponent_digits, scale, overflow, padchar, mark, sign)


def _exponential(stream, number, width, digits, exponent_digits, scale, overflow, padchar, mark, sign):
    if _is_special(number):
        prin1(number, stream)
        return
    significand, exponent = scaled(_magnitude(number))
    exponent -= scale
    exponent_text = str(abs(exponent))
    exponent_width = max(len(exponent_text), exponent_digits or 0)
    negative = _negative(number)
    space = None if width is None else width - 2 - exponent_width - (1 if sign or negative else 0)
    if width is not None and overflow is not None and exponent_digits is not None and exponent_width > exponent_digits:
        stream.write(overflow * width)
        return
    fraction = None if digits is None else digits - scale + 1 if scale > 0 else digits
    least = 1 if scale < 0 else fraction
    text, space = _fit(fixed_text(significand, space, fraction, scale, least), space, fraction == 0)
    if width is not None and space < 0 and overflow is not None:
        stream.write(overflow * width)
        return
    stream.write(
        (padchar * space if width is not None else "")
        + ("-" if negative else "+" if sign else "")
        + text
        + (mark or marker(number))
        + ("-" if exponent < 0 else "+")
        + exponent_text.rjust(exponent_digits or 0, "0")
    )


def write_general(stream, number, width, digits, exponent_digits, scale, overflow, padchar, mark, sign):
    """``~G``: fixed notation when the number is of ordinary size, else exponential."""
    value = as_float(number)
    if value is None:
        _write_non_real(stream, number, width)
        return
    if _is_special(value):
        prin1(value, stream)
        return
    size = scaled(_magnitude(value))[1]
    if digits is None:
        length = len(fixed_text(_magnitude(value)))
        digits = max(1 if length == 1 else length - 1, min(size, 7))
    exponent_columns = exponent_digits + 2 if exponent_digits else 4
    fraction = digits - size
    if 0 <= fraction <= digits:
        narrower = None if width is None else width - exponent_columns
        overflowed = _fixed(stream, value, narrower, fraction, None, overflow, padchar, sign)
        stream.write((overflow if overflowed else " ") * exponent_columns)
    else:
        _exponential(stream, value, width, digits, exponent_digits, 1 if scale is None else scale, overflow, padchar, mark, sign)


def write_dollars(stream, number, digits, least, width, padchar, sign_first, sign):
    """``~$``."""
    value = as_float(number)
    if value is None:
        with bound(PRINT_BASE, 10):
            text = princ_to_string(number)
        pad(stream, text, width, 1, 0, " ", True)
        return
    sign_text = "-" if _negative(value) else "+" if sign else ""
    text = fixed_text(_magnitude(value), None, digits)
    point = text.index(".")
    padding = padchar * (width - len(sign_text) - max(least, point) - 1 - digits)
    zeros = "0" * (least - point)
    stream.write((sign_text + padding if sign_first else padding + sign_text) + zeros + text)
