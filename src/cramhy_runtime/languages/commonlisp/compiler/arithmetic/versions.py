"""A second body of a function, for arguments of the classes that it seems to be written for.

What a function's arguments are is not known before it is called. But one that counts up to ``n`` is nearly always called with an
integer, and one that multiplies ``x`` by ``0.5d0`` with a double. So its body is made twice: once for such arguments, with the kinds
(``kinds.py``) that follow from them, and once for any. A test at the entry chooses. That pays where a body computes much; `guesses`
says where, and what the arguments seem to be.

Rows of ``make bench`` without it, as times of the row with it: roots of single-floats by
Newton 2.1, Mandelbrot 1.7, fib 1.4.
"""

from __future__ import annotations

from contextlib import contextmanager

from cramhy_runtime.lisp_core.data import Symbol
from cramhy_runtime.lisp_core.packages import sym

from .. import nodes
from ..core import expression, word
from ..destinations import RETURN
from ..facts import OPERANDS_OF, find_kinds, walk
from ..kinds import (
    BOOLEAN,
    DIVIDE,
    DOUBLE,
    FIXNUM_BITS,
    FLOATS,
    INFINITE,
    INT,
    NONE_YET,
    SINGLE,
    SMOOTH,
    SQRT,
    THING,
    kind_of,
    kind_of_type,
)
from ..passes import ENTRIES, opens
from ..words import AND, FLOAT_CLASS, INT_CLASS, IS, SINGLE_CLASS, class_of, fixnum_test
from .comparisons import COMPARISONS

WHOLE_ARGUMENTS = {sym(name) for name in "MOD REM EVENP ODDP LOGAND LOGIOR LOGXOR ASH GCD LCM ISQRT".split()}
INDEXED = {sym(name) for name in "AREF SVREF ELT".split()}
MAKE_ARRAY = sym("MAKE-ARRAY")
LARGEST, FEW, MANY = 500, 4, 12
"""The most nodes of a body that is made twice; the least number of operations in one that is run often, by a loop or by calling itself,
and in any other one. With floats one less pays."""


def guesses(node):
    """Parameter → kind, for the parameters of the `Lambda` ``node`` for which a second body pays; empty if none does."""
    candidates = {
        variable: set()
        for variable in node.parameters.required
        if variable.operand_uses and not variable.captured and (variable.proven in (None, FLOATS, SINGLE))
    }
    if not candidates or not node.scope.loops and sum(variable.operand_uses for variable in candidates) < FEW - 1:
        return {}
    size = operations = 0
    often = False
    for item in walk([node.body]):
        kind = item.__class__
        size += 1
        if kind is nodes.Lambda or size > LARGEST:
            return {}
        if kind is nodes.TagbodyNode:
            often = True
        elif kind is nodes.Let:
            for variable, value in item.bindings:  # another name of a parameter
                if value.__class__ is nodes.LocalVariable and value.variable in candidates and not isinstance(variable, Symbol):
                    if not variable.writes and not value.variable.writes:
                        candidates[variable] = candidates[value.variable]
        elif kind is nodes.Checked:
            if item.value.__class__ is nodes.LocalVariable and item.value.variable in candidates and kind_of_type(item.type) == INT:
                candidates[item.value.variable].add("whole")
        elif kind is nodes.Call:
            operations += item.symbol in OPERANDS_OF
            often = often or item.symbol is node.name
            _note(item, candidates)
    found = {variable: _guess(variable, candidates[variable]) for variable in node.parameters.required if variable in candidates}
    found = {variable: kind for variable, kind in found.items() if kind}
    if operations + any(kind & FLOATS for kind in found.values()) < (FEW if often else MANY):
        return {}
    return found


