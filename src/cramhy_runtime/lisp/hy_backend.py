"""The last step: from Hy models to Python's syntax tree, by Hy's own compiler.

Importing this module imports Hy, which costs a noticeable part of a start; so the evaluator does it when it first compiles.
"""

from __future__ import annotations

import ast
import types

from hy import models
from hy.compiler import hy_compile
from hy.errors import HyError

from .compiler import special_forms  # noqa: F401  fills SPECIAL_FORMS
from .compiler.analyze import SPECIAL_FORMS, Analyzer
from .compiler.constants import Constants, NotStorable
from .compiler.destinations import NONE, TRUE
from .compiler.environment import Env, FunctionScope, LocalMacro
from .compiler.generate import Generator
from .compiler.nodes import Lambda, Parameters

_module = types.ModuleType("cramhy_code")


def _place(model, place):
    """Give every model below ``model`` that has no place that of the expression around it.

    Python takes the place of a call from its function part, which stands nowhere in the user's text.
    """
    if "_start_line" not in vars(model):  # Hy says 1 for a model without a place
        if place is not None:
            model.start_line, model.start_column, model.end_line, model.end_column = place
    else:
        # only where it begins: Python lets a call begin where its function part ends
        place = model.start_line, model.start_column, model.start_line, model.start_column + 1
    for part in model:
        if isinstance(part, models.Sequence):
            _place(part, place)
        elif place is not None and part is not NONE and part is not TRUE and "_start_line" not in vars(part):
            part.start_line, part.start_column, part.end_line, part.end_column = place


def python_tree(statements, filename):
    """The Python module (an ``ast.Module``) that runs the Hy ``statements``."""
    for statement in statements:
        if isinstance(statement, models.Sequence):
            _place(statement, None)
    return tidy(hy_compile(models.Expression([models.Symbol("do"), *statements]), _module, filename=filename, source="",
                           import_stdlib=False))


def tidy(tree):
    """``tree`` without what Hy adds because its statements are expressions: variables that only ever hold ``None``, and what
    stands after a jump. Our generator delivers all values itself, so these cost time in every turn of a loop and mean nothing."""
    used = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Assign):
            if not _is_nothing(node.value):
                used.update(target.id for target in node.targets if isinstance(target, ast.Name))
        elif isinstance(node, ast.Return):
            if isinstance(node.value, ast.Name):
                node.value.ctx = None  # returning the variable is no use of it
        elif isinstance(node, ast.AnnAssign | ast.NamedExpr):
            used.add(getattr(node.target, "id", None))
    for node in ast.walk(tree):
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Load):
            used.add(node.id)
    for node in ast.walk(tree):
        for name in ("body", "orelse", "finalbody"):
            statements = getattr(node, name, None)
            if isinstance(statements, list):
                kept = _without_empty(statements, used)
                if statements and not kept and name == "body":
                    kept = [ast.copy_location(ast.Pass(), statements[0])]
                setattr(node, name, kept)
        if isinstance(node, ast.Return) and isinstance(node.value, ast.Name):
            node.value.ctx = ast.Load()
    return tree


def _is_nothing(value):
    return isinstance(value, ast.Constant) and value.value is None


def _without_empty(statements, used):
    kept = []
    for statement in statements:
        if isinstance(statement, ast.Assign) and isinstance(statement.targets[0], ast.Name):
            name = statement.targets[0].id
            if name.startswith("_hy_anon") and name not in used:
                continue
        if isinstance(statement, ast.Return) and isinstance(statement.value, ast.Name):
            name = statement.value.id
            if name.startswith("_hy_anon") and name not in used:
                continue
        kept.append(statement)
        if isinstance(statement, ast.Return | ast.Break | ast.Continue | ast.Raise):
            break
    return kept


def is_special(symbol):
    return symbol in SPECIAL_FORMS


def toplevel_with_macros(analyzer, form, environment):
    """As `Analyzer.toplevel`, with the local macros (but not the variables) of ``environment`` visible."""
    scope = FunctionScope()
    env = Env(None, scope)
    outer = environment
    while outer is not None:
        for name, meaning in outer.functions.items():
            if isinstance(meaning, LocalMacro):
                env.functions.setdefault(name, meaning)
        outer = outer.parent
    return Lambda(None, Parameters(), analyzer.form(form, env), scope)


__all__ = ["Analyzer", "Constants", "Generator", "HyError", "NotStorable", "is_special", "python_tree", "toplevel_with_macros"]
