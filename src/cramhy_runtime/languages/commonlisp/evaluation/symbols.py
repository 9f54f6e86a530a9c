"""The functions on symbols: their values, functions and names, and making new ones (ANSI chapter 10)."""

from __future__ import annotations

from weakref import WeakKeyDictionary

from cramhy_runtime.lisp_core import packages
from ..collections.list_search import symbol_plist
from ..collections.lists import copy_list
from ..collections.sequence_types import is_string
from ..compiler.support import fdefinition, value_of
from cramhy_runtime.lisp_core.conditions import error, type_error, undefined_function
from cramhy_runtime.lisp_core.data import Cons, Keyword, Symbol, UNBOUND, UndefinedFunction, lisp_list, truth
from .definitions import traced_like
from .evaluator import PACKAGE
from cramhy_runtime.lisp_core.dynamic import special
from cramhy_runtime.lisp_core.functions import functionp, invalid_function_name
from cramhy_runtime.lisp_core.packages import find_package_or_error, is_symbol, keyword, sym
from ..packages.package_errors import check_function_name, check_symbol

LISP_NAMES = """symbolp keywordp symbol-name symbol-package symbol-value set symbol-function boundp fboundp makunbound fmakunbound
make-symbol gensym gentemp copy-symbol"""


SETF = sym("SETF")


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


class OperatorFunction:
    """What stands for the function of a macro or special operator where a program looks for one: it can only be shown."""

    def __init__(self, kind, symbol):
        self.symbol, self.__lisp_name__ = symbol, lisp_list(keyword(kind), symbol)

    def __call__(self, *arguments, **keywords):
        return undefined_function(self.symbol, arguments, keywords)


def _operator_function(symbol):
    """The `OperatorFunction` of a symbol, always the same; ``None`` if it names no macro or special operator."""
    from ..compiler.analyze import SPECIAL_FORMS  # a program that was compiled before starts without the compiler

    if not isinstance(symbol, Symbol) or (symbol.macro is None and symbol not in SPECIAL_FORMS):
        return None
    known = _operator_functions.get(symbol)
    if known is None:
        known = _operator_functions[symbol] = OperatorFunction("MACRO" if symbol.macro is not None else "SPECIAL", symbol)
    return known


_operator_functions = WeakKeyDictionary()


def symbol_function(symbol):
    if isinstance(getattr(_symbol(symbol), "function", None), UndefinedFunction):
        operator = _operator_function(symbol)
        if operator is not None:
            return operator
    return fdefinition(symbol)


def set_symbol_function(function, symbol):
    """``(setf symbol-function)``"""
    check_symbol(_symbol(symbol), "setting the symbol-function of ~S", symbol)
    if isinstance(function, OperatorFunction):
        return error("~S is not acceptable to ~S.", function, lisp_list(SETF, sym("SYMBOL-FUNCTION")))
    _need_function(function)
    symbol.function = traced_like(symbol.function, function)
    symbol.function_changed()
    return function


def _need_function(thing):
    return thing if functionp(thing) is not None else type_error(thing, "FUNCTION", "\nwhen binding SB-IMPL::NEW-VALUE")


def boundp(symbol):
    return True if not isinstance(_symbol(symbol), Symbol) or symbol.value is not UNBOUND else None


def place_of(name):
    """The symbol in the function name ``(setf symbol)``, ``None`` if ``name`` is a symbol; another name is an error."""
    if is_symbol(name):
        return None
    if isinstance(name, Cons) and name.car is SETF and isinstance(name.cdr, Cons) and name.cdr.cdr is None and is_symbol(name.cdr.car):
        return name.cdr.car
    return error(invalid_function_name(name))


def fboundp(name):
    if (place := place_of(name)) is not None:
        return getattr(place, "setf_function", None)
    if not isinstance(name, Symbol):
        return None
    if not isinstance(name.function, UndefinedFunction):
        return name.function
    return _operator_function(name)


def makunbound(symbol):
    """``makunbound``"""
    check_symbol(_symbol(symbol), "unbinding the symbol ~S", symbol)
    if isinstance(symbol, Keyword):
        return error("Can't make ~S unbound.", symbol)
    symbol.value = UNBOUND
    return symbol


def fmakunbound(name):
    place = place_of(name)
    check_function_name(name, "removing the function or macro definition of ~S")
    if place is not None:
        place.setf_function = None
        place.function_changed()
    else:
        name.function = UndefinedFunction(name)
        name.macro = None
        name.function_changed()
    return name


def make_symbol(name):
    return Symbol(str(name)) if is_string(name) else type_error(name, "STRING", "\nwhen binding SB-IMPL::STRING")


GENSYM_COUNTER = special("*GENSYM-COUNTER*", 0)


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


_GENTEMP_COUNTER = special("CRAMHY::*GENTEMP-COUNTER*", 0)


def gentemp(prefix="T", package=None):
    """``gentemp``"""
    if not is_string(prefix):
        return type_error(prefix, "STRING", "\nwhen binding SB-IMPL::PREFIX")
    home = PACKAGE.value if package is None else find_package_or_error(package)
    while True:
        _GENTEMP_COUNTER.value += 1
        name = f"{prefix}{_GENTEMP_COUNTER.value}"
        if not home.lookup(name)[1]:
            return home.intern(name)


def copy_symbol(symbol, properties=None):
    copy = Symbol(packages.symbol_name(_symbol(symbol)))
    if truth(properties):
        copy.value, copy.plist = symbol_value(symbol) if boundp(symbol) else UNBOUND, copy_list(symbol_plist(symbol))
        if isinstance(symbol, Symbol):
            copy.macro = symbol.macro
            copy.function = UndefinedFunction(copy) if isinstance(symbol.function, UndefinedFunction) else symbol.function
    return copy


def set_fdefinition(function, name):
    """``(setf fdefinition)``: ``name`` is a symbol or ``(setf symbol)``."""
    symbol = place_of(name)
    check_function_name(name, "setting fdefinition of ~S")
    if symbol is None:
        return set_symbol_function(function, name)
    _need_function(function)
    symbol.setf_function = traced_like(symbol.setf_function, function)
    symbol.function_changed()
    return function


SETTERS = {"SYMBOL-VALUE": set_symbol_value, "SYMBOL-FUNCTION": set_symbol_function, "FDEFINITION": set_fdefinition}
