"""Kinds: what is known about the class of a value before the program runs.

A kind is a set of classes, as bits: ``INT | SINGLE`` is an integer or a single-float. `kind_of` says the kind of a node's first
value; variables get theirs in ``facts.py``. Where all classes of the operands are known, Python's operator stands alone.

A double-float is Python's float. A single-float is a `SingleFloat` wherever a program can see it, and its operators are Python functions.
But where a value is surely no double, a plain Python float of 24 bits can stand for the single: it is *raw*. So variables and
intermediate results of such kinds (`raw`) are computed with Python's own floats and rounded in place, and what leaves them is wrapped
again.
"""

from __future__ import annotations

import math

from cramhy_runtime.lisp_core.data import Cons, Symbol
from cramhy_runtime.lisp_core.floats import SingleFloat
from cramhy_runtime.lisp_core.packages import sym
from . import nodes
from .declared_types import FIXNUM

INT, SINGLE, DOUBLE, OTHER, BOOLEAN, THING = (1 << place for place in range(6))
"""``OTHER`` are ratios, complex numbers, and numbers of other libraries."""
NONE_YET = 0
NUMBER = INT | SINGLE | DOUBLE | OTHER
ANY = NUMBER | BOOLEAN | THING
MACHINE = INT | SINGLE | DOUBLE
"""The classes on which Python's operators do what Lisp's do."""
FLOATS = SINGLE | DOUBLE

PLUS, MINUS, TIMES, DIVIDE, ADD_ONE, SUBTRACT_ONE = map(sym, "+ - * / 1+ 1-".split())
SUMS = {PLUS, MINUS, ADD_ONE, SUBTRACT_ONE}
STEPS = {ADD_ONE: PLUS, SUBTRACT_ONE: MINUS}
OPERATORS = {PLUS, MINUS, TIMES, DIVIDE}
MOD, REM, MAX, MIN, ABS, SQRT, LOG, ASIN, ACOS, FLOAT, COERCE = map(sym, "MOD REM MAX MIN ABS SQRT LOG ASIN ACOS FLOAT COERCE".split())
WHOLE = {sym(name) for name in "FLOOR CEILING TRUNCATE ROUND".split()}
SMOOTH = {sym(name) for name in "SIN COS TAN ATAN EXP SINH COSH TANH ASINH".split()}
"""Functions that give a real float for every real number."""
INTEGERS = {
    sym(name)
    for name in """LENGTH CHAR-CODE COUNT LOGAND LOGIOR LOGXOR HASH-TABLE-COUNT LIST-LENGTH ARRAY-RANK ARRAY-DIMENSION
ARRAY-TOTAL-SIZE ASH GCD LCM INTEGER-LENGTH ISQRT LOGNOT""".split()
}
SIZES = {sym(name) for name in "LENGTH CHAR-CODE COUNT HASH-TABLE-COUNT LIST-LENGTH ARRAY-RANK ARRAY-DIMENSION ARRAY-TOTAL-SIZE".split()}
"""Integers that are at least 0 and never large."""
DOUBLE_TYPES = {sym("DOUBLE-FLOAT"), sym("LONG-FLOAT")}
SINGLE_TYPES = {sym("SINGLE-FLOAT"), sym("SHORT-FLOAT")}
PI = sym("PI")

_CLASSES = {int: INT, SingleFloat: SINGLE, float: DOUBLE}


def raw(kind):
    """Whether values of ``kind`` are held raw: a float among them is a single for sure."""
    return bool(kind & SINGLE) and not kind & (DOUBLE | THING)


def exactly(kind, classes):
    """Whether values of ``kind`` are surely of ``classes``."""
    return kind != NONE_YET and not kind & ~classes


_combined: dict = {}


def combined(one, other):
    """The kind of a sum, difference or product of numbers of two kinds."""
    known = _combined.get((one, other))
    if known is None:
        known = 0
        for first in _bits(one):
            for second in _bits(other):
                known |= _pair(first, second)
        _combined[one, other] = known
    return known


