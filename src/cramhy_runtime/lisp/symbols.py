"""Symbols and packages as functions of Common Lisp (ANSI chapters 10 and 11)."""

from __future__ import annotations

from . import packages
from .conditions import error, type_error
from .data import Cons, Keyword, MultipleValues, Symbol, UNBOUND, UndefinedFunction, list_from, python_list, truth
from .definitions import traced_like
from .evaluator import PACKAGE
from .packages import Package, find_package_or_error, is_symbol, keyword, string_designator, sym

LISP_NAMES = """symbolp keywordp symbol-name symbol-package symbol-value set symbol-function boundp fboundp makunbound fmakunbound
make-symbol gensym gentemp copy-symbol intern find-symbol unintern export unexport import shadow shadowing-import use-package
unuse-package find-package package-name package-nicknames package-use-list package-used-by-list package-shadowing-symbols
list-all-packages make-package delete-package rename-package packagep find-all-symbols package-error-package"""


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
    from .compiler.support import value_of

    return value_of(symbol) if isinstance(_symbol(symbol), Symbol) else symbol


def set_symbol_value(value, symbol):
    if not isinstance(symbol, Symbol) or symbol.constant:
        return error("~S is a constant and cannot be set.", symbol)
    symbol.value = value
    return value


def set_(symbol, value):
    return set_symbol_value(value, symbol)


def symbol_function(symbol):
    from .compiler.support import fdefinition

    return fdefinition(_symbol(symbol))


def set_symbol_function(function, symbol):
    symbol.function = traced_like(symbol.function, function)
    return function


def boundp(symbol):
    return True if not isinstance(_symbol(symbol), Symbol) or symbol.value is not UNBOUND else None


def fboundp(name):
    from .compiler.analyze import SPECIAL_FORMS

    if isinstance(name, Cons):
        return name.cdr.car.setf_function if isinstance(name.cdr.car, Symbol) else None
    if not isinstance(_symbol(name), Symbol):
        return None
    if not isinstance(name.function, UndefinedFunction):
        return name.function
    return True if name.macro is not None or name in SPECIAL_FORMS else None


def makunbound(symbol):
    symbol.value = UNBOUND
    return symbol


def fmakunbound(name):
    if isinstance(name, Cons):
        name.cdr.car.setf_function = None
    else:
        name.function = UndefinedFunction(name)
        name.macro = None
    return name


def make_symbol(name):
    return Symbol(str(name))


GENSYM_COUNTER = sym("*GENSYM-COUNTER*")
GENSYM_COUNTER.value, GENSYM_COUNTER.special = 0, True


def gensym(prefix="G"):
    if isinstance(prefix, int):
        return Symbol(f"G{prefix}")
    GENSYM_COUNTER.value += 1
    return Symbol(f"{prefix}{GENSYM_COUNTER.value}")


def gentemp(prefix="T", package=None):
    home = _package(package)
    while True:
        GENSYM_COUNTER.value += 1
        name = f"{prefix}{GENSYM_COUNTER.value}"
        if not home.lookup(name)[1]:
            return home.intern(name)


def copy_symbol(symbol, properties=None):
    copy = Symbol(packages.symbol_name(symbol))
    if truth(properties):
        copy.value, copy.function, copy.plist = symbol.value, symbol.function, symbol.plist
    return copy


def _package(designator):
    return PACKAGE.value if designator is None else find_package_or_error(designator)


def _status(status):
    return keyword(status.upper()) if status else None


def intern(name, package=None):
    """Two values: the symbol, and how it was there (nil: it is new)."""
    home = _package(package)
    name = str(name)
    found, status = home.lookup(name)
    if not status:
        found = home.intern(name)
    return MultipleValues((found, _status(status)))


def find_symbol(name, package=None):
    found, status = _package(package).lookup(str(name))
    return MultipleValues((found, _status(status)))


def unintern(symbol, package=None):
    return _package(package).unintern(symbol)


def _each(symbols, action):
    for symbol in [symbols] if is_symbol(symbols) and symbols is not None else python_list(symbols):
        action(symbol)
    return True


def export(symbols, package=None):
    return _each(symbols, _package(package).export)


def unexport(symbols, package=None):
    return _each(symbols, _package(package).unexport)


def import_(symbols, package=None):
    return _each(symbols, _package(package).import_symbol)


def shadow(names, package=None):
    home = _package(package)
    for name in python_list(names) if isinstance(names, Cons) or names is None else [names]:
        home.shadow(string_designator(name))
    return True


def shadowing_import(symbols, package=None):
    return _each(symbols, _package(package).shadowing_import)


def _designators(items):
    return python_list(items) if isinstance(items, Cons) or items is None else [items]


def use_package(used, package=None):
    for designator in _designators(used):
        _package(package).use_package(find_package_or_error(designator))
    return True


def unuse_package(used, package=None):
    for designator in _designators(used):
        _package(package).unuse_package(find_package_or_error(designator))
    return True


def find_package(designator):
    return packages.find_package(designator)


def package_name(designator):
    return find_package_or_error(designator).name


def package_nicknames(designator):
    return list_from(find_package_or_error(designator).nicknames)


def package_use_list(designator):
    return list_from(find_package_or_error(designator).use)


def package_used_by_list(designator):
    return list_from(find_package_or_error(designator).used_by)


def package_shadowing_symbols(designator):
    package = find_package_or_error(designator)
    return list_from([package.intern(name) for name in package.shadowing])


def list_all_packages():
    return list_from(packages.all_packages())


def make_package(name, *, nicknames=None, use=None):
    return packages.make_package(string_designator(name), [string_designator(item) for item in python_list(nicknames)], python_list(use))


def delete_package(designator):
    packages.delete_package(find_package_or_error(designator))
    return True


def rename_package(designator, name, nicknames=None):
    names = [string_designator(item) for item in python_list(nicknames)]
    return packages.rename_package(find_package_or_error(designator), string_designator(name), names)


def packagep(obj):
    return True if isinstance(obj, Package) else None


def find_all_symbols(name):
    name = string_designator(name)
    found = [package.lookup(name) for package in packages.all_packages() if package.present(name)]
    return list_from(list(dict.fromkeys(symbol for symbol, _ in found)))


def package_error_package(condition):
    return condition.package


SETTERS = {"SYMBOL-VALUE": set_symbol_value, "SYMBOL-FUNCTION": set_symbol_function, "FDEFINITION": set_symbol_function}
