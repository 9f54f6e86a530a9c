"""Sums, differences, products and quotients: the openings of ``+ - * / 1+ 1-``.

Rows of ``make bench`` without it, as times of the row with it: (* i 0.5) in a loop 37,
double-float arithmetic in a loop 27, Mandelbrot 17.
"""

from __future__ import annotations

from .. import nodes
from ..kinds import DIVIDE, MINUS, PLUS, STEPS, TIMES, kind_of, raw
from ..passes import opens_call, opens_effect
from .operations import MOST_OPERATIONS, Operation, computed, named_arguments, nested, never_ratio, operands_of, operation_tree
from .quotients import divided, may_fail

MOST_TERMS = 32
"""A sum of more terms is a call of the function: written as sums of two, it would take long to compile."""


@opens_call("arithmetic", PLUS, MINUS, TIMES, DIVIDE)
def _operators(generator, node, destination):
    arguments = node.arguments
    if 2 < len(arguments) <= MOST_TERMS:
        arguments = nested(node)
        if arguments is None:
            return (generator.gen(named_arguments(generator, node), destination),)
    if len(arguments) != 2:
        return None
    model, is_raw = arithmetic_of(generator, node, node.symbol, arguments, destination.raw)
    return (generator.finish(model, node, destination, raw=is_raw),)


@opens_call("arithmetic", *STEPS)
def _steps(generator, node, destination):
    if len(node.arguments) != 1:
        return None
    model, is_raw = arithmetic_of(generator, node, STEPS[node.symbol], [*node.arguments, nodes.Constant(1)], destination.raw)
    return (generator.finish(model, node, destination, raw=is_raw),)


@opens_effect("arithmetic", *STEPS)
def _step_without_value(generator, node, destination):
    if len(node.arguments) != 1:
        return None
    call = nodes.Call(STEPS[node.symbol], [*node.arguments, nodes.Constant(1)])
    call.single, call.position = node.single, node.position
    return (generator.gen(call, destination),)


def arithmetic_of(generator, node, symbol, arguments, wanted_raw):
    """(the expression of a sum, difference, product or quotient of two operands, whether it is raw).

    It may be raw even if that is not wanted, where it is all the same.
    """
    alone = symbol is DIVIDE and not never_ratio(*arguments)
    found = None if alone else operation_tree(generator, node, symbol, arguments, MOST_OPERATIONS)
    operation, leaves = found or operation_tree(generator, node, symbol, arguments, 1)
    operands = operands_of(generator, list(leaves.values()))
    by_key = dict(zip(leaves, operands))

    def filled(part):
        if part.__class__ is not Operation:
            return by_key[part]
        part.parts = list(map(filled, part.parts))
        return part

    filled(operation)
    is_raw = raw(kind_of(node)) and (wanted_raw or all(operand.known for operand in operands))
    if symbol is DIVIDE and may_fail(*operation.parts):
        return divided(generator, operation, operands, is_raw), is_raw
    return computed(generator, operation, operands, is_raw), is_raw
