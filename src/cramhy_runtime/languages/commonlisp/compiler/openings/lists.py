"""Lists: ``car``, ``cdr``, ``cons`` and ``list`` in place, and cells that are made without a call of Python's constructor.

Rows of ``make bench`` without a pass, as times of the row with it. ``lists``: destructuring-bind 1.95, a call of a generic function 1.43,
call-next-method 1.33. ``growth``: mapcar 1.54, loop collect when 1.42.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.packages import sym

from .. import nodes
from ..arithmetic.operations import named_value
from ..core import NONE, expression, word
from ..generator.output import GENERATORS, SINGLE_VALUE
from ..passes import opens_call, opens_node
from ..words import DOT, IF, IS, class_of

CAR, CDR, FIRST, REST, CONS, LIST = map(sym, "CAR CDR FIRST REST CONS LIST".split())
PARTS = {CAR: "car", FIRST: "car", CDR: "cdr", REST: "cdr"}
KNOWN_PARTS = {sym("CRAMHY::CAR-OF-CONS"): "car", sym("CRAMHY::CDR-OF-CONS"): "cdr"}
COLLECT = sym("CRAMHY::COLLECT")


@opens_call("lists", *PARTS)
def _part(generator, node, destination):
    if len(node.arguments) != 1:
        return None
    model, name = named_value(generator, node.arguments[0])
    slow = generator.positioned(expression(word(generator.constants.name("function", node.symbol)), name), node)
    part = expression(DOT, name, word(PARTS[node.symbol]))
    test = expression(IS, class_of(model), word("LCons"))
    return (generator.finish(expression(IF, test, part, slow), node, destination),)


@opens_call("lists", *KNOWN_PARTS, effect=True)
def _known_part(generator, node, destination):
    if len(node.arguments) != 1:
        return None
    part = expression(DOT, generator.value(node.arguments[0]), word(KNOWN_PARTS[node.symbol]))
    return (generator.finish(part, node, destination),)


@opens_call("lists", CONS)
def _cons(generator, node, destination):
    if len(node.arguments) != 2:
        return None
    return (generator.finish(expression(word("LCons"), *generator.arguments(node.arguments)), node, destination),)


@opens_call("lists", LIST)
def _list(generator, node, destination):
    if not node.arguments:
        return None
    if len(node.arguments) > 4:
        return (generator.finish(generator.call("list", *generator.arguments(node.arguments)), SINGLE_VALUE, destination),)
    model = NONE
    for item in reversed(generator.arguments(node.arguments)):
        model = expression(word("LCons"), item, model)
    return (generator.finish(model, node, destination),)


@opens_node("growth", GENERATORS, nodes.SetLocal)
def _grown(generator, node, destination):
    """``loop``'s ``collect`` and ``push`` to a variable."""
    variable = node.variable
    if destination.kind != "effect" or variable.boxed:
        return None
    grown = word(variable.name)
    if grows(node, COLLECT, 0):
        cell = new_cell(generator, node.value.arguments[1], NONE)
        generator.emit(word("setv"), expression(DOT, grown, word("cdr")), cell)
        generator.emit(word("setv"), grown, cell)
        return (None,)
    if grows(node, CONS, 1):  # as push writes it
        cell = new_cell(generator, node.value.arguments[0], grown)
        generator.emit(word("setv"), grown, cell)
        generator.emit(word("setv"), cell, NONE)  # or it would keep the list for as long as the function runs
        return (None,)
    return None


def grows(node, symbol, position):
    """Whether ``node`` gives a variable the value of a call of ``symbol`` with the variable itself as argument ``position`` of two."""
    value = node.value
    if value.__class__ is not nodes.Call or value.symbol is not symbol or len(value.arguments) != 2:
        return False
    argument = value.arguments[position]
    return argument.__class__ is nodes.LocalVariable and argument.variable is node.variable


def new_cell(generator, item, rest):
    """The name of a new cons of ``item``, a node, and ``rest``. It is made without its constructor, a call of a Python function."""
    cell, item = word(generator.temporary("Lnew")), generator.value(item)
    generator.emit(word("setv"), cell, expression(word("Lnew_object"), word("LCons")))
    generator.emit(word("setv"), expression(word("."), cell, word("car")), item)
    generator.emit(word("setv"), expression(word("."), cell, word("cdr")), rest)
    return cell
