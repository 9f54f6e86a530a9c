"""What code of the user's may ask of Lisp's world while a file is compiled, for `storage.dependency_tracing`.

A macro, a reader macro or the form behind ``#.`` may look at the value of a variable, at a property of a symbol, at whether there is such
a package, function or class, at how numbers are printed. `install` lets traces hear of it: functions that ask are in `_ASK`, variables are
found in the code that runs. The answers come from `lisp_answers`.

``gentemp``, ``*random-state*`` and the like have no answer that could be compared: code that asks for them is not kept.
"""

from __future__ import annotations

import functools
import types
from collections.abc import Callable
from typing import Any

from cramhy_runtime.lisp_core.data import Cons, Symbol
from cramhy_runtime.lisp_core.functions import apply, funcall, function_of
from cramhy_runtime.lisp_core.packages import Package, sym
from cramhy_runtime.storage import dependency_tracing
from cramhy_runtime.storage.dependency_tracing import Trace, questions

from ..compiler.support import called_function
from ..objects.classes import defined_class
from ..streams.streams import Stream
from . import lisp_answers
from .code_dependencies import globals_of


def _ask_symbol(kind: str, trace: Trace, symbol: object) -> None:
    if isinstance(symbol, Cons) and isinstance(symbol.cdr, Cons):  # (setf name)
        symbol = symbol.cdr.car
    if isinstance(symbol, Symbol) and symbol.package is not None:
        trace.ask(kind, (symbol.package.name, symbol.name))


def _of_symbol(kind: str, argument: str) -> Callable[[Trace, Any], None]:
    return lambda trace, arguments: _ask_symbol(kind, trace, arguments[argument])


def _of_call(trace: Trace, arguments: Any) -> None:
    form = arguments["form"]
    _ask_symbol("function", trace, form.car if isinstance(form, Cons) else form)


def _name_of(package: object) -> str | None:
    if isinstance(package, Package):
        return package.name
    return str(getattr(package, "name", package)) if package is not None else None


def _of_package(kind: str, argument: str) -> Callable[[Trace, Any], None]:
    def note(trace: Trace, arguments: Any) -> None:
        name = _name_of(arguments[argument])
        if name is not None:
            trace.ask(kind, name)

    return note


def _of_name(trace: Trace, arguments: Any) -> None:
    from ..evaluation.evaluator import PACKAGE

    package = arguments.get("package")
    name = PACKAGE.value.name if not isinstance(package, (Package, str, Symbol)) else _name_of(package)
    if name is not None:
        trace.ask("name", (name, str(arguments["name"])))


def _of_everything(trace: Trace, arguments: Any) -> None:
    trace.ask("packages", "")


def _refused(reason: str) -> Callable[[Trace, Any], None]:
    return lambda trace, arguments: trace.refuse(reason)


_CLOCK = _refused("it looks at the clock")
_SOMEBODY = _refused("it asks somebody at the terminal")
_ASK: dict[str, Callable[[Trace, Any], None]] = {
    **{name: _of_symbol("function", "name") for name in ("FBOUNDP", "FDEFINITION", "COMPILER-MACRO-FUNCTION")},
    **{name: _of_symbol("function", "symbol") for name in ("SYMBOL-FUNCTION", "MACRO-FUNCTION", "SPECIAL-OPERATOR-P")},
    **{name: _of_symbol("variable", "symbol") for name in ("BOUNDP", "SYMBOL-VALUE")},
    **{name: _of_symbol("properties", "symbol") for name in ("GET", "SYMBOL-PLIST")},
    **{name: _of_call for name in ("MACROEXPAND", "MACROEXPAND-1", "CONSTANTP")},
    "FIND-CLASS": _of_symbol("class", "symbol"),
    "TYPEP": _of_symbol("class", "type_specifier"),
    "SUBTYPEP": _of_symbol("class", "type_1"),
    "FIND-PACKAGE": _of_package("package", "designator"),
    **{
        name: _of_package("package", "designator")
        for name in ("PACKAGE-USE-LIST", "PACKAGE-NICKNAMES", "PACKAGE-SHADOWING-SYMBOLS", "PACKAGE-NAME")
    },
    "FIND-SYMBOL": _of_name,
    "CRAMHY::PACKAGE-SYMBOLS": _of_package("symbols", "package"),
    "CRAMHY::PACKAGE-ITERATOR": _of_everything,
    **{name: _of_everything for name in ("LIST-ALL-PACKAGES", "PACKAGE-USED-BY-LIST", "FIND-ALL-SYMBOLS", "APROPOS", "APROPOS-LIST")},
    **{name: _CLOCK for name in ("GET-UNIVERSAL-TIME", "GET-DECODED-TIME", "GET-INTERNAL-REAL-TIME", "GET-INTERNAL-RUN-TIME")},
    **{name: _refused("it depends on chance") for name in ("RANDOM", "MAKE-RANDOM-STATE")},
    "GENTEMP": _refused("it depends on how many symbols were made before"),
    **{name: _SOMEBODY for name in ("Y-OR-N-P", "YES-OR-NO-P")},
    **{name: _refused("it looks at the machine") for name in ("MACHINE-INSTANCE", "ROOM")},
}


