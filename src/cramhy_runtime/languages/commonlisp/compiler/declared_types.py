"""Declared types: what ``(declare (type integer x))`` and ``the`` promise, and the check of it.

As in SBCL at its usual safety a declaration is an assertion: a value of another type is a type-error where it is bound or assigned,
not somewhere later. A function that says ``(optimize (safety 0))`` is not checked. What cannot be known is let pass: types that
are not defined, and types of several values.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.classes import when_classes_change
from cramhy_runtime.lisp_core.numbers import FIXNUM_LIMIT
from cramhy_runtime.lisp_core.ports import PORTS
from cramhy_runtime.lisp_core.conditions import type_error
from cramhy_runtime.lisp_core.printing import prin1_to_string
from cramhy_runtime.lisp_core.data import Cons, MultipleValues, Symbol, one
from cramhy_runtime.lisp_core.conses import list_parts
from cramhy_runtime.lisp_core.packages import COMMON_LISP, is_symbol, sym

TYPE, OPTIMIZE, SAFETY = sym("TYPE"), sym("OPTIMIZE"), sym("SAFETY")
OTHERS = {
    sym(name)
    for name in """SPECIAL IGNORE IGNORABLE OPTIMIZE INLINE NOTINLINE FTYPE DYNAMIC-EXTENT DECLARATION VALUES
MUFFLE-CONDITIONS""".split()
}
"""Declarations whose name is no type."""

UNCHECKED = {sym("T"), sym("*"), True}
FIXNUM, INTEGER, MOD, SIGNED_BYTE, UNSIGNED_BYTE = map(sym, "FIXNUM INTEGER MOD SIGNED-BYTE UNSIGNED-BYTE".split())
LEAST_FIXNUM, GREATEST_FIXNUM = -FIXNUM_LIMIT, FIXNUM_LIMIT - 1
_LIMITS = {FIXNUM: (LEAST_FIXNUM, GREATEST_FIXNUM), UNSIGNED_BYTE: (0, None), sym("BIT"): (0, 1)}


def declared_types(specifiers):
    """Symbol → the type that ``specifiers`` declare for it; none where safety is 0."""
    found = {}
    for item in specifiers:
        if not isinstance(item, Cons):
            continue
        head, names = item.car, item.cdr
        if head is OPTIMIZE:
            if any(
                isinstance(quality, Cons) and quality.car is SAFETY and quality.cdr is not None and quality.cdr.car == 0
                for quality in names or ()
            ):
                return {}
        elif head is TYPE:
            if isinstance(names, Cons):
                found.update((name, names.car) for name in names.cdr or () if checkable(names.car))
        elif (isinstance(head, Cons) or head not in OTHERS) and checkable(head):
            found.update((name, head) for name in names or ())
    return found


def checkable(specifier):
    """Whether a declaration of the type ``specifier`` can be checked."""
    if specifier in UNCHECKED if not isinstance(specifier, Cons) else not isinstance(specifier.car, Symbol):
        return False
    if isinstance(specifier, Cons):
        return specifier.car.name not in ("VALUES", "FUNCTION")
    return specifier is None or isinstance(specifier, Symbol) and (specifier.compiler_data or {}).get("declaration") is None


def integer_limits(specifier):
    """The least and the greatest integer of a type that has all integers between them; ``None`` for other types, and for wrong specifiers.

    The greatest is ``None`` where there is none. Types that programs define are not looked into: they may be defined again.
    """
    if specifier.__class__ is not Cons:
        return _LIMITS.get(specifier) if specifier.__class__ is Symbol else None
    head, parameters = specifier.car, list_parts(specifier.cdr)[0]
    if head.__class__ is not Symbol or any(parameter.__class__ is not int for parameter in parameters):
        return None
    if head is INTEGER and 1 <= len(parameters) <= 2:
        return parameters[0], parameters[1] if len(parameters) == 2 else None
    if len(parameters) != 1 or parameters[0] < 1:
        return None
    if head is MOD:
        return 0, parameters[0] - 1
    if head is UNSIGNED_BYTE:
        return 0, 2 ** parameters[0] - 1
    return (-(2 ** (parameters[0] - 1)), 2 ** (parameters[0] - 1) - 1) if head is SIGNED_BYTE else None


def is_between(value, limits):
    """Whether ``value`` is an integer within the ``limits`` of `integer_limits`."""
    return value.__class__ is int and limits[0] <= value and (limits[1] is None or value <= limits[1])


_predicates: dict = {}
when_classes_change(_predicates.clear)


def checked(value, specifier, place=None):
    """``value``, whose first value must be of the type ``specifier``; ``place``: the variable that is bound to it, for the error."""
    known = _predicates.get(id(specifier))
    if known is None:
        if not _all_known(specifier):  # it may be defined later
            return value
        # the specifier is kept: its id must not become another object's
        known = _predicates[id(specifier)] = (PORTS.types.declared(specifier), specifier)
    first = one(value) if value.__class__ is MultipleValues else value
    if known[0](first):
        return value
    context = f"\nwhen binding {prin1_to_string(place)}" if place is not None else ""
    return type_error(first, PORTS.types.simplified(specifier), context)


def _all_known(specifier):
    """Whether all names of types in ``specifier`` are defined."""
    if not isinstance(specifier, Cons):
        return not is_symbol(specifier) or PORTS.types.known(specifier)
    head = specifier.car
    if isinstance(head, Symbol) and head.name in ("AND", "OR", "NOT"):
        return all(map(_all_known, specifier.cdr or ()))
    if isinstance(head, Symbol) and head.name == "SATISFIES":
        return isinstance(specifier.cdr, Cons) and is_symbol(specifier.cdr.car) and specifier.cdr.car.package is COMMON_LISP
    return isinstance(head, Symbol) and head.name in ("EQL", "MEMBER", "MOD") or PORTS.types.known(head)
