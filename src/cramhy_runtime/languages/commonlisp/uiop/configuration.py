"""UIOP: folders of settings and data, command lines of Windows, hooks, small questions. Source: UIOP's documentation strings."""

from __future__ import annotations

import os
import subprocess

from cramhy_runtime.lisp_core.conditions import Condition, handler_bind
from cramhy_runtime.lisp_core.data import Cons, Keyword, Symbol, boolean, list_from, python_list
from cramhy_runtime.lisp_core.functions import function_of
from cramhy_runtime.lisp_core.packages import find_package_or_error, is_symbol, keyword, sym, symbol_name
from cramhy_runtime.lisp_core.restarts import find_restart, invoke_restart
from cramhy_runtime.kernel.typing_names import Any

from ..files.files import path_of
from ..pathnames.pathname_objects import Pathname
from ..pathnames.pathnames import pathname
from ..streams.streams import SynonymStream
from . import files, pathnames, utilities
from .processes import escape_sh_command

FUNCTIONS = """call-around-hook register-hook-function escape-windows-token escape-windows-command escape-command find-preferred-file
    in-first-directory in-user-configuration-directory in-system-configuration-directory configuration-inheritance-directive-p
    location-designator-p location-function-p file-or-synonym-stream-p standard-case-symbol-name reify-simple-sexp unreify-simple-sexp
    nuke-symbol-in-package ensure-package-unused call-with-muffled-compiler-conditions call-with-muffled-loader-conditions get-folder-path
    always-default-encoding default-encoding-external-format detect-encoding encoding-external-format lisp-implementation-pathname-p
    filter-logical-directory-results read-little-endian read-null-terminated-string system-config-pathnames
    system-configuration-directories user-configuration-directories xdg-config-dirs xdg-data-dirs xdg-runtime-dir xdg-config-pathnames
    xdg-data-pathnames xdg-config-pathname xdg-data-pathname shell-boolean-exit"""
DIRECTIVES = ("INHERIT-CONFIGURATION", "IGNORE-INHERITED-CONFIGURATION")
UTF_8 = keyword("UTF-8")
INPUT, PROBE = keyword("INPUT"), keyword("PROBE")


# ----------------------------------------------------------------------------------------------------------------------- hooks


def call_around_hook(hook: Any, function: Any) -> Any:
    """``uiop:call-around-hook``: the values of ``function``, which the hook calls if there is one."""
    return utilities.call_function(function) if hook is None else utilities.call_function(hook, function)


def register_hook_function(variable: Any, hook: Any, call_now_p: Any = None) -> Any:
    """``uiop:register-hook-function``: add ``hook`` to the list that is the variable's value, and call it if that is said."""
    if hook not in python_list(variable.value):
        variable.value = Cons(hook, variable.value)
    if call_now_p is not None:
        utilities.call_function(hook)
    return None


def _muffling(thunk: Any) -> Any:
    def muffle(condition: Any) -> None:
        restart = find_restart(sym("MUFFLE-WARNING"))
        if restart is not None and utilities.match_any_condition_p(condition, list_from([sym("STYLE-WARNING")])):
            invoke_restart(restart)

    return handler_bind([(Condition, muffle)], function_of(thunk))


def call_with_muffled_compiler_conditions(thunk: Any) -> Any:
    """``uiop:call-with-muffled-compiler-conditions``: the values of ``thunk``, in which style-warnings are muffled."""
    return _muffling(thunk)


def call_with_muffled_loader_conditions(thunk: Any) -> Any:
    """``uiop:call-with-muffled-loader-conditions``: the values of ``thunk``, in which style-warnings are muffled."""
    return _muffling(thunk)


# -------------------------------------------------------------------------------------------------------------- command lines


def escape_windows_token(token: Any, stream: Any = None) -> Any:
    """``uiop:escape-windows-token``: the text as one word of a command line of Windows."""
    return _told(subprocess.list2cmdline([str(token)]), stream)


def escape_windows_command(command: Any, stream: Any = None) -> Any:
    """``uiop:escape-windows-command``: a list of words as a command line of Windows."""
    return _told(str(command) if isinstance(command, str) else subprocess.list2cmdline(map(str, python_list(command))), stream)


def escape_command(command: Any, stream: Any = None, escaper: Any = None) -> Any:
    """``uiop:escape-command``: a list of words as a line of this system's shell."""
    if escaper is not None:
        return _told(" ".join(str(function_of(escaper)(word)) for word in python_list(command)), stream)
    return (escape_windows_command if os.name == "nt" else escape_sh_command)(command, stream)


def _told(text: str, stream: Any) -> Any:
    if stream is None:
        return text
    stream.write(text)
    return None


def shell_boolean_exit(value: Any) -> Any:
    """``uiop:shell-boolean-exit``: end the process with the status 0 for a true value, else 1."""
    from .processes import quit_

    return quit_(1 if value is None else 0)


# -------------------------------------------------------------------------------------------------------------------- folders


