"""Tokens: which number or which name a run of characters means.

Source: ANSI 2.3. A token is a number when it has the syntax of one in the current radix; otherwise, unless it consists of dots
only, it names a symbol. Floats without an exponent marker, or with ``e``, have the format that
``*read-default-float-format*`` says; ``d`` and ``l`` make doubles, ``f`` and ``s`` singles, which are
rounded once from their digits.
"""

from __future__ import annotations

import math
import re
import unicodedata
from fractions import Fraction

from cramhy_runtime.kernel.active import checkpoint
from cramhy_runtime.kernel.late_patterns import late_pattern
from cramhy_runtime.lisp_core.condition_types import SimpleParseError
from cramhy_runtime.lisp_core.conditions import error, type_error
from cramhy_runtime.lisp_core.data import Character, LispString, MultipleValues
from cramhy_runtime.lisp_core.dynamic import special
from cramhy_runtime.lisp_core.floats import SingleFloat, to_float32
from cramhy_runtime.lisp_core.packages import KEYWORD, named_package, sym
from ..collections.sequence_types import TURN, BoundingIndicesBad, in_turns
from . import reader_errors
from .reader_errors import fail

_DECIMAL = late_pattern(
    r"([+-]?[0-9]+)(?:(\.)|/([0-9]+))?"
    r"|([+-]?(?:[0-9]*\.[0-9]+|[0-9]+(?:\.[0-9]*)?(?=[a-zA-Z])))(?:([esfdlESFDL])([+-]?[0-9]+))?"
)
DIGITS = "0123456789abcdefghijklmnopqrstuvwxyz"
_rationals: dict = {}
SINGLE_LIMIT = 3.4028235677973366e38
"""The smallest magnitude that rounds to no single-float."""

READ_BASE = special("*READ-BASE*", 10)
FLOAT_FORMAT = special("*READ-DEFAULT-FLOAT-FORMAT*", sym("SINGLE-FLOAT"))
_DOUBLES = (sym("DOUBLE-FLOAT"), sym("LONG-FLOAT"))


class NumberError(ValueError):
    """A token with the syntax of a number that no number can represent; ``hint`` says what to write instead."""

    def __init__(self, text, hint):
        super().__init__(text)
        self.hint = hint


def integer(digits, base=10):
    """The integer of ``digits``, however many; Python itself refuses more than some thousands."""
    if len(digits) <= 1000:
        return int(digits, base)
    sign, digits = (-1, digits[1:]) if digits[0] == "-" else (1, digits.lstrip("+"))
    return sign * _long_integer(digits, base)


def _long_integer(digits, base):
    if len(digits) <= 1000:
        return int(digits, base)
    checkpoint()
    low = len(digits) // 2
    return _long_integer(digits[:-low], base) * base**low + _long_integer(digits[-low:], base)


def ratio(numerator, denominator):
    """The rational number; an integer when it is one."""
    if denominator == 0:
        raise NumberError("failed to build ratio", "The denominator of a ratio must not be zero.")
    value = Fraction(numerator, denominator)
    return value.numerator if value.denominator == 1 else value


def number(token, base=None):
    """The number that ``token`` (without escapes) means, or ``None`` if it is none. Raises NumberError."""
    base = READ_BASE.value if base is None else base
    if base != 10:
        if base.__class__ is not int or not 2 <= base <= 36:
            type_error(base, "(INTEGER 2 36)")
        found = rational(token, base)
        if found is not None:
            return found
    match = _DECIMAL.fullmatch(token)
    if match is None:
        return None
    whole, dot, denominator, mantissa, marker, exponent = match.groups()
    if whole is not None:
        if base != 10 and not dot:
            return None
        return integer(whole) if denominator is None else ratio(integer(whole), integer(denominator))
    if marker is None and mantissa[-1] not in "0123456789":
        return None
    return _float(token, mantissa, marker, exponent)


def rational(token, base):
    """The integer or ratio that ``token`` is in ``base``, or ``None``."""
    pattern = _rationals.get(base)
    if pattern is None:
        digits = DIGITS[:base] + DIGITS[10:base].upper()
        pattern = _rationals[base] = re.compile(f"([+-]?[{digits}]+)(?:/([{digits}]+))?")
    match = pattern.fullmatch(token)
    if match is None:
        return None
    whole = integer(match[1], base)
    return whole if match[2] is None else ratio(whole, integer(match[2], base))


def looks_numeric(token, base=None):
    """Whether ``token`` has the syntax of a number in ``base``, by default ``*read-base*``."""
    try:
        return number(token, base) is not None
    except NumberError:
        return True


def _float(token, mantissa, marker, exponent):
    marker = "e" if marker is None else marker.lower()
    double = marker in "dl" or (marker == "e" and FLOAT_FORMAT.value in _DOUBLES)
    value = float(mantissa if exponent is None else f"{mantissa}e{exponent}")
    if double:
        if value in (float("inf"), float("-inf")):
            raise NumberError(f"failed to build float from {token}", "The largest double-float is about 1.8d308.")
        return value
    if not -SINGLE_LIMIT < value < SINGLE_LIMIT:
        raise NumberError(
            f"failed to build float from {token}",
            "The largest single-float is about 3.4e38; write the exponent with d for a double-float: 1d39.",
        )
    if to_float32(math.nextafter(value, -math.inf)) == to_float32(math.nextafter(value, math.inf)):
        return SingleFloat(value)
    return SingleFloat(Fraction(mantissa) * Fraction(10) ** int(exponent or 0))  # near the middle of two singles: else rounded twice


