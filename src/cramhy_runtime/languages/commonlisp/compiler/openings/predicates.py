"""Predicates: ``not``, ``zerop``, ``evenp``, ``consp``, ``eq`` and their like as Python's tests.

Rows of ``make bench`` without it, as times of the row with it: Collatz 2.6, loop collect
when 2.0, destructuring-bind 2.0.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.packages import sym

from .. import nodes
from ..arithmetic.comparisons import COMPARISONS, real_test
from ..arithmetic.operations import generic_call, named_value, operands_of
from ..core import NONE, expression, word
from ..kinds import INT, MACHINE, exactly, kind_of
from ..passes import opens_test
from ..words import AND, IF, INT_CLASS, IS, IS_NOT, OR, class_of

SIGNS = {sym("ZEROP"): COMPARISONS[sym("=")], sym("PLUSP"): COMPARISONS[sym(">")], sym("MINUSP"): COMPARISONS[sym("<")]}
PARITY = {sym("EVENP"): 0, sym("ODDP"): 1}
SAME = {sym("EQ"), sym("EQL")}
NEGATIONS = {sym("NOT"), sym("NULL")}
CONSP, ATOM, ENDP = map(sym, "CONSP ATOM ENDP".split())


@opens_test("predicates", *NEGATIONS, effect=True)
def _negation(generator, node):
    return expression(word("not"), generator.test(node.arguments[0])) if len(node.arguments) == 1 else None


@opens_test("predicates", *SIGNS, *PARITY)
def _property(generator, node):
    return property_test(generator, node, node.symbol, node.arguments) if len(node.arguments) == 1 else None


@opens_test("predicates", CONSP, ATOM)
def _consp(generator, node):
    if len(node.arguments) != 1:
        return None
    model = class_of(generator.value(node.arguments[0]))
    return expression(IS if node.symbol is CONSP else IS_NOT, model, word("LCons"))


@opens_test("predicates", ENDP)
def _endp(generator, node):
    if len(node.arguments) != 1:
        return None
    model, name = named_value(generator, node.arguments[0])
    slow = expression(IS_NOT, generator.positioned(expression(word(generator.constants.name("function", ENDP)), name), node), NONE)
    no_cons = expression(IS_NOT, class_of(model), word("LCons"))
    return expression(AND, no_cons, expression(OR, expression(IS, name, NONE), slow))


@opens_test("predicates", *SAME)
def _same(generator, node):
    return sameness_test(generator, node.arguments) if len(node.arguments) == 2 else None


def property_test(generator, node, symbol, arguments):
    """The test of the sign of a number, or whether an integer is even."""
    (operand,) = operands_of(generator, arguments)

    def test(value):
        if symbol in SIGNS:
            return expression(SIGNS[symbol], value, 0)
        return expression(word("="), expression(word("%"), value, 2), PARITY[symbol])

    if exactly(operand.kind, MACHINE if symbol in SIGNS else INT):
        return test(operand.first)
    function = word(generator.constants.name("function", symbol))
    slow = expression(
        IS_NOT, generator.positioned(expression(function, generator.call("one", generic_call(generator, operand))), node), NONE
    )
    quick = real_test(generator, operand) if symbol in SIGNS else expression(IS, class_of(operand.first), INT_CLASS)
    return expression(IF, quick, test(operand.later), slow)


def sameness_test(generator, arguments):
    """``eq`` and ``eql`` with a quoted symbol, a character, or an integer; else ``None``."""
    for index in (1, 0):
        constant = arguments[index]
        if constant.__class__ is not nodes.Constant:
            continue
        value = constant.value
        if value is None or value is False:
            return expression(word("not"), generator.test(arguments[1 - index]))
        if value.__class__ is int:
            first, later = named_value(generator, arguments[1 - index])
            if kind_of(arguments[1 - index]) == INT:
                return expression(word("="), first, value)
            return expression(AND, expression(IS, class_of(first), INT_CLASS), expression(word("="), later, value))
        if value is True or value.__class__.__name__ in ("Symbol", "Keyword", "Character"):
            return expression(IS, generator.value(arguments[1 - index]), generator.literal(value))
    return None
