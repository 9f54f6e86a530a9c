"""Objects: slots, instances and generic functions without a Python function between the form and what it means.

Rows of ``make bench`` without a pass, as times of the row with it. ``slots``: accessors of an instance 6.2, an instance with doubles 4.1.
``instances``: make-instance 8.4. ``generic-calls``: a call of a generic function 2.4, call-next-method 1.9.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import Keyword, Symbol
from cramhy_runtime.lisp_core.dispatch.reached_slots import read_attribute, written_attribute
from cramhy_runtime.lisp_core.packages import sym

from ...objects.makers import maker
from ...objects.slots import named_slot
from .. import nodes
from ..core import expression, word
from ..generator.output import SINGLE_VALUE
from ..passes import GENERAL_CALLS, GENERAL_SETTERS, opens, opens_call
from ..words import DOT, IF, IS, SETX, class_of

MAKE_INSTANCE, SLOT_VALUE = map(sym, "MAKE-INSTANCE SLOT-VALUE".split())
IN = word("in")


# ------------------------------------------------------------------------------------------------------------------ instances


@opens_call("instances", MAKE_INSTANCE)
def _make_instance(generator, node, destination):
    model = instance_made(generator, node, node.arguments)
    return None if model is None else (generator.finish(model, SINGLE_VALUE, destination),)


def instance_made(generator, node, arguments):
    """``(make-instance 'class :key value ...)``"""
    keys = arguments[1::2]
    constant = all(each.__class__ is nodes.Constant for each in (arguments[:1] + keys))
    if not arguments or not constant or len(arguments) % 2 == 0 or any(key.value.__class__ is not Keyword for key in keys):
        return None
    name = arguments[0].value
    if name.__class__ is not Symbol or name.package is None:
        return None
    made_by = generator.constant(maker(name, *[key.value for key in keys]))
    model = expression(expression(DOT, made_by, word("make")), *generator.arguments(arguments[2::2]))
    return generator.first_value(generator.positioned(model, node))


# ---------------------------------------------------------------------------------------------------------------------- slots


@opens_call("slots", SLOT_VALUE)
def _slot_value(generator, node, destination):
    arguments = node.arguments
    if len(arguments) != 2 or (named := slot_named_by(arguments[1])) is None:
        return None
    (target,) = generator.stable_names(generator.arguments(arguments[:1]))
    classes = generator.constant(named)
    slow = generator.positioned(expression(expression(DOT, classes, word("read")), target), node)
    model = expression(IF, among_classes(target, classes), expression(DOT, target, word(named.attribute)), generator.first_value(slow))
    return (generator.finish(model, SINGLE_VALUE, destination),)


@opens("slots", GENERAL_CALLS)
def slot_read(generator, node, models):
    """A call of an accessor: the attribute itself, if the object is of a class where that means the same; or ``None``."""
    symbol = node.symbol
    if len(models) != 1 or (attribute := read_attribute(symbol)) is None:
        return None
    (target,) = generator.stable_names(models)
    classes = word(generator.constants.name(f"calls.reads.of_{attribute}", symbol))
    slow = generator.positioned(expression(expression(DOT, generator.constant(symbol), word("function")), target), node)
    model = expression(IF, among_classes(target, classes), expression(DOT, target, word(attribute)), generator.first_value(slow))
    return model, SINGLE_VALUE


def among_classes(target, classes):
    """A test whether the class of ``target`` is one of ``classes`` (`lisp_core.data.Classes`)."""
    last = expression(IS, expression(SETX, word("Lo"), class_of(target)), expression(DOT, classes, word("last")))
    return expression(word("or"), last, expression(IN, word("Lo"), classes))


@opens("slots", GENERAL_SETTERS)
def slot_written(generator, node, models, destination):
    """``(setf (accessor object) new)``, with the new value and the object as ``models``."""
    if len(models) != 2 or (attribute := written_attribute(node.symbol)) is None:
        return None
    classes = word(generator.constants.name(f"calls.writes.of_{attribute}", node.symbol))
    setter = generator.call("setf_function", generator.constant(node.symbol))
    return attribute_set(generator, node, attribute, models, destination, classes, setter)


@opens("slots", GENERAL_SETTERS)
def named_slot_written(generator, node, models, destination):
    """``(setf (slot-value object 'name) new)``"""
    if node.symbol is not SLOT_VALUE or len(models) != 3 or (named := slot_named_by(node.arguments[2])) is None:
        return None
    classes = generator.constant(named)
    return attribute_set(generator, node, named.attribute, models[:2], destination, classes, expression(DOT, classes, word("write")))


def attribute_set(generator, node, attribute, models, destination, classes, function):
    """Set an attribute of an object that is an instance of one of ``classes``, or call ``function``."""

    def produce(inner):
        new, target = generator.stable_names(models)
        quick, _ = generator.captured(lambda: generator.finish(new, SINGLE_VALUE, inner, pure=True))
        call = generator.positioned(expression(function, new, target), node)
        slow, _ = generator.captured(lambda: generator.finish(call, node, inner))
        store = expression(word("setv"), expression(DOT, target, word(attribute)), new)
        generator.branch(among_classes(target, classes), [store, *quick], slow)
        generator.effects += 1

    return (generator.by_statements(node, destination, produce),)


def slot_named_by(node):
    """The `NamedSlot` of the symbol that ``node`` is; ``None`` for anything else."""
    name = node.value if node.__class__ is nodes.Constant else None
    return named_slot(name) if name.__class__ is Symbol and name.package is not None else None


# ---------------------------------------------------------------------------------------------------------- generic functions


@opens("generic-calls", GENERAL_CALLS)
def through_object(generator, node, models):
    """A call of a generic function that looks at the class of its first argument only: that is looked up right here; or ``None``."""
    symbol = node.symbol
    if not isinstance(symbol, Symbol) or not models or getattr(symbol.function, "by_first_of", None) != len(models):
        return None
    models = generator.stable_names(models)
    table = word(generator.constants.name("calls.unary" if len(models) == 1 else "calls.binary", symbol))
    known = expression(expression(DOT, table, word("get")), expression(DOT, models[0], word("__class__")))
    chosen = expression(word("or"), known, expression(DOT, generator.constant(symbol), word("function")))
    return generator.positioned(expression(chosen, *models), node), node
