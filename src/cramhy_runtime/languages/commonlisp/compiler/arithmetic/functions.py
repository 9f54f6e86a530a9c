"""Functions of numbers that become Python expressions: ``max``, ``abs``, ``sqrt``, ``sin``, ``floor`` and their like.

Each is a function of Python's ``math``, or an operator, behind a test that the argument is of a class and in a range where both mean
the same; what the test refuses is called as it stands.

Rows of ``make bench`` without it, as times of the row with it: sines of double-floats 12,
a pendulum, by sin 7.4.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.packages import sym

from .. import nodes
from ..core import expression, word
from ..destinations import FIRST_OF_VALUES
from ..generator.output import SINGLE_VALUE
from ..kinds import (
    ABS,
    COERCE,
    DOUBLE,
    FEW_BITS,
    FLOAT,
    FLOATS,
    INT,
    MACHINE,
    MAX,
    MIN,
    MINUS,
    MOD,
    NUMBER,
    REM,
    SINGLE,
    SQRT,
    THING,
    WHOLE,
    exactly,
    kind_of,
    never_negative,
    raw,
)
from ..passes import opens_call
from ..words import AND, FLOAT_CLASS, IF, INT_CLASS, IS, OR, SINGLE_CLASS, class_of
from .comparisons import real_test, same_class
from .operations import LARGEST, generic_call, named_arguments, nested, noted_class, operands_of, settle
from .single_rounding import rounded
from .sums import MOST_TERMS

LESS, LESS_OR_EQUAL, GREATER, GREATER_OR_EQUAL = map(word, "< <= > >=".split())
REMAINDER, WHOLE_QUOTIENT, NEGATIVE = map(word, "% // -".split())
FLOOR, CEILING, TRUNCATE, ROUND, ATAN = map(sym, "FLOOR CEILING TRUNCATE ROUND ATAN".split())
IN_PYTHON = {FLOOR: "floor", CEILING: "ceil", TRUNCATE: "int", ROUND: "round"}
"""Division of a float by 1 → the function of Python that gives its quotient. ``round`` goes from the middle to the even one, too."""


def _finite(value):
    return expression(LESS_OR_EQUAL, -LARGEST, value, LARGEST)


def _any_number(value):
    return None


SMOOTH_RANGES = {
    sym("SIN"): ("sin", _finite),
    sym("COS"): ("cos", _finite),
    sym("TAN"): ("tan", _finite),
    ATAN: ("atan", _any_number),
    sym("EXP"): ("exp", lambda value: expression(LESS, value, 700.0)),
    SQRT: ("sqrt", lambda value: expression(GREATER_OR_EQUAL, value, 0)),
    sym("LOG"): ("log", lambda value: expression(GREATER, value, 0)),
    sym("ASIN"): ("asin", lambda value: expression(LESS_OR_EQUAL, -1, value, 1)),
    sym("ACOS"): ("acos", lambda value: expression(LESS_OR_EQUAL, -1, value, 1)),
}
"""Function of one number → the function of Python's ``math``, and the test that a real number is where both mean the same."""


def number_function(generator, node, symbol, arguments, multiple):
    """(expression, whether it is raw) of a call of a function of numbers, or ``None``. ``multiple``: all its values are wanted."""
    count = len(arguments)
    if count == 1 and symbol in SMOOTH_RANGES:
        return smooth_function(generator, node, symbol, arguments)
    if symbol is MAX or symbol is MIN:
        return extreme_of(generator, node, symbol, arguments) if count == 2 else None
    if count == 1 and (symbol is ABS or symbol is MINUS):
        return changed_sign(generator, node, symbol, arguments)
    if (symbol is MOD or symbol is REM) and count == 2:
        return remainder_of(generator, node, symbol, arguments), False
    if symbol in WHOLE and not multiple and 0 < count < 3:
        return whole_part(generator, node, symbol, arguments)
    if symbol is ATAN and count == 2:
        return angle_of(generator, node, symbol, arguments)
    if symbol is FLOAT or symbol is COERCE:
        return as_float(generator, node, symbol, arguments)
    return None


def function_called(generator, node, symbol, operands):
    """The call of the function itself. It takes no several values, which an operand of unknown kind may be."""
    models = []
    for operand in operands:
        model = generic_call(generator, operand)
        models.append(model if exactly(operand.kind, NUMBER) else generator.call("one", model))
    return generator.positioned(expression(word(generator.constants.name("function", symbol)), *models), node)


