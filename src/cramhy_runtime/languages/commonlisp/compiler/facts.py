"""What is known about variables before code is made: how often each is read and assigned, and the kind of its values.

A variable that only ever gets integers needs no test before ``+``: the *kind* of a variable is "int", "float" or "boolean" when
all forms that give it a value are of that kind, "number" when they are numbers of any kinds, and ``ANY`` otherwise. Variables may
depend on each other and on themselves (``(setq s (+ s j))``), so the kinds are the least solution: all begin as ``NONE_YET`` and
are widened until nothing changes. Parameters are ``ANY``. "float" is the plain float that stands for a single-float, never a
`DoubleFloat`.
"""

from __future__ import annotations

from dataclasses import fields

from cramhy_runtime.ground.data import Symbol
from cramhy_runtime.ground.packages import sym
from . import nodes
from .declared_types import kind_of_type

NONE_YET, ANY = "none yet", None
NUMBERS = {"int", "float", "number"}

PLUS, MINUS, TIMES, DIVIDE, ADD_ONE, SUBTRACT_ONE = map(sym, "+ - * / 1+ 1-".split())
TESTED = {sym(name) for name in "+ - * 1+ 1- < > <= >= =".split()}
_STEPS = {ADD_ONE, SUBTRACT_ONE}
_OPERATORS = {PLUS, MINUS, TIMES}
_REST = {sym("MOD"), sym("REM")}
_CHOICE = {sym("MAX"), sym("MIN")}
_INTEGERS = {sym(name) for name in "LENGTH CHAR-CODE COUNT LOGAND LOGIOR LOGXOR HASH-TABLE-COUNT LIST-LENGTH ARRAY-RANK".split()}

_node_fields: dict = {}


def children(node):
    """The nodes directly below ``node``."""
    names = _node_fields.get(node.__class__)
    if names is None:
        names = () if node.__class__ is nodes.Constant else tuple(field.name for field in fields(node.__class__))
        _node_fields[node.__class__] = names
    for name in names:
        part = getattr(node, name)
        if isinstance(part, nodes.Node):
            yield part
        elif part.__class__ is list:
            for item in part:
                if isinstance(item, nodes.Node):
                    yield item
                elif item.__class__ is list:
                    yield from item  # the segments of a tagbody
                elif item.__class__ is tuple and isinstance(item[1], nodes.Node):
                    yield item[1]  # a binding
        elif part.__class__ is nodes.Parameters:
            for entry in (*part.optional, *part.keys):
                if entry[1] is not None:
                    yield entry[1]


def walk(roots):
    """All nodes at and below ``roots``."""
    pending = list(roots)
    while pending:
        node = pending.pop()
        yield node
        pending.extend(children(node))


def study(root):
    """Note on each variable bound in ``root`` its ``reads``, ``writes`` and ``kind``."""
    bound = []
    for node in walk([root]):
        kind = node.__class__
        if kind is nodes.LocalVariable:
            node.variable.reads += 1
        elif kind is nodes.SetLocal:
            node.variable.writes += 1
            node.variable.values.append(node.value)
        elif kind is nodes.Call and node.symbol in TESTED:
            for argument in node.arguments:
                if argument.__class__ is nodes.LocalVariable:
                    argument.variable.operand_uses += 1
        elif kind is nodes.Let:
            for variable, value in node.bindings:
                if not isinstance(variable, Symbol):
                    variable.values.append(value)
                    variable.kind = NONE_YET
                    bound.append(variable)
    changed = bool(bound)
    while changed:
        changed = False
        for variable in bound:
            if variable.kind is not ANY:
                new = variable.kind
                for value in variable.values:
                    new = join(new, kind_of(value))
                if new != variable.kind:
                    variable.kind = new
                    changed = True


def join(one, other):
    """The kind of a value that is of the kind ``one`` or ``other``."""
    if one == other or other == NONE_YET:
        return one
    if one == NONE_YET:
        return other
    return "number" if one in NUMBERS and other in NUMBERS else ANY


def kind_of(node):
    """The kind of the first value of ``node``."""
    kind = node.__class__
    if kind is nodes.Constant:
        value = node.value
        if value is None or value is True:
            return "boolean"
        kind = value.__class__
        return "int" if kind is int else "float" if kind is float else ANY
    if kind is nodes.LocalVariable:
        return node.variable.proven or node.variable.kind
    if kind is nodes.SetLocal:
        return kind_of(node.value)
    if kind is nodes.Checked:
        return kind_of_type(node.type) or kind_of(node.value)
    if kind is nodes.Call:
        return _call_kind(node)
    if kind is nodes.If:
        return join(kind_of(node.then), kind_of(node.otherwise))
    if kind is nodes.Let or kind is nodes.Functions or kind is nodes.MultipleValueBind:
        return kind_of(node.body)
    if kind is nodes.Progn:
        return kind_of(node.forms[-1])
    return "boolean" if node.boolean else ANY


def _call_kind(node):
    if node.boolean:
        return "boolean"
    symbol, arguments = node.symbol, node.arguments
    if symbol in _OPERATORS or symbol is DIVIDE:
        if len(arguments) < 2:
            return ANY
        kinds = [kind_of(argument) for argument in arguments]
    elif symbol in _STEPS and len(arguments) == 1:
        kinds = [kind_of(arguments[0]), "int"]
    elif symbol in _REST and len(arguments) == 2 or symbol in _CHOICE:
        kinds = [kind_of(argument) for argument in arguments]
        if NONE_YET in kinds:
            return NONE_YET
        return kinds[0] if kinds and all(kind == kinds[0] == "int" for kind in kinds) else ANY
    elif symbol in _INTEGERS:
        return "int"
    else:
        return ANY
    if NONE_YET in kinds:
        return NONE_YET
    if all(kind in ("int", "float") for kind in kinds):
        if "float" in kinds:
            return "float"
        return "int" if symbol is not DIVIDE else "number"
    return "number"  # of what is none these functions make an error
