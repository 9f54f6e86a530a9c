"""Types as SBCL names them in its errors: what ``deftype`` made is expanded, and integers have the shortest name.

``(integer 0 10)`` is ``(MOD 11)``, ``(integer 0 255)`` is ``(UNSIGNED-BYTE 8)``, ``(cons symbol)`` is ``(CONS SYMBOL T)``.
"""

from __future__ import annotations

from fractions import Fraction

from cramhy_runtime.lisp_core.data import Cons, Symbol, lisp_list, list_from, python_list
from cramhy_runtime.lisp_core.floats import SingleFloat
from cramhy_runtime.lisp_core.numbers import FIXNUM_LIMIT
from cramhy_runtime.lisp_core.packages import sym
from .types import expand_type


def simplified_type(specifier):
    """The name of the type ``specifier`` in error texts."""
    specifier = expand_type(specifier)
    if not isinstance(specifier, Cons) or not isinstance(specifier.car, Symbol):
        return specifier
    head, arguments = specifier.car, python_list(specifier.cdr)
    name = head.name
    if name in ("OR", "AND", "NOT"):
        return Cons(head, list_from([simplified_type(argument) for argument in arguments]))
    if name == "CONS":
        return lisp_list(head, *[True if part is STAR else simplified_type(part) for part in (*arguments, True, True)[:2]])
    if name == "INTEGER":
        return _integer(*(*arguments, STAR, STAR)[:2], specifier)
    if name in ("FLOAT", "REAL") and any(bound is not STAR for bound in arguments):
        parts = [_range("SINGLE-FLOAT", SingleFloat, arguments), _range("DOUBLE-FLOAT", float, arguments)]
        if name == "REAL":
            parts.append(_range("RATIONAL", _exact, arguments))
        return Cons(sym("OR"), list_from(parts))
    if name == "MOD":
        return _integer(0, arguments[0] - 1, specifier)
    return head if not arguments else specifier


STAR = sym("*")


def _exact(number):
    value = Fraction(number)
    return value.numerator if value.denominator == 1 else value


def _range(name, convert, bounds):
    def converted(bound):
        if bound is STAR:
            return bound
        return lisp_list(convert(bound.car)) if isinstance(bound, Cons) else convert(bound)

    return Cons(sym(name), list_from([converted(bound) for bound in bounds]))


def _integer(low, high, specifier):
    """The shortest name of the integers from ``low`` to ``high``, each an integer, ``(integer)`` for an open end, or ``*``."""
    if isinstance(low, Cons):
        low = low.car + 1
    if isinstance(high, Cons):
        high = high.car - 1
    if high is STAR:
        return sym("INTEGER") if low is STAR else sym("UNSIGNED-BYTE") if low == 0 else lisp_list(sym("INTEGER"), low)
    if low == 0 and high > 0:
        if high == 1:
            return sym("BIT")
        bits = high.bit_length()
        return lisp_list(sym("UNSIGNED-BYTE"), bits) if high == 2**bits - 1 else lisp_list(sym("MOD"), high + 1)
    if low == -high - 1 and high > 0 and high == 2 ** high.bit_length() - 1:
        return sym("FIXNUM") if high == FIXNUM_LIMIT - 1 else lisp_list(sym("SIGNED-BYTE"), high.bit_length() + 1)
    return lisp_list(sym("INTEGER"), low, high)
