"""Keywords of Hy stand for those of Lisp with the same name: they are equal, have equal hashes, and become them where Lisp gets them.

So ``=``, ``match``, ``case``, ``in`` and look-ups in dictionaries and sets find ``:driving`` in what a designator or a task gives, and a
keyword that Hy code puts into a fluent, a fact or a designator is Lisp's there. Lisp compares objects and never asks here.

Hy's class gets one other method, the hash: a keyword of Lisp is the key of many tables, which must stay as quick as they are. The ``match``
of Hy asks for an object of Hy's class; in a file that requires ``cramhy``, and at a prompt, it compares (`patterns`).
"""

from __future__ import annotations

import ast

import hy
from hy import models

from cramhy_runtime.lisp_core.data import STANDS_FOR
from cramhy_runtime.lisp_core.packages import keyword

from . import patches


def lisp_keyword(of_hy):
    """The keyword of Lisp for one of Hy."""
    return keyword(of_hy.name.upper())


def _hash(self):
    """That of Lisp's keyword, so names that differ by case only have one hash."""
    return hash(lisp_keyword(self))


def install():
    """Let Hy's keywords be Lisp's, in the whole process."""
    patches.hash_keywords(_hash)
    STANDS_FOR[models.Keyword] = lisp_keyword


class Values:
    """Its attributes are keywords of Hy: ``max_speed`` is ``:max-speed``, and ``as_written_max_speed`` is ``:max_speed``."""

    def __getattr__(self, name):
        written = name.removeprefix(_AS_WRITTEN)
        found = models.Keyword(hy.unmangle(name) if written == name else written, from_parser=True)
        setattr(self, name, found)
        return found


_AS_WRITTEN = "as_written_"


class patterns(ast.NodeTransformer):  # noqa: N801  it is called like a function: patterns(values).visit(pattern)
    """Makes of the pattern for a keyword, which Hy compiles to one for an object of its class, one for what is equal to the keyword.

    values: the name of the variable that has a `Values`.
    """

    def __init__(self, values):
        self.values = values

    def visit_MatchClass(self, node):  # noqa: N802
        name = _keyword_of(node)
        if name is None:
            return self.generic_visit(node)
        attribute = _AS_WRITTEN + name if "_" in name and name.isidentifier() else hy.mangle(name)
        value = ast.Attribute(ast.Name(self.values(), ast.Load()), attribute, ast.Load())
        return ast.fix_missing_locations(ast.copy_location(ast.MatchValue(ast.copy_location(value, node)), node))


def _keyword_of(node):
    """The name of the keyword that a class pattern of Hy's compiler is for, or ``None``."""
    if ast.unparse(node.cls) != "hy.models.Keyword" or len(node.patterns) != 1 or node.kwd_attrs:
        return None
    (name,) = node.patterns
    return name.value.value if isinstance(name, ast.MatchValue) and isinstance(name.value, ast.Constant) else None