_LISP = "cramhy_runtime.languages.commonlisp"
_SETTINGS = {
    "settings": tuple(f"{_LISP}.{part}." for part in ("printer", "format", "reader", "files", "pathnames", "streams")),
    "features": (f"{_LISP}.reader.",),
}
"""Kind of answer → the modules whose functions look at how Lisp reads and prints, and at the features."""

_uses: dict[int, tuple[types.CodeType, set[str], list[tuple[Symbol, frozenset[str]]]]] = {}
"""Number of a code object → it, what it asks for of `_SETTINGS`, and the symbols that it uses, with the attributes of them. The hash of a
code object would take longer than what is looked up."""


def _uses_of(code: types.CodeType, names: dict[str, Any]) -> tuple[types.CodeType, set[str], list[tuple[Symbol, frozenset[str]]]]:
    known = _uses.get(id(code))
    if known is None:
        settings, symbols = set(), []
        for name, attributes in globals_of(code):
            value = names.get(name)
            if not isinstance(value, Symbol):
                module = getattr(value, "__module__", None) or ""
                settings |= {kind for kind, modules in _SETTINGS.items() if module.startswith(modules)}
            elif value.package is not None and not value.constant and not (value.package.built_in and "value" not in attributes):
                symbols.append((value, attributes))
        if len(_uses) > 5000:
            _uses.clear()
        known = _uses[id(code)] = code, settings, symbols
    return known


def _expands(trace: Trace, function: Any, arguments: tuple[Any, ...]) -> None:
    """A macro, a compiler macro, the expander of a place or of a type is called, with the form: it may close over a table.

    That of a ``macrolet`` is part of the text.
    """
    form = arguments[0] if arguments else None
    symbol = form.car if isinstance(form, Cons) else None
    if isinstance(symbol, Symbol) and any(function is each for each in lisp_answers.expanders(symbol)):
        _ask_symbol("function", trace, symbol)


def _of_designator(trace: Trace, arguments: Any) -> None:
    """A symbol may stand for a function, which is called."""
    symbol = next(iter(arguments.values()))
    if isinstance(symbol, Symbol) and symbol.package is not None and not symbol.package.built_in:
        _ask_symbol("function", trace, symbol)


def _observe(trace: Trace, code: types.CodeType, names: dict[str, Any]) -> None:
    """A function in compiled Lisp runs: it reads variables and calls functions."""
    if names.get("__name__") != "cramhy_code":
        return
    _, settings, symbols = _uses_of(code, names)
    for kind in settings:
        trace.ask(kind, "")
    for symbol, attributes in symbols:
        if "value" in attributes and not isinstance(symbol.value, Stream):
            _ask_symbol("variable", trace, symbol)
        if not symbol.package.built_in:
            if "function" in attributes or "setf_function" in attributes:
                _ask_symbol("function", trace, symbol)
            if defined_class(symbol) is not None:
                _ask_symbol("class", trace, symbol)


@functools.cache
def install() -> None:
    """Let traces know the questions of Lisp."""
    for name, note in _ASK.items():
        package, _, short = name.rpartition(":")
        symbol = sym(f"{package.rstrip(':')}::{short}") if package else sym(name)
        questions(symbol.function, note)
    for function in (function_of, called_function, funcall, apply):
        questions(function, _of_designator)
    dependency_tracing.OBSERVERS.append(_observe)
    dependency_tracing.CALLS.append(_expands)


__all__ = ["install"]
