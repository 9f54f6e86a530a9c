"""UIOP: files of settings in which a form says what holds, places in them, and packages as forms. Source: UIOP's documentation strings."""

from __future__ import annotations

import os

from cramhy_runtime.lisp_core.condition_types import Condition, SimpleError
from cramhy_runtime.lisp_core.conditions import error, make_condition, type_error
from cramhy_runtime.lisp_core.data import Cons, FreshString, Keyword, boolean, lisp_list, list_from, python_list, truth
from cramhy_runtime.lisp_core.functions import function_of
from cramhy_runtime.lisp_core.packages import Package, find_package, find_package_or_error, is_symbol, keyword, string_designator, sym
from cramhy_runtime.kernel.typing_names import Any

from ..format.format import format_
from ..pathnames.pathname_objects import Pathname
from ..pathnames.pathnames import merge_pathnames, pathname
from ..types.types import typep
from . import configuration, files, pathnames, streams, utilities

FUNCTIONS = """report-invalid-form validate-configuration-form validate-configuration-file validate-configuration-directory
    resolve-location resolve-absolute-location resolve-relative-location filter-pathname-set upgrade-configuration base-string-p
    character-type-index strings-common-element-type timestamp*< find-standard-case-symbol package-definition-form reify-package
    unreify-package parse-define-package-form make-pathname-component-logical make-pathname-logical escape-token"""
INHERIT, IGNORE_INVALID = keyword("INHERIT-CONFIGURATION"), keyword("IGNORE-INVALID-ENTRIES")
WILD_ENDINGS = {"*/": "*/", "**/": "**/", "*.*": "*.*", "*.*.*": "*.*"}


class InvalidConfiguration(Condition):
    """A form of settings that means nothing."""

    lisp_name = "UIOP::INVALID-CONFIGURATION"
    initargs = {"FORM": "form", "LOCATION": "location", "FORMAT": "format", "ARGUMENTS": "arguments"}
    form: Any = None
    location: Any = None
    format: Any = None
    arguments: Any = None

    def report(self) -> str:
        text = "" if self.format is None else str(format_(None, self.format, *(self.arguments or ())))
        return f"{text} (will be skipped)"


# ------------------------------------------------------------------------------------------------------------- settings


def report_invalid_form(reporter: Any, *arguments: Any) -> Any:
    """``uiop:report-invalid-form``: tell of a form that means nothing: by a function, a kind of condition, or a text for ``error``."""
    if reporter is None or is_symbol(reporter):
        return error(make_condition(sym("UIOP::INVALID-CONFIGURATION") if reporter is None else reporter, arguments))
    if isinstance(reporter, utilities.TEXT):
        return error(SimpleError(reporter, *arguments))
    return function_of(reporter)(*arguments)


def validate_configuration_form(
    form: Any, tag: Any, directive_validator: Any, *, location: Any = None, invalid_form_reporter: Any = None
) -> Any:
    """``uiop:validate-configuration-form``: the form without what means nothing. It says once whether settings of others count, too."""

    def report(text: str, *parts: Any) -> Any:
        told = keyword("FORM"), form, keyword("LOCATION"), location, keyword("FORMAT"), text, keyword("ARGUMENTS"), list_from(list(parts))
        return report_invalid_form(invalid_form_reporter, *told)

    directives = [] if not isinstance(form, Cons) else python_list(form.cdr)
    if not isinstance(form, Cons) or form.car is not tag:
        report("Error: Form doesn't specify ~S", tag)
        return None
    kept, said, ignored = [], 0, False
    for directive in directives:
        if configuration.configuration_inheritance_directive_p(directive):
            said += 1
        elif directive in (IGNORE_INVALID,) or isinstance(directive, Cons) and directive.car is IGNORE_INVALID:
            ignored = True
        elif not truth(function_of(directive_validator)(directive)):
            if not ignored:
                report("Invalid configuration directive ~S", directive)
            continue
        kept.append(directive)
    if said != 1:
        report("One and only one of ~S or ~S is required", INHERIT, keyword("IGNORE-INHERITED-CONFIGURATION"))
    return Cons(form.car, list_from(kept))


