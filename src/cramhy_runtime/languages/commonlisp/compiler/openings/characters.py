"""Characters: ``char=`` and ``find`` in a constant text.

Rows of ``make bench`` without it, as times of the row with it: characters of a text 4.7.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import Character
from cramhy_runtime.lisp_core.packages import sym

from .. import nodes
from ..arithmetic.operations import known_function, named_value
from ..core import NONE, expression, word
from ..generator.output import SINGLE_VALUE
from ..passes import opens_call, opens_test
from ..words import AND, DOT, IF, IS, IS_NOT, class_of

FIND, SAME_CHARACTER = map(sym, "FIND CHAR=".split())
CHARACTER, IN = map(word, "Lcharacter in".split())


@opens_call("characters", SAME_CHARACTER)
def _same_character(generator, node, destination):
    test = same_character(generator, node)
    return None if test is None else (generator.finish(generator.truth_value(test), SINGLE_VALUE, destination),)


@opens_call("characters", FIND)
def _find(generator, node, destination):
    if len(node.arguments) != 2 or not _is_text(node.arguments[1]):
        return None
    item, name, among, slow = found_in_text(generator, node, node.arguments)
    model = expression(IF, expression(IS, class_of(item), CHARACTER), expression(IF, among, name, NONE), slow)
    return (generator.finish(model, SINGLE_VALUE, destination),)


@opens_test("characters", FIND, value=False)
def _found(generator, node):
    if len(node.arguments) != 2 or not _is_text(node.arguments[1]):
        return None
    item, _, among, slow = found_in_text(generator, node, node.arguments)
    return expression(IF, expression(IS, class_of(item), CHARACTER), among, expression(IS_NOT, slow, NONE))


def found_in_text(generator, node, arguments):
    """``(find item "text")``: the first and later use of the item, a test whether the character is in the text, and the usual call."""
    item, name = named_value(generator, arguments[0])
    among = expression(IN, expression(DOT, name, word("char")), arguments[1].value)
    return item, name, among, generator.positioned(expression(known_function(generator, FIND), name, arguments[1].value), node)


@opens_test("characters", SAME_CHARACTER, value=False)
def same_character(generator, node):
    """A test for ``(char= x y)``: characters are the same object if they are the same."""
    arguments = node.arguments
    if len(arguments) != 2 or any(each.__class__ is nodes.Constant and each.value.__class__ is not Character for each in arguments):
        return None
    models = generator.stable_names(generator.arguments(arguments))
    unknown = [
        expression(IS, class_of(model), CHARACTER)
        for model, argument in zip(models, arguments, strict=True)
        if not (argument.__class__ is nodes.Constant and argument.value.__class__ is Character)
    ]
    same = expression(IS, *models)
    if not unknown:
        return same
    test = unknown[0] if len(unknown) == 1 else expression(AND, *unknown)
    slow = generator.positioned(expression(known_function(generator, SAME_CHARACTER), *models), node)
    return expression(IF, test, same, expression(IS_NOT, slow, NONE))


def _is_text(node):
    return node.__class__ is nodes.Constant and node.value.__class__ is str