def find_preferred_file(found: Any, *, direction: Any = INPUT) -> Any:
    """``uiop:find-preferred-file``: the first of the files that is there; for output the first."""
    if direction not in (INPUT, PROBE):
        return found.car if isinstance(found, Cons) else None
    return next((each for each in python_list(found) if each is not None and os.path.exists(path_of(each))), None)


def in_first_directory(dirs: Any, x: Any, *, direction: Any = INPUT) -> Any:
    """``uiop:in-first-directory``: the file ``x`` in the first of the folders that has it; for output in the first."""
    return find_preferred_file(_below(python_list(dirs), x), direction=direction)


def _below(folders: list[Any], x: Any) -> Any:
    whole = [pathnames.ensure_directory_pathname(folder) for folder in folders if folder is not None]
    return list_from(whole if x is None else [pathnames.subpathname(folder, x) for folder in whole])


def _folders(variable: str, usual: str) -> list[Any]:
    return [pathname(folder.rstrip("/") + "/") for folder in (os.environ.get(variable) or usual).split(os.pathsep) if folder]


def xdg_config_dirs(more: Any = None) -> Any:
    """``uiop:xdg-config-dirs``: the system's folders of settings, or a path in each."""
    return _below(_folders("XDG_CONFIG_DIRS", "/etc/xdg"), more)


def xdg_data_dirs(more: Any = None) -> Any:
    """``uiop:xdg-data-dirs``: the system's folders of data, or a path in each."""
    return _below(_folders("XDG_DATA_DIRS", "/usr/local/share:/usr/share"), more)


def xdg_runtime_dir(more: Any = None) -> Any:
    """``uiop:xdg-runtime-dir``: the user's folder of what lasts until the end of the session, or a path below it; nil without one."""
    folder = os.environ.get("XDG_RUNTIME_DIR")
    if not folder:
        return None
    return pathname(folder.rstrip("/") + "/") if more is None else pathnames.subpathname(pathname(folder.rstrip("/") + "/"), more)


def xdg_config_pathnames(more: Any = None) -> Any:
    """``uiop:xdg-config-pathnames``: a path in the user's folder of settings, then in the system's."""
    return Cons(files.xdg_config_home(more), xdg_config_dirs(more))


def xdg_data_pathnames(more: Any = None) -> Any:
    """``uiop:xdg-data-pathnames``: a path in the user's folder of data, then in the system's."""
    return Cons(files.xdg_data_home(more), xdg_data_dirs(more))


def xdg_config_pathname(more: Any, direction: Any = INPUT) -> Any:
    """``uiop:xdg-config-pathname``: the first of `xdg_config_pathnames` that is there; for output the first."""
    return find_preferred_file(xdg_config_pathnames(more), direction=direction)


def xdg_data_pathname(more: Any, direction: Any = INPUT) -> Any:
    """``uiop:xdg-data-pathname``: the first of `xdg_data_pathnames` that is there; for output the first."""
    return find_preferred_file(xdg_data_pathnames(more), direction=direction)


def system_config_pathnames(*more: Any) -> Any:
    """``uiop:system-config-pathnames``: a path in ``/etc``."""
    return list_from([pathnames.subpathname(pathname("/etc/"), more[0] if more else "")])


def system_configuration_directories() -> Any:
    """``uiop:system-configuration-directories``: where the system keeps settings of Lisps."""
    return system_config_pathnames("common-lisp")


def user_configuration_directories() -> Any:
    """``uiop:user-configuration-directories``: where the user, then the machine keeps settings of Lisps."""
    return xdg_config_pathnames("common-lisp")


def in_user_configuration_directory(x: Any, *, direction: Any = INPUT) -> Any:
    """``uiop:in-user-configuration-directory``: the file ``x`` in the first of `user_configuration_directories` that has it."""
    return xdg_config_pathname(f"common-lisp/{x}", direction)


def in_system_configuration_directory(x: Any, *, direction: Any = INPUT) -> Any:
    """``uiop:in-system-configuration-directory``: the file ``x`` in ``/etc/common-lisp``, if it is there."""
    return find_preferred_file(system_config_pathnames(f"common-lisp/{x}"), direction=direction)


def get_folder_path(folder: Any) -> None:
    """``uiop:get-folder-path``: a folder of Windows; nil elsewhere."""


def lisp_implementation_pathname_p(path: Any) -> bool | None:
    """``uiop:lisp-implementation-pathname-p``: whether the file belongs to this Lisp."""
    home = files.lisp_implementation_directory()
    return boolean(home is not None and os.path.abspath(path_of(path)).startswith(os.path.join(path_of(home), "")))


def filter_logical_directory_results(directory: Any, entries: Any, merger: Any) -> Any:
    """``uiop:filter-logical-directory-results``: the entries of a folder; only those of a logical one have to be looked at."""
    return entries


def compile_file_pathname_or_given(input_file: Any, *, output_file: Any = None, **others: Any) -> Any:
    """``uiop:compile-file-pathname*``: where the compiled file is, unless it is said."""
    from ..systems.program_files import compile_file_pathname

    return compile_file_pathname(input_file) if output_file is None else pathname(output_file)


# -------------------------------------------------------------------------------------------------------------- configuration


