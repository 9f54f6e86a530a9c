"""The functions on packages (ANSI 11.2): what is seen by which name, and what happens when two symbols want one.

Every operation looks for conflicts before it changes anything; the restarts of the condition settle them, and then the operation
goes on. Where SBCL's restart TAKE-NEW leaves the old symbol visible (both are inherited), here the new one is.
"""

from __future__ import annotations

from cramhy_runtime.kernel.images import part
from cramhy_runtime.lisp_core import packages
from cramhy_runtime.lisp_core.condition_types import Condition, PackageError
from cramhy_runtime.lisp_core.conditions import cerror, error, restart_case, type_error, with_simple_restart
from cramhy_runtime.lisp_core.data import Cons, LispString, MultipleValues, Symbol, list_from, python_list
from cramhy_runtime.lisp_core.packages import (
    Package,
    common,
    find_package_or_error,
    is_ours,
    is_string_designator,
    is_symbol,
    keyword,
    our_own,
    printed,
    string_designator,
    sym,
    symbol_name,
)
from .package_errors import (
    PACKAGE,
    DONT_IMPORT_IT,
    KEEP_OLD,
    SHADOWING_IMPORT_IT,
    TAKE_NEW,
    NameConflict,
    SimplePackageError,
    check_package,
    locked,
    name_conflict,
)

LISP_NAMES = """intern find-symbol unintern export unexport import shadow shadowing-import use-package unuse-package find-package
package-name package-nicknames package-use-list package-used-by-list package-shadowing-symbols list-all-packages make-package
delete-package rename-package packagep find-all-symbols package-error-package"""
EXTENSION_NAMES = """lock-package unlock-package package-locked-p name-conflict-symbols name-conflict-function name-conflict-datum
package-local-nicknames add-package-local-nickname remove-package-local-nickname package-locally-nicknamed-by-list"""
"""Names of package SB-EXT."""


def package_of(designator):
    """The package that an optional argument names: the current one when it is nil."""
    return PACKAGE.value if designator is None else find_package_or_error(designator)


def _name(name):
    return str(name) if isinstance(name, (str, LispString)) else type_error(name, "STRING", "\nwhen binding SB-IMPL::NAME")


def _named(designator):
    return string_designator(designator) if is_string_designator(designator) else type_error(designator, "(OR STRING SYMBOL CHARACTER)")


def _status(status):
    return keyword(status.upper()) if status else None


def _symbols(designator):
    """The symbols that a designator for a list of symbols stands for."""
    if designator is None:
        return []
    symbols = (
        [designator]
        if is_symbol(designator)
        else python_list(designator)
        if isinstance(designator, Cons)
        else type_error(designator, "(OR CONS SYMBOL)")
    )
    return [symbol if is_symbol(symbol) else type_error(symbol, "SYMBOL") for symbol in symbols]


def _items(designator):
    return python_list(designator) if isinstance(designator, Cons) or designator is None else [designator]


# ---------------------------------------------------------------------------------------------------- symbols of a package


def intern(name, package=None):
    """``intern``: two values, the symbol and how it was there (nil: it is new)."""
    home = _home(package)
    name = _name(name)
    found, status = home.lookup(name)
    if not status:
        check_package(home, "interning ~A", name)
        found = home.intern(name)
    return MultipleValues((found, _status(status)))


def find_symbol(name, package=None):
    """``find-symbol``: two values, the symbol and how it is there; nil and nil when it is not."""
    found, status = _home(package).lookup(_name(name))
    return MultipleValues((found, _status(status)))


def _home(designator):
    """As `package_of`, but the error of a name without a package has the name as a string, as that of the reader."""
    named = designator is not None and is_string_designator(designator)
    return package_of(string_designator(designator) if named else designator)


def unintern(symbol, package=None):
    """``unintern``: whether the symbol was present. A conflict that it had hidden is a name-conflict."""
    home = package_of(package)
    name = symbol_name(symbol if is_symbol(symbol) else type_error(symbol, "SYMBOL"))
    if not home.present(name) or home.lookup(name)[0] is not symbol:
        return None
    check_package(home, "uninterning ~A", symbol)
    if name in home.shadowing:
        inherited = list(dict.fromkeys(other.external[name] for other in home.use if name in other.external))
        if len(inherited) > 1:
            name_conflict(home, "UNINTERN", symbol, inherited, (), home.shadowing_import)
            return True
    return home.unintern(symbol)


