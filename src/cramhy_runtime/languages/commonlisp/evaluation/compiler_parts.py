"""The compiler's parts in one place.

The evaluator imports this module when it first compiles, so that a cached program starts without the compiler.
"""

from __future__ import annotations

from ..compiler import special_exits, special_forms  # noqa: F401  they fill SPECIAL_FORMS
from ..compiler.analyze import SPECIAL_FORMS, Analyzer
from ..compiler.constants import Constants, NotStorable
from ..compiler.deep_blocks import flatten
from ..compiler.environment import Env, FunctionScope, LocalMacro, SymbolMacro
from ..compiler.generator.functions import toplevel as generated
from ..compiler.nodes import Lambda, Parameters
from ..compiler import openings  # noqa: F401  they offer shorter code
from ..compiler.python_code import allow_exits_from_cleanup, compiled
from ..compiler.python_code import module as python_tree


is_special = SPECIAL_FORMS.__contains__
"""Whether the compiler itself treats forms that begin with a symbol: special operators, and some macros."""


def toplevel_with_macros(analyzer, form, environment):
    """As `Analyzer.toplevel`, with the local macros and symbol macros of ``environment`` visible, but neither variables nor functions."""
    scope = FunctionScope()
    env = Env(None, scope)
    functions, variables = {}, {}
    outer = environment
    while outer is not None:
        functions = {**outer.functions, **functions}  # what is defined further in hides the rest
        variables = {**outer.variables, **variables}
        outer = outer.parent
    env.functions.update((name, meaning) for name, meaning in functions.items() if isinstance(meaning, LocalMacro))
    env.variables.update((name, meaning) for name, meaning in variables.items() if isinstance(meaning, SymbolMacro))
    return Lambda(None, Parameters(), analyzer.form(form, env), scope)


__all__ = [
    "Analyzer",
    "Constants",
    "NotStorable",
    "allow_exits_from_cleanup",
    "compiled",
    "flatten",
    "generated",
    "is_special",
    "python_tree",
    "toplevel_with_macros",
]
