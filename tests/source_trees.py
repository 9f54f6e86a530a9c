"""Syntax trees of source files, for tests that look through all of them."""

from __future__ import annotations

import ast
import functools
import gc
from contextlib import contextmanager


@contextmanager
def many_objects_that_stay():
    """Let the collector of garbage not look at what is made in the block: it took two thirds of the time in which a thousand files are parsed."""
    gc.disable()
    try:
        yield
    finally:
        gc.freeze()
        gc.enable()


@functools.cache
def tree_of(path):
    """The tree of a file."""
    with many_objects_that_stay():
        return ast.parse(path.read_text(encoding="utf-8"))


@functools.cache
def nodes_of(tree):
    """All nodes of a tree, in the order of `ast.walk`: a tree is asked many times."""
    with many_objects_that_stay():
        return list(ast.walk(tree))
