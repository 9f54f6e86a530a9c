"""``uiop:define-package`` and UIOP's functions of symbols and packages (UIOP's manual, "Package").

`define-package` is ``defpackage`` with more options. It settles conflicts itself: of two packages that :mix names, the first one wins.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.conditions import handler_bind
from cramhy_runtime.lisp_core.data import Cons, FreshString, Symbol, boolean, list_from
from cramhy_runtime.lisp_core.packages import (
    COMMON_LISP,
    Package,
    find_package,
    find_package_or_error,
    is_symbol,
    keyword,
    string_designator,
    symbol_name,
)
from cramhy_runtime.kernel.typing_names import Any

from ..packages import package_functions
from ..packages.package_definition import OPTIONS, define_package as define_standard_package
from ..packages.package_errors import PACKAGE

FUNCTIONS = """intern* export* import* shadowing-import* shadow* unintern* make-symbol* ensure-package delete-package* symbol-package-name
    standard-common-lisp-symbol-p reify-symbol unreify-symbol home-package-p symbol-shadowing-p package-names packages-from-names
    nuke-symbol rehome-symbol fresh-package-name rename-package-away"""


def package_or_current(package: Any) -> Package:
    """The package, by default the current one."""
    return find_package_or_error(PACKAGE.value if package is None else package)


def intern_(name: Any, package: Any = None, error: Any = True) -> Any:
    """``uiop:intern*``: ``intern`` of a name or the name of a symbol."""
    return package_functions.intern(string_designator(name), package_or_current(package))


def make_symbol_(name: Any) -> Symbol:
    """``uiop:make-symbol*``: a symbol of that name without a package."""
    return Symbol(string_designator(name))


def export_(name: Any, package: Any = None) -> Any:
    """``uiop:export*``: ``intern`` and ``export``."""
    return package_functions.export(package_or_current(package).intern(string_designator(name)), package_or_current(package))


def import_(symbol: Any, package: Any = None) -> Any:
    """``uiop:import*``"""
    return package_functions.import_(symbol, package_or_current(package))


def shadowing_import(symbol: Any, package: Any = None) -> Any:
    """``uiop:shadowing-import*``"""
    return package_functions.shadowing_import(symbol, package_or_current(package))


def shadow(name: Any, package: Any = None) -> Any:
    """``uiop:shadow*``"""
    return package_functions.shadow(string_designator(name), package_or_current(package))


def unintern(name: Any, package: Any = None, error: Any = True) -> Any:
    """``uiop:unintern*``: ``unintern`` of the symbol of that name, nil if there is none."""
    home = package_or_current(package)
    symbol, status = home.lookup(string_designator(name))
    return package_functions.unintern(symbol, home) if status else None


nuke_symbol = unintern


def rehome_symbol(symbol: Any, package: Any) -> Any:
    """``uiop:rehome-symbol``: let the package be the symbol's home."""
    home = find_package_or_error(package)
    home.shadowing_import(symbol)
    symbol.package = home
    return symbol


def symbol_package_name(symbol: Any) -> Any:
    """``uiop:symbol-package-name``: the name of a symbol's package, nil without one."""
    home = COMMON_LISP if symbol is None or symbol is True else symbol.package
    return home and FreshString(home.name)


def standard_common_lisp_symbol_p(thing: Any) -> bool | None:
    """``uiop:standard-common-lisp-symbol-p``: whether it is a symbol that the package COMMON-LISP exports."""
    return boolean(is_symbol(thing) and COMMON_LISP.external.get(symbol_name(thing)) is thing)


def reify_symbol(symbol: Any, package: Any = None) -> Any:
    """``uiop:reify-symbol``: a symbol as something that can be read again in another image: itself, or a vector of its names."""
    if not is_symbol(symbol) or symbol_package_name(symbol) in (None, "KEYWORD", "COMMON-LISP"):
        return symbol if symbol_package_name(symbol) else [symbol.name]
    return [symbol.name, symbol.package.name]


def unreify_symbol(thing: Any, package: Any = None) -> Any:
    """``uiop:unreify-symbol``: the symbol of which `reify_symbol` made this."""
    if is_symbol(thing):
        return thing
    name, *home = list(thing)
    return package_functions.find_symbol(str(name), str(home[0])) if home else Symbol(str(name))


def home_package_p(symbol: Any, package: Any) -> bool | None:
    """``uiop:home-package-p``: whether the package is the symbol's home."""
    home = find_package(package)
    return boolean(symbol_package_name(symbol) == (home and home.name))


def symbol_shadowing_p(symbol: Any, package: Any) -> bool | None:
    """``uiop:symbol-shadowing-p``"""
    return boolean(symbol_name(symbol) in find_package_or_error(package).shadowing)


def package_names(package: Any) -> Any:
    """``uiop:package-names``: the name and the nicknames."""
    return list_from([FreshString(name) for name in find_package_or_error(package).names])


def packages_from_names(names: Any) -> Any:
    """``uiop:packages-from-names``: those that there are, each once."""
    return list_from(list(dict.fromkeys(package for name in names or () if (package := find_package(name)) is not None)))


def fresh_package_name(*, prefix: Any = "%TO-BE-DELETED", index: Any = None, separator: Any = "-") -> str:
    """``uiop:fresh-package-name``: a name that no package has."""
    number = 0
    while find_package(f"{prefix}{separator}{number}") is not None:
        number += 1
    return FreshString(f"{prefix}{separator}{number}")


