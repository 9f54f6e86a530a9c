"""Floats: a double-float is Python's ``float``, a single-float is a `SingleFloat`.

Who passes floats on need not know that there are two kinds: `FLOATS` are both classes, `float_like` keeps a kind, and arithmetic in Python
does what Common Lisp's does. Numbers of messages, poses and the world are plain floats; a `SingleFloat` is what a literal of Lisp means.
"""

from __future__ import annotations

import math
import struct
import sys

from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable


def is_ratio(thing: object) -> bool:
    """Whether ``thing`` is a ratio, which is a `Fraction` of Python.

    There are ratios only where somebody has imported ``fractions``. The rooms that plans need do not: its import takes a tenth of theirs.
    `isinstance` would ask the abstract class of `Fraction`, which is slow.
    """
    fractions = sys.modules.get("fractions")
    return fractions is not None and fractions.Fraction in thing.__class__.__mro__


SPLITTER = 2.0**29 + 1
"""The factor of Veltkamp's splitting: with ``p = x * SPLITTER``, ``p - (p - x)`` is ``x`` rounded to 24 bits, ties to even."""
LARGEST_SINGLE = (2 - 2.0**-23) * 2.0**127
_BEYOND = 2.0**128
_LARGEST_SQUARE, _LEAST_SQUARE = LARGEST_SINGLE**2, 2.0**-252
_as_single = struct.Struct("<f")


def to_float32(value: float) -> float:
    """The plain float nearest to ``value`` among those that a single-float can hold (IEEE: ties to even, denormals, infinities)."""
    if _LEAST_SQUARE <= value * value <= _LARGEST_SQUARE:
        product = value * SPLITTER
        return product - (product - value)
    try:
        found: float = _as_single.unpack(_as_single.pack(value))[0]
        return found
    except OverflowError:
        return math.copysign(math.inf, value)


def rational_to_float32(number: Any) -> float:
    """The same for an integer or a ratio, which is rounded once. Raises OverflowError beyond the doubles."""
    near = float(number)
    found = to_float32(near)
    if near == number or found - found != 0.0 and not -_BEYOND < number < _BEYOND:
        return found
    if found - found != 0.0:
        found = math.copysign(_BEYOND, found)
    # rounded twice: `near` may have come to lie in the middle between two singles, where the number itself is beside it
    half, exponent = math.frexp(found)
    outwards = (number > found) == (found > 0)
    step = math.ldexp(1.0, max(exponent - 24 - (abs(half) == 0.5 and not outwards), -149))
    other = found + (step if number > found else -step)
    middle = (found + other) / 2
    if number > middle if number > found else number < middle:
        found = other
    return found if -_BEYOND < found < _BEYOND else math.copysign(math.inf, found)


class _Singles(type):
    """The class of `SingleFloat`, so that its instances are made without a function of Python where 24 bits are sure (`new_single`)."""

    def __call__(cls, value: Any = 0.0) -> Any:
        if isinstance(value, float):
            return value if value.__class__ is cls else new_single(to_float32(float(value)))
        if value.__class__ is int or is_ratio(value):
            return new_single(rational_to_float32(value))
        return new_single(to_float32(float(value)))


class SingleFloat(float, metaclass=_Singles):
    """A single-float, as ``2.4`` is one in Lisp: a float of 24 bits. ``SingleFloat(x)`` rounds ``x``.

    Arithmetic with singles, integers and ratios rounds once and gives a single; with a plain float, which is a double-float, it gives
    a plain float (ANSI 12.1.4.4, float contagion).
    """

    __slots__ = ()

    def __repr__(self) -> str:
        """The shortest text that reads back as the same single-float, written as Python writes floats."""
        for digits in (6, 7, 8, 9):
            text = float(f"{float(self):.{digits}g}")
            if to_float32(text) == self:
                break
        else:
            return float.__repr__(self)
        return float.__repr__(text)

    def __reduce__(self) -> tuple[Any, ...]:
        return SingleFloat, (float(self),)

    def __neg__(self) -> SingleFloat:
        return new_single(float.__neg__(self))

    def __pos__(self) -> SingleFloat:
        return self

    def __abs__(self) -> SingleFloat:
        return new_single(float.__abs__(self))


new_single: Callable[[float], SingleFloat] = type.__call__.__get__(SingleFloat)
"""The `SingleFloat` of a float that has 24 bits already."""


def _in_singles(name: str) -> Any:
    operation = getattr(float, name)

    def method(self: SingleFloat, other: Any) -> Any:
        if other.__class__ is not SingleFloat:
            if other.__class__ is not int and not is_ratio(other):
                return operation(self, other)
            other = rational_to_float32(other)
        result = operation(self, other)
        return new_single(to_float32(result)) if result.__class__ is float else result

    method.__name__ = name
    return method


for _name in ("add", "sub", "mul", "truediv", "floordiv", "mod", "pow"):
    for _side in ("", "r"):
        setattr(SingleFloat, f"__{_side}{_name}__", _in_singles(f"__{_side}{_name}__"))


FLOATS: frozenset[type] = frozenset({float, SingleFloat})
"""The classes of all floats."""


def result_class(*numbers: object) -> type[float]:
    """The class of a float that is computed of ``numbers``: ``float`` if one of them is a double-float, else that of single-floats."""
    return float if any(number.__class__ is float for number in numbers) else SingleFloat


def float_like(prototype: object, value: float) -> float:
    """``value`` as a float of the kind of ``prototype``; what is no single-float asks for a plain float."""
    return SingleFloat(value) if prototype.__class__ is SingleFloat else float(value)


def literal_float(value: float) -> float:
    """``value`` as the float that Lisp reads when its text does not say of which kind: the original gives such floats in a few places."""
    return SingleFloat(value)


ZERO = literal_float(0.0)
"""``0.0`` in a text of Lisp."""