def export(symbols, package=None):
    """``export``: make symbols external. Each package that uses this one is looked at for conflicts first."""
    home = package_of(package)
    symbols = _symbols(symbols)
    for symbol in symbols:
        if home.locked and symbol_name(symbol) not in home.external:
            check_package(home, "exporting symbol ~A", symbol)
    missing = [symbol for symbol in symbols if not _accessible(symbol, home)]
    if missing:
        condition = SimplePackageError(
            home, "~@<These symbols are not accessible in the ~A package:~2I~_~S~:@>", home.name, list_from(missing)
        )
        restart_case(
            [(sym("CONTINUE"), lambda: import_(list_from(missing), home), f"IMPORT these symbols into the {home.name} package.")],
            lambda: error(condition),
        )
    for symbol in symbols:
        name = symbol_name(symbol)
        if name not in home.external:
            for user in home.used_by:
                _settle_export(symbol, name, home, user)
            if changes(home):
                _exported.setdefault(home, set()).add(name)
            home.export(symbol)
    return True


def _accessible(symbol, package):
    found, status = package.lookup(symbol_name(symbol))
    return status and found is symbol


def _settle_export(symbol, name, home, user):
    found, status = user.lookup(name)
    if not status or found is symbol or name in user.shadowing:
        return

    def keep_old():
        user.shadowing_import(found)

    def take_new():
        user.unintern(found) if user.present(name) else user.shadowing_import(symbol)

    name_conflict(
        user,
        "EXPORT",
        symbol,
        [symbol, found],
        [
            (KEEP_OLD, keep_old, f"Keep {printed(found)} accessible in {user.name} (shadowing {printed(symbol)})."),
            (TAKE_NEW, take_new, f"Make {printed(symbol)} accessible in {user.name} (uninterning {printed(found)})."),
        ],
        lambda chosen: keep_old() if chosen is found else take_new(),
    )


def unexport(symbols, package=None):
    """``unexport``: make symbols internal again."""
    home = package_of(package)
    symbols = _symbols(symbols)
    for symbol in symbols:
        if not _accessible(symbol, home):
            error(SimplePackageError(home, "~S is not accessible in the ~A package.", symbol, home.name))
    for symbol in symbols:
        if symbol_name(symbol) in home.external:
            check_package(home, "unexporting symbol ~A", symbol)
            home.unexport(symbol)
    return True


def import_(symbols, package=None):
    """``import``: make symbols present."""
    home = package_of(package)
    for symbol in _symbols(symbols):
        name = symbol_name(symbol)
        found, status = home.lookup(name)
        if home.present(name) and found is symbol:
            continue
        check_package(home, "importing symbol ~A", symbol)
        changes(home)
        if not status or found is symbol:
            home.import_symbol(symbol)
            continue

        def shadowing(symbol=symbol):
            home.shadowing_import(symbol)

        doing = f"uninterning {printed(found)}." if home.present(name) else f"shadowing {printed(found)}."
        name_conflict(
            home,
            "IMPORT",
            symbol,
            [symbol, found],
            [
                (SHADOWING_IMPORT_IT, shadowing, f"Shadowing-import {printed(symbol)}, {doing}"),
                (DONT_IMPORT_IT, lambda: None, f"Don't import {printed(symbol)}, keeping {printed(found)}."),
            ],
            lambda chosen, symbol=symbol: home.shadowing_import(symbol) if chosen is symbol else None,
        )
    return True


def shadow(names, package=None):
    """``shadow``: make sure that names mean symbols present in the package."""
    home = package_of(package)
    for name in map(_named, _items(names)):
        if name not in home.shadowing:
            check_package(home, "shadowing symbol ~A", name)
        home.shadow(name)
    return True


def shadowing_import(symbols, package=None):
    """``shadowing-import``: make symbols present, whatever had their names before."""
    home = package_of(package)
    for symbol in _symbols(symbols):
        check_package(home, "shadowing-importing symbol ~A", symbol)
        changes(home)
        home.shadowing_import(symbol)
    return True


def find_all_symbols(name):
    """``find-all-symbols``: the symbols of that name in all packages."""
    name = _named(name)
    found = [package.lookup(name)[0] for package in packages.all_packages() if package.present(name)]
    return list_from(list(dict.fromkeys(found)))


# ------------------------------------------------------------------------------------------------- packages that use others


def use_package(used, package=None):
    """``use-package``: inherit the external symbols of packages."""
    home = package_of(package)
    for designator in _items(used):
        other = find_package_or_error(designator)
        if other is not home and other not in home.use:
            check_package(home, "using package ~A", other)
            changes(home)
            other.complete()
            _settle_use(home, other)
            home.use_package(other)
    return True


def _conflicts_of_use(home, other):
    """(name, symbol of ``other``, symbol that is seen now) for each name that would mean both."""
    for name, symbol in other.external.items():
        found, status = home.lookup(name)
        if status and found is not symbol and name not in home.shadowing:
            yield name, symbol, found