def rename_package_away(package: Any, *, index: Any = None, **options: Any) -> Any:
    """``uiop:rename-package-away``: give it a name that nobody uses."""
    return package_functions.rename_package(package, fresh_package_name())


def delete_package_(package: Any, *, nuke: Any = None) -> Any:
    """``uiop:delete-package*``: delete the package, also if others use it; nil if there is none."""
    home = find_package(package)
    if home is None:
        return None
    for user in list(home.used_by):
        user.unuse_package(home)
    return package_functions.delete_package(home)


# ---------------------------------------------------------------------------------------------------------- define-package


def ensure_package(
    name: Any,
    *,
    nicknames: Any = None,
    documentation: Any = None,
    use: Any = None,
    shadow: Any = None,
    shadowing_import_from: Any = None,
    import_from: Any = None,
    export: Any = None,
    intern: Any = None,
    recycle: Any = None,
    mix: Any = None,
    reexport: Any = None,
    unintern: Any = None,
    local_nicknames: Any = None,
) -> Package:
    """``uiop:ensure-package``: make the package, or let it be as the arguments say; they are the options of ``define-package``."""
    told = {"NICKNAMES": nicknames, "SHADOW": shadow, "EXPORT": export, "INTERN": intern, "USE": use}
    told.update({"MIX": mix, "REEXPORT": reexport, "UNINTERN": unintern})
    clauses = {kind: [list(value)] for kind, value in told.items() if value is not None}
    for kind, value in (
        ("IMPORT-FROM", import_from),
        ("SHADOWING-IMPORT-FROM", shadowing_import_from),
        ("LOCAL-NICKNAMES", local_nicknames),
    ):
        clauses[kind] = [list(each) for each in value or ()]
    return _defined(name, clauses)


def define_package(name: Any, options: Any) -> Package:
    """What ``define-package`` becomes: make or update the package; returns it."""
    clauses: dict[str, list[Any]] = {}
    for option in options or ():
        clauses.setdefault(symbol_name(option.car) if isinstance(option, Cons) else "", []).append(list(option.cdr or ()))
    return _defined(name, clauses)


def _defined(name: Any, clauses: dict[str, list[Any]]) -> Package:
    def packages(*kinds: str) -> list[Any]:
        return list(dict.fromkeys(each for kind in kinds for names in clauses.get(kind, ()) for each in names))

    # As UIOP: without a :use or :mix, COMMON-LISP is used.
    uses = packages("USE", "USE-REEXPORT") if {"USE", "USE-REEXPORT", "MIX", "MIX-REEXPORT"} & set(clauses) else ["COMMON-LISP"]
    standard = [
        list_from([keyword(kind), *names])
        for kind, listed in clauses.items()
        if kind in OPTIONS and kind not in ("USE", "EXPORT", "IMPORT-FROM")
        for names in listed
        if names or kind != "LOCAL-NICKNAMES"
    ]
    package = _without_warnings(lambda: define_standard_package(name, list_from(standard)))
    for source, *names in [*clauses.get("SHADOWING-IMPORT-FROM", ()), *clauses.get("IMPORT-FROM", ())]:
        for each in names:
            _bring(package, find_package_or_error(source).intern(string_designator(each)))
    for other in map(find_package_or_error, [*uses, *packages("MIX", "MIX-REEXPORT")]):
        _mixed(package, other)
    for each in packages("UNINTERN"):
        unintern(each, package)
    package_functions.export(list_from([package.intern(string_designator(each)) for each in packages("EXPORT")]), package)
    for other in map(find_package_or_error, packages("REEXPORT", "USE-REEXPORT", "MIX-REEXPORT")):
        _reexported(package, other)
    return package


def _bring(package: Package, symbol: Any) -> None:
    found, status = package.lookup(symbol_name(symbol))
    if not status:
        package.import_symbol(symbol)
    elif found is not symbol:
        was_external = symbol_name(symbol) in package.external
        package.shadowing_import(symbol)
        if was_external:
            package.export(symbol)
    elif status == "inherited":
        package.import_symbol(symbol)


def _mixed(package: Package, other: Package) -> None:
    """Let ``package`` use ``other``; a name that means something there already goes on meaning that."""
    if other in package.use or other is package:
        return
    other.complete()
    for name, symbol in other.external.items():
        found, status = package.lookup(name)
        if status and found is not symbol and name not in package.shadowing:
            package.shadowing_import(found) if name not in package.external else package.shadowing.setdefault(name, True)
    package.use_package(other)


def _reexported(package: Package, other: Package) -> None:
    other.complete()
    for name, symbol in list(other.external.items()):
        found, status = package.lookup(name)
        if not status:
            package.import_symbol(symbol)
        if not status or found is symbol:
            package_functions.export(symbol if symbol is not None else list_from([None]), package)


def _without_warnings(define: Any) -> Package:
    """The value of ``define()``; that the package was another before is what ``define-package`` is for."""
    from cramhy_runtime.lisp_core.conditions import Warning_
    from cramhy_runtime.lisp_core.packages import sym
    from cramhy_runtime.lisp_core.restarts import find_restart, invoke_restart

    def muffle(condition: Any) -> None:
        found = find_restart(sym("MUFFLE-WARNING"))
        if found is not None:
            invoke_restart(found)

    return handler_bind([(Warning_, muffle)], define)