def _note(call, candidates):
    """Note what ``call`` says about the parameters among its arguments."""
    symbol, arguments = call.symbol, call.arguments
    for index, argument in enumerate(arguments):
        if argument.__class__ is nodes.LocalVariable and argument.variable in candidates:
            if symbol in WHOLE_ARGUMENTS or symbol in INDEXED and index or symbol is MAKE_ARRAY and not index:
                candidates[argument.variable].add("whole")
            elif symbol in COMPARISONS and any(
                other.__class__ is nodes.LocalVariable and other.variable.kind == INT for other in arguments if other is not argument
            ):
                candidates[argument.variable].add("whole")
    if symbol in OPERANDS_OF:
        leaves = call.arguments if symbol is DIVIDE else list(_leaves(call))
        signs = set()
        for leaf in leaves:
            if leaf.__class__ is nodes.Constant:
                signs.add({INT: "number", SINGLE: "single", DOUBLE: "double"}.get(kind_of(leaf), "other"))
            elif kind_of(leaf) & FLOATS and not kind_of(leaf) & (BOOLEAN | THING):
                # what began as a single may become a double if a parameter is one, but nothing else does so
                signs.add("single" if kind_of(leaf) & SINGLE else "double")
            elif leaf.__class__ is not nodes.LocalVariable or leaf.variable not in candidates:
                signs.add("other")
        if symbol is DIVIDE or symbol is SQRT or symbol in SMOOTH:
            signs.add("other")
        for leaf in leaves:
            if leaf.__class__ is nodes.LocalVariable and leaf.variable in candidates:
                candidates[leaf.variable] |= signs


def _leaves(call):
    for argument in call.arguments:
        if argument.__class__ is not nodes.Call or argument.symbol not in OPERANDS_OF:
            yield argument
        elif argument.symbol is not DIVIDE:  # which says nothing about its operands
            yield from _leaves(argument)


def _guess(variable, signs):
    if variable.proven is not None:
        return variable.proven & DOUBLE or SINGLE
    if "whole" in signs:
        return INT
    if "double" in signs:
        return DOUBLE
    if "single" in signs:
        return SINGLE
    return INT if signs == {"number"} else 0


def bounded(node, variable):
    """Whether the test at the entry of ``node`` asks whether an integer is a fixnum: where a loop makes it worth its time."""
    return node.scope.loops and not variable.writes


_FACTS = "kind", "raw", "bits", "never_negative", "name", "proven"


@contextmanager
def assumed(node, found):
    """While it lasts, the parameters in ``found`` are of the kinds there, and the other variables of what follows from them."""
    bound = []
    for item in walk([node.body]):
        if item.__class__ is nodes.Let:
            bound += [variable for variable, _ in item.bindings if not isinstance(variable, Symbol)]
    saved = [(variable, [getattr(variable, name) for name in _FACTS]) for variable in (*bound, *found)]
    for variable in bound:
        variable.kind, variable.raw, variable.bits, variable.never_negative = NONE_YET, False, None, None
    for variable, kind in found.items():
        variable.kind, variable.proven, variable.never_negative = kind, None, False
        variable.bits = FIXNUM_BITS if kind == INT and bounded(node, variable) else INFINITE
    try:
        find_kinds([*bound, *found])
        yield
    finally:
        for variable, facts in saved:
            for name, value in zip(_FACTS, facts, strict=True):
                setattr(variable, name, value)


@opens("versions", ENTRIES)
def second_body(generator, node, returning):
    """Emit the body for arguments of the usual classes, behind a test of them, if that pays."""
    found = guesses(node) if returning is RETURN else None
    if not found:
        return
    tests = []
    for variable, kind in found.items():
        name = word(variable.name)
        tests.append(expression(IS, class_of(name), {INT: INT_CLASS, SINGLE: SINGLE_CLASS, DOUBLE: FLOAT_CLASS}[kind]))
        if kind == INT and bounded(node, variable):
            tests.append(fixnum_test(name))

    def body():
        for variable in found:
            if variable.raw:
                generator.assign(variable.name, generator.call("float", word(variable.name)))
        generator.gen(node.body, RETURN)

    with assumed(node, found):
        statements, _ = generator.captured(body)
    generator.emit(word("when"), tests[0] if len(tests) == 1 else expression(AND, *tests), *statements)
