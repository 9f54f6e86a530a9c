"""Code nested deeper than Python allows: the inner part becomes a function of its own.

Python compiles at most 20 ``for``, ``while``, ``try`` and ``with`` statements inside each other in one function; Lisp has no such
limit, and macros reach it (the clauses of ITERATE do). Where the limit is reached, a block moves into a function that stands in its
place and is called once. It shares the variables of its surroundings (``nonlocal``), and the ways out of it become values:

    def _deep1():                    (v,) for ``return v``, 1 for ``break``, 2 for ``continue``, None for the end of the block
    _way = _deep1()

Only code that Python has refused comes here, so ordinary code pays nothing. Source: CO_MAXBLOCKS in Python's compiler.
"""

from __future__ import annotations

import ast
from itertools import count

_BLOCKS = (ast.For, ast.While, ast.Try, ast.With)
_FUNCTIONS = (ast.FunctionDef, ast.Lambda)
LIMIT = 9
"""Blocks that stay together in one function; ``finally`` and ``except`` take room of their own."""


def flatten(tree):
    """The module ``tree`` with no function in it nested too deeply; it is changed in place and returned."""
    numbers = count(1)
    for node in [node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)]:
        _flatten_function(node, numbers)
    _flatten_function(tree, numbers)
    return ast.fix_missing_locations(tree)


def _flatten_function(function, numbers):
    _Cutter(function, numbers).statements(function.body, 0, False)


def _own_nodes(node):
    """The nodes below ``node`` that run in the same function, the definitions of inner functions (not their bodies) among them."""
    rest = list(ast.iter_child_nodes(node))
    while rest:
        item = rest.pop()
        yield item
        if not isinstance(item, _FUNCTIONS):
            rest.extend(ast.iter_child_nodes(item))


def _assigned(node):
    for item in (node, *_own_nodes(node)):
        if isinstance(item, ast.Name) and not isinstance(item.ctx, ast.Load):
            yield item.id
        elif isinstance(item, ast.FunctionDef):
            yield item.name
        elif isinstance(item, ast.ExceptHandler) and item.name:
            yield item.name


class _Cutter:
    """Cuts one function (or module) into functions."""

    def __init__(self, function, numbers):
        self.function, self.numbers = function, numbers
        self.at_module = isinstance(function, ast.Module)
        self.globals = {name for item in _own_nodes(function) if isinstance(item, ast.Global) for name in item.names}
        self.foreign = {name for item in _own_nodes(function) if isinstance(item, ast.Nonlocal) for name in item.names}

    def statements(self, body, depth, in_loop):
        """Cut the statements ``body``, which stand ``depth`` blocks deep; ``in_loop``: a loop of this function is around them."""
        for statement in list(body):
            if isinstance(statement, _BLOCKS) and depth >= LIMIT:
                body[body.index(statement) : body.index(statement) + 1] = self.cut(statement, in_loop)
            elif not isinstance(statement, _FUNCTIONS):
                self.inside(statement, depth + isinstance(statement, _BLOCKS), in_loop)

    def inside(self, statement, depth, in_loop):
        looping = in_loop or isinstance(statement, (ast.For, ast.While))
        for name in ("body", "orelse", "finalbody"):
            if isinstance(getattr(statement, name, None), list):
                self.statements(getattr(statement, name), depth, looping if name == "body" else in_loop)
        for handler in getattr(statement, "handlers", ()):
            self.statements(handler.body, depth, in_loop)

    def cut(self, block, in_loop):
        """The statements that take the place of ``block``."""
        name = f"_deep{next(self.numbers)}"
        names = sorted(set(_assigned(block)))
        ways = _Ways()
        inner = ast.FunctionDef(
            name=name,
            args=ast.arguments(posonlyargs=[], args=[], kwonlyargs=[], kw_defaults=[], defaults=[]),
            body=[ways.visit(block)],
            decorator_list=[],
        )
        shared = [item for item in names if not self.at_module and item not in self.globals]
        everywhere = [item for item in names if item not in shared]
        if everywhere:
            inner.body.insert(0, ast.Global(names=everywhere))
        if shared:
            inner.body.insert(0, ast.Nonlocal(names=shared))
            self.declare([item for item in shared if item not in self.foreign])
        _Cutter(inner, self.numbers).statements(inner.body, 0, False)
        result = f"{name}_way"
        after = [ast.copy_location(inner, block), _parsed(f"{result} = {name}()")]
        if ways.returns:
            after.append(_parsed(f"if {result}.__class__ is tuple:\n    return {result}[0]"))
        if ways.breaks and in_loop:
            after.append(_parsed(f"if {result} == 1:\n    break"))
        if ways.continues and in_loop:
            after.append(_parsed(f"if {result} == 2:\n    continue"))
        for item in after[1:]:
            for node in ast.walk(item):
                ast.copy_location(node, block)
        return after

    def declare(self, names):
        """Make ``names`` variables of the function, without giving them a value."""
        if names:
            never = _parsed("if False:\n    " + "\n    ".join(f"{name} = None" for name in names))
            place = next((index for index, item in enumerate(self.function.body) if not isinstance(item, (ast.Global, ast.Nonlocal))), 0)
            self.function.body.insert(place, never)


class _Ways(ast.NodeTransformer):
    """Turns the ways out of a block into values; jumps within its own loops stay."""

    def __init__(self):
        self.loops = 0
        self.returns = self.breaks = self.continues = False

    def visit_FunctionDef(self, node):
        return node

    visit_Lambda = visit_FunctionDef

    def visit_loop(self, node):
        self.loops += 1
        node.body = [self.visit(item) for item in node.body]
        self.loops -= 1
        node.orelse = [self.visit(item) for item in node.orelse]
        return node

    visit_For = visit_While = visit_loop

    def visit_Return(self, node):
        self.returns = True
        value = node.value or ast.Constant(None)
        return ast.copy_location(ast.Return(ast.Tuple([value], ast.Load())), node)

    def visit_Break(self, node):
        if self.loops:
            return node
        self.breaks = True
        return ast.copy_location(ast.Return(ast.Constant(1)), node)

    def visit_Continue(self, node):
        if self.loops:
            return node
        self.continues = True
        return ast.copy_location(ast.Return(ast.Constant(2)), node)


def _parsed(text):
    return ast.parse(text).body[0]
