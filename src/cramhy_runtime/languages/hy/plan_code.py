"""What the loops, the ``finally`` and the ``match`` of a Hy program have beside what they say: a checkpoint, a shield, keywords of Lisp.

A task is preempted, and asked to end, at park points and checkpoints. Compiled Common Lisp has a checkpoint in each turn of a loop, and
its cleanup forms are shielded (law 2). Hy knows of neither. So each syntax tree that Hy's compiler has made is gone through before
Python compiles it:

* ``while`` and ``for`` take one of ``budget.ticks`` in each turn, as loops of Lisp do, which costs Python some nanoseconds;
* what stands in ``finally`` stands in a `kernel.cleanup`, which no request to end interrupts. A generator that yields there is left
  alone: a shield must not stay up while its caller goes on;
* the pattern ``:driving`` in ``match`` fits what is equal to the keyword, see `keywords`.

Comprehensions stay as they are, since Python has no place for a statement in them.
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterable

from . import keywords

_LOOPS = (ast.While, ast.For)
_TRIES = (ast.Try, getattr(ast, "TryStar", ast.Try))
_LEAVES_THE_STACK = (ast.Yield, ast.YieldFrom, ast.Await)
_FUNCTIONS = (ast.FunctionDef, ast.AsyncFunctionDef, ast.Lambda)

Names = Callable[[str], str]
"""Gives the global variable that has a function or an object of `calls`, by its name there."""


def complete(trees: Iterable[ast.AST], names: Names) -> None:
    """Give the loops, the ``finally`` and the ``match`` in ``trees`` what they lack."""
    for tree in trees:
        _complete(tree, names, False)


def _complete(node, names, in_a_class):
    """in_a_class: whether a variable that ``node`` assigns is an attribute of a class."""
    inside = isinstance(node, ast.ClassDef) or in_a_class and not isinstance(node, _FUNCTIONS)
    for child in ast.iter_child_nodes(node):
        _complete(child, names, inside)
    if isinstance(node, ast.match_case):
        node.pattern = keywords.patterns(lambda: names("keyword_values")).visit(node.pattern)
    elif isinstance(node, _LOOPS):
        node.body.insert(0, _at(node, _call(names("checkpoint")) if in_a_class else _turn(names)))
    elif isinstance(node, _TRIES) and node.finalbody and not _yields(node.finalbody):
        node.finalbody = [_at(node.finalbody[0], _shielded(names, node.finalbody))]


def _turn(names):
    """``for VARIABLE in BUDGET.ticks: break`` with ``else: refill()``: when there are no more ticks, others run. The quickest way."""
    return ast.For(
        target=ast.Name("_cramhy_turn", ast.Store()),
        iter=ast.Attribute(_variable(names("budget")), "ticks", ast.Load()),
        body=[ast.Break()],
        orelse=[_call(names("refill"))],
    )


def _call(name):
    return ast.Expr(ast.Call(_variable(name), [], []))


def _shielded(names, body):
    return ast.With(items=[ast.withitem(ast.Call(_variable(names("cleanup_here")), [], []))], body=body)


def _variable(name):
    return ast.Name(name, ast.Load())


def _at(place, node):
    """``node`` with the place of ``place``; what in it has a place of its own keeps that."""
    ast.copy_location(node, place)
    return ast.fix_missing_locations(node)


def _yields(statements):
    """Whether the statements of a function may give the stack to its caller before they are done."""
    rest = list(statements)
    while rest:
        node = rest.pop()
        if isinstance(node, _LEAVES_THE_STACK):
            return True
        rest += [child for child in ast.iter_child_nodes(node) if not isinstance(child, _FUNCTIONS)]
    return False


__all__ = ["complete"]
