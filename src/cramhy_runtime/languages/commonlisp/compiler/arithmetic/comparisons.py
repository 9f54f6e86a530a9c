"""Comparisons of two numbers: Python's operators behind a test that both are of classes whose values Python compares as Lisp does.

Rows of ``make bench`` without it, as times of the row with it: Collatz 5.6, fib 5.2.
"""

from __future__ import annotations

from ..core import Symbol
from cramhy_runtime.lisp_core.packages import sym

from ..core import NONE, expression, word
from ..kinds import INT, MACHINE, NUMBER, THING, exactly
from ..passes import opens_test
from ..words import AND, CLASSES, FLOAT_CLASS, IF, INT_CLASS, IS, IS_NOT, OR, SETX, SINGLE_CLASS, class_of
from .operations import Operation, generic_call, noted_class, operands_of, settle

COMPARISONS = {sym(name): word(name) for name in ("<", ">", "<=", ">=", "=")}


@opens_test("comparisons", *COMPARISONS)
def comparison_test(generator, node):
    """The Python test of a comparison of two operands."""
    symbol, arguments = node.symbol, node.arguments
    if len(arguments) != 2:
        return None
    operands = operands_of(generator, arguments)
    one, other = operands
    operator = COMPARISONS[symbol]
    if exactly(one.kind, MACHINE) and exactly(other.kind, MACHINE):
        return expression(operator, one.first, other.first)
    slow = expression(IS_NOT, generic_call(generator, Operation(symbol, node, operands)), NONE)
    if any(operand.kind and not operand.kind & (NUMBER | THING) for operand in operands):
        settle(generator, operands)
        return slow
    quick = expression(operator, one.later, other.later)
    unsure = [operand for operand in operands if not exactly(operand.kind, MACHINE)]
    if len(unsure) == 2 and not (one.raw or other.raw):
        return expression(IF, same_class(generator, one, other), quick, slow)
    if len(unsure) == 2 or any(operand.first is not operand.later for operand in operands if operand is not unsure[0]):
        settle(generator, operands)
    return expression(
        IF,
        expression(AND, *[real_test(generator, each) for each in unsure]) if len(unsure) > 1 else real_test(generator, unsure[0]),
        quick,
        slow,
    )


def real_test(generator, operand):
    """A test that an operand is of a class whose values Python compares as Lisp does."""
    noted, again = noted_class(operand.first)
    classes = [INT_CLASS, FLOAT_CLASS] if operand.kind & INT or not operand.raw else [FLOAT_CLASS]
    if not operand.raw:
        classes.append(SINGLE_CLASS)
    tests = [expression(IS, noted if index == 0 else again, each) for index, each in enumerate(classes)]
    return tests[0] if len(tests) == 1 else expression(OR, *tests)


def same_class(generator, one, other):
    """A test that both operands are of one class whose values Python compares as Lisp does."""
    if one.later is other.later:
        return real_test(generator, one)
    second = other.first
    if second.__class__ is Symbol:
        first, second = expression(SETX, CLASSES, class_of(one.first)), class_of(second)
    else:
        first, second = class_of(one.first), expression(SETX, CLASSES, class_of(second))
    classes = (INT_CLASS, FLOAT_CLASS, SINGLE_CLASS)
    return expression(AND, expression(IS, first, second), expression(OR, *(expression(IS, CLASSES, each) for each in classes)))
