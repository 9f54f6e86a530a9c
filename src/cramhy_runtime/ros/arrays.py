"""Floats and arrays of numbers in messages, in the form in which the graph carries them (``wire.py``).

A float is a double-float, or roslisp's keyword if it is not finite. An array is a list, and that of a ``uint8[]`` is `Octets`.
``received.py`` makes of it what Python and Lisp get.

A scan has a thousand elements and an image millions. So the usual ones cost no loop of Python: `map`, `array` and `bytearray` go through
the elements. Elements of other classes, and integers that have to be cut, are left to the converters of one element in ``wire.py``.
"""

from __future__ import annotations

import math
from array import array

from cramhy_runtime.lisp_core.data import FLOATS, Symbol
from cramhy_runtime.lisp_core.packages import keyword
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any, overload

from .definition_text import INTEGERS

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from typing import SupportsIndex

OCTETS = ("uint8", "char")
"""The base types whose arrays are `Octets`."""
_REALS = FLOATS | {int}
_INTS, _BOOLS = frozenset({int}), frozenset({bool})


POSITIVE_INFINITY, NEGATIVE_INFINITY, NOT_A_NUMBER = NONFINITE = [
    keyword(name) for name in ("POSITIVE-INFINITY", "NEGATIVE-INFINITY", "NOT-A-NUMBER")
]
_FLOATS: dict[Symbol, float] = {POSITIVE_INFINITY: math.inf, NEGATIVE_INFINITY: -math.inf, NOT_A_NUMBER: math.nan}


def as_float(value: float | Symbol) -> float:
    """A received real as a Python float. The symbols for infinity and not-a-number become floats too."""
    if isinstance(value, Symbol):
        return _FLOATS.get(value, math.nan)
    return float(value)


def lisp_float(value: float) -> float | Symbol:
    """A float in the form that the graph carries: a double-float, or a symbol if it is not finite."""
    if math.isfinite(value):
        return float(value)
    if value != value:
        return NOT_A_NUMBER
    return POSITIVE_INFINITY if value > 0 else NEGATIVE_INFINITY


class Octets(bytearray):
    """The numbers of a ``uint8[]``, from 0 to 255. ``numpy.asarray(octets)`` and ``numpy.frombuffer(octets)`` see them without a copy.

    They are equal to other octets, and to lists and tuples of the same numbers. Lisp gets a vector of integers instead.
    """

    __slots__ = ()

    def __eq__(self, other: object) -> bool:
        if isinstance(other, (list, tuple)):
            return len(other) == len(self) and list(self) == list(other)
        return bytearray.__eq__(self, other)

    __hash__ = None

    @overload
    def __getitem__(self, index: SupportsIndex, /) -> int: ...
    @overload
    def __getitem__(self, index: slice[SupportsIndex | None], /) -> Octets: ...
    def __getitem__(self, index: Any, /) -> Any:
        found = bytearray.__getitem__(self, index)
        return Octets(found) if index.__class__ is slice else found

    def tolist(self) -> list[int]:
        """The numbers as a list."""
        return list(self)


def octets(values: object) -> Octets | None:
    """``values`` as `Octets` if they are bytes, or an array or buffer of one dimension whose elements are; ``None`` for other values."""
    given: Any = values
    if isinstance(given, (bytes, bytearray)):
        return Octets(given)
    shape = getattr(given, "shape", None)
    dtype = getattr(given, "dtype", None)
    if shape is not None and len(shape) == 1 and (getattr(dtype, "char", None) or getattr(given, "format", None)) == "B":
        return Octets(given)
    return Octets(given) if getattr(given, "typecode", None) == "B" else None


def float64s(values: Sequence[object]) -> list[float | Symbol] | None:
    """The numbers in the form that receivers get (`lisp_float`); ``None`` if there are others than integers and floats."""
    if not _REALS.issuperset(map(type, values)):
        return None
    numbers: Sequence[Any] = values
    return list(map(float, numbers)) if all(map(math.isfinite, numbers)) else [lisp_float(float(number)) for number in numbers]


def float32s(values: Sequence[object]) -> list[float | Symbol] | None:
    """As `float64s`, each number rounded to 24 bits."""
    numbers: Sequence[Any] = values
    return float64s(array("f", numbers).tolist()) if _REALS.issuperset(map(type, numbers)) else None


def _integers(bits: int, signed: bool) -> Callable[[Sequence[Any]], list[int] | None]:
    least, most = (-(1 << (bits - 1)), (1 << (bits - 1)) - 1) if signed else (0, (1 << bits) - 1)

    def integers(values: Sequence[Any]) -> list[int] | None:
        """The integers, if they are in the range of the field; ``None`` for others."""
        if not values:
            return []
        return list(values) if _INTS.issuperset(map(type, values)) and least <= min(values) and max(values) <= most else None

    return integers


def _bools(values: Sequence[Any]) -> list[bool] | None:
    """The truth values, if all are Python's; ``None`` for others."""
    return list(values) if _BOOLS.issuperset(map(type, values)) else None


QUICK: dict[str, Callable[[Sequence[object]], Sequence[object] | None]] = {
    "float64": float64s,
    "float32": float32s,
    "bool": _bools,
    **{name: _integers(*size) for name, size in INTEGERS.items()},
}
"""Base type → the function of a list or tuple that gives what receivers get, or ``None`` if it has to be made element by element."""
