"""Operators: the small functions on numbers and lists, and the tests, that become Python expressions.

Sums, products, quotients and comparisons are in ``arithmetic/``.
"""

from __future__ import annotations

from cramhy_runtime.ground.data import Symbol as LispSymbol
from cramhy_runtime.ground.packages import sym
from cramhy_runtime.ground.ports import PORTS
from . import nodes
from .core import NONE, Expression, Symbol, expression, word
from .declared_types import integer_limits, is_between
from .arithmetic.comparisons import COMPARISONS
from .arithmetic.operations import AND, ARITHMETIC, DOT, FLOAT_CLASS, IF, INT_CLASS, IS, IS_NOT, OR, SETX, SINGLE_CLASS, Operand, class_of
from .arithmetic.elements import ELEMENTS, LENGTH, ArrayGenerator
from .arithmetic.functions import NumberGenerator
from .kinds import ANY, DOUBLE_TYPES, INT, MACHINE, SINGLE_TYPES, exactly, kind_of, kind_of_type

SIGNS = {sym("ZEROP"): COMPARISONS[sym("=")], sym("PLUSP"): COMPARISONS[sym(">")], sym("MINUSP"): COMPARISONS[sym("<")]}
PARITY = {sym("EVENP"): 0, sym("ODDP"): 1}
SAME = {sym("EQ"), sym("EQL")}
NOT = sym("NOT")
NEGATIONS = {NOT, sym("NULL")}
CAR, CDR, FIRST, REST, CONS, LIST = map(sym, "CAR CDR FIRST REST CONS LIST".split())
PARTS = {CAR: "car", FIRST: "car", CDR: "cdr", REST: "cdr"}
KNOWN_PARTS = {sym("CRAMHY::CAR-OF-CONS"): "car", sym("CRAMHY::CDR-OF-CONS"): "cdr"}
CONSP, ATOM, ENDP = map(sym, "CONSP ATOM ENDP".split())
PROVING_CLASSES = {
    sym("INTEGER"): [INT_CLASS],
    **dict.fromkeys(SINGLE_TYPES, [SINGLE_CLASS]),
    **dict.fromkeys(DOUBLE_TYPES, [FLOAT_CLASS]),
    sym("FLOAT"): [FLOAT_CLASS, SINGLE_CLASS],
    sym("REAL"): [INT_CLASS, FLOAT_CLASS, SINGLE_CLASS],
    sym("NUMBER"): [INT_CLASS, FLOAT_CLASS, SINGLE_CLASS],
}
"""Types that a comparison of classes proves."""

MOST_TERMS = 32
"""A sum of more terms is a call of the function: written as sums of two, it would take long to compile."""


