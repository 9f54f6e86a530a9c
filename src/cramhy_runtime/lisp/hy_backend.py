"""The last step: from Hy models to Python's syntax tree, by Hy's own compiler.

Importing this module imports Hy, which costs a noticeable part of a start; so the evaluator does it when it first compiles.
"""

from __future__ import annotations

import types

from hy import models
from hy.compiler import hy_compile

from .compiler import special_forms  # noqa: F401  fills SPECIAL_FORMS
from .compiler.analyze import SPECIAL_FORMS, Analyzer
from .compiler.constants import Constants, NotStorable
from .compiler.environment import Env, FunctionScope, LocalMacro
from .compiler.generate import Generator
from .compiler.nodes import Lambda, Parameters

_module = types.ModuleType("cramhy_code")


def python_tree(statements, filename):
    """The Python module (an ``ast.Module``) that runs the Hy ``statements``."""
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


__all__ = ["Analyzer", "Constants", "Generator", "NotStorable", "is_special", "python_tree", "toplevel_with_macros"]