# -------------------------------------------------------------------------------------------------------------------- names


def upcase(text):
    """``text`` in upper case, character by character: what has no single upper-case character stays."""
    if text.isascii():
        return text.upper()
    return "".join([_other_case(character, str.upper) for character in text])


def downcase(text):
    return text.lower() if text.isascii() else "".join([_other_case(character, str.lower) for character in text])


def _other_case(character, convert):
    other = convert(character)
    return other if len(other) == 1 else character


def invert(text):
    """Readtable case :invert: a name all of whose letters have one case gets the other."""
    letters = [character for character in text if _other_case(character, str.upper) != _other_case(character, str.lower)]
    if all(character.isupper() for character in letters):
        return downcase(text)
    if all(character.islower() for character in letters):
        return upcase(text)
    return text


def in_case(parts, convert):
    """The name whose ``parts`` are (text, whether it was written without escapes); ``convert`` makes one text of the latter."""
    plain, end = convert("".join([text for text, converted in parts if converted])), 0
    name = ""
    for text, converted in parts:
        if converted:
            text, end = plain[end : end + len(text)], end + len(text)
        name += text
    return name


CASES = {"UPCASE": upcase, "DOWNCASE": downcase, "PRESERVE": str, "INVERT": invert}


def normalized(text):
    """Names are compared after compatibility normalization, as in SBCL: composed and decomposed accents are one name."""
    return text if text.isascii() else unicodedata.normalize("NFKC", text)


# ------------------------------------------------------------------------------------------------------------ parse-integer


def parse_integer(string_, *, start=0, end=None, radix=10, junk_allowed=None):
    """``cl:parse-integer``: the integer written in ``string_``, and the index where reading ended (two values).

    White space around it is skipped. Anything else is a parse-error, or with ``junk_allowed`` ends the number; then the
    first value is nil if there was no digit.
    """
    if not isinstance(string_, (str, LispString)):
        return type_error(string_, "STRING")
    whole = str(string_)
    start, end = bounds(whole, start, end)
    index = start
    while index < end and whole[index] in WHITESPACE:
        index += 1
    first = index
    if index < end and whole[index] in "+-":
        index += 1
    digits_from = index
    while index < end and _digit(whole[index], radix):
        index += 1
        if not index % TURN:
            checkpoint()
    if index == digits_from:
        if junk_allowed is not None:
            return MultipleValues((None, index))
        return _no_digits(whole[start:end]) if index == end else _junk(whole[start:end])
    value = integer("".join([_ascii_digit(character) for character in in_turns(whole[first:index])]), radix)
    if junk_allowed is None:
        while index < end and whole[index] in WHITESPACE:
            index += 1
        if index < end:
            return _junk(whole[start:end])
    return MultipleValues((value, index))


WHITESPACE = " \t\n\r\f\v"


def _digit(character, radix):
    weight = unicodedata.digit(character, None) if not character.isascii() else DIGITS.find(character.lower())
    return weight is not None and 0 <= weight < radix


def _ascii_digit(character):
    return character if character.isascii() else str(unicodedata.digit(character))


def _junk(text):
    return error(SimpleParseError("junk in string ~S", text))


def _no_digits(text):
    what = "no digits in string ~S" if text.strip(WHITESPACE) else "no non-whitespace characters in string ~S."
    return error(SimpleParseError(what, text))


def bounds(text, start, end):
    """``start`` and ``end`` of a part of ``text``, ``end`` ``None`` being its end; an error when they are none."""
    stop = len(text) if end is None else end
    if isinstance(start, int) and isinstance(stop, int) and 0 <= start <= stop <= len(text):
        return start, stop
    return error(BoundingIndicesBad(start, end, len(text)))


LISP_NAMES = "parse-integer"


# -------------------------------------------------------------------------------------------------- names with packages


def qualified_symbol(reader, parts, convert, word, start):
    """The symbol of a token with package markers; ``parts`` are the texts between its colons."""
    name = convert(parts[-1])
    count = len(parts) - 1
    if not name and "|" not in word:
        if reader.offset == len(reader.text):
            reader.frames.append([None, start, None, word])
            return reader.ended("after reading a colon")
        return fail(
            reader,
            reader.offset,
            "illegal terminating character after a colon: ~S",
            Character(reader.text[reader.offset]),
            hint=f"After {word} the name of a symbol must follow, without white space.",
        )
    if count > 2 or (count == 2 and parts[1]):
        return fail(reader, start, "too many colons in ~S", word, hint="A symbol is written name, package:name, package::name or :keyword.")
    if not parts[0]:
        return KEYWORD.intern(name)
    package_name = convert(parts[0])
    package = named_package(package_name)
    if package is None:
        return reader_errors.no_package(reader, start, package_name, name)
    if count == 2 or package is KEYWORD:
        if package.locked and not package.lookup(name)[1]:
            reader_errors.new_in_locked_package(reader, start, package, name)
        return package.intern(name)
    found, status = package.lookup(name)
    if status == "external":
        return found
    if status == "inherited" and not package.internal:
        return found
    return reader_errors.no_external(reader, start, package, name, status is not None)