def configuration_inheritance_directive_p(x: Any) -> Any:
    """``uiop:configuration-inheritance-directive-p``: whether it says that settings of others count, or do not."""
    kinds = [keyword(name) for name in DIRECTIVES]
    if isinstance(x, Cons):
        return configuration_inheritance_directive_p(x.car) if x.cdr is None and isinstance(x.car, Keyword) else None
    return list_from(kinds[kinds.index(x) :]) if x in kinds else None


_ABSOLUTE = "ROOT HOME HERE USER-CACHE SYSTEM-CACHE".split()
_RELATIVE = "DEFAULT-DIRECTORY *.* *.*.* */ **/ IMPLEMENTATION IMPLEMENTATION-TYPE".split()


def location_designator_p(x: Any) -> bool | None:
    """``uiop:location-designator-p``: whether it may stand for a place in the settings of ASDF."""

    def absolute(part: Any) -> bool:
        return _is_path(part) or isinstance(part, Keyword) and part.name in _ABSOLUTE

    def relative(part: Any) -> bool:
        return _is_path(part) or isinstance(part, Keyword) and part.name in _RELATIVE

    if isinstance(x, Cons):
        parts = python_list(x)
        if parts[0] is keyword("FUNCTION"):
            return None
        return boolean(absolute(parts[0]) and all(map(relative, parts[1:])))
    return boolean(absolute(x) or x is True or x is None)


def _is_path(x: Any) -> bool:
    return isinstance(x, (str, Pathname))


def location_function_p(x: Any) -> bool | None:
    """``uiop:location-function-p``: whether it is ``(:function f)``, which computes a place."""
    parts = python_list(x) if isinstance(x, Cons) else []
    return boolean(len(parts) == 2 and parts[0] is keyword("FUNCTION"))


# ---------------------------------------------------------------------------------------------------------- small questions


def file_or_synonym_stream_p(stream: Any) -> bool | None:
    """``uiop:file-or-synonym-stream-p``: whether it is a stream of a file, or stands for another stream."""
    return boolean(isinstance(stream, SynonymStream) or getattr(stream, "pathname", None) is not None)


def standard_case_symbol_name(name_designator: Any) -> Any:
    """``uiop:standard-case-symbol-name``: the name in the case of symbols of COMMON-LISP."""
    return symbol_name(name_designator) if is_symbol(name_designator) else str(name_designator).upper()


def reify_simple_sexp(sexp: Any) -> Any:
    """``uiop:reify-simple-sexp``: a form in which vectors of names stand for symbols, so that it can be written without packages."""
    if isinstance(sexp, Cons):
        return Cons(reify_simple_sexp(sexp.car), reify_simple_sexp(sexp.cdr))
    if not isinstance(sexp, Symbol) or isinstance(sexp, Keyword) or sexp.package is None:
        return sexp
    return sym("VECTOR").function(sexp.name, sexp.package.name)


def unreify_simple_sexp(sexp: Any) -> Any:
    """``uiop:unreify-simple-sexp``: the form that `reify_simple_sexp` was given."""
    if isinstance(sexp, Cons):
        return Cons(unreify_simple_sexp(sexp.car), unreify_simple_sexp(sexp.cdr))
    if sym("SIMPLE-VECTOR-P").function(sexp) is None:
        return sexp
    name, package = python_list(sym("COERCE").function(sexp, sym("LIST")))
    return find_package_or_error(package).intern(str(name))


def nuke_symbol_in_package(symbol: Any, package_designator: Any) -> None:
    """``uiop:nuke-symbol-in-package``: take a symbol out of a package, and let it have no home."""
    home = find_package_or_error(package_designator)
    home.unintern(symbol)
    symbol.package = None


def ensure_package_unused(package: Any) -> None:
    """``uiop:ensure-package-unused``: let no package use this one."""
    used = find_package_or_error(package)
    for user in python_list(sym("PACKAGE-USED-BY-LIST").function(used)):
        sym("UNUSE-PACKAGE").function(used, user)


# ------------------------------------------------------------------------------------------------------------------ encodings


def always_default_encoding(path: Any) -> Any:
    """``uiop:always-default-encoding``: UTF-8, whatever the file."""
    return UTF_8


def default_encoding_external_format(encoding: Any) -> Any:
    """``uiop:default-encoding-external-format``: the external format of an encoding."""
    return UTF_8 if encoding is keyword("DEFAULT") else encoding


detect_encoding, encoding_external_format = always_default_encoding, default_encoding_external_format


def read_little_endian(s: Any, bytes: int = 4) -> int:
    """``uiop:read-little-endian``: the next octets of a stream as a number, the lowest first."""
    read_byte = sym("READ-BYTE").function
    return sum(read_byte(s) << 8 * place for place in range(bytes))


def read_null_terminated_string(s: Any) -> str:
    """``uiop:read-null-terminated-string``: the text of the octets until one that is 0."""
    read_byte, octets = sym("READ-BYTE").function, bytearray()
    while octet := read_byte(s):
        octets.append(octet)
    return octets.decode("latin-1")
