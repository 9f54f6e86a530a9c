"""Which Python objects are numbers for a plan.

``bool`` is no number, though Python says so: ``t`` and ``nil`` are symbols.
"""

from __future__ import annotations

from fractions import Fraction

from .conditions import FloatingPointOverflow, error, type_error
from .data import FLOATS, lisp_list, one
from .packages import sym

FIXNUM_LIMIT = 2**62
"""The first integer that is too large for a fixnum; the smallest fixnum is its negative."""
_REALS = FLOATS | {int, Fraction}


def is_real(obj):
    """Whether ``obj`` is a real number. Subclasses of Python's numbers count, ``bool`` does not."""
    return obj.__class__ in _REALS or (isinstance(obj, (int, float, Fraction)) and obj.__class__ is not bool)


def need_real(obj):
    """``obj``, or the first of several values, if it is a real number; anything else is a ``type-error``."""
    if is_real(obj):
        return obj
    first = one(obj)
    return first if is_real(first) else type_error(first, sym("REAL"))


def too_large_for(number, kind):
    """Signal that ``number`` does not fit into the kind of float that ``kind`` names."""
    return error(FloatingPointOverflow(sym("FLOAT"), lisp_list(number, sym(kind))))
