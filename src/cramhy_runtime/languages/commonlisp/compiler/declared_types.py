"""Declared types: what ``(declare (type integer x))`` and ``the`` promise, and the check of it.

As in SBCL at its usual safety a declaration is an assertion: a value of another type is a type-error where it is bound or assigned,
not somewhere later. A function that says ``(optimize (safety 0))`` is not checked. What cannot be known is let pass: types that
are not defined, and types of several values.
"""

from __future__ import annotations

from cramhy_runtime.ground.numbers import FIXNUM_LIMIT
from cramhy_runtime.ground.ports import PORTS
from cramhy_runtime.ground.conditions import type_error
from cramhy_runtime.ground.printing import prin1_to_string
from cramhy_runtime.ground.data import Cons, MultipleValues, Symbol, one
from cramhy_runtime.ground.packages import COMMON_LISP, is_symbol, sym

TYPE, OPTIMIZE, SAFETY = sym("TYPE"), sym("OPTIMIZE"), sym("SAFETY")
OTHERS = {
    sym(name)
    for name in """SPECIAL IGNORE IGNORABLE OPTIMIZE INLINE NOTINLINE FTYPE DYNAMIC-EXTENT DECLARATION VALUES
MUFFLE-CONDITIONS""".split()
}
"""Declarations whose name is no type."""

UNCHECKED = {sym("T"), sym("*"), True}
FIXNUM = sym("FIXNUM")
LEAST_FIXNUM, GREATEST_FIXNUM = -FIXNUM_LIMIT, FIXNUM_LIMIT - 1


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


def is_fixnum(value):
    return value.__class__ is int and LEAST_FIXNUM <= value <= GREATEST_FIXNUM


_predicates: dict = {}


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
