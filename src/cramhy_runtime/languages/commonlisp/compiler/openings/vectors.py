"""``vector-push`` and ``vector-push-extend`` where the vector has room.

Rows of ``make bench`` without it, as times of the row with it: vector-push-extend 1.3.
"""

from __future__ import annotations

from ..arithmetic.elements import GET
from ..arithmetic.operations import known_function
from ..core import NONE, TRUE, expression, word
from ..generator.output import SINGLE_VALUE
from ..loop_shapes import CHANGES
from ..passes import opens_call
from ..words import AND, DOT, IS, IS_NOT, SETX, class_of

PLUS, SETV = map(word, "+ setv".split())


@opens_call("vector-push", *CHANGES, effect=True)
def _vector_push(generator, node, destination):
    if len(node.arguments) != 2:
        return None
    return (generator.by_statements(node, destination, lambda inner: vector_pushed(generator, node, node.arguments, inner)),)


def vector_pushed(generator, node, arguments, destination):
    """``(vector-push new vector)`` and ``vector-push-extend``: if there is room in the vector, its new element is stored right here."""
    new, vector = generator.stable_names(generator.arguments(arguments))
    index, end = word(generator.temporary("Lindex")), expression(DOT, vector, word("fill_pointer"))
    test = expression(
        AND,
        expression(IS, class_of(vector), word("Lany_vector")),
        expression(IS, expression(DOT, vector, word("element_type")), TRUE),
        expression(IS_NOT, expression(SETX, index, end), NONE),
        expression(word("<"), index, expression(GET, expression(DOT, vector, word("dimensions")), 0)),
    )
    place = expression(GET, expression(DOT, vector, word("storage")), expression(PLUS, expression(DOT, vector, word("offset")), index))
    quick = [expression(SETV, place, new), expression(SETV, end, expression(PLUS, index, 1))]
    value, _ = generator.captured(lambda: generator.finish(index, SINGLE_VALUE, destination, pure=True))
    call = generator.positioned(expression(known_function(generator, node.symbol), new, vector), node)
    slow, _ = generator.captured(lambda: generator.finish(call, SINGLE_VALUE, destination))
    generator.branch(test, [*quick, *value], slow)
    generator.effects += 1
