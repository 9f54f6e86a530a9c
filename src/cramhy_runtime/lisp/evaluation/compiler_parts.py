"""The compiler's parts in one place.

The evaluator imports this module when it first compiles, so that a cached program starts without the compiler.
"""

from __future__ import annotations

from ..compiler import special_forms  # noqa: F401  fills SPECIAL_FORMS
from ..compiler.analyze import SPECIAL_FORMS, Analyzer
from ..compiler.constants import Constants, NotStorable
from ..compiler.deep_blocks import flatten
from ..compiler.environment import Env, FunctionScope, LocalMacro
from ..compiler.generate import Generator
from ..compiler.nodes import Lambda, Parameters
from ..compiler.python_code import module as python_tree


def is_special(symbol):
    """Whether the compiler itself treats forms that begin with ``symbol``: special operators, and some macros."""
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


__all__ = ["Analyzer", "Constants", "Generator", "NotStorable", "flatten", "is_special", "python_tree", "toplevel_with_macros"]
