"""Macros: expanders by symbol, and the expansion of forms.

An expander is a Python function ``(form, environment) -> form`` kept in ``symbol.macro``. Those of the standard macros and of the plan
language come from `operator_macros`.
"""

from __future__ import annotations

import functools
import importlib

from cramhy_runtime.lisp_core.conditions import CompileError, Error, error, handler_case, type_error
from cramhy_runtime.lisp_core.data import Cons, Symbol, one
from cramhy_runtime.lisp_core.functions import function_of
from cramhy_runtime.lisp_core.packages import COMMON_LISP, is_symbol, our_own, sym
from cramhy_runtime.lisp_core.printing import prin1_to_string
from cramhy_runtime.storage.dependency_tracing import run
from .backquote import QUOTE, Comma
from .operator_macros import define_all

FILES = ("cl", "clos", "cut", "prolog_operators", "cpl", "plans", "desig", "cpm", "proj", "roslisp", "python")
"""The modules of ``hy_src/cramhy`` that define operators, in order."""

HOOK, FUNCALL = sym("*MACROEXPAND-HOOK*"), sym("FUNCALL")


@functools.cache
def ensure_loaded():
    """Load the macro files, once; called before the first compilation, so that a cached program starts without them."""
    with our_own:
        for name in FILES:
            importlib.import_module(f"cramhy.{name}")
        define_all()


def macro_function(symbol, environment=None):
    """The expander of ``symbol``: a local macro of ``environment``, or the global one; ``None`` when it is no macro."""
    if environment is not None:
        local = environment.function(symbol)
        if local is not None:
            return getattr(local, "expander", None)
    return symbol.macro if isinstance(symbol, Symbol) else None


def checked_environment(environment):
    """``environment``, which is an argument of the user's: nil or what a macro got behind ``&environment``."""
    if environment is None or hasattr(environment, "variable") and hasattr(environment, "function"):
        return environment
    return type_error(environment, "(OR SB-C::ABSTRACT-LEXENV NULL)")


def macroexpand_1(form, environment=None):
    """(expansion, True) when ``form`` is a macro call or a symbol macro, else (form, False)."""
    ensure_loaded()
    if isinstance(form, Cons) and is_symbol(form.car):
        expander = macro_function(form.car, environment)
        if expander is not None:
            hook = HOOK.value
            if hook is FUNCALL:
                return run(expander, form, environment), True
            return one(run(function_of(hook), expander, form, environment)), True
    elif isinstance(form, Symbol):
        local = environment.variable(form) if environment is not None else None
        expansion = getattr(local, "expansion", None)
        if expansion is None and local is None and form.compiler_data is not None:
            expansion = form.compiler_data.get("symbol-macro")
        if expansion is not None:
            return expansion, True
    return form, False


def mentions(form, symbols, plain=None):
    """Whether one of ``symbols`` stands in ``form``: in its code, its templates, or what the user's macros make of it.

    plain: a symbol; where it stands as a call without arguments it does not count.
    """
    if isinstance(form, Cons) and (form.car is QUOTE or plain is not None and form.car is plain and form.cdr is None):
        return False
    while isinstance(form, Cons):
        head = form.car
        if isinstance(head, Symbol) and hasattr(head.macro, "__lisp_lambda_list__") and head.package is not COMMON_LISP:
            expansion = _tried(head.macro, form)
            if expansion is not form and mentions(expansion, symbols, plain):
                return True
        if mentions(head, symbols, plain):
            return True
        form = form.cdr
    if type(form) is Comma:
        return mentions(form.form, symbols, plain)
    if type(form) is list:
        return any(mentions(item, symbols, plain) for item in form)
    return isinstance(form, Symbol) and form in symbols


def _tried(macro, form):
    """What ``macro`` makes of ``form``; ``None`` after an error: it is no call, as the ``(test)`` of the clause ``(1 test)``, or one of a
    macrolet. What is wrong with a call the compiler will say, so the error enters no debugger."""
    return handler_case([(Error, lambda condition: None)], lambda: macro(form, None))


def macroexpand(form, environment=None):
    """``form`` expanded until its head is no macro any more, and whether anything was expanded."""
    return expand_fully(form, lambda form: macroexpand_1(form, environment))


MOST_EXPANSIONS = 10_000


def expand_fully(form, expand, position=None):
    """``form`` expanded by ``expand`` (see `macroexpand_1`) as often as possible, and whether anything was expanded.

    position: where the form stands, for the error when that does not end.
    """
    for count in range(MOST_EXPANSIONS):
        form, more = expand(form)
        if not more:
            return form, count > 0
    head = form.car if isinstance(form, Cons) else form
    return error(
        CompileError(
            f"The expansion of {prin1_to_string(head)} does not end: after {MOST_EXPANSIONS} expansions there is "
            "still a macro call. A macro must not expand into a call of itself without making it smaller.",
            position=position,
        )
    )
