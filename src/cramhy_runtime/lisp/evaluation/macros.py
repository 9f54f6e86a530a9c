"""Macros: expanders by symbol, and the bridge from macros written in Hy.

An expander is a Python function ``(form, environment) -> form`` kept in ``symbol.macro``. The standard macros and those of the
plan language are written in Hy, in ``hy_src/cramhy``, with Hy's quasiquote; `define_operator` enters them here. What they return
is made of Hy models and of the forms that they were given; `from_hy` turns it into Lisp data: an unqualified symbol is that of
Common Lisp if there is one, else one of the macro file's package. So a macro is written once and serves ``.lisp`` files, the
REPL and ``.hy`` files.
"""

from __future__ import annotations

import importlib
from fractions import Fraction

from ..conditions import CompileError, Condition, error
from ..data import Character, Cons, Symbol, list_from, one
from ..late import late
from ..packages import COMMON_LISP, find_package_or_error, intern, is_symbol, keyword, sym
from ..reader.backquote import QUOTE, Comma
from .functions import function_of
from .macro_shapes import SHAPES

FILES = ("cl", "clos", "cut", "prolog", "cpl", "plans", "desig", "cet", "cpm", "proj", "roslisp", "python")
"""The modules of ``hy_src/cramhy`` that define operators, in order."""

HOOK, FUNCALL = sym("*MACROEXPAND-HOOK*"), sym("FUNCALL")
_loaded = False


def ensure_loaded():
    """Load the macro files, once; called before the first compilation, so that a cached program starts without them."""
    global _loaded
    if _loaded:
        return
    for name in FILES:
        importlib.import_module(f"cramhy.{name}")
    _loaded = True


def macro_function(symbol, environment=None):
    """The expander of ``symbol``: a local macro of ``environment``, or the global one; ``None`` when it is no macro."""
    if environment is not None:
        local = environment.function(symbol)
        if local is not None:
            return getattr(local, "expander", None)
    return symbol.macro if isinstance(symbol, Symbol) else None


def define_operator(package, name, function):
    """Enter a macro written in Hy: ``function`` gets the forms of the call as Python arguments, returns models or forms.

    package: the Lisp package in which unqualified symbols of the expansion are read, and that of the macro unless ``name`` says
    ``package::name``. A function with a keyword parameter ``environment`` gets the lexical environment of the call too.
    """
    home = find_package_or_error(package)
    owner, _, short = name.upper().rpartition("::")
    owner = find_package_or_error(owner) if owner else home
    symbol = owner.intern(short)
    looks_around = "environment" in function.__code__.co_varnames[:function.__code__.co_argcount + function.__code__.co_kwonlyargcount]

    def expander(form, environment):
        try:
            expansion = function(*(form.cdr or ()), **({"environment": environment} if looks_around else {}))
        except Condition:
            raise
        except (TypeError, ValueError, AttributeError, IndexError) as problem:
            return malformed(form, symbol, problem)
        return from_hy(expansion, home, form)

    symbol.macro, expander.source = expander, function
    if short not in owner.external:
        owner.export(symbol)
    return symbol


def malformed(form, symbol, problem):
    """Signal that a call of the macro ``symbol`` has not the shape that it must have."""
    why = str(problem)
    for marker in ("positional argument", "unpack", "iterable", "takes", "missing", "has no attribute", "out of range"):
        if marker in why:
            why = "it has the wrong number of parts, or a part is not a list."
            break
    shape = SHAPES.get(symbol.name) if symbol.package is COMMON_LISP else (symbol.compiler_data or {}).get("shape")
    hint = None if shape is None else f"It is written {shape}."
    return error(CompileError("The ~A form ~S is malformed: ~A", symbol, form, why), hint=hint)


def from_hy(model, package, form=None):
    """Lisp data for a Hy model; forms inside it that are Lisp data already stay as they are.

    A Python list is a list of forms if the macro made it, and a literal vector if it stands in the ``form`` that is expanded.
    """
    kept = None

    def convert(model):
        nonlocal kept
        if type(model) is list:
            if kept is None:
                kept = _vectors_in(form)
            if id(model) in kept:
                return model
        return _converted(model, package, convert)

    return convert(model)


def _vectors_in(form):
    """The identities of the vectors that stand in ``form``."""
    found, seen, rest = set(), set(), [form]
    while rest:
        item = rest.pop()
        while isinstance(item, Cons) and id(item) not in seen:
            seen.add(id(item))
            rest.append(item.car)
            item = item.cdr
        if type(item) is list:
            found.add(id(item))
    return found


def _converted(model, package, convert):
    from hy import models

    kind = type(model)
    if kind in (Cons, str, int, float, Fraction, Character, type(None), bool) or isinstance(model, Symbol):
        return None if model is False else model
    if isinstance(model, models.Symbol):
        return _symbol(str(model), package)
    if isinstance(model, models.Keyword):
        return keyword(model.name.upper())
    if isinstance(model, (models.Expression, models.List, models.Tuple)) or kind in (list, tuple):
        items = [convert(item) for item in model]
        dot = sym("CRAMHY::|.|")
        if len(items) > 2 and items[-2] is dot:
            return list_from(items[:-2], items[-1])
        return list_from(items)
    if isinstance(model, models.String):
        return str(model)
    if isinstance(model, models.Integer):
        return int(model)
    if isinstance(model, models.Float):
        return float(model)
    return model


def _symbol(text, package):
    if text == ".":
        return intern(".", "CRAMHY")
    if text.startswith("%"):
        return intern(text[1:].upper(), "CRAMHY")
    head, colons, name = text.partition("::") if "::" in text else text.partition(":")
    if colons and head and name:
        return intern(name.upper(), head.upper())
    standard, found = COMMON_LISP.lookup(text.upper())
    return standard if found == "external" else package.intern(text.upper())


def macroexpand_1(form, environment=None):
    """(expansion, True) when ``form`` is a macro call or a symbol macro, else (form, False)."""
    ensure_loaded()
    if isinstance(form, Cons) and is_symbol(form.car):
        expander = macro_function(form.car, environment)
        if expander is not None:
            hook = HOOK.value
            if hook is FUNCALL:
                return expander(form, environment), True
            return one(function_of(hook)(expander, form, environment)), True
    elif isinstance(form, Symbol):
        local = environment.variable(form) if environment is not None else None
        expansion = getattr(local, "expansion", None)
        if expansion is None and local is None and form.compiler_data is not None:
            expansion = form.compiler_data.get("symbol-macro")
        if expansion is not None:
            return expansion, True
    return form, False


def mentions(form, symbols):
    """Whether one of ``symbols`` stands in ``form``: in its code, its templates, or what the user's macros make of it."""
    if isinstance(form, Cons) and form.car is QUOTE:
        return False
    while isinstance(form, Cons):
        head = form.car
        if isinstance(head, Symbol) and hasattr(head.macro, "__lisp_lambda_list__") and head.package is not COMMON_LISP:
            try:
                expansion = head.macro(form, None)
            except Exception:  # no call, or one of a macrolet; what is wrong with it the compiler will say
                expansion = None
            if expansion is not form and mentions(expansion, symbols):
                return True
        if mentions(head, symbols):
            return True
        form = form.cdr
    if type(form) is Comma:
        return mentions(form.form, symbols)
    if type(form) is list:
        return any(mentions(item, symbols) for item in form)
    return isinstance(form, Symbol) and form in symbols


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
    return error(CompileError(f"The expansion of {late.prin1_to_string(head)} does not end: after {MOST_EXPANSIONS} expansions there is "
                              "still a macro call. A macro must not expand into a call of itself without making it smaller.",
                              position=position))
