"""The element types of arrays: what a declared type is upgraded to, what an element is before it is set, what fits.

An implementation keeps only some specialised arrays and upgrades other types to these; programs see the result in
``array-element-type``. Ours are SBCL's. Source: ANSI 15.1.2.1; the table was read off SBCL 2.2.9.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.ports import PORTS
from cramhy_runtime.lisp_core.conditions import error, type_error
from cramhy_runtime.lisp_core.data import Character, Cons, Symbol, lisp_list
from cramhy_runtime.lisp_core.floats import SingleFloat
from cramhy_runtime.lisp_core.packages import sym
from cramhy_runtime.lisp_core.arrays import BASE_CHAR, BIT, CHARACTER, STRING_KINDS

_SINGLE, _DOUBLE, _FIXNUM = sym("SINGLE-FLOAT"), sym("DOUBLE-FLOAT"), sym("FIXNUM")
FLOAT_CLASSES = {_SINGLE: SingleFloat, _DOUBLE: float}
"""Upgraded element type → the class of its elements, for the kinds of floats."""
_NAMES = {
    "CHARACTER": CHARACTER,
    "BASE-CHAR": BASE_CHAR,
    "STANDARD-CHAR": BASE_CHAR,
    "EXTENDED-CHAR": CHARACTER,
    "BIT": BIT,
    "FIXNUM": _FIXNUM,
    "SINGLE-FLOAT": _SINGLE,
    "SHORT-FLOAT": _SINGLE,
    "DOUBLE-FLOAT": _DOUBLE,
    "LONG-FLOAT": _DOUBLE,
}
_UNSIGNED_BITS = (1, 2, 4, 7, 8, 15, 16, 31, 32, 62, 63, 64)
_SIGNED_BITS = (8, 16, 32, 63, 64)
_of_bits: dict = {}
"""(UNSIGNED-BYTE or SIGNED-BYTE, number of bits) → the element type for such a list as ``(unsigned-byte 8)``, once it was asked for."""
_UNSIGNED = {bits: lisp_list(sym("UNSIGNED-BYTE"), bits) for bits in _UNSIGNED_BITS}
_SIGNED = {bits: lisp_list(sym("SIGNED-BYTE"), bits) for bits in _SIGNED_BITS}
LIMITS = {
    **{id(kind): (0, 2**bits - 1) for bits, kind in _UNSIGNED.items()},
    **{id(kind): (-(2 ** (bits - 1)), 2 ** (bits - 1) - 1) for bits, kind in _SIGNED.items()},
}
"""The least and the greatest integer in arrays of each element type, by the id of the list that is the type."""


def upgraded_element_type(specifier):
    """``upgraded-array-element-type``: the element type that an array for ``specifier`` really has; ``True`` for T."""
    if isinstance(specifier, Symbol) and specifier.package is BIT.package:
        return _NAMES.get(specifier.name, True) if specifier.name != "UNSIGNED-BYTE" else True
    if specifier.__class__ is Cons and specifier.cdr.__class__ is Cons and specifier.cdr.cdr is None and specifier.cdr.car.__class__ is int:
        found = _of_bits.get((specifier.car, specifier.cdr.car)) if specifier.car.__class__ is Symbol else None
        if found is not None:
            return found
    if isinstance(specifier, Cons) and isinstance(specifier.car, Symbol):
        if specifier.car.package is not BIT.package and (expansion := PORTS.types.expand(specifier)) is not specifier:
            return upgraded_element_type(expansion)
        name, parameters = specifier.car.name, list(specifier.cdr or ())
        if name in ("SINGLE-FLOAT", "DOUBLE-FLOAT", "SHORT-FLOAT", "LONG-FLOAT"):
            return _NAMES[name]
        if name in ("MEMBER", "EQL") and parameters and all(parameter.__class__ is Character for parameter in parameters):
            return _for_characters(parameters)
        if parameters and parameters[0].__class__ is int or name in ("INTEGER", "MEMBER", "EQL"):
            limits = _integer_limits(name, parameters)
            found = _for_integers(*limits) if limits else True
            if name in ("UNSIGNED-BYTE", "SIGNED-BYTE") and len(parameters) == 1:
                _of_bits[specifier.car, parameters[0]] = found
            return found
        return True
    if isinstance(specifier, (Symbol, type)):
        expansion = PORTS.types.expand(specifier)
        if expansion is not specifier:
            return upgraded_element_type(expansion)
        if not PORTS.types.known(specifier):
            error("Undefined type: ~S", specifier)
    elif specifier is not None and specifier is not True:
        error("bad thing to be a type specifier: ~S", specifier)
    return specifier is not None or None


def _for_characters(characters):
    """The element type for strings that have only ``characters``."""
    return BASE_CHAR if all(character.char < "\x80" for character in characters) else CHARACTER


def _integer_limits(name, parameters):
    if name == "UNSIGNED-BYTE":
        return 0, 2 ** parameters[0] - 1
    if name == "SIGNED-BYTE":
        return -(2 ** (parameters[0] - 1)), 2 ** (parameters[0] - 1) - 1
    if name == "MOD":
        return 0, parameters[0] - 1
    if name in ("MEMBER", "EQL") and parameters and all(parameter.__class__ is int for parameter in parameters):
        return min(parameters), max(parameters)
    if name == "INTEGER" and len(parameters) == 2:
        low, high = (_limit(parameter, step) for parameter, step in zip(parameters, (1, -1), strict=True))
        if low is not None and high is not None:
            return low, high
    return None


def _limit(parameter, step):
    if isinstance(parameter, Cons):
        return parameter.car + step
    return parameter if parameter.__class__ is int else None


def _for_integers(low, high):
    if low >= 0:
        for bits in _UNSIGNED_BITS:
            if high < 2**bits:
                return BIT if bits == 1 else _UNSIGNED[bits]
        return True
    for bits in _SIGNED_BITS:
        if -(2 ** (bits - 1)) <= low and high < 2 ** (bits - 1):
            return _FIXNUM if bits == 63 else _SIGNED[bits]
    return True


def initial_element(element_type):
    """What the elements of a new array are when the program does not say: SBCL's zero of the type."""
    if element_type in STRING_KINDS:
        return Character("\0")
    if element_type is _SINGLE:
        return SingleFloat(0.0)
    if element_type is _DOUBLE:
        return 0.0
    return 0