def _bits(kind):
    found = [bit for bit in (INT, SINGLE, DOUBLE, OTHER) if kind & bit]
    return [*found, OTHER] if kind & THING and not kind & OTHER else found  # it may be a number of another library


def _pair(one, other):
    most = max(one, other)
    if most < OTHER:
        return most
    if DOUBLE in (one, other):
        return DOUBLE | OTHER
    return SINGLE | DOUBLE | OTHER if SINGLE in (one, other) else INT | DOUBLE | OTHER


def kind_of(node):
    """The kind of the first value of ``node``."""
    rule = _RULES.get(node.__class__)
    if rule is not None:
        return rule(node)
    return BOOLEAN if node.boolean else ANY


def _constant(node):
    value = node.value
    if value is None or value is True or value is False:
        return BOOLEAN
    return _CLASSES.get(value.__class__, THING | OTHER)


def _local_variable(node):
    variable = node.variable
    return variable.proven or variable.kind


def _global_variable(node):
    return DOUBLE if node.symbol is PI else ANY


def _checked(node):
    kind, wanted = kind_of(node.value), kind_of_type(node.type)
    return kind if wanted is None else kind & wanted if not kind or kind & wanted else wanted


def kind_of_type(specifier):
    """The kind of the values that have passed the check of a declared type, or ``None`` if it says nothing."""
    if specifier.__class__ is Cons:
        specifier = specifier.car
    return _TYPES.get(specifier) if specifier.__class__ is Symbol else None


_INTEGER_TYPES = {sym(name) for name in "INTEGER FIXNUM BIGNUM UNSIGNED-BYTE SIGNED-BYTE MOD BIT".split()}
_TYPES = {
    **dict.fromkeys(_INTEGER_TYPES, INT),
    **dict.fromkeys(SINGLE_TYPES, SINGLE),
    **dict.fromkeys(DOUBLE_TYPES, DOUBLE),
    sym("FLOAT"): FLOATS,
    sym("REAL"): NUMBER,
    sym("NUMBER"): NUMBER,
}


def _if(node):
    return kind_of(node.then) | kind_of(node.otherwise)


def _of_body(node):
    return kind_of(node.body)


def _block(node):
    kind = kind_of(node.body)
    for value in node.block.values:
        kind |= kind_of(value)
    return kind


def _never(node):
    return NONE_YET


def _call(node):
    if node.boolean:
        return BOOLEAN
    rule = CALLS.get(node.symbol)
    return ANY if rule is None else rule(node.symbol, node.arguments)


def _arithmetic(symbol, arguments):
    if len(arguments) < 2:
        if not arguments:
            return INT
        kind = kind_of(arguments[0])
        if symbol is PLUS or symbol is TIMES or symbol is MINUS:
            return combined(kind, INT)
        return quotient(INT, kind)
    combine = quotient if symbol is DIVIDE else combined
    kind = kind_of(arguments[0])
    for argument in arguments[1:]:
        kind = combine(kind, kind_of(argument))
    return kind


def quotient(one, other):
    """The kind of a quotient of numbers of two kinds."""
    kind = combined(one, other)
    return kind | OTHER if one & INT and other & INT else kind


def _step(symbol, arguments):
    return combined(kind_of(arguments[0]), INT) if len(arguments) == 1 else ANY


def _rest(symbol, arguments):
    if len(arguments) != 2:
        return ANY
    return combined(kind_of(arguments[0]), kind_of(arguments[1]))


def _choice(symbol, arguments):
    kind = 0
    for argument in arguments:
        kind |= kind_of(argument)
    return kind if not kind & (BOOLEAN | THING) else kind & ~BOOLEAN


def _smooth(symbol, arguments):
    if not arguments or len(arguments) > 2:
        return ANY
    kind = kind_of(arguments[0])
    for argument in arguments[1:]:
        kind |= kind_of(argument)
    return _floated(kind)


