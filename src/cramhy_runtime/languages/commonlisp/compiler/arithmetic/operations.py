"""Arithmetic: from calls of ``+ - * /`` to Python's operators.

Where the kinds of the operands are known (``kinds.py``) a Python operator stands alone. Where they are not, one test of classes
stands before as many operations as belong together (`fused`), and the generic functions of ``numbers/arithmetic.py`` behind it:
ratios, complex numbers, errors and several values are their business. Numbers stay what they are in Lisp: ``t`` is none although
Python's ``True`` is, a quotient of integers is a ratio, and a product of floats that became infinite is an error, unless it is a
term of a sum of singles.

Singles are raw wherever it is known that a float must be a single. Each operation with them is done in doubles and rounded in place
(`rounded`), and they are wrapped where they leave the expression.
"""

from __future__ import annotations

from ..words import AND, CLASSES, FLOAT_CLASS, IF, INT_CLASS, IS, OR, SETX, SINGLE_CLASS, class_of, fixnum_test, nameable

import sys

from ..core import Symbol
from cramhy_runtime.lisp_core.floats import SingleFloat
from cramhy_runtime.lisp_core.packages import sym

from .. import nodes
from ..core import TRUE, expression, word
from ..destinations import FIRST_OF_VALUES, RAW, VALUE
from ..environment import Variable
from ..kinds import (
    DIVIDE,
    DOUBLE,
    FEW_BITS,
    FIXNUM_BITS,
    FLOATS,
    INT,
    MINUS,
    NUMBER,
    PLUS,
    SINGLE,
    STEPS,
    THING,
    TIMES,
    bits,
    combined,
    exactly,
    kind_of,
    magnitude,
    never_negative,
    raw,
)
from ..loop_shapes import quiet
from .single_rounding import RESULT, rounded, shape_of_product, shape_of_sum

ARITHMETIC = {
    sym(name): word(f"L{function}")
    for name, function in (
        ("+", "add2"),
        ("-", "sub2"),
        ("*", "mul2"),
        ("/", "div2"),
        ("<", "lt2"),
        (">", "gt2"),
        ("<=", "le2"),
        (">=", "ge2"),
        ("=", "num_eq2"),
    )
}
OPERATORS = {PLUS: word("+"), MINUS: word("-"), TIMES: word("*"), DIVIDE: word("/")}

LARGEST = sys.float_info.max
SMALL_INTEGERS = 2**24
"""Integers up to here are single-floats."""
BELOW = word("<=")
MOST_LEAVES, MOST_OPERATIONS = 5, 8
FIXNUM = 1 << 10
"""That what is not known is assumed to be a fixnum, which needs a look at its size as well."""


class Operand:
    """The value of ``node``. ``first`` evaluates it and is used once, ``later`` means the same value afterwards."""

    __slots__ = ("node", "kind", "first", "later", "raw", "size")

    def __init__(self, node, kind, first, later):
        self.node, self.kind, self.first, self.later = node, kind, first, later
        self.raw = raw(kind)
        self.size = bits(node) if kind & INT else 0

    @property
    def known(self):
        """Whether Python's operators may be used without a look at the class."""
        return exactly(self.kind, INT | SINGLE) or exactly(self.kind, INT | DOUBLE)


class Operation:
    """A call of a function of two numbers; ``parts`` are operations and `Operand` objects."""

    __slots__ = ("symbol", "node", "parts")

    def __init__(self, symbol, node, parts):
        self.symbol, self.node, self.parts = symbol, node, parts


def bare(symbol, one, other, size, other_size):
    """The kind of ``one symbol other`` if Python's operator gives it, both operands being `Operand.known`; else 0."""
    if symbol is DIVIDE and one & other & INT:
        return 0
    both = one | other
    if both & FLOATS and max(size, other_size) > FEW_BITS:
        return 0
    if both & SINGLE and (DOUBLE if both & DOUBLE else SINGLE) not in (one, other):
        return 0  # nobody would know whether the result is to be rounded
    return combined(one, other)


def noted_class(model):
    """(first use, later use) of the class of the value of ``model``."""
    return expression(SETX, CLASSES, class_of(model)), CLASSES


