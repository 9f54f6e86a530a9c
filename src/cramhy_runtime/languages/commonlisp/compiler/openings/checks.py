"""Declared types: one comparison of classes in place of a call, where that proves the type.

Rows of ``make bench`` without it, as times of the row with it: queens 1.09, matrices of
double-floats 1.07.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import Symbol as LispSymbol
from cramhy_runtime.lisp_core.packages import sym
from cramhy_runtime.lisp_core.ports import PORTS

from .. import nodes
from ..arithmetic.operations import Operand, generic_call, noted_class, operands_of, settle
from ..core import expression, word
from ..declared_types import integer_limits, is_between
from ..generator.output import GENERATORS
from ..kinds import ANY, DOUBLE_TYPES, MACHINE, SINGLE_TYPES, exactly, kind_of, kind_of_type
from ..passes import opens_node
from ..words import AND, FLOAT_CLASS, IF, INT_CLASS, IS, OR, SINGLE_CLASS

PROVING_CLASSES = {
    sym("INTEGER"): [INT_CLASS],
    **dict.fromkeys(SINGLE_TYPES, [SINGLE_CLASS]),
    **dict.fromkeys(DOUBLE_TYPES, [FLOAT_CLASS]),
    sym("FLOAT"): [FLOAT_CLASS, SINGLE_CLASS],
    sym("REAL"): [INT_CLASS, FLOAT_CLASS, SINGLE_CLASS],
    sym("NUMBER"): [INT_CLASS, FLOAT_CLASS, SINGLE_CLASS],
}
"""Types that a comparison of classes proves."""


@opens_node("checks", GENERATORS, nodes.Checked)
def _checked(generator, node, destination):
    return (checked_value(generator, node, destination),)


def checked_value(generator, node, destination):
    """A value of a declared type: one comparison of classes, and of size for a range of integers, where that proves it."""
    meant = PORTS.types.without_parameters(node.type)
    limits = integer_limits(meant)
    classes = [INT_CLASS] if limits else PROVING_CLASSES.get(meant) if isinstance(meant, LispSymbol) else None
    kind, fits = kind_of(node.value), limits is None
    if classes is not None and not node.entry and exactly(kind, kind_of_type(meant) & MACHINE):
        if fits or node.value.__class__ is nodes.Constant and is_between(node.value.value, limits):
            return generator.gen(node.value, destination)
    if node.entry and not node.value.variable.raw:  # its kind is what is to be checked
        name = generator.reference(node.value.variable)
        operand, kind = Operand(node.value, ANY, name, name), ANY
    else:
        (operand,) = operands_of(generator, [node.value], all_values=True)
    place = [generator.constant(node.place)] if node.place is not None else []
    if classes is None:
        value = generator.wrapped(operand.first, kind) if operand.raw else operand.first
        return generator.finish(
            generator.positioned(generator.call("checked", value, generator.literal(node.type), *place), node), node, destination
        )
    value = generic_call(generator, operand)
    slow = generator.positioned(generator.call("checked", value, generator.literal(node.type), *place), node)
    if operand.raw:
        slow = generator.unwrapped(slow, 0)
        classes = [FLOAT_CLASS if each is SINGLE_CLASS else each for each in classes if each is not FLOAT_CLASS]
    if not classes:  # it is of another kind for sure
        settle(generator, [operand])
        return generator.finish(slow, node, destination, raw=operand.raw)
    noted, again = noted_class(operand.first)
    tests = [expression(IS, again if index else noted, each) for index, each in enumerate(classes)]
    test = tests[0] if len(tests) == 1 else expression(OR, *tests)
    if not fits:
        test = expression(AND, test, expression(word("<="), limits[0], operand.later, *([] if limits[1] is None else limits[1:])))
    if destination.kind == "effect":
        generator.emit(word("when"), expression(word("not"), test), slow)
        generator.effects += 1
        return None
    return generator.finish(expression(IF, test, operand.later, slow), node, destination, raw=operand.raw)
