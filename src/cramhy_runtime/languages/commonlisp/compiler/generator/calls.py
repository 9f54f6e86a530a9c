"""Calls: of global and local functions, of the values of forms, and of setters."""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import Symbol
from cramhy_runtime.lisp_core.packages import CRAMHY, is_symbol, sym

from .. import core, nodes
from ..core import expression, word
from ..destinations import VALUES
from ..passes import CALL_TESTS, CALLS, EFFECTS, GENERAL_CALLS, GENERAL_SETTERS, SETTERS
from .output import generates, makes_test, test_of_value

KNOWN_SETTERS = {sym(name) for name in "GETHASH AREF SVREF ELT NTH GET CHAR".split()}
"""Functions of Common Lisp whose ``setf`` is a function, which nobody may redefine or give methods."""


@generates(nodes.Call)
def _call(generator, node, destination):
    symbol = node.symbol
    for opening in (EFFECTS if destination.kind == "effect" else CALLS).get(symbol, ()):
        done = opening(generator, node, destination)
        if done is not None:
            return done[0]
    models = generator.arguments(node.arguments)
    for opening in GENERAL_CALLS:
        found = opening(generator, node, models)
        if found is not None:
            return generator.finish(*found, destination)
    if generator.standard(symbol) or generator.standard(symbol, CRAMHY):
        model = expression(word(generator.constants.name("function", symbol)), *models)
    elif is_symbol(symbol) and not isinstance(symbol, Symbol):
        model = generator.call("undefined", generator.constant(symbol), *models)
    else:  # named, because Python takes longer to call an attribute of an object with slots
        function = expression(word("setx"), word("Lf"), expression(word("."), generator.constant(symbol), word("function")))
        model = expression(function, *models)
    return generator.finish(generator.positioned(model, node), node, destination)


@makes_test(nodes.Call)
def _test_of_call(generator, node):
    for opening in CALL_TESTS.get(node.symbol, ()):
        test = opening(generator, node)
        if test is not None:
            return test
    return test_of_value(generator, node)


@generates(nodes.CallLocal)
def _call_local(generator, node, destination):
    arguments = generator.arguments(node.arguments)
    return generator.finish(generator.positioned(expression(generator.reference(node.variable), *arguments), node), node, destination)


@generates(nodes.CallValue)
def _call_value(generator, node, destination):
    function, *arguments = generator.arguments([node.function, *node.arguments])
    if not isinstance(node.function, nodes.Lambda):
        if function.__class__ is core.Symbol:
            name = function
        else:
            name = word(generator.temporary())
            function = expression(word("setx"), name, function)
        plain = expression(word("is"), expression(word("."), function, word("__class__")), word("LFunction"))
        function = expression(word("if"), plain, name, generator.call("callable", name))
    return generator.finish(generator.positioned(expression(function, *arguments), node), node, destination)


@generates(nodes.CallSetf)
def _call_setf(generator, node, destination):
    for opening in SETTERS.get(node.symbol, ()):
        done = opening(generator, node, destination)
        if done is not None:
            return done[0]
    arguments = generator.arguments(node.arguments)
    for opening in GENERAL_SETTERS:
        done = opening(generator, node, arguments, destination)
        if done is not None:
            return done[0]
    if node.symbol in KNOWN_SETTERS:
        setter = word(generator.constants.name("setf_function", node.symbol))
    else:
        setter = generator.call("setf_function", generator.constant(node.symbol))
    return generator.finish(generator.positioned(expression(setter, *arguments), node), node, destination)


@generates(nodes.CallSpread)
def _call_spread(generator, node, destination):
    arguments = generator.arguments([node.function])
    spread = generator.arguments(node.arguments, VALUES)
    unpacked = [expression(word("unpack-iterable"), generator.call("all_values", item)) for item in spread]
    return generator.finish(expression(generator.call("callable", arguments[0]), *unpacked), node, destination)


@generates(nodes.Support)
def _support(generator, node, destination):
    arguments = generator.arguments(node.arguments, VALUES)
    return generator.finish(generator.positioned(generator.call(node.name, *arguments), node), node, destination)