def operands_of(generator, arguments, all_values=False):
    """The `Operand` of each of ``arguments``: an expression that is not simple is named by its first use.

    Several values are left in where the kind is unknown: the generic functions take the first.
    """
    kinds = [kind_of(argument) for argument in arguments]
    wanted = [RAW if raw(kind) else FIRST_OF_VALUES if all_values or not exactly(kind, NUMBER) else VALUE for kind in kinds]
    models = generator.arguments(arguments, wanted)
    found = []
    for index, (model, node) in enumerate(zip(models, arguments)):
        simple = nameable(model)
        if simple and node.__class__ is nodes.LocalVariable and node.variable.captured and node.variable.assigned:
            simple = all(map(nameable, models[index + 1 :]))  # else a later operand may change it
        if simple:
            first = later = model
        else:
            later = word(generator.temporary())
            first = expression(SETX, later, model)
        found.append(Operand(node, kinds[index], first, later))
    return found


def named_value(generator, argument):
    """(first use, later use) of the first value of ``argument``."""
    model = generator.value(argument)
    if model.__class__ is Symbol:
        return model, model
    name = word(generator.temporary())
    return expression(SETX, name, model), name


def known_function(generator, symbol):
    """The function of ``symbol``, a standard one."""
    return word(generator.constants.name("function", symbol))


def settle(generator, operands):
    """Evaluate by statements all ``operands`` that are not simple."""
    for operand in operands:
        if operand.first is not operand.later:
            generator.emit(word("setv"), operand.later, operand.first[2])
            operand.first = operand.later


def settle_all_but(generator, tested, operands):
    """Settle ``operands`` unless a test that compares the classes of ``tested`` in turn evaluates all that are not simple."""
    if any(operand.first is not operand.later and operand not in tested[:2] for operand in operands):
        settle(generator, operands)


def generic_call(generator, part):
    """The call of the generic functions that ``part`` means, with what Lisp sees."""
    if part.__class__ is Operand:
        return generator.wrapped(part.later, part.kind) if part.raw else part.later
    return generator.positioned(expression(ARITHMETIC[part.symbol], *[generic_call(generator, each) for each in part.parts]), part.node)


def operation_tree(generator, node, symbol, arguments, most):
    """(the `Operation` of ``node``, key → node of its leaves), or ``None`` if they are too many, or would be evaluated too early.

    Leaves are named by keys: a variable by itself, so that it is tested once.
    """
    leaves, count, done, failed, changed = {}, 1, False, False, False

    def leaf(item):
        nonlocal failed, changed
        kind = item.__class__
        if kind is nodes.LocalVariable and not item.variable.boxed and not (changed and item.variable.assigned):
            key = item.variable
        else:
            key = object()
            failed = failed or done and kind is not nodes.Constant  # the operations before it must be over
            changed = changed or not quiet(item)
        leaves[key] = item
        return key

    def part(item):
        nonlocal count, done
        if count < most and item.__class__ is nodes.Call:
            operator, operands = operation_in(generator, item)
            if operator is not None:
                count += 1
                parts = list(map(part, operands))
                done = True
                return Operation(operator, item, parts)
        return leaf(item)

    operation = Operation(symbol, node, list(map(part, arguments)))
    if failed or most > 1 and (sum(item.__class__ is not nodes.Constant for item in leaves.values()) > MOST_LEAVES or count == 1):
        return None
    return operation, leaves


def operation_in(generator, item):
    """(operator, its two operands) of a call that may be part of a larger one; (``None``, ``None``) of others."""
    symbol, arguments = item.symbol, item.arguments
    if symbol in STEPS and len(arguments) == 1:
        return STEPS[symbol], [*arguments, nodes.Constant(1)]
    if symbol not in OPERATORS:
        return None, None
    if len(arguments) > 2:
        arguments = nested(item)
    if arguments is None or len(arguments) != 2 or symbol is DIVIDE and not never_ratio(*arguments):
        return None, None
    return symbol, arguments