def smooth_function(generator, node, symbol, arguments):
    (operand,) = operands_of(generator, arguments)
    name, inside = SMOOTH_RANGES[symbol]
    is_raw = raw(kind_of(node))
    slow = function_called(generator, node, symbol, [operand])
    if is_raw:
        slow = generator.unwrapped(slow, 0)
    single = not operand.kind & DOUBLE
    if not operand.kind & (MACHINE | THING) or not operand.kind or operand.kind & (INT | DOUBLE) == INT | DOUBLE and operand.known:
        settle(generator, [operand])
        return slow, is_raw
    if operand.known and operand.size < FEW_BITS:
        sure = symbol is SQRT and never_negative(arguments[0]) and exactly(operand.kind, INT)
        test = None if sure else inside(operand.first)
        model = generator.call(name, operand.first if test is None else operand.later)
        if single:
            model = rounded(model)
            model = model if is_raw else generator.call("new_single", model)
        return (model if test is None else expression(IF, test, model, slow)), is_raw
    model = generator.call(name, operand.later)
    if operand.raw:
        if operand.kind & INT:
            settle(generator, [operand])
            return slow, is_raw
        noted, _ = noted_class(operand.first)
        tests = [expression(IS, noted, FLOAT_CLASS), inside(operand.later)]
        model = rounded(model) if is_raw else generator.call("new_single", rounded(model))
        return behind_tests(tests, model, slow), is_raw
    if is_raw:  # the other two answers are not raw here
        slow = function_called(generator, node, symbol, [operand])
    noted, again = noted_class(operand.first)
    test = inside(operand.later)
    single = generator.call("new_single", rounded(model))
    if test is None:
        both = expression(IF, expression(IS, again, SINGLE_CLASS), single, slow)
        return expression(IF, expression(IS, noted, FLOAT_CLASS), model, both), False
    # the class once more after the range, which must not be asked of what is no number
    one = expression(AND, expression(IS, noted, FLOAT_CLASS), test)
    other = expression(AND, expression(IS, class_of(operand.later), SINGLE_CLASS), test)
    return expression(IF, one, model, expression(IF, other, single, slow)), False


def angle_of(generator, node, symbol, arguments):
    operands = operands_of(generator, arguments)
    known = all(operand.known and exactly(operand.kind, MACHINE) and operand.size < FEW_BITS for operand in operands)
    kind = kind_of(node)
    settle(generator, operands)
    one, other = operands
    model = generator.call("atan2", one.later, other.later)
    if known and exactly(kind, SINGLE):
        return rounded(model), True
    if known and exactly(kind, DOUBLE) and not (one.kind | other.kind) & INT:
        return model, False
    slow = function_called(generator, node, symbol, operands)
    if one.raw or other.raw:
        return (generator.unwrapped(slow, 0), True) if raw(kind) else (slow, False)
    test = expression(IS, class_of(one.later), class_of(other.later), FLOAT_CLASS)
    return expression(IF, test, model, slow), False


def extreme_of(generator, node, symbol, arguments):
    operands = operands_of(generator, arguments)
    settle(generator, operands)
    one, other = operands
    better = expression(GREATER if symbol is MAX else LESS, other.later, one.later)
    model = expression(IF, better, other.later, one.later)
    slow = function_called(generator, node, symbol, operands)
    if all(exactly(operand.kind, MACHINE) for operand in operands):
        if one.raw == other.raw or exactly(one.kind | other.kind, INT | SINGLE):
            return model, one.raw or other.raw
    is_raw = raw(kind_of(node))
    if is_raw:
        slow = generator.unwrapped(slow, 0)
    if one.raw or other.raw or not all(operand.kind & (NUMBER | THING) for operand in operands):
        return slow, is_raw
    unsure = [operand for operand in operands if not exactly(operand.kind, MACHINE)]
    test = same_class(generator, one, other) if len(unsure) == 2 else real_test(generator, unsure[0])
    return expression(IF, test, model, slow), is_raw


def changed_sign(generator, node, symbol, arguments):
    """``(abs x)`` and ``(- x)``."""
    (operand,) = operands_of(generator, arguments)

    def change(value):
        return generator.call("abs", value) if symbol is ABS else expression(NEGATIVE, value)

    if exactly(operand.kind, MACHINE) and operand.known:
        return change(operand.first), operand.raw
    slow = function_called(generator, node, symbol, [operand])
    if operand.raw:
        settle(generator, [operand])
        return (generator.unwrapped(slow, 0), True) if raw(kind_of(node)) else (slow, False)
    noted, again = noted_class(operand.first)
    test = expression(OR, expression(IS, noted, INT_CLASS), expression(IS, again, FLOAT_CLASS))
    return expression(IF, test, change(operand.later), slow), False


def integers_test(generator, operands):
    """A test that all ``operands``, which are settled, are integers; ``None`` if they surely are."""
    unsure = [class_of(operand.later) for operand in operands if not exactly(operand.kind, INT)]
    return expression(IS, *unsure, INT_CLASS) if unsure else None