def validate_configuration_file(file: Any, validator: Any, *, description: Any = None) -> Any:
    """``uiop:validate-configuration-file``: what ``validator`` makes of the one form in the file."""
    forms = streams.read_file_forms(file)
    if forms is None or forms.cdr is not None:
        return error(SimpleError("One and only one form allowed for ~A. Got: ~S~%", description, forms))
    return function_of(validator)(forms.car, location=file)


def validate_configuration_directory(directory: Any, tag: Any, validator: Any, *, invalid_form_reporter: Any = None) -> Any:
    """``uiop:validate-configuration-directory``: one form made of the forms in all files ``*.conf`` of a folder, by name."""
    found = []
    for path in sorted(python_list(files.directory_files(directory, "*.conf")), key=str):
        for form in python_list(streams.read_file_forms(path)):
            if truth(function_of(validator)(form)):
                found.append(form)
            else:
                report_invalid_form(invalid_form_reporter, keyword("FORM"), form, keyword("LOCATION"), path)
    return Cons(tag, list_from([*found, INHERIT]))


def upgrade_configuration() -> None:
    """``uiop:upgrade-configuration``: nothing, since settings here are never older than the functions that read them."""


# --------------------------------------------------------------------------------------------------------------- places


def _home(folder: str, x: Any) -> Any:
    if folder == "HOME":
        return sym("USER-HOMEDIR-PATHNAME").function()
    if folder == "HERE":
        here = sym("UIOP::*HERE-DIRECTORY*").value
        return pathname(os.getcwd() + "/") if here is None else pathname(here)
    if folder in ("USER-CACHE", "SYSTEM-CACHE"):
        return files.xdg_cache_home("common-lisp/cramhy/")
    return error(SimpleError("Using ~S in a location is not to be had here: there is none.", x))


def resolve_relative_location(x: Any, *, ensure_directory: Any = None, wilden: Any = None) -> Any:
    """``uiop:resolve-relative-location``: the relative pathname that a part of a location means."""
    if isinstance(x, Cons):
        return _joined(python_list(x), resolve_relative_location, ensure_directory, wilden)
    if isinstance(x, Keyword) and x.name in ("DEFAULT-DIRECTORY", "IMPLEMENTATION", "IMPLEMENTATION-TYPE"):
        name = {"DEFAULT-DIRECTORY": "", "IMPLEMENTATION": "cramhy/", "IMPLEMENTATION-TYPE": "cramhy/"}[x.name]
        return pathname(name)
    if isinstance(x, Keyword) and x.name.lower() in WILD_ENDINGS:
        return pathname(WILD_ENDINGS[x.name.lower()])
    found = _given(x, ensure_directory, wilden)
    if pathnames.absolute_pathname_p(found):
        error(SimpleError("pathname ~S is not relative", x))
    return found


def resolve_absolute_location(x: Any, *, ensure_directory: Any = None, wilden: Any = None) -> Any:
    """``uiop:resolve-absolute-location``: the absolute pathname that a location, or its first part, means."""
    if isinstance(x, Cons):
        return _joined(python_list(x), resolve_absolute_location, ensure_directory, wilden)
    if isinstance(x, Keyword) and x.name == "ROOT":
        return pathname("")
    if isinstance(x, Keyword):
        return _home(x.name, x)
    found = _given(x, ensure_directory, wilden)
    if not pathnames.absolute_pathname_p(found):
        error(SimpleError("Invalid absolute pathname ~S", x))
    return found


def _given(x: Any, ensure_directory: Any, wilden: Any) -> Any:
    if not isinstance(x, (Pathname, *utilities.TEXT)):
        return error(SimpleError("~S is not a part of a location", x))
    found = pathname(x) if isinstance(x, Pathname) else pathnames.parse_unix_namestring(x)
    if truth(ensure_directory):
        found = pathnames.ensure_directory_pathname(found)
    return pathnames.wilden(found) if truth(wilden) and not isinstance(x, Pathname) else found


def _joined(parts: list[Any], first: Any, ensure_directory: Any, wilden: Any) -> Any:
    *folders, last = parts
    if not folders:
        return first(last, ensure_directory=ensure_directory, wilden=wilden)
    found = first(folders[0], ensure_directory=True)
    for folder in folders[1:]:
        found = merge_pathnames(resolve_relative_location(folder, ensure_directory=True), found)
    return merge_pathnames(resolve_relative_location(last, ensure_directory=ensure_directory, wilden=wilden), found)