def nested(node):
    """The two operands that a call with more means, if all is evaluated in the same order then; else ``None``."""
    first, second, *others = node.arguments
    sums = node.symbol is PLUS or node.symbol is MINUS
    sure = sums and exactly(kind_of(first), NUMBER) and exactly(kind_of(second), NUMBER)
    for other in others:
        if not (nameable_node(other) or sure and exactly(kind_of(other), NUMBER)):
            return None
    inner = node
    for other in (second, *others[:-1]):
        first = nodes.Call(node.symbol, [first, other])
        first.single, first.position = True, inner.position
    return [first, others[-1]]


def named_arguments(generator, node):
    """A node that evaluates the arguments of the call ``node`` before it calls, each into a variable of its own."""
    bindings, arguments = [], []
    for argument in node.arguments:
        if argument.__class__ is not nodes.Constant:
            variable = Variable(node.symbol, generator.scope, generator.temporary())
            variable.kind, variable.reads, variable.values = kind_of(argument), 1, [argument]
            variable.raw = bool(raw(variable.kind))
            bindings.append((variable, argument))
            argument = nodes.LocalVariable(variable)
        arguments.append(argument)
    call = nodes.Call(node.symbol, arguments)
    call.single, call.boolean, call.position = True, node.boolean, node.position
    let = nodes.Let(bindings, call)
    let.single, let.boolean = True, node.boolean
    return let


def computed(generator, operation, operands, is_raw):
    """The expression of ``operation``: bare if all is known, else behind tests of the classes of what is not."""
    unknown = [operand for operand in operands if not operand.known]
    generic = generic_call(generator, operation)
    if any(operand.kind and not operand.kind & (NUMBER | THING) for operand in operands):
        settle(generator, operands)
        return generator.unwrapped(generic, 0) if is_raw else generic
    slow = generator.unwrapped(generic, 0) if is_raw else generic
    if not unknown:
        kind = kind_in(generator, operation, 0)
        if not kind:
            settle(generator, operands)
            return slow
        used = set()
        model = bare_model(generator, operation, 0, used)
        if needs_check(generator, operation, kind):
            return finite_or(generator, TRUE, model, slow)
        return model
    if len(operation.parts) == 2 and operation.parts[0].__class__ is operation.parts[1].__class__ is Operand:
        model = sum_of_numbers(generator, operation, operands)
        if model is not None:
            return generator.unwrapped(model, 0) if is_raw else model
    worlds = worlds_of(generator, operation, operands, unknown, is_raw)
    if not worlds:
        settle(generator, operands)
        return slow
    settle_all_but(generator, unknown, operands)
    return chosen_world(generator, operation, unknown, worlds, slow, is_raw)


def worlds_of(generator, operation, operands, unknown, is_raw):
    """The classes that all ``unknown`` operands may be of so that Python's operators do: (class bits, kind of the result)."""
    if any(operand.raw for operand in unknown):  # a float is a single, which no test of all their classes says at once
        return [(SINGLE, SINGLE)] if len(unknown) == 1 and kind_in(generator, operation, SINGLE) == SINGLE else []
    known = 0
    for operand in operands:
        if operand.known and operand.later.__class__ is not int:
            known |= operand.kind
    count = sum(1 for _ in operations_of(operation))
    products = any(each.symbol is TIMES for each in operations_of(operation))
    if known & FLOATS:
        order = (DOUBLE,) if known & DOUBLE else (SINGLE, DOUBLE)
        if len(unknown) == 1:
            order = (*order, FIXNUM)
    elif known:
        order = (INT,)
    else:
        simple = all(operand.first is operand.later for operand in operands)
        order = (DOUBLE, INT, SINGLE) if products and count > 1 and simple else (INT, DOUBLE, SINGLE)
    found = []
    for assumed in order:
        kind = kind_in(generator, operation, assumed)
        if kind and bool(raw(kind)) >= bool(is_raw):
            found.append((assumed, kind))
    return found


