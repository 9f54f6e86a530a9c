"""Several values are taken apart where they are made, if that can be seen (``several_values.py``).

Rows of ``make bench`` without it, as times of the row with it: several values 1.9.
"""

from __future__ import annotations

from .. import core, nodes
from ..arithmetic.elements import as_arguments
from ..arithmetic.functions import FLOOR, TRUNCATE
from ..arithmetic.operations import known_function, named_value, operands_of, settle
from ..core import NONE, TRUE, Tuple, expression, word
from ..facts import walk
from ..destinations import RETURN, Destination
from ..generator.functions import definition
from ..generator.output import SINGLE_VALUE
from ..kinds import INT, exactly, kind_of, raw
from ..passes import FUNCTIONS, opens, opens_call
from ..passes import VALUES as IN_PLACE
from ..several_values import VALUES, gives_tuple, values_calls
from ..words import AND, DOT, IF, INT_CLASS, IS, SETX, class_of


LARGEST = 60
"""The most nodes of a body that is made twice. In a larger one, or one that loops, 120 ns do not count."""


def gives_several(node):
    """Whether the `Lambda` ``node`` is made twice."""
    if not _ends_in_values(node.body) or node.scope.loops:
        return False
    return sum(1 for _ in walk([node.body])) <= LARGEST


def _ends_in_values(node):
    kind = node.__class__
    if kind is nodes.Call:
        return node.symbol is VALUES and len(node.arguments) > 1
    if kind is nodes.If:
        return _ends_in_values(node.then) or _ends_in_values(node.otherwise)
    if kind is nodes.Progn:
        return _ends_in_values(node.forms[-1])
    if kind is nodes.BlockNode:
        return any(map(_ends_in_values, (node.body, *node.block.values)))
    return kind in (nodes.Let, nodes.Functions, nodes.MultipleValueBind) and _ends_in_values(node.body)


def tuple_of_values(generator, model):
    """A tuple of all values of ``model``."""
    if model.__class__ is not core.Expression:
        return generator.call("all_values", model) if model.__class__ is core.Symbol and model not in (NONE, TRUE) else Tuple([model])
    if model[0] == "LMultipleValues":
        return model[1]
    if model[0] == IF:
        return expression(IF, model[1], *[tuple_of_values(generator, each) for each in model[2:]])
    return generator.call("all_values", model)


RETURN_TUPLE = Destination("return", multiple=True, through=tuple_of_values)
"""The values are returned as a tuple."""


@opens("several-values", FUNCTIONS)
def _function_twice(generator, node, name, given):
    """A function whose body ends in ``values``: as every function is, and so that it returns its values as a tuple."""
    if not (node.everywhere and gives_several(node)):
        return None
    other = generator.scope.unique("Lother")
    generator.assign(other, definition(generator, node, name, given, RETURN_TUPLE))
    definition(generator, node, name, given, RETURN)
    generator.out.append(generator.call("beside", word(name), word(other)))
    return word(name)


@opens_call("several-values", VALUES)
def _values(generator, node, destination):
    if len(node.arguments) < 2:
        return None
    if destination.multiple:
        model = expression(word("LMultipleValues"), Tuple(generator.arguments(node.arguments)))
    else:
        (model, *_) = generator.stable_names(generator.arguments(node.arguments))
    return (generator.finish(model, SINGLE_VALUE, destination),)


@opens_call("several-values", FLOOR)
def _floor(generator, node, destination):
    """Both values of a quotient by a constant, an integer."""
    if len(node.arguments) != 2 or not destination.multiple or not _is_number(node.arguments[1]):
        return None
    divisor = node.arguments[1].value
    number, name = named_value(generator, node.arguments[0])
    slow = generator.positioned(expression(known_function(generator, FLOOR), name, divisor), node)
    quick = expression(word("LMultipleValues"), generator.call("divmod", name, divisor))
    return (generator.finish(expression(IF, expression(IS, class_of(number), INT_CLASS), quick, slow), SINGLE_VALUE, destination),)


@opens("several-values", IN_PLACE)
def values_in_place(generator, names, node):
    """A Python tuple of as many values of ``node``, a call of a function that gives them, as there are ``names``; or ``None``."""
    if node.__class__ is not nodes.Call:
        return None
    symbol, arguments, wanted = node.symbol, node.arguments, len(names)
    if symbol is VALUES and arguments:
        models = generator.arguments(arguments)
        if len(models) > wanted:
            models = generator.stable_names(models)[:wanted]
        models += [NONE] * (wanted - len(models))
        return Tuple(models) if wanted > 1 else models[0]
    if wanted == 2 and (symbol is FLOOR or symbol is TRUNCATE) and len(arguments) == 2:
        return quotient_and_rest(generator, node, symbol, arguments)
    return None


@opens("several-values", IN_PLACE)
def _values_of_function(generator, names, node):
    """The values of a function that has another one beside it, which returns them as a tuple."""
    if len(names) < 2 or node.__class__ is not nodes.Call or not gives_tuple(node.symbol):
        return None
    function = expression(DOT, generator.constant(values_calls(node.symbol)), word("call"))
    call = generator.positioned(expression(function, *generator.arguments(node.arguments)), node)
    values = word(generator.temporary())
    fits = expression(word("="), generator.call("len", expression(SETX, values, call)), len(names))
    return expression(IF, fits, values, generator.call("first_of", values, len(names)))


def quotient_and_rest(generator, node, symbol, arguments):
    """Both values of ``floor`` or ``truncate`` of two arguments, as a tuple: Python's ``divmod``, where that gives the same."""
    if not all(kind_of(argument) & INT and not raw(kind_of(argument)) for argument in arguments):
        return None
    operands = number, divisor = operands_of(generator, arguments)
    settle(generator, operands)
    tests = [expression(IS, class_of(each.later), INT_CLASS) for each in operands if not exactly(each.kind, INT)]
    certain = _is_number(divisor.node) and (symbol is FLOOR or divisor.node.value > 0)
    if symbol is TRUNCATE:
        tests.append(expression(word("<="), 0, number.later))
    if not certain:
        tests.append(expression(word("!=" if symbol is FLOOR else "<"), 0, divisor.later))
    quick = generator.call("divmod", number.later, divisor.later)
    if not tests:
        return quick
    call = generator.positioned(expression(known_function(generator, symbol), *as_arguments(generator, operands)), node)
    return expression(IF, tests[0] if len(tests) == 1 else expression(AND, *tests), quick, generator.call("spread", call, 2))


def _is_number(node):
    """Whether ``node`` is an integer that one can divide by."""
    return node.__class__ is nodes.Constant and node.value.__class__ is int and node.value != 0