def resolve_location(x: Any, *, ensure_directory: Any = None, wilden: Any = None, directory: Any = None) -> Any:
    """``uiop:resolve-location``: the pathname that a location of ASDF's settings means: a path, a keyword, or a list of parts."""
    if x is None or configuration.location_function_p(x):
        return x
    return resolve_absolute_location(x, ensure_directory=True if truth(ensure_directory) else directory, wilden=wilden)


def filter_pathname_set(dirs: Any) -> Any:
    """``uiop:filter-pathname-set``: the pathnames, each once, in order."""
    seen: dict[str, Any] = {}
    for path in python_list(dirs):
        seen.setdefault(str(pathname(path)), path)
    return list_from(list(seen.values()))


# ------------------------------------------------------------------------------------------------------ characters, times


def base_string_p(string: Any) -> bool | None:
    """``uiop:base-string-p``: whether the string can hold base characters only."""
    if not truth(typep(string, sym("STRING"))):
        return type_error(string, "STRING")
    return boolean(truth(typep(string, sym("BASE-STRING"))))


def character_type_index(x: Any) -> int:
    """``uiop:character-type-index``: 0 for a base character or that type, else 1: the place in ``+character-types+``."""
    if is_symbol(x):
        return 0 if x is sym("BASE-CHAR") else 1
    if not truth(typep(x, sym("CHARACTER"))):
        return type_error(x, "(OR CHARACTER SYMBOL)")
    return 0 if truth(typep(x, sym("BASE-CHAR"))) else 1


def strings_common_element_type(strings: Any) -> Any:
    """``uiop:strings-common-element-type``: the type that holds all characters of these strings and characters."""
    wide = any(ord(char) > 127 for each in python_list(strings) if each is not None for char in str(getattr(each, "char", each)))
    return sym("CHARACTER" if wide else "BASE-CHAR")


def times_rise(*times: Any) -> bool | None:
    """``uiop:timestamp*<``: whether each time is before the next."""
    return utilities.timestamps_rise(times)


def find_standard_case_symbol(name_designator: Any, package_designator: Any, error: Any = True) -> Any:
    """``uiop:find-standard-case-symbol``: the symbol of that name, in the case of COMMON-LISP's, or an error."""
    from .texts import find_symbol_

    name = configuration.standard_case_symbol_name(name_designator)
    return find_symbol_(name, configuration.standard_case_symbol_name(package_designator), error)


# ------------------------------------------------------------------------------------------------------ packages as forms


def package_definition_form(
    package_designator: Any,
    *,
    nicknamesp: Any = True,
    usep: Any = True,
    shadowp: Any = True,
    shadowing_import_p: Any = True,
    exportp: Any = True,
    importp: Any = True,
    internp: Any = None,
    error: Any = True,
) -> Any:
    """``uiop:package-definition-form``: a ``defpackage`` that makes such a package; nil of none if ``error`` is nil."""
    package = find_package_or_error(package_designator) if truth(error) else find_package(string_designator(package_designator))
    if package is None:
        return None
    shadowed: list[str] = []
    imported: dict[str, list[str]] = {}
    shadowing: dict[str, list[str]] = {}
    interned = []
    for name, symbol in {**package.internal, **package.external}.items():
        home = None if symbol is None or symbol.package is None else symbol.package.name
        if name in package.shadowing:
            if home == package.name:
                shadowed.append(name)
            else:
                shadowing.setdefault(str(home), []).append(name)
        elif home != package.name:
            imported.setdefault(str(home), []).append(name)
        elif name in package.internal:
            interned.append(name)

    def clause(option: str, wanted: Any, names: list[str]) -> list[Any]:
        return [Cons(keyword(option), list_from(list(map(FreshString, names))))] if truth(wanted) and names else []

    def sources(option: str, wanted: Any, table: dict[str, list[str]]) -> list[Any]:
        return [each for home in sorted(table) for each in clause(option, wanted, [home, *sorted(table[home])])]

    return lisp_list(
        sym("DEFPACKAGE"),
        package.name,
        *clause("NICKNAMES", nicknamesp, sorted(package.nicknames)),
        Cons(keyword("USE"), list_from([other.name for other in package.use] if truth(usep) else [])),
        *clause("SHADOW", shadowp, sorted(shadowed)),
        *sources("IMPORT-FROM", importp, imported),
        *sources("SHADOWING-IMPORT-FROM", shadowing_import_p, shadowing),
        *clause("EXPORT", exportp, sorted(package.external)),
        *clause("INTERN", internp, sorted(interned)),
    )