def check_element(element, element_type, context=None):
    """``element`` if it may stand in an array of the upgraded type, else a type-error."""
    if element_type is True:
        return element
    if element_type is CHARACTER:
        fits = element.__class__ is Character
    elif element_type is BASE_CHAR:
        fits = element.__class__ is Character and element.char < "\x80"
    elif element_type is None:
        fits = False
    elif element_type is BIT:
        fits = element.__class__ is int and 0 <= element <= 1
    elif element_type is _SINGLE:
        fits = element.__class__ is SingleFloat
    elif element_type is _DOUBLE:
        fits = isinstance(element, float) and element.__class__ is not SingleFloat
    else:
        fits = element.__class__ is int and _in_range(element, element_type)
    if not fits:
        type_error(
            element, element_type, f"\nwhen setting an element of (ARRAY {printed_type(element_type)})" if context is None else context
        )
    return element


def _in_range(integer, element_type):
    if element_type is _FIXNUM:
        return -(2**62) <= integer < 2**62
    bits = element_type.cdr.car
    if element_type.car.name == "UNSIGNED-BYTE":
        return 0 <= integer < 1 << bits
    return -(1 << bits - 1) <= integer < 1 << bits - 1


def printed_type(element_type):
    """``element_type`` as it is printed."""
    if element_type is True or element_type is None:
        return "T" if element_type else "NIL"
    return f"({element_type.car.name} {element_type.cdr.car})" if isinstance(element_type, Cons) else element_type.name
