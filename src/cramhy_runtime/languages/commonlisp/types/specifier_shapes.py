"""Whether a compound type specifier is well formed: how many arguments its head takes, and what they may be.

``(integer 0 1 2)``, ``(unsigned-byte -1)`` and ``(cons 1 2 3)`` are errors wherever a type is read, with SBCL's texts. Source: ANSI 4.2.3
and the pages of the type specifiers.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.conditions import SimpleError, SimpleTypeError, error
from cramhy_runtime.lisp_core.data import Cons, Symbol, lisp_list, list_from
from cramhy_runtime.lisp_core.floats import SingleFloat
from cramhy_runtime.lisp_core.functions import check_shape
from cramhy_runtime.lisp_core.packages import is_symbol, sym
from ..numbers.arithmetic import is_integer, is_rational, is_real

_REALS = {
    "INTEGER": ("an integer", "integer", is_integer),
    "RATIONAL": ("a rational", "rational", is_rational),
    "REAL": ("a real", "real", is_real),
    "FLOAT": ("a real", "real", is_real),
    "SINGLE-FLOAT": ("a single-float", "single-float", lambda limit: limit.__class__ is SingleFloat),
    "DOUBLE-FLOAT": ("a double-float", "double-float", lambda limit: isinstance(limit, float) and limit.__class__ is not SingleFloat),
}
_REALS |= {"SHORT-FLOAT": _REALS["SINGLE-FLOAT"], "LONG-FLOAT": _REALS["DOUBLE-FLOAT"]}
_SHAPES = {
    "NOT": (1, 1, "TYPE"),
    "EQL": (1, 1, "N"),
    "SATISFIES": (1, 1, "PREDICATE-NAME"),
    "MOD": (1, 1, "N"),
    "SIGNED-BYTE": (0, 1, "&OPTIONAL SIZE"),
    "UNSIGNED-BYTE": (0, 1, "&OPTIONAL SIZE"),
    "COMPLEX": (0, 1, "&OPTIONAL TYPESPEC"),
    "CONS": (0, 2, "&OPTIONAL CAR-TYPE-SPEC CDR-TYPE-SPEC"),
    "VECTOR": (0, 2, "&OPTIONAL ELEMENT-TYPE SIZE"),
    "ARRAY": (0, 2, "&OPTIONAL ELEMENT-TYPE DIMENSIONS"),
    "SIMPLE-ARRAY": (0, 2, "&OPTIONAL ELEMENT-TYPE DIMENSIONS"),
    **{name: (0, 2, "&OPTIONAL LOW HIGH") for name in _REALS},
}
_SIZED = """STRING SIMPLE-STRING BASE-STRING SIMPLE-BASE-STRING SIMPLE-VECTOR BIT-VECTOR SIMPLE-BIT-VECTOR""".split()
_SHAPES |= {name: (0, 1, "&OPTIONAL SIZE") for name in _SIZED}
"""How many arguments a head takes, at least and at most, and its lambda list."""
_ARRAY_RANK_LIMIT = 129


def check_specifier(specifier):
    """Check a list that is headed by a name of Common Lisp; returns its arguments as a Python list.

    Errors: a program-error for too few or too many arguments, a simple-error for an argument that the type cannot have.
    """
    name, rest = specifier.car.name, specifier.cdr
    shape = _SHAPES.get(name)
    if shape is not None:
        least, most, lambda_list = shape
        check_shape(rest, least, most, f"DEFTYPE {name}", list_from([sym(word) for word in lambda_list.split()]))
    elif rest is not None and not isinstance(rest, Cons):
        return bad_specifier(specifier)
    arguments = list(rest or ())
    if name in _REALS:
        _check_limits(arguments, *_REALS[name])
    elif name in _CHECKS:
        _CHECKS[name](arguments)
    return arguments


def bad_specifier(specifier):
    return error(SimpleError("bad thing to be a type specifier: ~S", specifier))


def _check_limits(limits, article, kind, fits):
    for limit, which in zip(limits, ("Low", "High")):
        if isinstance(limit, Cons):
            good = limit.cdr is None and fits(limit.car)
        else:
            good = limit is sym("*") or limit is None or fits(limit)
        if not good:
            error(SimpleError(f"{which} bound is not * or {article} or list of one {kind}: ~S", limit))


def _check_size(kind, argument):
    def check(arguments):
        if arguments and arguments[0] is not sym("*") and not (is_integer(arguments[0]) and arguments[0] > 0):
            error(SimpleError(f"bad {argument} specified for {kind} type specifier: ~S", arguments[0]))

    return check


def _check_dimension(size):
    if size is not sym("*") and not (is_integer(size) and size >= 0):
        error(SimpleError("bad dimension in array type: ~S", size))


def _check_length(index):
    return lambda arguments: [_check_dimension(size) for size in arguments[index : index + 1]]


def _check_dimensions(arguments):
    shape = arguments[1] if len(arguments) > 1 else sym("*")
    if is_integer(shape):
        if shape < 0:
            error(SimpleError("Arrays can't have a negative number of dimensions: ~S", shape))
        if shape >= _ARRAY_RANK_LIMIT:
            error(SimpleError("array type with too many dimensions: ~S", shape))
    elif shape is None or isinstance(shape, Cons):
        for size in shape or ():
            _check_dimension(size)
    elif shape is not sym("*"):
        error(SimpleError("array dimensions is not a list, integer or *:~%  ~S", shape))


def _check_predicate(arguments):
    if not is_symbol(arguments[0]):
        name = arguments[0]
        error(SimpleTypeError("The SATISFIES predicate name is not a symbol: ~S", name, datum=name, expected_type=sym("SYMBOL")))


_CHECKS = {
    "MOD": _check_size("MOD", "modulus"),
    "UNSIGNED-BYTE": _check_size("UNSIGNED-BYTE", "size"),
    "SIGNED-BYTE": _check_size("SIGNED-BYTE", "size"),
    "SATISFIES": _check_predicate,
    "VECTOR": _check_length(1),
    "ARRAY": _check_dimensions,
    "SIMPLE-ARRAY": _check_dimensions,
    **{name: _check_length(0) for name in _SIZED},
}
_OPERATORS = frozenset(["AND", "OR", "NOT", "MEMBER", "SATISFIES", "VALUES", "EQL", "MOD"])


def is_operator(symbol):
    """Whether ``symbol`` is a name of Common Lisp that stands for a type only as the head of a list."""
    return isinstance(symbol, Symbol) and symbol.name in _OPERATORS and symbol.package is sym("AND").package


def bad_operator(symbol):
    """Signal that a name for which `is_operator` holds stands alone."""
    if symbol.name in ("EQL", "MOD"):
        check_specifier(lisp_list(symbol))
    return bad_specifier(symbol)
