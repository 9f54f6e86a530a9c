"""Proclamations, and the constants and variables of evaluation (ANSI 3.3, 3.4, 3.8).

``declaim`` and ``proclaim`` make variables special; the rest of what they say is advice that this compiler does without. It is
checked for its shape all the same, so that a slip of the pen is found.
"""

from __future__ import annotations

from ..compiler.declared_types import checkable
from cramhy_runtime.lisp_core.conditions import error, program_error, type_error, warn
from cramhy_runtime.lisp_core.conses import list_parts
from cramhy_runtime.lisp_core.data import Cons, MultipleValues, Symbol, list_from, python_list
from cramhy_runtime.lisp_core.packages import sym
from ..packages.package_errors import check_function_name
from ..types.types import is_known_type
from ..compiler.compilation_unit import muffle
from ..syntax.declaration_names import EXTENSIONS, is_declared, is_extension
from .definitions import data, proclaim_special
from ..syntax.lambda_lists import KEYWORDS

LISP_NAMES = "proclaim"
NAMING = {sym(name) for name in ("SPECIAL", "TYPE", "FTYPE", "DECLARATION")}
"""The proclamations of which ``declaim`` gives the names that they are about."""
PROCLAIMED = {sym(name) for name in ("INLINE", "NOTINLINE", "OPTIMIZE")}


def proclaim(specifier):
    """``proclaim``: returns no values."""
    _proclaim(specifier)
    return MultipleValues()


def declaim(*specifiers):
    """What a ``declaim`` form does when it is run. Returns what SBCL returns: the names of the last specifier, or nil."""
    result = None
    for specifier in specifiers:
        result = _proclaim(specifier)
    return result


def _proclaim(specifier):
    if isinstance(specifier, Symbol):  # (declaim optimize) is no declaration
        return program_error("malformed proclamation specifier: ~S", specifier)
    if not isinstance(specifier, Cons):
        return type_error(specifier, "LIST")
    kind, names = specifier.car, python_list(specifier.cdr)
    if list_parts(specifier)[1] is not None:
        return type_error(list_parts(specifier)[1], "LIST")
    if kind is sym("SPECIAL"):
        for symbol in names:
            proclaim_special(symbol)
    elif kind in (sym("TYPE"), sym("FTYPE")):
        kind_of_value, *names = names
        for name in names if kind is sym("FTYPE") else ():
            check_function_name(name, "globally declaring the FTYPE of ~S")
        for symbol in names if kind is sym("TYPE") and checkable(kind_of_value) else ():
            data(symbol)["type"] = kind_of_value
    elif kind is sym("DECLARATION"):
        for symbol in names:
            if is_known_type(symbol):
                return error("~S names a type, so it cannot be proclaimed as the name of a declaration.", symbol)
            data(symbol)["declaration"] = True
    elif kind is sym("NOTINLINE"):
        for symbol in names:
            if isinstance(symbol, Symbol):
                data(symbol)["notinline"] = True
    elif kind is sym("INLINE"):
        for symbol in names:
            if isinstance(symbol, Symbol):
                data(symbol).pop("notinline", None)
    elif is_extension(kind, "MUFFLE-CONDITIONS", "UNMUFFLE-CONDITIONS"):
        muffle(names, kind.name == "MUFFLE-CONDITIONS")
    elif not (kind in PROCLAIMED or is_extension(kind, *EXTENSIONS) or is_declared(kind) or is_known_type(kind)):
        warn("unrecognized proclamation ~S", specifier)
    return list_from(names) if kind in NAMING else None


CONSTANTS = {
    "LAMBDA-LIST-KEYWORDS": list_from([sym(name) for name in KEYWORDS.values()]),
    "CALL-ARGUMENTS-LIMIT": 2**62,
    "LAMBDA-PARAMETERS-LIMIT": 2**62,
    "MULTIPLE-VALUES-LIMIT": 2**62,
}
VARIABLES = {**CONSTANTS, "*MACROEXPAND-HOOK*": sym("FUNCALL")}
