"""What is known about variables before code is made: how often each is read and assigned, and the kind of its values.

A variable that only ever gets integers needs no test before ``+``: the kind (``kinds.py``) of a variable joins the kinds of all
forms that give it a value. Variables may depend on each other and on themselves (``(setq s (+ s j))``), so the kinds are the least
solution: all begin as ``NONE_YET`` and are widened until nothing changes. Parameters are of ``ANY`` kind.

Rows of ``make bench`` without the pass ``kinds``, as times of the row with it: (* i 0.5) in a loop 29, nested dotimes 3.0, sines of
single-floats 2.8.
"""

from __future__ import annotations

from cramhy_runtime.kernel.typing_names import annotations_of

from cramhy_runtime.lisp_core.data import Symbol
from cramhy_runtime.lisp_core.packages import sym
from . import nodes
from .passes import ON
from .kinds import ABS, ANY, DIVIDE, MAX, MIN, MINUS, NONE_YET, PLUS, SMOOTH, SQRT, STEPS, TIMES, kind_of, raw

OPERANDS_OF = {PLUS, MINUS, TIMES, DIVIDE, MAX, MIN, ABS, SQRT, *STEPS, *SMOOTH, *map(sym, "< > <= >= = ZEROP PLUSP MINUSP".split())}
"""Functions for whose arguments it pays to know the class, or to be raw."""

_NODES = {kind for kind in vars(nodes).values() if isinstance(kind, type) and issubclass(kind, nodes.Node)}
_node_fields: dict = {}
_WITH_NODES = ("Node", "list", "Parameters")
"""Annotations of the fields that may hold nodes."""
_ENDS = {nodes.Constant, nodes.LocalVariable, nodes.GlobalVariable, nodes.FunctionReference, nodes.Go}
"""Nodes that have none below them."""


def children(node):
    """A list of the nodes directly below ``node``."""
    names = _node_fields.get(node.__class__)
    if names is None:
        names = _node_fields[node.__class__] = tuple(name for name, kind in annotations_of(node.__class__).items() if kind in _WITH_NODES)
    found = []
    for name in names:
        part = getattr(node, name)
        kind = part.__class__
        if kind in _NODES:
            found.append(part)
        elif kind is list:
            for item in part:
                if item.__class__ in _NODES:
                    found.append(item)
                elif item.__class__ is list:
                    found += item  # the segments of a tagbody
                elif item.__class__ is tuple and item[1].__class__ in _NODES:
                    found.append(item[1])  # a binding
        elif kind is nodes.Parameters:
            found += (entry[1] for entry in (*part.optional, *part.keys) if entry[1] is not None)
    return found


def walk(roots):
    """All nodes at and below ``roots``."""
    pending = list(roots)
    while pending:
        node = pending.pop()
        yield node
        if node.__class__ not in _ENDS:
            pending += children(node)


def study(root):
    """Note on each variable bound in ``root`` its ``reads``, ``writes`` and ``kind``, and whether it is ``raw``.

    Without the pass ``kinds`` all variables are of ``ANY`` kind.
    """
    bound = []
    for node in walk([root]):
        kind = node.__class__
        if kind is nodes.LocalVariable:
            node.variable.reads += 1
        elif kind is nodes.SetLocal:
            node.variable.writes += 1
            node.variable.values.append(node.value)
        elif kind is nodes.Call:
            if node.symbol in OPERANDS_OF:
                for argument in node.arguments:
                    if argument.__class__ is nodes.LocalVariable:
                        argument.variable.operand_uses += 1
        elif kind is nodes.Let:
            for variable, value in node.bindings:
                if not isinstance(variable, Symbol):
                    variable.values.append(value)
                    variable.kind = NONE_YET
                    bound.append(variable)
        elif kind is nodes.ReturnFrom:
            node.block.values.append(node.value)
    for variable in reversed(bound):
        value = variable.values[0]
        if not variable.writes and value.__class__ is nodes.LocalVariable:  # another name
            value.variable.operand_uses += variable.operand_uses
    if "kinds" in ON:
        find_kinds(bound)
    else:
        for variable in bound:
            variable.kind = ANY


def find_kinds(bound):
    """Note on each variable in ``bound`` its ``kind``, given what it is assigned, and whether it is held ``raw``."""
    changed = bool(bound)
    while changed:
        changed = False
        for variable in bound:
            if variable.kind != ANY:
                new = variable.kind
                for value in variable.values:
                    new |= kind_of(value)
                if new != variable.kind:
                    variable.kind = new
                    changed = True
    held = [variable for variable in bound if raw(variable.kind)]
    for variable in held:
        for value in variable.values:
            for other in _passed_on(value):
                other.operand_uses += 1
    for variable in held:
        if not variable.captured and 2 * variable.operand_uses >= variable.reads:
            variable.raw = True


def _passed_on(node):
    """The variables of which one may be the value of ``node``."""
    kind = node.__class__
    if kind is nodes.LocalVariable:
        return [node.variable]
    if kind is nodes.If:
        return [*_passed_on(node.then), *_passed_on(node.otherwise)]
    if kind is nodes.Progn:
        return _passed_on(node.forms[-1])
    return _passed_on(node.body) if kind is nodes.Let else []