def _floated(kind):
    if not kind:
        return kind
    found = 0
    if kind & (INT | SINGLE | OTHER | THING):
        found |= SINGLE
    if kind & DOUBLE:
        found |= DOUBLE
    if kind & (OTHER | THING):
        found |= OTHER | DOUBLE
    return found


def _root(symbol, arguments):
    if len(arguments) != 1:
        return ANY
    kind = kind_of(arguments[0])
    found = _floated(kind)
    if not kind or symbol is SQRT and never_negative(arguments[0]):
        return found
    return found | OTHER


def _abs(symbol, arguments):
    if len(arguments) != 1:
        return ANY
    kind = kind_of(arguments[0])
    found = kind & MACHINE
    return found | SINGLE | DOUBLE | OTHER if kind & (OTHER | THING) else found


def _float(symbol, arguments):
    if len(arguments) == 1:
        kind = kind_of(arguments[0])
        return (SINGLE if kind & ~DOUBLE else 0) | kind & (DOUBLE | THING)
    if len(arguments) == 2 and kind_of(arguments[1]) in (SINGLE, DOUBLE):
        return kind_of(arguments[1])
    return ANY


def _coerce(symbol, arguments):
    if len(arguments) == 2 and arguments[1].__class__ is nodes.Constant:
        if arguments[1].value in DOUBLE_TYPES:
            return DOUBLE
        if arguments[1].value in SINGLE_TYPES:
            return SINGLE
    return ANY


def _integer(symbol, arguments):
    return INT


CALLS = {
    **dict.fromkeys(OPERATORS, _arithmetic),
    **dict.fromkeys(STEPS, _step),
    **dict.fromkeys((MOD, REM), _rest),
    **dict.fromkeys((MAX, MIN), _choice),
    **dict.fromkeys(INTEGERS | WHOLE, _integer),
    **dict.fromkeys(SMOOTH, _smooth),
    **dict.fromkeys((SQRT, LOG, ASIN, ACOS), _root),
    ABS: _abs,
    FLOAT: _float,
    COERCE: _coerce,
}
"""Function of Common Lisp → the kind of its first value, given the symbol and the nodes of the arguments."""

_RULES = {
    nodes.Constant: _constant,
    nodes.LocalVariable: _local_variable,
    nodes.GlobalVariable: _global_variable,
    nodes.SetLocal: lambda node: kind_of(node.value),
    nodes.Checked: _checked,
    nodes.Call: _call,
    nodes.If: _if,
    nodes.Let: _of_body,
    nodes.Functions: _of_body,
    nodes.MultipleValueBind: _of_body,
    nodes.Progn: lambda node: kind_of(node.forms[-1]),
    nodes.BlockNode: _block,
    nodes.ReturnFrom: _never,
    nodes.Go: _never,
    nodes.TagbodyNode: lambda node: BOOLEAN,
}


# ------------------------------------------------------------------------------------------------------------------ sizes

FIXNUM_BITS, FEW_BITS, COUNTED, INFINITE = 62, 1000, 64, math.inf
"""An integer of fewer than ``FEW_BITS`` bits fits into a float. A sum that grows by one amount in every turn of a loop, however often, has
``COUNTED`` more bits than the amount."""


def bits(node):
    """A bound for the bits of the integers that ``node`` may give, 0 if it gives none; ``INFINITE`` if there is no bound."""
    kind = node.__class__
    if kind is nodes.Constant:
        return node.value.bit_length() if node.value.__class__ is int else 0
    if kind is nodes.LocalVariable:
        return _bits_of_variable(node.variable)
    if not kind_of(node) & INT:
        return 0
    if kind is nodes.Checked:
        return FIXNUM_BITS if node.type is FIXNUM else bits(node.value)
    if kind is nodes.SetLocal:
        return bits(node.value)
    if kind is nodes.If:
        return max(bits(node.then), bits(node.otherwise))
    if kind is not nodes.Call:
        return INFINITE
    symbol, arguments = node.symbol, node.arguments
    if symbol in SUMS:
        return sum(map(bits, arguments)) + 2  # not tight: the sum of the sizes instead of the largest
    if symbol is TIMES:
        return sum(map(bits, arguments))
    if symbol in SIZES:
        return FIXNUM_BITS
    if symbol in _NOT_LARGER and exactly(kind_of(node), INT) and all(exactly(kind_of(each), INT) for each in arguments):
        return max(map(bits, arguments))
    return INFINITE


