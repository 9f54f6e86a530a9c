"""Quotients: ``/`` of two operands, where the divisor may be zero and a quotient of integers is a ratio, unless it is whole."""

from __future__ import annotations

from ..core import expression, word
from ..kinds import DIVIDE, DOUBLE, FLOATS, INT, NUMBER, SINGLE, THING, exactly, raw
from ..words import AND, IF, INT_CLASS, IS, class_of
from .operations import ARITHMETIC, FIXNUM, Operand, Operation, bare_model, generic_call, kind_in, settle, world_test

OVER, WHOLE_OVER, REST, NOT = map(word, "/ // % not".split())


def may_fail(one, other):
    """Whether a quotient needs a look at the numbers: at the divisor for zero, at integers for a ratio."""
    if other.__class__ is Operand and other.later.__class__ in (int, float) and other.later:
        return one.__class__ is Operand and one.kind & INT and exactly(other.kind, INT) and not one.raw
    return True


def divided(generator, operation, operands, is_raw):
    """A quotient by what is not a constant, or of integers."""
    one, other = operation.parts
    generic = generic_call(generator, operation)
    slow = generator.unwrapped(generic, 0) if is_raw else generic
    unknown = [operand for operand in operands if not operand.known]
    zero = other.later.__class__ in (int, float) and not other.later
    if len(operands) < 2 or zero or any(operand.kind and not operand.kind & (NUMBER | THING) for operand in operands):
        settle(generator, operands)
        return slow
    if not unknown and kind_in(generator, operation, 0):
        return known_quotient(generator, operation, operands, is_raw, slow)
    settle(generator, operands)
    if all(operand.kind & INT and not operand.raw for operand in operands):
        slow = whole_quotient(generator, one, other, unknown, slow)
    known = 0
    for operand in operands:
        if operand.known:
            known |= operand.kind
    if not unknown:
        return slow
    if any(operand.raw for operand in unknown):
        return slow
    worlds = (DOUBLE, SINGLE)
    if known & FLOATS:
        worlds = (*((DOUBLE,) if known & DOUBLE else (SINGLE, DOUBLE)), *((FIXNUM,) if len(unknown) == 1 else ()))
    for assumed in reversed(worlds):
        kind = kind_in(generator, operation, assumed)
        if kind and raw(kind) >= is_raw:
            test = world_test(assumed, [class_of(operand.later) for operand in unknown], unknown)
            model = bare_model(generator, operation, assumed, None)
            if raw(kind) and not is_raw:
                model = generator.wrapped(model, kind)
            slow = expression(IF, nonzero([test], other), model, slow)
    return slow


def nonzero(tests, divisor):
    """A test that all of ``tests`` hold and the divisor is not 0."""
    if divisor.later.__class__ not in (int, float):
        tests = [*tests, divisor.later]
    return tests[0] if len(tests) == 1 else expression(AND, *tests)


def whole_quotient(generator, one, other, unknown, slow):
    """The quotient of two integers, of which ``unknown`` are yet to be tested, if it is whole."""
    tests = [expression(IS, *(class_of(operand.later) for operand in unknown), INT_CLASS)] if unknown else []
    if other.later.__class__ is not int:
        tests.append(other.later)
    tests.append(expression(NOT, expression(REST, one.later, other.later)))
    return expression(IF, tests[0] if len(tests) == 1 else expression(AND, *tests), expression(WHOLE_OVER, one.later, other.later), slow)


def known_quotient(generator, operation, operands, is_raw, slow):
    """A quotient of a float by what is not 0. What is divided may be an operation of its own."""
    one, other = operation.parts
    if one.__class__ is Operation or kind_in(generator, operation, 0) == SINGLE:
        settle(generator, operands)
        return expression(IF, other.later, bare_model(generator, operation, 0, None), slow)
    if one.first is not one.later and other.first is not other.later:
        settle(generator, [one, other])
    elif one.first is not one.later:  # the divisor is asked first; only one of the branches is run
        dividend = generator.wrapped(one.first, one.kind) if one.raw else one.first
        slow = generator.positioned(expression(ARITHMETIC[DIVIDE], dividend, generic_call(generator, other)), operation.node)
        slow = generator.unwrapped(slow, 0) if is_raw else slow
    return expression(IF, other.first, expression(OVER, one.first, other.later), slow)
