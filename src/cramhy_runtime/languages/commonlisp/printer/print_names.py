"""Symbols, strings, characters and integers as text.

A symbol prints so that reading the text gives the symbol again: with the package in front where the current package
would not find it, and between bars where its name would be read as something else, such as ``|foo|`` or ``|1|``.
Whether a name needs bars is told by the automaton of SBCL (``SYMBOL-QUOTEP`` in ``src/code/print.lisp``), because
"might be a number" is a matter of many cases (ANSI 2.3.1.1). Source: ANSI 22.1.3.3.
"""

from __future__ import annotations

import unicodedata

from cramhy_runtime.lisp_core.conditions import type_error
from cramhy_runtime.lisp_core.data import Symbol
from cramhy_runtime.lisp_core.packages import COMMON_LISP, KEYWORD
from cramhy_runtime.kernel.active import checkpoint
from ..collections.characters import character_name
from ..reader.readtables import READTABLE
from ..reader.tokens import CASES, downcase, invert, looks_numeric, upcase
from .print_controls import CAPITALIZE, DOWNCASE, PACKAGE, PRINT_BASE, PRINT_CASE, PRINT_GENSYM, PRINT_RADIX, PRINT_READABLY, UPCASE

# ------------------------------------------------------------------------------------------------------------- integers

_DIGITS = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZ"


def integer_text(number, base=None, radix=None):
    """``number`` in ``base`` (default ``*print-base*``), with its radix when ``radix`` (default ``*print-radix*``)."""
    base = PRINT_BASE.value if base is None else base
    text = digits_in_base(number, base)
    if (PRINT_RADIX.value if radix is None else radix) not in (None, False):
        return text + "." if base == 10 else radix_prefix(base) + text
    return text


def radix_prefix(base):
    return {2: "#b", 8: "#o", 16: "#x"}.get(base) or f"#{base}r"


def digits_in_base(number, base):
    if base == 10:
        return _decimal(number)
    if base.__class__ is not int or not 2 <= base <= 36:
        return type_error(base, "(INTEGER 2 36)")
    if base in (2, 8, 16):
        return format(number, {2: "b", 8: "o", 16: "X"}[base])
    sign, number, figures = "-" if number < 0 else "", abs(number), []
    while True:
        checkpoint()
        number, digit = divmod(number, base)
        figures.append(_DIGITS[digit])
        if not number:
            return sign + "".join(reversed(figures))


def _decimal(number):
    try:
        return int.__repr__(number)
    except ValueError:  # Python refuses to print integers of more than 4300 digits in one go
        checkpoint()
        sign, number = "-" if number < 0 else "", abs(number)
        half = number.bit_length() * 3 // 20
        high, low = divmod(number, 10**half)
        return sign + _decimal(high) + _decimal(low).rjust(half, "0")


def ratio_text(ratio):
    base = PRINT_BASE.value
    prefix = radix_prefix(base) if PRINT_RADIX.value not in (None, False) else ""
    return f"{prefix}{digits_in_base(ratio.numerator, base)}/{digits_in_base(ratio.denominator, base)}"


# -------------------------------------------------------------------------------------------------------------- symbols

_OTHER, _NUMBER, _UPPER, _LOWER, _SIGN, _EXTENSION, _DOT, _SLASH, _FUNNY = (1 << index for index in range(9))
_ATTRIBUTES = dict.fromkeys("!@$%&*=~[]{}?<>", _OTHER) | dict.fromkeys("0123456789", _NUMBER)
_ATTRIBUTES |= dict.fromkeys("ABCDEFGHIJKLMNOPQRSTUVWXYZ", _UPPER) | dict.fromkeys("abcdefghijklmnopqrstuvwxyz", _LOWER)
_ATTRIBUTES |= {"-": _SIGN, "+": _SIGN, "^": _EXTENSION, "_": _EXTENSION, ".": _DOT, "/": _SLASH}