def chosen_world(generator, operation, unknown, worlds, slow, is_raw):
    """The bare expression of the first of ``worlds`` that the classes of ``unknown`` make, or ``slow``."""
    tests = [class_of(operand.first) for operand in unknown]
    again = [class_of(operand.later) for operand in unknown]
    both = [assumed for assumed, _ in worlds[:2]] == [INT, DOUBLE]  # in this order: see `worlds`
    checked = [needs_check(generator, operation, kind) for _, kind in worlds]
    if both and not any(checked[:2]):
        noted = expression(SETX, CLASSES, tests[0])
        either = expression(OR, expression(IS, CLASSES, INT_CLASS), expression(IS, CLASSES, FLOAT_CLASS))
        if len(tests) == 1:
            either[1] = expression(IS, noted, INT_CLASS)
            guard = either
        else:
            guard = expression(AND, expression(IS, noted, *tests[1:]), either)
        rest = chosen_from(generator, operation, unknown, worlds[2:], again, again, slow, is_raw)
        return expression(IF, guard, bare_model(generator, operation, INT, None), rest)
    return chosen_from(generator, operation, unknown, worlds, tests, again, slow, is_raw)


def chosen_from(generator, operation, unknown, worlds, tests, again, slow, is_raw):
    if not worlds:
        return slow
    (assumed, kind), *others = worlds
    rest = chosen_from(generator, operation, unknown, others, again, again, slow, is_raw)
    if assumed == DOUBLE and tests is again and operation.symbol is not TIMES:
        certain = [each for each, operand in zip(tests, unknown) if not exactly(operand.kind, NUMBER)]
        tests = certain or tests  # what is a number becomes a float with floats
    elif assumed == DOUBLE and operation.symbol is not TIMES and all(operand.first is operand.later for operand in unknown):
        certain = [each for each, operand in zip(tests, unknown) if not exactly(operand.kind, NUMBER)]
        tests = certain or tests
    guard = world_test(assumed, tests, unknown)
    model = bare_model(generator, operation, assumed, None)
    if needs_check(generator, operation, kind):
        inside = finite_test(model)
        model = RESULT if not raw(kind) or is_raw else generator.wrapped(RESULT, kind)
        return expression(IF, expression(AND, guard, *inside), model, rest)
    if raw(kind) and not is_raw:
        model = generator.wrapped(model, kind)
    return expression(IF, guard, model, rest)


def world_test(assumed, classes, unknown):
    """A test that the ``classes`` of the ``unknown`` operands are the assumed one."""
    if assumed == FIXNUM:
        return expression(AND, expression(IS, *classes, INT_CLASS), fixnum_test(unknown[0].later))
    of_class = FLOAT_CLASS if unknown[0].raw else {INT: INT_CLASS, SINGLE: SINGLE_CLASS, DOUBLE: FLOAT_CLASS}[assumed]
    if all(each[1].__class__ is Symbol for each in classes if each.__class__ is not Symbol):
        return expression(IS, of_class, *classes)  # it fails at the first
    return expression(IS, *classes, of_class)


def kind_in(generator, part, assumed):
    """The kind of ``part`` when all unknown operands are of the class ``assumed`` and Python's operators give it; else 0."""
    return _kind_and_size(generator, part, assumed)[0]


def _kind_and_size(generator, part, assumed):
    if part.__class__ is Operand:
        if part.known:
            return part.kind, part.size
        return (INT, FIXNUM_BITS) if assumed == FIXNUM else (assumed, FEW_BITS + 1 if assumed == INT else 0)
    (one, size), (other, other_size) = (_kind_and_size(generator, each, assumed) for each in part.parts)
    kind = one and other and bare(part.symbol, one, other, size, other_size)
    return kind, size + other_size + 2 if kind & INT else 0