def reify_package(package: Any, package_context: Any = None) -> Any:
    """``uiop:reify-package``: what stands for a package in a form: T for the one of the context, nil, or the name."""
    if package is package_context:
        return True
    return package.name if isinstance(package, Package) else package


def unreify_package(package: Any, package_context: Any = None) -> Any:
    """``uiop:unreify-package``: the package of which `reify_package` has made this."""
    if package is None:
        return None
    return package_context if package is True else find_package(string_designator(package))


_LISTED = ("NICKNAMES", "DOCUMENTATION", "USE", "SHADOW", "SHADOWING-IMPORT-FROM", "IMPORT-FROM", "EXPORT", "INTERN")
_LATER = ("RECYCLE", "MIX", "REEXPORT", "UNINTERN")


def parse_define_package_form(package: Any, clauses: Any) -> Any:
    """``uiop:parse-define-package-form``: the name of the package, and its options as a property list."""
    found: dict[str, list[Any]] = {}
    documentation = None
    for clause in python_list(clauses):
        option = clause.car.name
        if option == "DOCUMENTATION":
            documentation = clause.cdr.car
        elif option in ("IMPORT-FROM", "SHADOWING-IMPORT-FROM"):
            found.setdefault(option, []).append(clause.cdr)
        elif option in (*_LISTED, "RECYCLE", "MIX", "REEXPORT", "UNINTERN", "USE-REEXPORT", "MIX-REEXPORT"):
            for name in ("USE", "REEXPORT") if option == "USE-REEXPORT" else ("MIX", "REEXPORT") if option == "MIX-REEXPORT" else (option,):
                found.setdefault(name, []).extend(python_list(clause.cdr))
        else:
            error(SimpleError("unrecognized define-package keyword ~S", clause.car))
    if "USE" not in found:
        found["USE"] = [keyword("COMMON-LISP")]
    if "RECYCLE" not in found:
        found["RECYCLE"] = [package, *found.get("NICKNAMES", ())]
    options = [
        item
        for name in (*_LISTED, *_LATER)
        for item in (keyword(name), documentation if name == "DOCUMENTATION" else list_from(found.get(name, [])))
    ]
    return Cons(package, list_from(options))


# -------------------------------------------------------------------------------------------------------- names, command lines


def make_pathname_component_logical(x: Any) -> Any:
    """``uiop:make-pathname-component-logical``: a part of a pathname as a logical pathname has it; nil for :unspecific."""
    return None if x is keyword("UNSPECIFIC") else x


def make_pathname_logical(path: Any, host: Any) -> Any:
    """``uiop:make-pathname-logical``: the logical pathname of ``host`` with the parts of another pathname."""
    part = {name: sym(f"PATHNAME-{name.upper()}").function(path) for name in ("directory", "name", "type", "version")}
    return sym("MAKE-PATHNAME").function(host=host, **{name: make_pathname_component_logical(value) for name, value in part.items()})


def escape_token(
    token: Any, *, stream: Any = None, quote: Any = None, good_chars: Any = None, bad_chars: Any = None, escaper: Any = None
) -> Any:
    """``uiop:escape-token``: the text for a shell: as it is where all its characters are good, else as ``escaper`` writes it."""
    text = str(token)

    def holds(characters: Any, char: str) -> bool:
        if isinstance(characters, utilities.TEXT):
            return char in str(characters)
        return truth(utilities.one(function_of(characters)(sym("CHAR").function(char, 0))))

    good = not any(holds(bad_chars, char) for char in text) if good_chars is None else all(holds(good_chars, char) for char in text)
    if good:
        return token if stream is None else stream.write(text)
    options = {} if quote is None else {"quote": quote}
    if stream is not None:
        return function_of(escaper)(token, stream, **options)
    from ..streams.streams import StringOutputStream

    target = StringOutputStream()
    function_of(escaper)(token, target, **options)
    return FreshString(target.text())
