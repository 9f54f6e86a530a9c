"""Variables: ``incf`` of one changes it in place, and a variable that only has another's value has no name of its own.

Rows of ``make bench`` without a pass, as times of the row with it. ``places``: matrices of single-floats 1.58, of double-floats 1.21.
``copies``: remove-if, reduce 1.18, a hash table filled and read 1.09.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import Symbol

from .. import nodes
from ..facts import walk
from ..generator.output import GENERATORS
from ..kinds import MINUS, PLUS
from ..passes import BINDINGS, opens, opens_node


@opens_node("places", GENERATORS, nodes.Let)
def _modified(generator, node, destination):
    body = modification(node) if node.bindings else None
    return None if body is None else (generator.gen(body, destination),)


@opens("copies", BINDINGS)
def _without_copies(generator, pairs, body):
    bindings = []
    for variable, value in pairs:
        plain = not isinstance(variable, Symbol) and value.__class__ is nodes.LocalVariable
        if plain and alike(variable, value.variable, [body, *(other for _, other in pairs)]):
            variable.name = value.variable.name
        else:
            bindings.append((variable, value))
    return bindings


def modification(node):
    """The body of ``(let ((delta value)) (setq place (+ place delta)))``, as ``incf`` makes it, with the value in place of delta.

    ``None`` if the body is another, or if the value may change the place: then the sum must read the place after it.
    """
    (variable, value), body = node.bindings[0], node.body
    if len(node.bindings) > 1 or isinstance(variable, Symbol) or body.__class__ is not nodes.SetLocal:
        return None
    call, place = body.value, body.variable
    if call.__class__ is not nodes.Call or call.symbol not in (PLUS, MINUS) or len(call.arguments) != 2:
        return None
    if [each.variable if each.__class__ is nodes.LocalVariable else None for each in call.arguments] != [place, variable]:
        return None
    if variable.reads != 1 or variable.writes or place.captured:
        return None
    if any(item.__class__ is nodes.SetLocal and item.variable is place for item in walk([value])):
        return None
    sum_ = nodes.Call(call.symbol, [call.arguments[0], value])
    sum_.single, sum_.position = True, call.position
    changed = nodes.SetLocal(place, sum_)
    changed.position = body.position
    return changed


def alike(variable, other, forms):
    """Whether ``variable``, bound to the value of ``other`` while ``forms`` run, can do without a Python variable of its own."""
    if variable.writes or variable.captured or other.boxed or variable.owner is not other.owner or variable.raw is not other.raw:
        return False
    if not other.writes:
        return True
    return not other.captured and not any(item.__class__ is nodes.SetLocal and item.variable is other for item in walk(forms))
