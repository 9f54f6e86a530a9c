"""Functions of numbers that become Python expressions: ``max``, ``abs``, ``sqrt``, ``sin``, ``floor`` and their like.

Each is a function of Python's ``math``, or an operator, behind a test that the argument is of a class and in a range where both mean
the same; what the test refuses is called as it stands.
"""

from __future__ import annotations

from cramhy_runtime.ground.packages import sym
from .. import nodes
from ..core import expression, word
from .operations import AND, FLOAT_CLASS, IF, INT_CLASS, IS, LARGEST, OR, SINGLE_CLASS
from .quotients import QuotientGenerator
from .single_rounding import rounded
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


class NumberGenerator(QuotientGenerator):
    """The part of the `Generator` that makes expressions of functions of numbers."""

    def number_function(self, node, symbol, arguments, multiple):
        """(expression, whether it is raw) of a call of a function of numbers, or ``None``. ``multiple``: all its values are wanted."""
        count = len(arguments)
        if count == 1 and symbol in SMOOTH_RANGES:
            return self.smooth(node, symbol, arguments)
        if symbol is MAX or symbol is MIN:
            return self.extreme(node, symbol, arguments) if count == 2 else None
        if count == 1 and (symbol is ABS or symbol is MINUS):
            return self.changed_sign(node, symbol, arguments)
        if (symbol is MOD or symbol is REM) and count == 2:
            return self.remainder(node, symbol, arguments), False
        if symbol in WHOLE and not multiple and 0 < count < 3:
            return self.whole(node, symbol, arguments)
        if symbol is ATAN and count == 2:
            return self.angle(node, symbol, arguments)
        if symbol is FLOAT or symbol is COERCE:
            return self.floated(node, symbol, arguments)
        return None

    def called(self, node, symbol, operands):
        """The call of the function itself. It takes no several values, which an operand of unknown kind may be."""
        models = []
        for operand in operands:
            model = self.generic(operand)
            models.append(model if exactly(operand.kind, NUMBER) else self.call("one", model))
        return self.positioned(expression(word(self.constants.name("function", symbol)), *models), node)

    def smooth(self, node, symbol, arguments):
        (operand,) = self.operands(arguments)
        name, inside = SMOOTH_RANGES[symbol]
        is_raw = raw(kind_of(node))
        slow = self.called(node, symbol, [operand])
        if is_raw:
            slow = self.unwrapped(slow, 0)
        single = not operand.kind & DOUBLE
        if not operand.kind & (MACHINE | THING) or not operand.kind or operand.kind & (INT | DOUBLE) == INT | DOUBLE and operand.known:
            self.settle([operand])
            return slow, is_raw
        if operand.known and operand.size < FEW_BITS:
            sure = symbol is SQRT and never_negative(arguments[0]) and exactly(operand.kind, INT)
            test = None if sure else inside(operand.first)
            model = self.call(name, operand.first if test is None else operand.later)
            if single:
                model = rounded(model)
                model = model if is_raw else self.call("new_single", model)
            return (model if test is None else expression(IF, test, model, slow)), is_raw
        model = self.call(name, operand.later)
        if operand.raw:
            if operand.kind & INT:
                self.settle([operand])
                return slow, is_raw
            noted, _ = self.noted_class(operand.first)
            tests = [expression(IS, noted, FLOAT_CLASS), inside(operand.later)]
            model = rounded(model) if is_raw else self.call("new_single", rounded(model))
            return self.behind(tests, model, slow), is_raw
        if is_raw:  # the other two answers are not raw here
            slow = self.called(node, symbol, [operand])
        noted, again = self.noted_class(operand.first)
        test = inside(operand.later)
        single = self.call("new_single", rounded(model))
        if test is None:
            both = expression(IF, expression(IS, again, SINGLE_CLASS), single, slow)
            return expression(IF, expression(IS, noted, FLOAT_CLASS), model, both), False
        # the class once more after the range, which must not be asked of what is no number
        one = expression(AND, expression(IS, noted, FLOAT_CLASS), test)
        other = expression(AND, expression(IS, self.class_of(operand.later), SINGLE_CLASS), test)
        return expression(IF, one, model, expression(IF, other, single, slow)), False

    def angle(self, node, symbol, arguments):
        operands = self.operands(arguments)
        known = all(operand.known and exactly(operand.kind, MACHINE) and operand.size < FEW_BITS for operand in operands)
        kind = kind_of(node)
        self.settle(operands)
        one, other = operands
        model = self.call("atan2", one.later, other.later)
        if known and exactly(kind, SINGLE):
            return rounded(model), True
        if known and exactly(kind, DOUBLE) and not (one.kind | other.kind) & INT:
            return model, False
        slow = self.called(node, symbol, operands)
        if one.raw or other.raw:
            return (self.unwrapped(slow, 0), True) if raw(kind) else (slow, False)
        test = expression(IS, self.class_of(one.later), self.class_of(other.later), FLOAT_CLASS)
        return expression(IF, test, model, slow), False

    def extreme(self, node, symbol, arguments):
        operands = self.operands(arguments)
        self.settle(operands)
        one, other = operands
        better = expression(GREATER if symbol is MAX else LESS, other.later, one.later)
        model = expression(IF, better, other.later, one.later)
        slow = self.called(node, symbol, operands)
        if all(exactly(operand.kind, MACHINE) for operand in operands):
            if one.raw == other.raw or exactly(one.kind | other.kind, INT | SINGLE):
                return model, one.raw or other.raw
        is_raw = raw(kind_of(node))
        if is_raw:
            slow = self.unwrapped(slow, 0)
        if one.raw or other.raw or not all(operand.kind & (NUMBER | THING) for operand in operands):
            return slow, is_raw
        unsure = [operand for operand in operands if not exactly(operand.kind, MACHINE)]
        test = self.same_class(one, other) if len(unsure) == 2 else self.real_test(unsure[0])
        return expression(IF, test, model, slow), is_raw

    def changed_sign(self, node, symbol, arguments):
        """``(abs x)`` and ``(- x)``."""
        (operand,) = self.operands(arguments)

        def change(value):
            return self.call("abs", value) if symbol is ABS else expression(NEGATIVE, value)

        if exactly(operand.kind, MACHINE) and operand.known:
            return change(operand.first), operand.raw
        slow = self.called(node, symbol, [operand])
        if operand.raw:
            self.settle([operand])
            return (self.unwrapped(slow, 0), True) if raw(kind_of(node)) else (slow, False)
        noted, again = self.noted_class(operand.first)
        test = expression(OR, expression(IS, noted, INT_CLASS), expression(IS, again, FLOAT_CLASS))
        return expression(IF, test, change(operand.later), slow), False

    def integers(self, operands):
        """A test that all ``operands``, which are settled, are integers; ``None`` if they surely are."""
        unsure = [self.class_of(operand.later) for operand in operands if not exactly(operand.kind, INT)]
        return expression(IS, *unsure, INT_CLASS) if unsure else None

    def remainder(self, node, symbol, arguments):
        operands = self.operands(arguments)
        self.settle(operands)
        one, other = operands
        slow = self.called(node, symbol, operands)
        if one.raw or other.raw or not (one.kind & INT and other.kind & INT):
            return slow
        model = expression(REMAINDER, one.later, other.later)
        tests = [self.integers(operands)]
        if other.later.__class__ is not int:
            tests.append(other.later)
        elif not other.later:
            return slow
        if symbol is REM:  # Python's rest has the sign of the divisor
            tests += [expression(GREATER_OR_EQUAL, each.later, 0) for each in operands if not never_negative(each.node)]
        return self.behind(tests, model, slow)

    @staticmethod
    def behind(tests, model, slow):
        """``model`` if all ``tests`` hold that are not ``None``, else ``slow``."""
        tests = [test for test in tests if test is not None]
        if not tests:
            return model
        return expression(IF, tests[0] if len(tests) == 1 else expression(AND, *tests), model, slow)

    def whole(self, node, symbol, arguments):
        """The first value of a division with rest."""
        one, *rest = operands = self.operands(arguments)
        divisor = arguments[1].value if rest and arguments[1].__class__ is nodes.Constant else None
        if one.kind & FLOATS and not rest and one.known and exactly(one.kind, MACHINE):
            if one.first is not one.later:
                self.settle(operands)
            slow = self.first_value(self.called(node, symbol, operands))
            return expression(IF, _finite(one.later), self.call(IN_PYTHON[symbol], one.later), slow), False
        self.settle(operands)
        slow = self.first_value(self.called(node, symbol, operands))
        if divisor.__class__ is int and divisor > 0 and one.kind & INT and symbol is not ROUND and not one.raw:
            quotient = expression(WHOLE_QUOTIENT, one.later, divisor)
            upward = expression(NEGATIVE, expression(WHOLE_QUOTIENT, expression(NEGATIVE, one.later), divisor))
            if symbol is CEILING:
                quotient = upward
            elif symbol is TRUNCATE and not never_negative(one.node):
                quotient = expression(IF, expression(GREATER_OR_EQUAL, one.later, 0), quotient, upward)
            return self.behind([self.integers([one])], quotient, slow), False
        if symbol is FLOOR and rest and all(each.kind & INT and not each.raw for each in operands) and divisor is None:
            quotient = expression(WHOLE_QUOTIENT, one.later, rest[0].later)
            return self.behind([self.integers(operands), rest[0].later], quotient, slow), False
        if not rest and not one.raw and one.kind & FLOATS:
            of_float = [expression(IS, self.class_of(one.later), each) for each in (FLOAT_CLASS, SINGLE_CLASS)]
            tests = [expression(OR, *of_float), _finite(one.later)]
            return self.behind(tests, self.call(IN_PYTHON[symbol], one.later), slow), False
        return slow, False

    def floated(self, node, symbol, arguments):
        """``(float i)``, ``(float i 1d0)``, ``(coerce i 'double-float)`` and their like, of a small integer or a float."""
        if not arguments or len(arguments) > 2 or not exactly(kind_of(arguments[0]), MACHINE):
            return None
        if len(arguments) == 2 and arguments[1].__class__ is not nodes.Constant or symbol is COERCE and len(arguments) != 2:
            return None
        kind = kind_of(node)
        if kind not in (SINGLE, DOUBLE):
            return None
        (operand,) = self.operands(arguments[:1])
        if not operand.known or operand.size > 100 or kind == SINGLE and operand.kind & DOUBLE:
            slow = self.called(node, symbol, [operand]) if len(arguments) == 1 else None
            if slow is None:
                more = self.value(arguments[1])
                slow = self.positioned(expression(word(self.constants.name("function", symbol)), self.generic(operand), more), node)
            self.settle([operand])
            return slow, False
        if kind == DOUBLE:
            return (operand.first if operand.kind in (SINGLE, DOUBLE) else self.call("float", operand.first)), False
        if not operand.kind & INT:
            return operand.first, True
        return self.call("in_single" if operand.size > 24 or operand.kind & SINGLE else "float", operand.first), True


NUMBER_FUNCTIONS = {*SMOOTH_RANGES, *WHOLE, MAX, MIN, ABS, MINUS, MOD, REM, FLOAT, COERCE}
