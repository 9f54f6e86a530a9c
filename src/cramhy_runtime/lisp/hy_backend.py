"""The last step: from Hy models to Python's syntax tree, by Hy's own compiler.

Importing this module imports Hy, which costs a noticeable part of a start; so the evaluator does it when it first compiles.
"""

from __future__ import annotations

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
    return hy_compile(models.Expression([models.Symbol("do"), *statements]), _module, filename=filename, source="",
                      import_stdlib=False)


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