_NOT_LARGER = {MOD, REM, ABS, MAX, MIN, *WHOLE}


def magnitude(node):
    """A bound for the binary exponent of the numbers that ``node`` gives, which are integers or a constant; else ``INFINITE``."""
    if node.__class__ is nodes.Constant and isinstance(node.value, float):
        return abs(math.frexp(node.value)[1]) if math.isfinite(node.value) else INFINITE
    return bits(node) if exactly(kind_of(node), INT) else INFINITE


def _bits_of_variable(variable):
    known = variable.bits
    if known is None:
        if not (variable.proven or variable.kind) & INT:
            return 0
        if variable.proven and variable.type is FIXNUM:
            return FIXNUM_BITS
        variable.bits = INFINITE  # while it is found out: so is a variable that depends on itself otherwise than by steps
        known = variable.bits = _bits_of_values(variable)
    return known


def _bits_of_values(variable):
    if variable.kind & (BOOLEAN | THING) or not variable.values:
        return INFINITE
    most = 0
    for value in variable.values:
        if kind_of(value) & INT:
            amount = step_of(value, variable)
            most = max(most, bits(value) if amount is None else bits(amount) + COUNTED)
    return most + 1


def step_of(value, variable):
    """The node that ``value`` adds to ``variable``, which it is assigned to, or takes from it; ``None`` if it is of another form."""
    while value.__class__ is nodes.Checked:
        value = value.value
    if value.__class__ is not nodes.Call or value.symbol not in SUMS or not value.arguments:
        return None
    first, *others = value.arguments
    if first.__class__ is not nodes.LocalVariable or first.variable is not variable:
        return None
    if value.symbol in STEPS:
        return nodes.Constant(1) if not others else None
    return others[0] if len(others) == 1 else None


def never_negative(node):
    """Whether ``node`` surely gives no number below 0. It may give what is not a number."""
    kind = node.__class__
    if kind is nodes.Constant:
        return node.value.__class__ in _CLASSES and node.value >= 0 and math.copysign(1, node.value) > 0
    if kind is nodes.LocalVariable:
        return _variable_never_negative(node.variable)
    if kind is nodes.Checked or kind is nodes.SetLocal:
        return never_negative(node.value)
    if kind is not nodes.Call:
        return False
    symbol, arguments = node.symbol, node.arguments
    if symbol is PLUS or symbol is ADD_ONE or symbol is DIVIDE:
        return all(map(never_negative, arguments))
    if symbol is TIMES:
        return _is_square(arguments) or all(map(never_negative, arguments))
    if symbol in SIZES or symbol is ABS:
        return True
    if symbol is MOD:
        return len(arguments) == 2 and never_negative(arguments[1])
    return symbol is MAX and all(exactly(kind_of(each), MACHINE) for each in arguments) and any(map(never_negative, arguments))


def _is_square(arguments):
    first = arguments[0].__class__
    return (
        len(arguments) == 2
        and first is nodes.LocalVariable
        and first is arguments[1].__class__
        and arguments[0].variable is arguments[1].variable
        and exactly(kind_of(arguments[0]), MACHINE)
    )


_asked: list = []
"""The variables of which it is being found out whether they are ever negative, the innermost last."""


def _variable_never_negative(variable):
    known = variable.never_negative
    if known is None:
        if variable in _asked:
            return variable is _asked[-1]  # a sum that grows by what is not negative; in longer circles nobody can be sure
        _asked.append(variable)
        try:
            known = exactly(variable.kind, MACHINE) and bool(variable.values) and all(map(never_negative, variable.values))
        finally:
            _asked.pop()
        variable.never_negative = known
    return known
