"""Calls that describe: symbols, functions, documentation, apropos."""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import UNBOUND, Symbol, UndefinedFunction
from cramhy_runtime.lisp_core.dispatch.generic_functions import GenericFunction
from cramhy_runtime.lisp_core.packages import is_symbol, sym
from cramhy_runtime.languages.commonlisp.evaluation.forms import SPECIAL_OPERATORS
from cramhy_runtime.languages.commonlisp.objects.classes import registered_class
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string
from cramhy_runtime.languages.commonlisp.tools import apropos
from cramhy_runtime.languages.commonlisp.tools.describing import description
from cramhy_runtime.languages.commonlisp.tools.documentation import shown_documentation
from cramhy_runtime.languages.operators import operator_of

from ..rpcs import Refused, rpc, text
from ..wire import Name
from .packages import package_named, symbol_of

FUNCTION, VARIABLE, TYPE = sym("FUNCTION"), sym("VARIABLE"), sym("TYPE")
MOST_FOUND = 500


@rpc("describe-symbol")
def describe_symbol(call, name):
    return description(symbol_of(call, name))


@rpc("describe-function")
def describe_function(call, name):
    symbol = symbol_of(call, name)
    function = getattr(symbol, "macro", None) or getattr(symbol, "function", None)
    if function is None or isinstance(function, UndefinedFunction):
        raise Refused(f"{prin1_to_string(symbol)} is no function, no macro and no special operator.")
    return description(function)


@rpc("describe-definition-for-emacs")
def describe_definition(call, name, kind=None):
    return description(symbol_of(call, name))


@rpc("describe-inspectee")
def describe_inspectee(call):
    if call.connection.inspector is None:
        raise Refused("Nothing is inspected.")
    return description(call.connection.inspector.object)


@rpc("documentation-symbol")
def documentation_symbol(call, name):
    symbol = symbol_of(call, name)
    found = [f"Documentation for the symbol {prin1_to_string(symbol)}:\n", *(f"{label}:\n {told}\n" for label, told in _documented(symbol))]
    return "\n".join(found) if len(found) > 1 else f"Not documented: {prin1_to_string(symbol)}."


def _documented(symbol):
    operator = operator_of(symbol)
    if operator is not None:
        yield "Operator", f"{operator.shape}\n {operator.documentation}"
    for label, kind in (("Variable", VARIABLE), ("Function", FUNCTION), ("Type", TYPE)):
        told = shown_documentation(symbol, kind) if not (operator is not None and kind is FUNCTION) else None
        if isinstance(told, str):
            yield label, str(told).strip()


@rpc("apropos-list-for-emacs")
def apropos_list(call, pattern, external_only=None, case_sensitive=None, package=None):
    home = package_named(package) if isinstance(package, str) else None
    words = text(pattern).split() or [""]
    found = list(apropos.apropos_list(words[0].upper(), home, True if external_only and home else None) or ())
    found = [symbol for symbol in found if all(word.upper() in symbol.name for word in words)]
    if external_only and home is None:
        found = [symbol for symbol in found if symbol.package is None or symbol.name in symbol.package.external]
    shown = []
    for symbol in found:
        facts = _facts(symbol)
        if facts:
            shown.append([Name(":designator"), prin1_to_string(symbol), *facts])
        if len(shown) >= MOST_FOUND:
            break
    return shown


def _facts(symbol):
    """A property list: what a symbol means, with the first line of its documentation."""
    if not is_symbol(symbol) or not isinstance(symbol, Symbol):
        return [Name(":variable"), Name(":not-documented")]
    function = None if isinstance(symbol.function, UndefinedFunction) else symbol.function
    kinds = [
        (":variable", symbol.value is not UNBOUND, VARIABLE),
        (":generic-function", isinstance(function, GenericFunction), FUNCTION),
        (":function", function is not None and not isinstance(function, GenericFunction), FUNCTION),
        (":macro", symbol.macro is not None, FUNCTION),
        (":special-operator", symbol in SPECIAL_OPERATORS, FUNCTION),
        (":class", registered_class(symbol) is not None, TYPE),
    ]
    facts = []
    for name, is_so, kind in kinds:
        if is_so:
            operator = operator_of(symbol) if name == ":macro" else None
            told = operator.documentation if operator is not None else shown_documentation(symbol, kind)
            first = str(told).strip().partition("\n")[0] if isinstance(told, str) and told.strip() else Name(":not-documented")
            facts += [Name(name), first]
    return facts
