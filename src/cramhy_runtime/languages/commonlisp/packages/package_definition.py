"""``defpackage`` and the macros that walk through packages (ANSI 11.2).

All options are looked at before anything is done, so a malformed definition leaves no half-made package. A package that is
defined again gets what is new in the definition; what it has beyond that stays, with a warning, as in SBCL.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.conditions import CompileError, SimpleTypeError, error, program_error, restart_case, warn
from cramhy_runtime.lisp_core.data import UNBOUND, Cons, MultipleValues, Symbol, list_from, truth
from cramhy_runtime.lisp_core.packages import (
    all_packages,
    defined_by_program,
    find_package,
    find_package_or_error,
    is_string_designator,
    is_symbol,
    keyword,
    make_package,
    near_names,
    string_designator,
    sym,
    symbol_name,
)
from cramhy_runtime.lisp_core.printing import prin1_to_string
from cramhy_runtime.storage.dependency_tracing import is_library
from .package_errors import PACKAGE, SimplePackageError, unlocked
from .package_functions import add_nicknames, add_package_local_nickname, changes, export, import_, shadow, shadowing_import, use_package

OPTIONS = """NICKNAMES USE SHADOW SHADOWING-IMPORT-FROM IMPORT-FROM EXPORT INTERN SIZE DOCUMENTATION LOCAL-NICKNAMES LOCK
IMPLEMENT""".split()
"""What ``defpackage`` knows: the standard's options and SBCL's."""
ONCE = ("SIZE", "DOCUMENTATION", "LOCK")


class Definition:
    """The options of one ``defpackage`` form, sorted by name; malformed ones are program errors."""

    def __init__(self, name, options):
        self.name = _string(name)
        self.clauses = {}
        for option in options or ():
            if not isinstance(option, Cons) or not is_symbol(option.car) or symbol_name(option.car) not in OPTIONS:
                error(
                    CompileError("bogus DEFPACKAGE option: ~S", option),
                    hint=f"There are {', '.join(':' + known.lower() for known in OPTIONS)}. Is a parenthesis missing?",
                )
            kind = symbol_name(option.car)
            if kind in ONCE and kind in self.clauses:
                program_error("can't specify ~S more than once.", keyword(kind))
            self.clauses.setdefault(kind, []).append(list(option.cdr or ()))
        interned, exported = self.names("INTERN"), self.names("EXPORT")
        imported, shadowed = self.imported("IMPORT-FROM"), self.names("SHADOW")
        _disjoint(("INTERN", interned), ("EXPORT", exported))
        _disjoint(
            ("INTERN", interned),
            ("IMPORT-FROM", imported),
            ("SHADOW", shadowed),
            ("SHADOWING-IMPORT-FROM", self.imported("SHADOWING-IMPORT-FROM")),
        )

    def names(self, kind):
        return list(dict.fromkeys(_string(item) for items in self.clauses.get(kind, ()) for item in items))

    def imported(self, kind):
        return [_string(item) for items in self.clauses.get(kind, ()) for item in items[1:]]

    def sources(self, kind):
        """(package, names) for each clause of an option that imports."""
        return [
            (find_package_or_error(_string(source)), [_string(item) for item in items]) for source, *items in self.clauses.get(kind, ())
        ]


def _string(designator):
    if not is_string_designator(designator):
        return error(SimpleTypeError("~S does not designate a string", designator, datum=designator, expected_type=sym("STRING")))
    return string_designator(designator)


def _disjoint(*sets):
    for index, (kind, names) in enumerate(sets):
        for other, others in sets[index + 1 :]:
            common = [name for name in names if name in others]
            if common:
                program_error(
                    "Parameters ~S and ~S must be disjoint but have common elements ~%   ~S",
                    keyword(kind),
                    keyword(other),
                    list_from(common),
                )


_LOADED = sym("*LOAD-TRUENAME*")


def define_package(name, options):
    """``defpackage``: make or update the package; returns it."""
    definition = Definition(name, options)
    defined_by_program([definition.name, *definition.names("NICKNAMES")])
    package = find_package(definition.name)
    if package is not None and package.name != definition.name:
        return error(SimplePackageError(package, "~A is a nickname for the package ~A", definition.name, package.name))
    uses = [find_package_or_error(other) for other in definition.names("USE")]
    if package is None:
        package = make_package(definition.name)
    elif package.defined:
        _warn_of_other_place(package)
        _warn_of_differences(package, definition, uses)
    else:
        _warn_of_other_place(package)
    changes(package)
    with unlocked([package]):
        _fill(package, definition, uses)
    package.defined, package.file = True, _file_of_load()
    if "LOCK" in definition.clauses:
        package.locked = truth(definition.clauses["LOCK"][0][0])
    return package


def _file_of_load():
    """The file that is being loaded, or ``None`` at a prompt."""
    path = _LOADED.value
    return None if path is None or path is UNBOUND else prin1_to_string(path).removeprefix("#P").strip('"')


def _warn_of_other_place(package):
    """Warn if a file of the user's defines a package of cramhy's libraries, or of cramhy itself, anew."""
    old, new = package.file, _file_of_load()
    if new is None or is_library(new) or not (package.built_in if old is None else is_library(old)):
        return
    warn("The package ~A of ~A is defined anew by ~A, whose definitions count from now on.", package.name, old or "cramhy itself", new)


def _fill(package, definition, uses):
    add_nicknames(package, definition.names("NICKNAMES"))
    shadow(list_from(definition.names("SHADOW")), package)
    for source, names in definition.sources("SHADOWING-IMPORT-FROM"):
        shadowing_import(list_from([_existing(source, name) for name in names]), package)
    use_package(list_from(uses), package)
    for source, names in definition.sources("IMPORT-FROM"):
        import_(list_from([_existing(source, name) for name in names]), package)
    for name in definition.names("INTERN"):
        package.intern(name)
    export(list_from([package.intern(name) for name in definition.names("EXPORT")]), package)
    for nickname, actual in (pair for pairs in definition.clauses.get("LOCAL-NICKNAMES", ()) for pair in pairs):
        add_package_local_nickname(nickname, actual, package)
    for text in definition.clauses.get("DOCUMENTATION", ()):
        package.documentation = text[0]


def _existing(source, name):
    """The symbol ``name`` of the package ``source``; one that is not there may be made by a restart."""
    found, status = source.lookup(name)
    if status:
        return found
    near = near_names(name, [*source.external, *source.internal])
    hint = f"Did you mean {' or '.join(near)}?" if near else None
    return restart_case(
        [(sym("CONTINUE"), lambda: source.intern(name), "INTERN it.")],
        lambda: error(SimplePackageError(source, "no symbol named ~S in ~S", name, source.name), hint=hint),
    )


def _warn_of_differences(package, definition, uses):
    shadowed = {*definition.names("SHADOW"), *definition.imported("SHADOWING-IMPORT-FROM")}
    more = [package.lookup(name)[0] for name in package.shadowing if name not in shadowed]
    if more:
        warn("~A also shadows the following symbols:~%  ~S", package.name, list_from(more))
    more = [other.name for other in package.use if other not in uses]
    if more:
        warn("~A also uses the following packages:~%  ~A", package.name, list_from(more))
    exported = definition.names("EXPORT")
    more = [symbol for name, symbol in package.external.items() if name not in exported]
    if more:
        warn("~A also exports the following symbols:~%  ~S", package.name, list_from(more))


def set_package(designator):
    """``in-package``: make it the current package; one that does not exist is an error that names its neighbours."""
    package = find_package_or_error(string_designator(designator) if is_symbol(designator) else designator)
    PACKAGE.value = package
    return package


def call_unlocked(packages, thunk):
    """``without-package-locks`` (``packages`` is t) and ``with-unlocked-packages``."""
    with unlocked(True if packages is True else [find_package_or_error(each) for each in packages or ()]):
        return thunk()


# ------------------------------------------------------------------------------------------------------- walking through them


def package_symbols(package, external_only):
    """The symbols accessible in a package, or only its external ones, each once."""
    package = find_package_or_error(package)
    package.complete()
    symbols = dict(package.external)
    if not truth(external_only):
        symbols.update(package.internal)
        for other in package.use:
            for name, symbol in other.external.items():
                symbols.setdefault(name, symbol)
    return list_from(list(symbols.values()))


def all_symbols():
    """The symbols present in any package, for ``do-all-symbols``; one that is present in two comes twice."""
    return list_from([symbol for package in all_packages() for table in (package.external, package.internal) for symbol in table.values()])


KINDS = ("INTERNAL", "EXTERNAL", "INHERITED")


def check_kinds(kinds):
    """Program errors for what follows the packages in ``with-package-iterator``."""
    if not kinds:
        program_error("At least one of :INTERNAL, :EXTERNAL, or :INHERITED must be supplied.")
    for kind in kinds:
        if not isinstance(kind, Symbol) or kind.name not in KINDS:
            program_error("~S is not one of :INTERNAL, :EXTERNAL, or :INHERITED.", kind)


def package_iterator(packages, kinds):
    """The generator function of ``with-package-iterator``: four values a call, nil at the end."""
    kinds = {kind.name for kind in kinds or ()}

    def entries():
        for designator in packages if isinstance(packages, Cons) else [packages]:
            package = find_package_or_error(designator)
            tables = [("INTERNAL", package.internal), ("EXTERNAL", package.external)]
            hidden = {*package.internal, *package.external}
            tables += [
                ("INHERITED", {name: symbol for name, symbol in other.external.items() if name not in hidden}) for other in package.use
            ]
            for kind, table in tables:
                if kind in kinds:
                    for symbol in list(table.values()):
                        yield MultipleValues((True, symbol, keyword(kind), package))

    iterator = entries()
    return lambda: next(iterator, None)