def bare_model(generator, part, assumed, used, floats=None):
    """The expression of Python's operators. ``used``: the operands that have been evaluated, or ``None`` if all have.

    ``floats``: the names of operands that have been made raw, which is done once in the whole expression.
    """
    if part.__class__ is Operand:
        if used is None or part in used:
            model = part.later
        else:
            used.add(part)
            model = part.first
        return model if assumed != SINGLE or part.known or part.raw else float_once(generator, part, model, floats)
    if floats is None:
        floats = {}
        operands = [each for operation in operations_of(part) for each in operation.parts if each.__class__ is Operand]
        floats.update((each, None) for each in operands if operands.count(each) > 1)
    models = [bare_model(generator, each, assumed, used, floats) for each in part.parts]
    if kind_in(generator, part, assumed) != SINGLE:
        return expression(OPERATORS[part.symbol], *models)
    for index, each in enumerate(part.parts):
        kind, size = _kind_and_size(generator, each, assumed)
        if kind & INT and size > 24:  # a single may not hold it exactly
            exact = generator.call("in_single", models[index])
            if nameable(models[index]):
                below = [] if never_negative(each.node) else [-SMALL_INTEGERS]
                exact = expression(IF, expression(BELOW, *below, models[index], SMALL_INTEGERS), models[index], exact)
            models[index] = exact
    slow = None
    if part.parts[0].__class__ is part.parts[1].__class__ is Operand:
        slow = generator.unwrapped(generic_call(generator, part), SINGLE)
    shaping = {TIMES: shape_of_product, PLUS: shape_of_sum}.get(part.symbol)
    shape = shaping and shaping(part.parts[0].node, part.parts[1].node)
    return rounded(expression(OPERATORS[part.symbol], *models), part.symbol is TIMES or part.symbol is DIVIDE, slow, shape)


def float_once(generator, operand, model, floats):
    """The raw value of ``operand``, a single; with a name, if ``floats`` says that it is used again."""
    raw_model = generator.call("float", model)
    if operand not in floats:
        return raw_model
    if floats[operand] is None:
        floats[operand] = word(generator.temporary())
        return expression(SETX, floats[operand], raw_model)
    return floats[operand]


def needs_check(generator, operation, kind):
    """Whether a result of ``kind`` may be infinite because of a product."""
    if not kind & DOUBLE:
        return False
    products = [each for each in operations_of(operation) if each.symbol is TIMES]
    if len(products) == 1 and all(each.__class__ is Operand for each in products[0].parts):
        return sum(magnitude(each.node) for each in products[0].parts) > FEW_BITS
    return bool(products)


def finite_test(model):
    """The tests that ``model``, which they note as the result, is finite."""
    return [expression(BELOW, -LARGEST, expression(SETX, RESULT, model), LARGEST)]


def finite_or(generator, guard, model, slow):
    """``model`` if ``guard`` holds and it is finite, else what the generic functions say to it."""
    tests = finite_test(model)
    if guard is not TRUE:
        tests.insert(0, guard)
    return expression(IF, tests[0] if len(tests) == 1 else expression(AND, *tests), RESULT, slow)


def sum_of_numbers(generator, operation, operands):
    """A sum or difference of which one operand surely is a number: with an integer or a float it needs no other test.

    (A ratio plus an integer is never whole, and contagion to a float or a double is Python's too.)
    """
    if operation.symbol is not PLUS and operation.symbol is not MINUS or len(operands) < 2:
        return None
    one, other = operation.parts
    if one.known or other.known or one.raw or other.raw:
        return None
    slow = generic_call(generator, operation)
    if exactly(one.kind, NUMBER) and one.first is one.later:
        tested, models = other, [one.later, other.later]
    elif exactly(other.kind, NUMBER):
        tested, models = one, [one.later, other.first]
        if other.first is not other.later:
            slow = generator.positioned(expression(ARITHMETIC[operation.symbol], one.later, other.first), operation.node)
    else:
        return None
    noted, again = noted_class(tested.first)
    test = expression(OR, expression(IS, noted, INT_CLASS), expression(IS, again, FLOAT_CLASS))
    return expression(IF, test, expression(OPERATORS[operation.symbol], *models), slow)


def nameable_node(node):
    """Whether evaluating ``node`` does nothing and cannot fail."""
    if node.__class__ is nodes.LocalVariable:
        return not (node.variable.captured and node.variable.assigned)
    return node.__class__ is nodes.Constant


def never_ratio(node, divisor):
    """Whether a quotient fails nowhere and is not one of integers."""
    return _certain_divisor(divisor) and not (divisor.value.__class__ is int and kind_of(node) & INT)


def _certain_divisor(node):
    return node.__class__ is nodes.Constant and node.value.__class__ in (int, float, SingleFloat) and node.value != 0


def operations_of(part):
    """All operations in ``part``."""
    if part.__class__ is Operation:
        yield part
        for each in part.parts:
            yield from operations_of(each)