# state: list of (what the character is, next state, whether the name may end there as a symbol that needs no bars)
# "digit" and "letter digit" depend on the base; a rule "again" looks at the same character in another state.
_SIGNS = _SIGN | _SLASH
_STATES = {
    "start": [
        ("letter digit", "last digit alpha", 0),
        ("digit", "digit", 0),
        (_UPPER | _NUMBER | _OTHER | _SLASH, "other", 1),
        (_DOT, "dot", 0),
        (_SIGN | _EXTENSION, "start stuff", 1),
    ],
    "dot": [
        (_UPPER, "start dot marker", 1),
        ("digit", "dot digit", 0),
        (_NUMBER | _OTHER, "other", 1),
        (_EXTENSION | _SIGNS, "start dot stuff", 1),
        (_DOT, "dot", 0),
    ],
    "start stuff": [
        ("letter digit", "last digit alpha", 0),
        ("digit", "digit", 0),
        (_NUMBER | _OTHER, "other", 1),
        (_UPPER, "start marker", 1),
        (_DOT, "start dot stuff", 1),
        (_SIGNS | _EXTENSION, "start stuff", 1),
    ],
    "start marker": [(_UPPER, "other", 1), ("again", "start stuff", 0)],
    "start dot stuff": [
        (_UPPER, "start dot stuff", 1),
        ("digit", "dot digit", 0),
        (_SIGNS | _EXTENSION | _DOT, "start dot stuff", 1),
        (_NUMBER | _OTHER, "other", 1),
    ],
    "start dot marker": [(_UPPER, "other", 1), ("again", "start dot stuff", 0)],
    "dot digit": [
        (_UPPER, "dot marker", 0),
        ("digit", "dot digit", 0),
        (_NUMBER | _OTHER, "other", 1),
        (_SIGNS | _EXTENSION | _DOT, "dot digit", 0),
    ],
    "dot marker": [(_UPPER, "other", 1), ("again", "dot digit", 0)],
    "last digit alpha": [("digit", "alpha digit", 0), (_SIGNS, "alpha digit", 0), (_UPPER | _NUMBER | _OTHER | _DOT, "other", 1)],
    "alpha digit": [
        ("letter digit", "last digit alpha", 0),
        ("digit", "alpha digit", 0),
        (_SIGNS, "alpha digit", 0),
        (_UPPER, "alpha marker", 0),
        (_NUMBER | _OTHER | _DOT, "other", 1),
    ],
    "alpha marker": [(_UPPER, "other", 1), ("again", "alpha digit", 0)],
    "digit": [
        ("letter digit", "alpha digit", 0),
        ("digit", "digit", 0),
        (_NUMBER | _OTHER, "other", 1),
        (_UPPER, "marker", 0),
        (_EXTENSION | _SIGNS, "digit", 0),
        (_DOT, "dot digit", 0),
    ],
    "marker": [(_UPPER, "other", 1), ("again", "digit", 0)],
}


_SWAPPED = {_UPPER: _LOWER, _LOWER: _UPPER}


def _attributes_for(readtable_case):
    """A function from characters to attributes, in which letters that the readtable would change to the other case are _LOWER."""

    def attribute(character):
        found = (
            _ATTRIBUTES.get(character, _FUNNY)
            if character < "\xa0"
            else _UPPER
            if character.isupper()
            else _LOWER
            if character.islower()
            else _OTHER
        )
        if readtable_case == "UPCASE":
            return found
        return _SWAPPED.get(found, found) if readtable_case == "DOWNCASE" else _UPPER if found is _LOWER else found

    return attribute


_attribute_functions = {name: _attributes_for(name) for name in ("UPCASE", "DOWNCASE", "PRESERVE", "INVERT")}


def _is_digit(character, base):
    return character < "\x80" and character.isalnum() and int(character, 36) < base


def _next_state(state, character, bits, base):
    for what, successor, may_end in _STATES[state]:
        if what == "again":
            return _next_state(successor, character, bits, base)
        if what.__class__ is int:
            matches = bits & what
        else:
            matches = _is_digit(character, base) and bits & (_NUMBER | _UPPER if what == "digit" else _UPPER)
        if matches:
            return successor, may_end
    return None, 0


