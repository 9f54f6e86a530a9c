"""Faces: the built-in packages, as tables of Lisp names and the Python functions behind them.

The runtime is written in Python and usable without Lisp. What of it a Lisp program sees, and under which names, stands in one
table per package, beside the code: a call of `define_face` in the room's ``package.py``. Names are the key; the Python
function is found by its name (``make-fluent`` is ``make_fluent``) or given explicitly.

A Python function with keyword-only parameters becomes a Lisp function with ``&key``: Lisp callers pass keyword objects, which
`lispify` sorts into Python keywords; Python callers go on using keywords.
"""

from __future__ import annotations

import functools
import keyword as python_keywords
import sys

from .data import Keyword, Symbol
from .dynamic import special
from .late import late
from .packages import Package, find_package, find_package_or_error, intern, keyword, register


_WORDS = (("->", "_to_"), ("/=", "_ne"), ("<=", "_le"), (">=", "_ge"), ("=", "_eq"), ("<", "_lt"), (">", "_gt"), ("+", "_plus"),
          ("*", "_star"), ("/", "_slash"), ("?", "_p"), ("!", "_bang"), ("%", "_"), (".", "_"), ("&", "_and_"), ("-", "_"))


def python_name(name):
    """The Python identifier for a Lisp name: ``make-fluent`` → ``make_fluent``, ``string=`` → ``string_eq``."""
    name = name.lower()
    if len(name) > 2 and name[0] == name[-1] == "*":
        name = name[1:-1]  # *package* is the variable `package` for Python
    plain = name.replace("-", "_")
    if "->" in name or not plain.isidentifier():
        for character, word in _WORDS:
            name = name.replace(character, word)
        plain = "".join(character if f"_{character}".isidentifier() else "_" for character in name)
    if python_keywords.iskeyword(plain):
        plain += "_"
    return plain if plain.isidentifier() else f"_{plain}"


def lispify(function):
    """``function`` as Lisp calls it: keyword objects among the arguments become Python keywords.

    A function without keyword-only parameters is returned as it is. Unknown and odd keywords are program-errors, unless the
    call says ``:allow-other-keys t`` or the function takes ``**others``.
    """
    code = getattr(function, "__code__", None)
    if code is None or not code.co_kwonlyargcount:
        return function
    positional = code.co_argcount
    names = code.co_varnames[positional:positional + code.co_kwonlyargcount]
    known = {keyword(_keyword_name(name)): name for name in names}
    takes_others = bool(code.co_flags & 0x08)
    takes_rest = bool(code.co_flags & 0x04)
    allow = keyword("ALLOW-OTHER-KEYS")

    @functools.wraps(function)
    def lisp_function(*arguments, **keywords):
        if len(arguments) <= positional:
            return function(*arguments, **keywords)
        rest = arguments[positional:]
        if len(rest) % 2:
            return late.program_error("odd number of &KEY arguments")
        unknown = []
        for index in range(0, len(rest), 2):
            key = rest[index]
            name = known.get(key) if isinstance(key, Symbol) else None
            if name is not None:
                keywords.setdefault(name, rest[index + 1])  # the first of equal keywords counts
            elif takes_others:
                if isinstance(key, Keyword):
                    keywords.setdefault(python_name(key.name), rest[index + 1])
            elif key is not allow:
                unknown.append(key)
        if unknown and not (allow in rest[::2] and rest[rest.index(allow) + 1] is not None):
            return late.unknown_key(unknown[0], known)
        return function(*(arguments if takes_rest else arguments[:positional]), **keywords)

    lisp_function.python = function
    return lisp_function


def _keyword_name(name):
    return name.rstrip("_").replace("_", "-").upper()


def define_face(name, nicknames=(), use=(), shadow=(), functions=None, variables=None, export="", internal="",
                imports=None, reexport=()):
    """Declare the built-in package ``name`` and return it.

    functions: a mapping of a module (or its name) to a string of Lisp names defined there, or of a Lisp name to a function.
    variables: a mapping of Lisp names to initial values; they are proclaimed special.
    export: further names to export (operators that are macros, markers). internal: names that are present but not external.
    imports: a mapping of package names to strings of names whose symbols are imported and exported here.
    reexport: packages whose external symbols this one exports too. shadow: names that are not taken from ``use``.
    """
    package = find_package(name)
    if package is None:
        package = register(Package(name, nicknames))
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


def attribute_symbols(package, attribute):
    """The symbols visible in ``package`` that Python code may mean by ``attribute``, its own before inherited ones.

    ``drive`` is DRIVE; ``turtle_pose`` is TURTLE-POSE or the special *TURTLE-POSE*.
    """
    package = find_package(package)
    tables = [package.internal, package.external, *(other.external for other in package.use)]
    size = sum(map(len, tables))
    index = package.__dict__.get("_attributes")
    if index is None or index[0] != size:
        names = {}
        for table in tables:
            for name, symbol in table.items():
                names.setdefault(python_name(name), []).append(symbol)
        index = package._attributes = (size, names)
    return index[1].get(attribute, ())
