"""``coerce``: an object as one of another type.

Sequences become other sequences (``collections/sequence_types.py``), reals become floats or complex numbers, strings and symbols of one
character become characters, symbols and lambda expressions become functions. Source: ANSI COERCE; texts are SBCL's.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.conditions import SimpleTypeError, error
from cramhy_runtime.lisp_core.data import Cons, LispString, Symbol
from cramhy_runtime.lisp_core.functions import fdefinition, function_named, functionp
from ..numbers.arithmetic import is_real, single_of
from ..numbers.complex_numbers import parts
from ..numbers.irrational import complex_, to_double
from cramhy_runtime.lisp_core.packages import is_symbol, sym
from cramhy_runtime.lisp_core.ports import PORTS
from .types import expand_type, type_predicate

LISP_NAMES = "coerce"

_SEQUENCES = frozenset(
    """LIST VECTOR SIMPLE-VECTOR STRING SIMPLE-STRING BASE-STRING SIMPLE-BASE-STRING BIT-VECTOR
SIMPLE-BIT-VECTOR ARRAY SIMPLE-ARRAY CONS NULL SEQUENCE""".split()
)
_SINGLES = ("FLOAT", "SINGLE-FLOAT", "SHORT-FLOAT")
_DOUBLES = ("DOUBLE-FLOAT", "LONG-FLOAT")


def coerce(object, output_type_spec):
    """``cl:coerce``"""
    specifier = expand_type(output_type_spec)
    head = specifier.car if isinstance(specifier, Cons) else specifier
    name = head.name if isinstance(head, Symbol) else ""
    if name in _DOUBLES and is_real(object):
        return _checked(to_double(object), object, specifier)
    if name in _SINGLES and is_real(object):
        result = object if name == "FLOAT" and isinstance(object, float) else single_of(object)
        return _checked(result, object, specifier)
    if name == "COMPLEX":
        return _to_complex(object, specifier)
    if type_predicate(specifier)(object):
        return object
    if name == "CHARACTER":
        from ..collections.characters import character

        return character(object)
    if name in ("FUNCTION", "COMPILED-FUNCTION", "GENERIC-FUNCTION"):
        return object if functionp(object) else _to_function(object)
    if name in _SEQUENCES and _is_sequence(object) and (isinstance(specifier, Cons) or name not in ("ARRAY", "SIMPLE-ARRAY", "SEQUENCE")):
        from ..collections.sequence_types import to_sequence_type

        return to_sequence_type(object, specifier)
    if name == "AND":
        for part in specifier.cdr:
            object = coerce(object, part)
        return object
    return _cannot(object, output_type_spec)


def _checked(result, obj, specifier):
    return result if type_predicate(specifier)(result) else _cannot(obj, specifier)


def _is_sequence(obj):
    return type_predicate(sym("SEQUENCE"))(obj)


def _to_complex(obj, specifier):
    part = specifier.cdr.car if isinstance(specifier, Cons) and specifier.cdr else sym("*")
    if type_predicate(specifier)(obj):
        return obj
    if not isinstance(obj, complex) and not is_real(obj):
        return _cannot(obj, specifier)
    if part is not sym("*") and part not in (sym("REAL"), sym("RATIONAL"), sym("INTEGER")):
        return complex_(*(coerce(each, part) for each in (parts(obj) if isinstance(obj, complex) else (obj, 0))))
    return complex_(obj, obj.__class__(0.0)) if isinstance(obj, float) else obj


def _to_function(obj):
    if is_symbol(obj):
        return fdefinition(obj)
    if isinstance(obj, Cons) and obj.car is sym("LAMBDA"):
        return PORTS.user.evaluate(obj)
    if isinstance(obj, Cons) and obj.car is sym("SETF"):
        return function_named(obj)
    return _cannot(obj, sym("FUNCTION"))


def _cannot(obj, specifier):
    shown = str(obj) if isinstance(obj, LispString) else obj
    return error(SimpleTypeError("~S can't be converted to type ~S.", shown, specifier, datum=obj, expected_type=specifier))
