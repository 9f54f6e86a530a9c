"""The three kinds of complex numbers: of doubles (Python's ``complex``), of singles, and of rationals.

Python knows the first only. `SingleComplex` has single-floats as parts, `ExactComplex` has integers and ratios, so ``(* #c(0 1) #c(0 1))``
is -1. Both are classes of ``complex``, and what knows only Python's numbers sees the nearest one of those. A rational result without an
imaginary part is a rational. They are added and multiplied in ``arithmetic.py``, part by part. Source: ANSI 12.1.5.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.floats import SingleFloat


class SingleComplex(complex):
    """A complex number of single-floats, as plain ``complex`` is one of double-floats. ``SingleComplex(x, y)`` rounds the parts."""

    __slots__ = ()

    def __new__(cls, real, imag=0.0):
        if isinstance(real, complex):
            real, imag = real.real, real.imag
        return complex.__new__(cls, SingleFloat(real), SingleFloat(imag))

    def __reduce__(self):
        return SingleComplex, (self.real, self.imag)

    def __neg__(self):
        return complex.__new__(SingleComplex, -self.real, -self.imag)

    def conjugate(self):
        return complex.__new__(SingleComplex, self.real, -self.imag)


class ExactComplex(complex):
    """A complex number of integers and ratios; the imaginary part is not 0 (see `exact`)."""

    __slots__ = ("real", "imag")

    def __new__(cls, real, imag):
        self = complex.__new__(cls, _nearest(real), _nearest(imag))
        self.real, self.imag = real, imag
        return self

    def __repr__(self):
        return f"ExactComplex({self.real!r}, {self.imag!r})"

    def __reduce__(self):
        return ExactComplex, (self.real, self.imag)

    def __eq__(self, other):
        if isinstance(other, ExactComplex):
            return self.real == other.real and self.imag == other.imag
        return complex.__eq__(self, other)

    __hash__ = complex.__hash__

    def __bool__(self):
        return True

    def __neg__(self):
        return ExactComplex(-self.real, -self.imag)

    def conjugate(self):
        return ExactComplex(self.real, -self.imag)


def _nearest(rational):
    try:
        return float(rational)
    except OverflowError:
        return float("inf") if rational > 0 else float("-inf")


def _whole(rational):
    return rational.numerator if rational.denominator == 1 else rational


def exact(real, imag):
    """The complex number of two rationals; a rational when ``imag`` is 0."""
    real, imag = _whole(real), _whole(imag)
    return ExactComplex(real, imag) if imag else real


def of_parts(real, imag):
    """The complex number of these parts, as ``cl:complex`` makes it: the floats among them decide of which kind it is."""
    kinds = real.__class__, imag.__class__
    if float in kinds:
        return complex(real, imag)
    return SingleComplex(real, imag) if SingleFloat in kinds else exact(real, imag)


def parts(number):
    """(real, imaginary) part of the ``number``, as Lisp sees them; the imaginary part of a real is 0."""
    if number.__class__ is SingleComplex:
        return SingleFloat(number.real), SingleFloat(number.imag)
    return (number.real, number.imag) if isinstance(number, complex) else (number, 0)
