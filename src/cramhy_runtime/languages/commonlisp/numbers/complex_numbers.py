"""The three kinds of complex numbers: of singles (Python's ``complex``), of doubles, and of rationals.

Python knows the first only. `DoubleComplex` keeps contagion of double-floats; `ExactComplex` has integers and ratios as parts,
so ``(* #c(0 1) #c(0 1))`` is -1. Both are classes of ``complex``, and what knows only Python's numbers sees the nearest one of
those. A rational result without an imaginary part is a rational. Source: ANSI 12.1.5.
"""

from __future__ import annotations

from fractions import Fraction

from cramhy_runtime.ground.data import DoubleFloat


class DoubleComplex(complex):
    """A complex number of double-floats, as plain ``complex`` is one of single-floats."""

    __slots__ = ()
    double = True  # asked by the printer


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


def parts(number):
    """(real, imaginary) part of a complex ``number``, as Lisp sees them."""
    kind = DoubleFloat if isinstance(number, DoubleComplex) else _same
    return kind(number.real), kind(number.imag)


def _same(part):
    return part


def exact_power(base, power):
    """``base``, an `ExactComplex`, to the power of an integer, exactly."""
    result, factor = 1, base if power >= 0 else 1 / base
    power = abs(power)
    while power:
        if power & 1:
            result = factor * result
        factor, power = factor * factor, power >> 1
    return result


def _quotient(a, b, c, d):
    size = Fraction(c * c + d * d)
    return exact((a * c + b * d) / size, (b * c - a * d) / size)


_EXACT = {
    "add": lambda a, b, c, d: exact(a + c, b + d),
    "sub": lambda a, b, c, d: exact(a - c, b - d),
    "mul": lambda a, b, c, d: exact(a * c - b * d, a * d + b * c),
    "truediv": _quotient,
}
_RATIONALS, _DOUBLES = (int, Fraction), (DoubleFloat, DoubleComplex)


def _define(name):
    exactly = _EXACT[name]
    for reflected in (False, True):
        inexactly = getattr(complex, f"__{'r' * reflected}{name}__")

        def of_doubles(self, other, inexactly=inexactly):
            result = inexactly(self, complex(other))
            return result if result is NotImplemented else DoubleComplex(result)

        def of_rationals(self, other, inexactly=inexactly, reflected=reflected):
            if isinstance(other, (ExactComplex, *_RATIONALS)):
                mine, its = (self.real, self.imag), (other.real, other.imag)
                return exactly(*its, *mine) if reflected else exactly(*mine, *its)
            kind = DoubleComplex if isinstance(other, _DOUBLES) else complex
            return kind(inexactly(self, complex(other)))

        setattr(DoubleComplex, f"__{'r' * reflected}{name}__", of_doubles)
        setattr(ExactComplex, f"__{'r' * reflected}{name}__", of_rationals)


for _name in _EXACT:
    _define(_name)
DoubleComplex.__neg__ = lambda self: DoubleComplex(complex.__neg__(self))
DoubleComplex.conjugate = lambda self: DoubleComplex(complex.conjugate(self))