def _settle_use(home, other):
    def keep_old():
        for _, _, found in list(_conflicts_of_use(home, other)):
            home.shadowing_import(found)

    def take_new():
        for name, symbol, found in list(_conflicts_of_use(home, other)):
            home.unintern(found) if home.present(name) else home.shadowing_import(symbol)

    while conflict := next(_conflicts_of_use(home, other), None):
        name, symbol, found = conflict
        name_conflict(
            home,
            "USE-PACKAGE",
            other,
            [found, symbol] if home.present(name) else [symbol, found],
            [
                (KEEP_OLD, keep_old, f"Keep symbols already accessible in {home.name} (shadowing others)."),
                (TAKE_NEW, take_new, f"Make newly exposed symbols accessible in {home.name}, uninterning old ones."),
            ],
            home.shadowing_import,
        )


def unuse_package(used, package=None):
    """``unuse-package``: inherit from packages no longer."""
    home = package_of(package)
    for other in [find_package_or_error(designator) for designator in _items(used)]:
        if other in home.use:
            check_package(home, "unusing package ~A", other)
            changes(home)
        home.unuse_package(other)
    return True


# ------------------------------------------------------------------------------------------------- our packages made anew

_changed: dict = {}  # packages of ours that a program changed -> what was in them before
_exported: dict = {}  # those of them -> the names that programs exported, in any image


def changes(package):
    """A program is about to change what ``package`` uses or contains. Of one of ours the other images keep what was before.

    Returns whether it is one of ours.
    """
    if our_own.depth or not is_ours(package):
        return False
    if package not in _changed:
        _changed[package] = _copied(_state(package))
    return True


def _state(package):
    foreign = {
        name: (symbol, table is package.external)
        for table in (package.internal, package.external)
        for name, symbol in table.items()
        if isinstance(symbol, Symbol) and not common(symbol)
    }
    exported = _exported.get(package, set()) & package.external.keys()
    return package.use, package.nicknames, package.shadowing, foreign, exported, package.defined, package.file


def _copied(state):
    *tables, defined, file = state
    return (*(table.copy() for table in tables), defined, file)


@part
class _PackagesMadeAnew:
    """What programs made of our packages, as a checkout of CL-TRANSFORMS does that is loaded in the place of ours.

    All images share these packages. In the others each uses what it used before, contains nothing of that program, and exports
    nothing for it.
    """

    @staticmethod
    def take():
        return {package: _state(package) for package in _changed}

    @staticmethod
    def put(state):
        for package, own in _changed.items():
            for name in _state(package)[3]:
                package.internal.pop(name, None)
                package.external.pop(name, None)
            use, nicknames, shadowing, foreign, exported, package.defined, package.file = state.get(package) or _copied(own)
            package.use, package.nicknames, package.shadowing = use, nicknames, shadowing
            for name, (symbol, external) in foreign.items():
                (package.external if external else package.internal)[name] = symbol
            for name in _exported.get(package, ()):
                source, target = (package.internal, package.external) if name in exported else (package.external, package.internal)
                if name in source:
                    target[name] = source.pop(name)

    @staticmethod
    def copy(state):
        return {package: _copied(contents) for package, contents in state.items()}

    @staticmethod
    def new(state):
        return {}


# ----------------------------------------------------------------------------------------------------- packages themselves


def find_package(designator):
    """``find-package``: the package of that name, or nil."""
    found = packages.find_package(designator)
    return find_package_or_error(designator) if found is None and not is_string_designator(designator) else found


def package_name(designator):
    """``package-name``: its name; nil for a package that was deleted."""
    return designator.name if isinstance(designator, Package) else find_package_or_error(designator).name


def package_nicknames(designator):
    return list_from(find_package_or_error(designator).nicknames)


def package_use_list(designator):
    return list_from(find_package_or_error(designator).use[::-1])


def package_used_by_list(designator):
    return list_from(find_package_or_error(designator).used_by[::-1])


def package_shadowing_symbols(designator):
    package = find_package_or_error(designator)
    return list_from([package.lookup(name)[0] for name in reversed(package.shadowing)])


def list_all_packages():
    return list_from(packages.all_packages())


def packagep(obj):
    return True if isinstance(obj, Package) else None


def make_package(name, *, nicknames=None, use=None, internal_symbols=None, external_symbols=None):
    """``make-package``: a new package, which uses none unless ``use`` says so."""
    name = _named(name)
    packages.defined_by_program([name, *map(string_designator, _items(nicknames))])
    old = packages.find_package(name)
    if old is not None:
        with_simple_restart(
            sym("CONTINUE"), "Clobber existing package.", lambda: error(SimplePackageError(old, "A package named ~S already exists", name))
        )
        packages.delete_package(old)
    made = packages.make_package(name)
    add_nicknames(made, map(string_designator, _items(nicknames)))
    use_package(use, made)
    return made


