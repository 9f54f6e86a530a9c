"""The functions on symbols: their values, functions and names, and making new ones (ANSI chapter 10)."""

from __future__ import annotations

from .. import packages
from ..collections.sequence_types import is_string
from ..compiler.support import fdefinition, value_of
from ..conditions import SimpleTypeError, error, type_error
from ..data import Cons, Keyword, Symbol, UNBOUND, UndefinedFunction, truth
from ..evaluation.definitions import traced_like
from ..evaluation.evaluator import PACKAGE
from ..packages import find_package_or_error, is_symbol, sym
from .package_errors import check_symbol

LISP_NAMES = """symbolp keywordp symbol-name symbol-package symbol-value set symbol-function boundp fboundp makunbound fmakunbound
make-symbol gensym gentemp copy-symbol"""


def _symbol(obj):
    return obj if is_symbol(obj) else type_error(obj, "SYMBOL", "\nwhen binding SYMBOL")


def symbolp(obj):
    return True if is_symbol(obj) else None


def keywordp(obj):
    return True if isinstance(obj, Keyword) else None


def symbol_name(symbol):
    return packages.symbol_name(_symbol(symbol))


def symbol_package(symbol):
    return packages.symbol_package(_symbol(symbol))


def symbol_value(symbol):
    return value_of(symbol) if isinstance(_symbol(symbol), Symbol) else symbol


def set_symbol_value(value, symbol):
    if not is_symbol(symbol):
        return type_error(symbol, "SYMBOL", "\nwhen binding SYMBOL")
    if not isinstance(symbol, Symbol) or symbol.constant:
        maxim = {None: "Nihil ex nihil. (can't set ~S of NIL)", True: "Veritas aeterna. (can't set ~S of T)"}.get(symbol)
        return error(maxim, sym("SYMBOL-VALUE")) if maxim else error("Can't set ~S of ~S.", sym("SYMBOL-VALUE"), symbol)
    symbol.value = value
    return value


def set_(symbol, value):
    return set_symbol_value(value, symbol)


def symbol_function(symbol):
    return fdefinition(_symbol(symbol))


def set_symbol_function(function, symbol):
    check_symbol(symbol, "setting the symbol-function of ~S", symbol)
    symbol.function = traced_like(symbol.function, function)
    symbol.function_changed()
    return function


def boundp(symbol):
    return True if not isinstance(_symbol(symbol), Symbol) or symbol.value is not UNBOUND else None


def invalid_name(name):
    """The error that ``name`` names no function."""
    return SimpleTypeError("Invalid function name: ~S", name, datum=name, expected_type="(SATISFIES SB-INT:LEGAL-FUNCTION-NAME-P)")


def fboundp(name):
    from ..compiler.analyze import SPECIAL_FORMS  # a program that was compiled before starts without the compiler

    if isinstance(name, Cons):
        return name.cdr.car.setf_function if isinstance(name.cdr.car, Symbol) else None
    if not is_symbol(name):
        return error(invalid_name(name))
    if not isinstance(name, Symbol):
        return None
    if not isinstance(name.function, UndefinedFunction):
        return name.function
    return True if name.macro is not None or name in SPECIAL_FORMS else None


def makunbound(symbol):
    check_symbol(symbol, "unbinding the symbol ~S", symbol)
    symbol.value = UNBOUND
    return symbol


def fmakunbound(name):
    check_symbol(name.cdr.car if isinstance(name, Cons) else name, "removing the function or macro definition of ~S", name)
    if isinstance(name, Cons):
        name.cdr.car.setf_function = None
        name.cdr.car.function_changed()
    else:
        name.function = UndefinedFunction(name)
        name.macro = None
        name.function_changed()
    return name


def make_symbol(name):
    return Symbol(str(name)) if is_string(name) else type_error(name, "STRING", "\nwhen binding SB-IMPL::STRING")


GENSYM_COUNTER = sym("*GENSYM-COUNTER*")
GENSYM_COUNTER.value, GENSYM_COUNTER.special = 0, True


def gensym(prefix="G"):
    """A new symbol without a package; its name ends in ``*gensym-counter*``, which goes up, or in the number ``prefix``."""
    if isinstance(prefix, int) and not isinstance(prefix, bool) and prefix >= 0:
        return Symbol(f"G{prefix}")
    if not is_string(prefix):
        return type_error(prefix, "(OR STRING UNSIGNED-BYTE)", "\nwhen binding SB-IMPL::THING")
    number = GENSYM_COUNTER.value
    if not isinstance(number, int) or number < 0:
        return type_error(number, "UNSIGNED-BYTE")
    GENSYM_COUNTER.value = number + 1
    return Symbol(f"{prefix}{number}")


def gentemp(prefix="T", package=None):
    home = PACKAGE.value if package is None else find_package_or_error(package)
    while True:
        GENSYM_COUNTER.value += 1
        name = f"{prefix}{GENSYM_COUNTER.value}"
        if not home.lookup(name)[1]:
            return home.intern(name)


def copy_symbol(symbol, properties=None):
    copy = Symbol(packages.symbol_name(_symbol(symbol)))
    if truth(properties):
        copy.value, copy.function, copy.plist = symbol.value, symbol.function, symbol.plist
    return copy


SETTERS = {"SYMBOL-VALUE": set_symbol_value, "SYMBOL-FUNCTION": set_symbol_function, "FDEFINITION": set_symbol_function}
