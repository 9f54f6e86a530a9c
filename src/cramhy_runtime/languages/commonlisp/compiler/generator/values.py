"""Constants, variables, sequence, choice and bindings: the nodes that every program is made of."""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import Symbol
from cramhy_runtime.lisp_core.floats import SingleFloat

from .. import nodes
from ..constants import float_model
from ..core import NONE, TRUE, List, expression, word
from ..destinations import EFFECT, FIRST_OF_VALUES, RAW, VALUE, VALUES, Destination
from ..kinds import BOOLEAN, PI, THING
from ..passes import BINDINGS
from ..passes import VALUES as VALUES_IN_PLACE
from ..words import AND, IF, IS, SETX, class_of
from .functions import function_of
from .output import SINGLE_VALUE, generates, makes_test, test_of_value


@generates(nodes.Constant)
def _constant(generator, node, destination):
    if destination.raw and node.value.__class__ is SingleFloat:
        return generator.finish(float_model(float(node.value)), node, destination, pure=True, raw=True)
    return generator.finish(generator.literal(node.value), node, destination, pure=True)


@generates(nodes.LocalVariable)
def _local_variable(generator, node, destination):
    return generator.finish(generator.reference(node.variable), node, destination, pure=True, raw=node.variable.raw)


@generates(nodes.GlobalVariable)
def _global_variable(generator, node, destination):
    if node.symbol is PI:
        return generator.finish(PI.value, SINGLE_VALUE, destination, pure=True)
    constant, value = generator.constant(node.symbol), word("Lv")
    place = expression(word("."), constant, word("value"))
    bound = expression(word("is-not"), expression(word("setx"), value, place), word("Lunbound"))
    model = expression(word("if"), bound, value, generator.positioned(generator.call("value", constant), node))
    return generator.finish(model, node, destination)


@generates(nodes.SetLocal)
def _set_local(generator, node, destination):
    variable = node.variable
    if not variable.boxed:
        generator.gen(node.value, Destination("assign", variable.name, raw=variable.raw))
    else:
        generator.emit(word("setv"), generator.reference(variable), generator.value(node.value))
    return generator.finish(generator.reference(variable), node, destination, pure=True, raw=variable.raw)


@generates(nodes.SetGlobal)
def _set_global(generator, node, destination):
    value = generator.value(node.value)
    place = expression(word("."), generator.constant(node.symbol), word("value"))
    generator.emit(word("setv"), place, value)
    return generator.finish(place, node, destination, pure=True)


@generates(nodes.FunctionReference)
def _function_reference(generator, node, destination):
    if node.setf:
        model = generator.call("setf_function", generator.constant(node.symbol))
    elif generator.standard(node.symbol):
        model = word(generator.constants.name("function", node.symbol))
    else:
        model = generator.call("fdefinition", generator.constant(node.symbol))
    return generator.finish(model, node, destination, pure=True)


@generates(nodes.Checked)
def _checked(generator, node, destination):
    """A value of a declared type."""
    value = generator.gen(node.value, FIRST_OF_VALUES)
    place = [generator.constant(node.place)] if node.place is not None else []
    model = generator.call("checked", value, generator.literal(node.type), *place)
    return generator.finish(generator.positioned(model, node), node, destination)


@generates(nodes.Progn)
def _progn(generator, node, destination):
    for item in node.forms[:-1]:
        generator.gen(item, EFFECT)
    return generator.gen(node.forms[-1], destination)


@generates(nodes.MultipleValueProg1)
def _multiple_value_prog1(generator, node, destination):
    if not node.rest:
        return generator.gen(node.first, destination)
    name = generator.temporary()
    generator.gen(node.first, Destination("assign", name, destination.multiple, destination.raw))
    for item in node.rest:
        generator.gen(item, EFFECT)
    saved = nodes.Constant(None)
    return generator.finish(word(name), saved, destination, pure=True, raw=destination.raw)


@generates(nodes.LoadTimeValue)
def _load_time_value(generator, node, destination):
    if not hasattr(node, "name"):
        node.name = generator.constants.own_name("Lloaded")  # a global: functions of other forms have theirs beside it
        generator.hoisted.append((node.name, node.node))
    return generator.finish(word(node.name), node, destination, pure=True)


# ----------------------------------------------------------------------------------------------------------------------- choice


@makes_test(nodes.Constant)
def _test_of_constant(generator, node):
    return NONE if node.value is None or node.value is False else TRUE


@makes_test(nodes.LocalVariable)
def _test_of_variable(generator, node):
    if node.boolean:
        return expression(word("is-not"), generator.value(node), NONE)
    kind, value = node.variable.kind, generator.reference(node.variable)
    if kind and not kind & (BOOLEAN | THING):
        return TRUE
    true = expression(word("is-not"), value, NONE)
    return true if not kind & THING else expression(word("and"), true, expression(word("is-not"), value, word("False")))