def needs_bars(name, base, readtable_case="UPCASE"):
    """Whether ``name`` must stand between bars: it has letters of the wrong case or odd characters, or might be a number or a dot."""
    _attribute = _attribute_functions[readtable_case]
    state, may_end = "start", 0
    bits = 0
    for index, character in enumerate(name):
        bits = _attribute(character)
        state, may_end = _next_state(state, character, bits, base)
        if state is None:
            return True
        if state == "other":
            return any(_attribute(following) & (_LOWER | _FUNNY) for following in name[index:])
    return not may_end and not bits & _SIGN


_quoted: dict = {}


def token(name):
    """``name`` as it stands in a symbol's printed form: between bars if need be, in the case of ``*print-case*``.

    With ``*print-readably*`` it is written for the standard readtable, which will read it (ANSI, ``*print-readably*``).
    """
    reads_as = READTABLE.value.case if PRINT_READABLY.value is None else UPCASE
    base, case = PRINT_BASE.value, reads_as.name
    text = _quoted.get((name, base, case))
    if text is None:
        if needs_bars(name, base, case) or looks_numeric(name, base) or not unicodedata.is_normalized("NFKC", name):
            # SBCL's automaton misses 1E5 in base 2; the reader normalizes a name that has no bars
            text = _between_bars(name)
        else:
            text = ""
        if len(_quoted) < 100_000:
            _quoted[name, base, case] = text
    if text:
        return text
    shown = in_print_case(name, reads_as)
    if not name.isascii() and CASES[case](shown) != name:  # a letter whose other case is not one letter, as in STRASSE
        return _between_bars(name)
    return shown


def _between_bars(name):
    return "|" + name.replace("\\", "\\\\").replace("|", "\\|") + "|"


def in_print_case(name, reads_as=None):
    """``name`` in the case that ``*print-case*`` asks for; the readtable decides where its case is not :upcase (ANSI 22.1.3.3.2).

    reads_as: the readtable case for which it is written; that of ``*readtable*`` by default.
    """
    case, reads_as = PRINT_CASE.value, reads_as or READTABLE.value.case
    if reads_as is not UPCASE:
        if reads_as.name == "INVERT":
            return invert(name)
        if reads_as.name == "PRESERVE" or case is DOWNCASE:
            return name
        if case is UPCASE:
            return upcase(name)
        return "".join(
            upcase(character) if not index or not name[index - 1].isalnum() else character for index, character in enumerate(name)
        )
    if case is UPCASE:
        return name
    if case is DOWNCASE:
        return downcase(name)
    if case is CAPITALIZE:
        return "".join(
            character if not index or not name[index - 1].isalnum() or character.islower() else character.lower()
            for index, character in enumerate(name)
        )
    return name


def symbol_text(symbol, escape=True):
    """The printed form of a symbol, NIL and T included, as seen from ``*package*``."""
    if symbol is None or symbol is False:
        name, package = "NIL", COMMON_LISP
    elif symbol is True:
        name, package = "T", COMMON_LISP
    else:
        name, package = symbol.name, symbol.package
    if not escape:
        return in_print_case(name)
    text = token(name)
    if package is KEYWORD:
        return ":" + text
    current = PACKAGE.value
    if package is current:
        return text
    if package is None:
        return "#:" + text if PRINT_GENSYM.value is not None or PRINT_READABLY.value is not None else text
    found, status = current.lookup(name)
    if status and found is (None if symbol is False else symbol):
        return text
    return qualified(text, name, package)


def qualified(text, name, package):
    return f"{token(package.name)}{':' if name in package.external else '::'}{text}"


def symbol_with_prefix(symbol):
    """``symbol`` with its package in front, always: how SBCL names classes and generic functions."""
    if isinstance(symbol, Symbol) and symbol.package is None:
        return symbol_text(symbol)
    package = symbol.package if isinstance(symbol, Symbol) else COMMON_LISP
    name = symbol.name if isinstance(symbol, Symbol) else "NIL" if symbol is None else "T"
    return ":" + token(name) if package is KEYWORD else qualified(token(name), name, package)


# ----------------------------------------------------------------------------------------------- strings and characters


def string_text(text):
    """``text`` between double quotes."""
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"'


def character_text(char):
    """``#\\a``, ``#\\Newline``: graphic ASCII as itself (the space too, as in SBCL), others by name."""
    return "#\\" + (char if " " <= char <= "~" else character_name(char))
