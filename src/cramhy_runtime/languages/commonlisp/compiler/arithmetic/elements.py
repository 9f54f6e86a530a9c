"""Elements of arrays: ``aref``, ``svref``, ``elt``, ``length`` and their ``setf``.

A simple vector is a Python list or a `TypedVector`, and an element of it is one subscript behind the tests of the class and the bounds.
Of a simple array with two axes the element is found by its row and its column. Other arrays, and all errors, are the functions' business.

Rows of ``make bench`` without it, as times of the row with it: matrix multiplication by
aref 17.5, the sieve 7.7.
"""

from __future__ import annotations

from ..core import Symbol
from cramhy_runtime.lisp_core.packages import sym

from .. import nodes
from ..core import TRUE, expression, word
from ..generator.output import SINGLE_VALUE
from ..kinds import INT, exactly, never_negative
from ..passes import opens_call, opens_setter
from ..words import AND, DOT, IF, INT_CLASS, IS, OR, class_of
from .operations import generic_call, operands_of, settle

AREF, SVREF, ELT, LENGTH = map(sym, "AREF SVREF ELT LENGTH".split())
ELEMENTS = {AREF, SVREF, ELT}
LESS, GET, VECTOR, TYPED_VECTOR, MATRIX = map(word, "< get Lvector Ltyped_vector Larray".split())
ROWS, COLUMNS, STORAGE = map(word, "rows columns storage".split())


@opens_call("elements", *ELEMENTS, LENGTH)
def _element(generator, node, destination):
    model = element_read(generator, node, node.symbol, node.arguments)
    return None if model is None else (generator.finish(model, node, destination),)


@opens_setter("elements", *ELEMENTS)
def _set_element(generator, node, destination):
    stored = element_written(generator, node)
    return None if stored is None else (generator.finish(stored, SINGLE_VALUE, destination, pure=True),)


def element_read(generator, node, symbol, arguments):
    """The expression of an element, or of a length; ``None`` for other calls."""
    if symbol is LENGTH and len(arguments) == 1:
        (vector,) = operands_of(generator, arguments)
        slow = generator.positioned(
            expression(word(generator.constants.name("function", symbol)), generator.call("one", vector.later)), node
        )
        return expression(IF, expression(IS, class_of(vector.first), VECTOR), generator.call("len", vector.later), slow)
    if symbol not in ELEMENTS or len(arguments) != 2 and (len(arguments) != 3 or symbol is not AREF):
        return None
    operands = operands_of(generator, arguments)
    settle(generator, operands)
    tests, place = element_place(generator, operands)
    function = word(generator.constants.name("function", symbol))
    slow = generator.positioned(expression(function, *(as_argument(generator, operand) for operand in operands)), node)
    if tests is None:
        return slow
    if symbol is not SVREF and len(operands) == 2:
        typed = expression(IS, class_of(operands[0].later), TYPED_VECTOR)
        tests[0] = expression(OR, tests[0], typed)
    return expression(IF, expression(AND, *tests), place, slow)


def as_argument(generator, operand):
    """An operand as an argument of a function, which takes no several values."""
    model = generic_call(generator, operand)
    return generator.call("one", model) if operand.node.__class__ is not nodes.LocalVariable and not operand.node.single else model


def as_arguments(generator, operands):
    """All ``operands`` as arguments of a function."""
    return [as_argument(generator, operand) for operand in operands]


def element_place(generator, operands):
    """(tests, Python's place) of the element of a vector or matrix that ``operands`` mean; (``None``, ``None``) if they cannot."""
    array, *subscripts = operands
    if (
        array.later.__class__ is not Symbol
        or array.later in ("None", "True")
        or any(not each.kind & INT or each.raw for each in subscripts)
    ):
        return None, None
    matrix = len(subscripts) == 2
    tests = [expression(IS, class_of(array.later), MATRIX if matrix else VECTOR)]
    ends = [expression(DOT, array.later, ROWS), expression(DOT, array.later, COLUMNS)]
    if not matrix:
        ends = [generator.call("len", array.later)]
    for subscript, end in zip(subscripts, ends):
        if not exactly(subscript.kind, INT):
            tests.append(expression(IS, class_of(subscript.later), INT_CLASS))
        below = [] if never_negative(subscript.node) else [-1]
        tests.append(expression(LESS, *below, subscript.later, end))
    if not matrix:
        return tests, expression(GET, array.later, subscripts[0].later)
    row, column = (each.later for each in subscripts)
    index = expression(word("+"), expression(word("*"), row, ends[1]), column)
    return tests, expression(GET, expression(DOT, array.later, STORAGE), index)


def element_written(generator, node):
    """Emit the store of an element, if ``node`` is one of a simple kind; the stored value, or ``None``."""
    symbol, arguments = node.symbol, node.arguments
    if symbol not in ELEMENTS or len(arguments) != 3 and (len(arguments) != 4 or symbol is not AREF):
        return None
    new, *others = operands = operands_of(generator, arguments)
    settle(generator, operands)
    tests, place = element_place(generator, others)
    if tests is None:
        tests, place = [TRUE], None
    elif len(others) == 3:
        tests.insert(1, expression(IS, expression(DOT, others[0].later, word("element_type")), TRUE))
    value = generic_call(generator, new)
    if value.__class__ is not Symbol and value.__class__ not in (int, float):
        name = word(generator.temporary())
        generator.emit(word("setv"), name, value)
        value = name
    setter = word(generator.constants.name("setf_function", symbol))
    slow = generator.positioned(expression(setter, value, *(as_argument(generator, operand) for operand in others)), node)
    if place is None:
        generator.out.append(slow)
    else:
        generator.emit(word("if"), expression(AND, *tests), expression(word("setv"), place, value), slow)
    generator.effects += 1
    return value