@makes_test(nodes.If)
def _test_of_choice(generator, node):
    test = generator.test(node.test)
    then_out, then = generator.captured(lambda: generator.test(node.then))
    else_out, otherwise = generator.captured(lambda: generator.test(node.otherwise))
    if not then_out and not else_out:
        if otherwise is NONE:
            return expression(word("and"), test, then)
        return expression(word("if"), test, then, otherwise)
    name = generator.temporary()
    generator.branch(test, [*then_out, generator.setting(name, then)], [*else_out, generator.setting(name, otherwise)])
    return word(name)


@makes_test(nodes.Let)
def _test_of_let(generator, node):
    if any(isinstance(variable, Symbol) for variable, _ in node.bindings):
        return test_of_value(generator, node)
    bind(generator, node.bindings, node.body)
    return generator.test(node.body)


@generates(nodes.If)
def _if(generator, node, destination):
    if isinstance(node.test, nodes.Constant):
        return generator.gen(node.then if generator.test(node.test) is TRUE else node.otherwise, destination)
    test = generator.test(node.test)
    then_out, then = generator.captured(lambda: generator.gen(node.then, destination))
    else_out, otherwise = generator.captured(lambda: generator.gen(node.otherwise, destination))
    if destination.kind != "value":
        generator.branch(test, then_out, else_out)
        return None
    if not then_out and not else_out:
        return expression(word("if"), test, then, otherwise)
    name = generator.temporary()
    generator.branch(test, [*then_out, generator.setting(name, then)], [*else_out, generator.setting(name, otherwise)])
    return word(name)


# --------------------------------------------------------------------------------------------------------------------- bindings


def bind_variable(generator, variable, value):
    generator.assign(variable.name, generator.call("cell", value) if variable.boxed else value)


@generates(nodes.Let)
def _let(generator, node, destination):
    dynamic = bind(generator, node.bindings, node.body)
    return with_specials(generator, node.body, dynamic, destination) if dynamic else generator.gen(node.body, destination)


def bind(generator, pairs, body):
    """Emit the bindings ``pairs`` of the lexical variables of a ``let``; gives those of the specials, symbols with their values."""
    bindings = pairs
    for opening in BINDINGS:
        bindings = opening(generator, bindings, body)
    wanted = [RAW if getattr(variable, "raw", False) else VALUE for variable, _ in bindings]
    values = generator.arguments([value for _, value in bindings], wanted)
    for (variable, _), value in zip(bindings, values):
        if not isinstance(variable, Symbol):
            bind_variable(generator, variable, value)
    return [(symbol, value) for (symbol, _), value in zip(bindings, values) if isinstance(symbol, Symbol)]


def with_specials(generator, body, dynamic, destination):
    def produce(inner):
        for symbol, value in dynamic:
            generator.emit(word("Lbind"), generator.constant(symbol), value)
        statements, _ = generator.captured(lambda: generator.gen(body, inner))
        undo = expression(word("finally"), generator.call("unbind", len(dynamic)))
        generator.emit(word("try"), *(statements or [NONE]), undo)

    return generator.by_statements(body, destination, produce)


@generates(nodes.MultipleValueBind)
def _multiple_value_bind(generator, node, destination):
    names, dynamic, boxed = [], [], []
    for variable in node.variables:
        name = generator.temporary() if isinstance(variable, Symbol) or variable.boxed else variable.name
        names.append(word(name))
        if isinstance(variable, Symbol):
            dynamic.append((variable, word(name)))
        elif variable.boxed:
            boxed.append((variable, word(name)))
    if names:
        assign_values(generator, names, node.values)
    else:
        generator.out.append(generator.gen(node.values, VALUES))
        generator.effects += 1
    for variable, name in boxed:
        bind_variable(generator, variable, name)
    if dynamic:
        return with_specials(generator, node.body, dynamic, destination)
    return generator.gen(node.body, destination)


def assign_values(generator, names, node):
    """Assign the values of ``node`` to the variables ``names``; those that are missing are nil."""
    target = List(names) if len(names) > 1 else names[0]
    for opening in VALUES_IN_PLACE:
        made = opening(generator, names, node)
        if made is not None:
            generator.emit(word("setv"), target, made)
            return
    value = generator.gen(node, VALUES)
    if len(names) == 1:
        generator.emit(word("setv"), target, generator.first_value(value))
        return
    values = word(generator.temporary())
    several = expression(IS, class_of(expression(SETX, values, value)), word("LMultipleValues"))
    fits = expression(AND, several, expression(word("="), generator.call("len", values), len(names)))
    generator.emit(word("setv"), target, expression(IF, fits, values, generator.call("spread", values, len(names))))


@generates(nodes.Functions)
def _functions(generator, node, destination):
    for variable, _ in node.functions:
        if variable.boxed:
            generator.assign(variable.name, generator.call("cell", NONE))
    for variable, function in node.functions:
        if variable.boxed:
            generator.emit(word("setv"), generator.reference(variable), function_of(generator, function))
        else:
            function_of(generator, function, variable.name)
    return generator.gen(node.body, destination)