def remainder_of(generator, node, symbol, arguments):
    operands = operands_of(generator, arguments)
    settle(generator, operands)
    one, other = operands
    slow = function_called(generator, node, symbol, operands)
    if one.raw or other.raw or not (one.kind & INT and other.kind & INT):
        return slow
    model = expression(REMAINDER, one.later, other.later)
    tests = [integers_test(generator, operands)]
    if other.later.__class__ is not int:
        tests.append(other.later)
    elif not other.later:
        return slow
    if symbol is REM:  # Python's rest has the sign of the divisor
        tests += [expression(GREATER_OR_EQUAL, each.later, 0) for each in operands if not never_negative(each.node)]
    return behind_tests(tests, model, slow)


def behind_tests(tests, model, slow):
    """``model`` if all ``tests`` hold that are not ``None``, else ``slow``."""
    tests = [test for test in tests if test is not None]
    if not tests:
        return model
    return expression(IF, tests[0] if len(tests) == 1 else expression(AND, *tests), model, slow)


def whole_part(generator, node, symbol, arguments):
    """The first value of a division with rest."""
    one, *rest = operands = operands_of(generator, arguments)
    divisor = arguments[1].value if rest and arguments[1].__class__ is nodes.Constant else None
    if one.kind & FLOATS and not rest and one.known and exactly(one.kind, MACHINE):
        if one.first is not one.later:
            settle(generator, operands)
        slow = generator.first_value(function_called(generator, node, symbol, operands))
        return expression(IF, _finite(one.later), generator.call(IN_PYTHON[symbol], one.later), slow), False
    settle(generator, operands)
    slow = generator.first_value(function_called(generator, node, symbol, operands))
    if divisor.__class__ is int and divisor > 0 and one.kind & INT and symbol is not ROUND and not one.raw:
        quotient = expression(WHOLE_QUOTIENT, one.later, divisor)
        upward = expression(NEGATIVE, expression(WHOLE_QUOTIENT, expression(NEGATIVE, one.later), divisor))
        if symbol is CEILING:
            quotient = upward
        elif symbol is TRUNCATE and not never_negative(one.node):
            quotient = expression(IF, expression(GREATER_OR_EQUAL, one.later, 0), quotient, upward)
        return behind_tests([integers_test(generator, [one])], quotient, slow), False
    if symbol is FLOOR and rest and all(each.kind & INT and not each.raw for each in operands) and divisor is None:
        quotient = expression(WHOLE_QUOTIENT, one.later, rest[0].later)
        return behind_tests([integers_test(generator, operands), rest[0].later], quotient, slow), False
    if not rest and not one.raw and one.kind & FLOATS:
        of_float = [expression(IS, class_of(one.later), each) for each in (FLOAT_CLASS, SINGLE_CLASS)]
        tests = [expression(OR, *of_float), _finite(one.later)]
        return behind_tests(tests, generator.call(IN_PYTHON[symbol], one.later), slow), False
    return slow, False


def as_float(generator, node, symbol, arguments):
    """``(float i)``, ``(float i 1d0)``, ``(coerce i 'double-float)`` and their like, of a small integer or a float."""
    if not arguments or len(arguments) > 2 or not exactly(kind_of(arguments[0]), MACHINE):
        return None
    if len(arguments) == 2 and arguments[1].__class__ is not nodes.Constant or symbol is COERCE and len(arguments) != 2:
        return None
    kind = kind_of(node)
    if kind not in (SINGLE, DOUBLE):
        return None
    (operand,) = operands_of(generator, arguments[:1])
    if not operand.known or operand.size > 100 or kind == SINGLE and operand.kind & DOUBLE:
        slow = function_called(generator, node, symbol, [operand]) if len(arguments) == 1 else None
        if slow is None:
            more = generator.value(arguments[1])
            slow = generator.positioned(
                expression(word(generator.constants.name("function", symbol)), generic_call(generator, operand), more), node
            )
        settle(generator, [operand])
        return slow, False
    if kind == DOUBLE:
        return (operand.first if operand.kind in (SINGLE, DOUBLE) else generator.call("float", operand.first)), False
    if not operand.kind & INT:
        return operand.first, True
    return generator.call("in_single" if operand.size > 24 or operand.kind & SINGLE else "float", operand.first), True


NUMBER_FUNCTIONS = {*SMOOTH_RANGES, *WHOLE, MAX, MIN, ABS, MINUS, MOD, REM, FLOAT, COERCE}


@opens_call("number-functions", *NUMBER_FUNCTIONS)
def _number_function(generator, node, destination):
    symbol, arguments = node.symbol, node.arguments
    if (symbol is MAX or symbol is MIN) and 2 < len(arguments) <= MOST_TERMS:
        arguments = nested(node)
        if arguments is None:
            return (generator.gen(named_arguments(generator, node), destination),)
    found = number_function(generator, node, symbol, arguments, destination.multiple and destination is not FIRST_OF_VALUES)
    if found is None:
        return None
    return (generator.finish(found[0], SINGLE_VALUE if symbol in WHOLE else node, destination, raw=found[1]),)