class OperatorGenerator(ArrayGenerator, NumberGenerator):
    """The part of the `Generator` that makes expressions of calls of standard functions."""

    def Checked(self, node, destination):
        """A value of a declared type: one comparison of classes, and of size for a range of integers, where that proves it."""
        meant = PORTS.types.without_parameters(node.type)
        limits = integer_limits(meant)
        classes = [INT_CLASS] if limits else PROVING_CLASSES.get(meant) if isinstance(meant, LispSymbol) else None
        kind, fits = kind_of(node.value), limits is None
        if classes is not None and not node.entry and exactly(kind, kind_of_type(meant) & MACHINE):
            if fits or node.value.__class__ is nodes.Constant and is_between(node.value.value, limits):
                return self.gen(node.value, destination)
        if node.entry and not node.value.variable.raw:  # its kind is what is to be checked
            name = self.reference(node.value.variable)
            operand, kind = Operand(node.value, ANY, name, name), ANY
        else:
            (operand,) = self.operands([node.value], all_values=True)
        place = [self.constant(node.place)] if node.place is not None else []
        if classes is None:
            value = self.wrapped(operand.first, kind) if operand.raw else operand.first
            return self.finish(self.positioned(self.call("checked", value, self.literal(node.type), *place), node), node, destination)
        value = self.generic(operand)
        slow = self.positioned(self.call("checked", value, self.literal(node.type), *place), node)
        if operand.raw:
            slow = self.unwrapped(slow, 0)
            classes = [FLOAT_CLASS if each is SINGLE_CLASS else each for each in classes if each is not FLOAT_CLASS]
        if not classes:  # it is of another kind for sure
            self.settle([operand])
            return self.finish(slow, node, destination, raw=operand.raw)
        noted, again = self.noted_class(operand.first)
        tests = [expression(IS, again if index else noted, each) for index, each in enumerate(classes)]
        test = tests[0] if len(tests) == 1 else expression(OR, *tests)
        if not fits:
            test = expression(AND, test, expression(word("<="), limits[0], operand.later, *([] if limits[1] is None else limits[1:])))
        if destination.kind == "effect":
            self.emit(word("when"), expression(word("not"), test), slow)
            self.effects += 1
            return None
        return self.finish(expression(IF, test, operand.later, slow), node, destination, raw=operand.raw)

    # --------------------------------------------------------------------------------------------------------------- tests

    def small_test(self, node, symbol, arguments):
        """The Python test of a call of a predicate that has one, or ``None``."""
        if len(arguments) == 1:
            if symbol in SIGNS or symbol in PARITY:
                return self.property_test(node, symbol, arguments)
            if symbol is CONSP:
                return expression(IS, self.class_of(self.value(arguments[0])), word("LCons"))
            if symbol is ATOM:
                return expression(IS_NOT, self.class_of(self.value(arguments[0])), word("LCons"))
            if symbol is ENDP:
                model, name = self.named(arguments[0])
                slow = expression(IS_NOT, self.positioned(expression(word(self.constants.name("function", symbol)), name), node), NONE)
                no_cons = expression(IS_NOT, class_of(model), word("LCons"))
                return expression(AND, no_cons, expression(OR, expression(IS, name, NONE), slow))
        elif symbol in SAME and len(arguments) == 2:
            return self.sameness(arguments)
        return None

    def property_test(self, node, symbol, arguments):
        """The test of the sign of a number, or whether an integer is even."""
        (operand,) = self.operands(arguments)

        def test(value):
            if symbol in SIGNS:
                return expression(SIGNS[symbol], value, 0)
            return expression(word("="), expression(word("%"), value, 2), PARITY[symbol])

        if exactly(operand.kind, MACHINE if symbol in SIGNS else INT):
            return test(operand.first)
        function = word(self.constants.name("function", symbol))
        slow = expression(IS_NOT, self.positioned(expression(function, self.call("one", self.generic(operand))), node), NONE)
        quick = self.real_test(operand) if symbol in SIGNS else expression(IS, self.class_of(operand.first), INT_CLASS)
        return expression(IF, quick, test(operand.later), slow)

    def sameness(self, arguments):
        """``eq`` and ``eql`` with a quoted symbol, a character, or an integer; else ``None``."""
        for index in (1, 0):
            constant = arguments[index]
            if constant.__class__ is not nodes.Constant:
                continue
            value = constant.value
            if value is None or value is False:
                return expression(word("not"), self.test(arguments[1 - index]))
            if value.__class__ is int:
                first, later = self.named(arguments[1 - index])
                if kind_of(arguments[1 - index]) == INT:
                    return expression(word("="), first, value)
                return expression(AND, expression(IS, self.class_of(first), INT_CLASS), expression(word("="), later, value))
            if value is True or value.__class__.__name__ in ("Symbol", "Keyword", "Character"):
                return expression(IS, self.value(arguments[1 - index]), self.literal(value))
        return None

    # --------------------------------------------------------------------------------------------------------------- lists

    def named(self, argument):
        """(first use, later use) of the first value of ``argument``."""
        model = self.value(argument)
        if model.__class__ is Symbol:
            return model, model
        name = word(self.temporary())
        return expression(SETX, name, model), name

    def small_function(self, node, symbol, arguments):
        """The expression of a call of a standard function that has a short one, or ``None``."""
        count = len(arguments)
        if count == 1:
            if symbol in PARTS:
                model, name = self.named(arguments[0])
                slow = self.positioned(expression(word(self.constants.name("function", symbol)), name), node)
                return expression(IF, expression(IS, self.class_of(model), word("LCons")), expression(DOT, name, word(PARTS[symbol])), slow)
            if symbol in KNOWN_PARTS:
                return expression(DOT, self.value(arguments[0]), word(KNOWN_PARTS[symbol]))
        if symbol is CONS and count == 2:
            return expression(word("LCons"), *self.arguments(arguments))
        if symbol is LIST and 0 < count < 5:
            model = NONE
            for item in reversed(self.arguments(arguments)):
                model = expression(word("LCons"), item, model)
            return model
        if symbol in ELEMENTS or symbol is LENGTH:
            return self.element(node, symbol, arguments)
        return None


__all__ = ["ARITHMETIC", "COMPARISONS", "Expression", "OperatorGenerator"]
