"""Comparisons of two numbers: Python's operators behind a test that both are of classes whose values Python compares as Lisp does."""

from __future__ import annotations

from cramhy_runtime.ground.packages import sym
from ..core import NONE, Symbol, expression, word
from .operations import AND, CLASSES, FLOAT_CLASS, IF, INT_CLASS, IS, IS_NOT, OR, SETX, SINGLE_CLASS, ArithmeticGenerator, Operation
from ..kinds import INT, MACHINE, NUMBER, THING, exactly

COMPARISONS = {sym(name): word(name) for name in ("<", ">", "<=", ">=", "=")}


class ComparisonGenerator(ArithmeticGenerator):
    """The part of the `Generator` that compares."""

    def comparison(self, node, symbol, arguments):
        """The Python test of a comparison of two operands."""
        operands = self.operands(arguments)
        one, other = operands
        operator = COMPARISONS[symbol]
        if exactly(one.kind, MACHINE) and exactly(other.kind, MACHINE):
            return expression(operator, one.first, other.first)
        slow = expression(IS_NOT, self.generic(Operation(symbol, node, operands)), NONE)
        if any(operand.kind and not operand.kind & (NUMBER | THING) for operand in operands):
            self.settle(operands)
            return slow
        quick = expression(operator, one.later, other.later)
        unsure = [operand for operand in operands if not exactly(operand.kind, MACHINE)]
        if len(unsure) == 2 and not (one.raw or other.raw):
            return expression(IF, self.same_class(one, other), quick, slow)
        if len(unsure) == 2 or any(operand.first is not operand.later for operand in operands if operand is not unsure[0]):
            self.settle(operands)
        return expression(IF, expression(AND, *map(self.real_test, unsure)) if len(unsure) > 1 else self.real_test(unsure[0]), quick, slow)

    def real_test(self, operand):
        """A test that an operand is of a class whose values Python compares as Lisp does."""
        noted, again = self.noted_class(operand.first)
        classes = [INT_CLASS, FLOAT_CLASS] if operand.kind & INT or not operand.raw else [FLOAT_CLASS]
        if not operand.raw:
            classes.append(SINGLE_CLASS)
        tests = [expression(IS, noted if index == 0 else again, each) for index, each in enumerate(classes)]
        return tests[0] if len(tests) == 1 else expression(OR, *tests)

    def same_class(self, one, other):
        """A test that both operands are of one class whose values Python compares as Lisp does."""
        if one.later is other.later:
            return self.real_test(one)
        second = other.first
        if second.__class__ is Symbol:
            first, second = expression(SETX, CLASSES, self.class_of(one.first)), self.class_of(second)
        else:
            first, second = self.class_of(one.first), expression(SETX, CLASSES, self.class_of(second))
        classes = (INT_CLASS, FLOAT_CLASS, SINGLE_CLASS)
        return expression(AND, expression(IS, first, second), expression(OR, *(expression(IS, CLASSES, each) for each in classes)))