def add_nicknames(package, nicknames):
    """Give a package further names; a name that is taken may be left alone."""
    for nickname in nicknames:
        owner = packages.find_package(nickname)
        if owner is package:
            continue
        if owner is None:
            package.nicknames.insert(0, nickname)
            packages.register(package)
        elif owner.name == nickname:
            cerror(
                "Ignore this nickname.",
                SimplePackageError(owner, "~S is a package name, so it cannot be a nickname for ~S.", nickname, package.name),
            )
        else:
            cerror("Leave this nickname alone.", SimplePackageError(owner, "~S is already a nickname for ~S.", nickname, owner.name))


def delete_package(designator):
    """``delete-package``: t, or nil when there was none. Packages that use it may be made to do without."""
    if isinstance(designator, Package) and designator.name is None:
        return None
    package = packages.find_package(designator)
    if package is None:
        return cerror("Ignore.", SimplePackageError(designator, "There is no package named ~S.", designator))
    check_package(package, "deleting package ~A", package)
    users = list(package.used_by)
    if users:
        cerror(
            "Remove dependency in other packages.",
            SimplePackageError(
                package,
                "~@<Package ~S is used by package~P:~2I~@:_~S~:@>",
                package.name,
                len(users),
                list_from([user.name for user in reversed(users)]),
            ),
        )
        for user in users:
            user.unuse_package(package)
    packages.delete_package(package)
    return True


def rename_package(designator, name, nicknames=None):
    """``rename-package``: the package with its new name and nicknames; the old ones are gone."""
    package = find_package_or_error(designator)
    name = string_designator(name)
    check_package(package, "renaming as ~A", name)
    owner = packages.find_package(name)
    if owner is not None and owner is not package:
        return error(SimplePackageError(owner, "A package named ~S already exists.", name))
    packages.rename_package(package, name)
    add_nicknames(package, [nickname for nickname in map(string_designator, _items(nicknames)) if nickname != name])
    return package


def package_error_package(condition):
    """``package-error-package``"""
    package = getattr(condition, "package", None) if isinstance(condition, Condition) else type_error(condition, "CONDITION")
    return package if isinstance(condition, PackageError) else type_error(condition, "PACKAGE-ERROR")


# ------------------------------------------------------------------------------------------------- locks and local nicknames


def lock_package(package):
    """``sb-ext:lock-package``: protect the package and its symbols from changes."""
    find_package_or_error(package).locked = True
    return True


def unlock_package(package):
    """``sb-ext:unlock-package``: allow changes."""
    find_package_or_error(package).locked = False
    return True


def package_locked_p(package):
    """``sb-ext:package-locked-p``."""
    return True if locked(find_package_or_error(package)) else None


def name_conflict_symbols(condition):
    """``sb-ext:name-conflict-symbols``: the list of symbols that want the same name."""
    return list_from(_conflict(condition).symbols)


def name_conflict_function(condition):
    """``sb-ext:name-conflict-function``: the symbol of the function that found the conflict."""
    return _conflict(condition).function


def name_conflict_datum(condition):
    """``sb-ext:name-conflict-datum``: what that function was given."""
    return _conflict(condition).datum


def _conflict(condition):
    return condition if isinstance(condition, NameConflict) else type_error(condition, "SB-EXT:NAME-CONFLICT")


def package_local_nicknames(package):
    """``sb-ext:package-local-nicknames``: an association list of nicknames and packages."""
    return list_from([Cons(name, other) for name, other in find_package_or_error(package).local_nicknames.items()])


def add_package_local_nickname(nickname, actual, package=None):
    """``sb-ext:add-package-local-nickname``: while ``package`` is current, ``nickname`` means the package ``actual``."""
    home, name, other = package_of(package), string_designator(nickname), find_package_or_error(actual)
    check_package(home, "defining ~A as a package local nickname for ~A", name, other)
    if name in ("CL", "COMMON-LISP", "KEYWORD", *home.names):
        error(SimplePackageError(home, "Attempt to use ~A as a package local nickname.", name))
    old = home.local_nicknames.get(name)
    if old is not None and old is not other:
        cerror(
            f"Keep {name} as local nickname for {old.name}.",
            SimplePackageError(
                home, "~@<Cannot add ~A as local nickname for ~A in ~A: already nickname for ~A.~:@>", name, other.name, home.name, old.name
            ),
        )
        return home
    home.local_nicknames[name] = other
    return home


def remove_package_local_nickname(nickname, package=None):
    """``sb-ext:remove-package-local-nickname``: t, or nil when there was none."""
    home = package_of(package)
    check_package(home, "removing local nickname ~A", nickname)
    return True if home.local_nicknames.pop(string_designator(nickname), None) is not None else None


def package_locally_nicknamed_by_list(package):
    """``sb-ext:package-locally-nicknamed-by-list``: the packages that have a nickname of their own for it."""
    wanted = find_package_or_error(package)
    return list_from([home for home in packages.all_packages() if wanted in home.local_nicknames.values()])
