"""Faces: the built-in packages, as tables of Lisp names and the Python functions behind them.

The runtime is written in Python and usable without Lisp. What of it a Lisp program sees, and under which names, stands in one
table per package: a call of `define_face` in the module ``package`` of the room's face. Names are the key; the Python
function is found by its name (``make-fluent`` is ``make_fluent``) or given explicitly.

A Python function with keyword-only parameters becomes a Lisp function with ``&key``: Lisp callers pass keyword objects, which
`lispify` sorts into Python keywords; Python callers go on using keywords.
"""

from __future__ import annotations

import sys
from types import FunctionType

from cramhy_runtime.lisp_core.dispatch.open_functions import open_to_methods
from cramhy_runtime.lisp_core.dynamic import special
from cramhy_runtime.lisp_core.keyword_calls import lispify
from cramhy_runtime.lisp_core.python_names import python_name
from cramhy_runtime.lisp_core.packages import ensure_package, find_package_or_error, intern


def define_face(
    name, nicknames=(), use=(), shadow=(), functions=None, variables=None, export="", internal="", imports=None, reexport=(), generic=""
):
    """Declare the built-in package ``name`` and return it.

    functions: a mapping of a module (or its name) to a string of Lisp names defined there, or of a Lisp name to a function.
    variables: a mapping of Lisp names to initial values; they are proclaimed special.
    export: further names to export (operators that are macros, markers). internal: names that are present but not external.
    imports: a mapping of package names to strings of names whose symbols are imported and exported here.
    reexport: packages whose external symbols this one exports too. shadow: names that are not taken from ``use``.
    generic: names from ``functions`` whose functions are generic in the original, for arguments of any class: users may define methods.
    """
    package = ensure_package(name, *nicknames)
    package.built_in = True
    for symbol_name in shadow.split() if isinstance(shadow, str) else shadow:
        package.shadow(symbol_name.upper())
    for other, names in (imports or {}).items():
        source = find_package_or_error(other)
        for symbol_name in names.upper().split():
            package.shadowing_import(source.intern(symbol_name))
            package.export(package.intern(symbol_name))
    for other in use:
        package.use_package(find_package_or_error(other))
    for key, value in (functions or {}).items():
        for symbol_name, function in _functions(key, value):
            symbol = package.intern(symbol_name)
            symbol.function = lispify(function)
            package.export(symbol)
    for symbol_name in generic.upper().split():
        symbol = package.intern(symbol_name)
        open_to_methods(getattr(symbol.function, "python", symbol.function), f"{package.name}::{symbol_name}")
    for variable, value in (variables or {}).items():
        package.export(special(package.intern(variable.upper()), value))
    for symbol_name in export.upper().split():
        package.export(package.intern(symbol_name))
    for symbol_name in internal.upper().split():
        symbol = package.intern(symbol_name)
        if symbol_name in package.external:
            package.unexport(symbol)
    for other in reexport:
        for symbol_name in list(find_package_or_error(other).external):
            package.export(package.intern(symbol_name))
    return package


def define_meanings(table, *modules, adapters=None):
    """Enter into CRAMHY what the operators of ``table`` call: for ``%name`` in a template, and for an operator's own name, the function of
    one of ``modules``.

    adapters: a module all of whose public functions are entered. They turn Lisp's lists into what a room's function takes.
    """
    names = {name: python_name(name) for operator in table.values() for name in operator.meanings}
    found = {name: vars(module)[function] for module in modules for name, function in names.items() if function in vars(module)}
    for name, value in vars(adapters).items() if adapters is not None else ():
        if value.__class__ is FunctionType and value.__module__ == adapters.__name__ and name[0] != "_" and name != "define":
            found[name.replace("_", "-")] = value
    define_face("CRAMHY", functions=found)


def _functions(key, value):
    if isinstance(value, str):
        module = sys.modules[key] if isinstance(key, str) else key
        for lisp_name in value.split():
            attribute = python_name(lisp_name)
            function = getattr(module, attribute, None)
            if function is None:
                function = getattr(module, attribute + "_", None)
            if function is None:
                raise AttributeError(f"{module.__name__} defines no {attribute} for the Lisp name {lisp_name}")
            yield lisp_name.upper(), function
    else:
        yield key.upper(), value


def lisp_function(designator):
    """Decorator: make the Python function the global function of the symbol ``"PACKAGE::NAME"``."""

    def define(function):
        package, _, name = designator.rpartition("::")
        intern(name, package or "COMMON-LISP").function = lispify(function)
        return function

    return define
