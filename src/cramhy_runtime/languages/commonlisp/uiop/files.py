"""UIOP's functions of files and folders (UIOP's manual, "Filesystem" and "OS")."""

from __future__ import annotations

import os
import platform
import shutil
import socket
import sys
import tempfile

from cramhy_runtime.lisp_core.data import FreshString, boolean, list_from, one, truth
from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.lisp_core.functions import function_of
from cramhy_runtime.lisp_core.packages import is_symbol, keyword, sym
from cramhy_runtime.kernel.typing_names import Any

from ..files.file_streams import with_open_file
from ..files.files import (
    delete_file,
    directory,
    ensure_directories_exist,
    file_write_date,
    lisp_path,
    path_of,
    rename_file,
    user_homedir_pathname,
)
from ..pathnames.pathname_objects import WILD, Pathname
from ..pathnames.pathnames import DEFAULTS, merge_pathnames, pathname
from ..reader.dispatch_macros import FEATURES
from .pathnames import ensure_directory_pathname, pathname_directory_pathname, split_native_pathnames_string, subpathname
from .utilities import call_function, parameter_error

FUNCTIONS = """safe-file-write-date delete-file-if-exists rename-file-overwriting-target copy-file concatenate-files
    ensure-all-directories-exist delete-empty-directory delete-directory-tree directory-files subdirectories collect-sub*directories
    temporary-directory default-temporary-directory tmpize-pathname hostname chdir getenv-pathname getenv-pathnames
    getenv-absolute-directory getenv-absolute-directories featurep os-unix-p os-windows-p os-macosx-p os-genera-p detect-os
    operating-system architecture implementation-type implementation-identifier lisp-version-string xdg-config-home xdg-cache-home
    xdg-data-home call-with-current-directory call-with-temporary-file call-with-staging-pathname get-pathname-defaults
    lisp-implementation-directory load-pathname current-lisp-file-pathname argv0 raw-command-line-arguments"""


def safe_file_write_date(path: Any) -> Any:
    """``uiop:safe-file-write-date``: when the file was changed last, nil if it is not there."""
    return file_write_date(path) if path is not None and os.path.exists(path_of(path)) else None


def delete_file_if_exists(path: Any) -> Any:
    """``uiop:delete-file-if-exists``: remove the file; nil if it is not there."""
    return delete_file(path) if path is not None and os.path.lexists(path_of(path)) else None


def rename_file_overwriting_target(source: Any, target: Any) -> Any:
    """``uiop:rename-file-overwriting-target``: ``rename-file``, also if there is a file of that name."""
    return rename_file(source, target)


def copy_file(source: Any, target: Any) -> Any:
    """``uiop:copy-file``: make ``target`` a copy of the file ``source``."""
    return concatenate_files([source], target)


def concatenate_files(inputs: Any, output: Any) -> None:
    """``uiop:concatenate-files``: write the bytes of files, one after the other, into ``output``."""
    octets = {"element_type": list_from([sym("UNSIGNED-BYTE"), 8])}

    def copy(target: Any) -> None:
        for each in inputs or ():
            with_open_file(lambda source: copy_bytes(source, target), each, **octets)

    with_open_file(copy, output, direction=keyword("OUTPUT"), if_exists=keyword("SUPERSEDE"), **octets)


def copy_bytes(source: Any, target: Any) -> None:
    """Write each byte of a stream to another."""
    from ..files.file_stream_functions import read_byte, write_byte

    while (byte := read_byte(source, None, None)) is not None:
        write_byte(byte, target)


def ensure_all_directories_exist(pathnames: Any) -> None:
    """``uiop:ensure-all-directories-exist``: ``ensure-directories-exist`` for each."""
    for each in pathnames or ():
        ensure_directories_exist(pathname(each))


def delete_empty_directory(path: Any) -> None:
    """``uiop:delete-empty-directory``: remove a folder in which there is nothing."""
    from ..files.files import delete_directory

    delete_directory(path)


def delete_directory_tree(path: Any, *, validate: Any = None, if_does_not_exist: Any = keyword("ERROR")) -> Any:
    """``uiop:delete-directory-tree``: remove a folder with all that is in it.

    validate: T, or a function that says of the pathname whether it may be removed; without it nothing is.
    """
    name = sym("UIOP::DELETE-DIRECTORY-TREE")
    if not isinstance(path, Pathname) or path.name is not None or not path.directory or path.directory[0] is not keyword("ABSOLUTE"):
        return parameter_error("~S was asked to delete ~S but it is not a physical directory pathname", name, path)
    if validate is None:
        return parameter_error("~S was asked to delete ~S but was not provided a validation predicate", name, path)
    if validate is not True and not truth(one(call_function(validate, path))):
        return parameter_error("~S was asked to delete ~S but it is not valid ~@[according to ~S~]", name, path, validate)
    folder = path_of(path)
    if os.path.isdir(folder):
        shutil.rmtree(folder)
    elif if_does_not_exist is not keyword("IGNORE"):
        return parameter_error("~S was asked to delete ~S but the directory does not exist", name, path)
    return None


def directory_files(folder: Any, pattern: Any = None) -> Any:
    """``uiop:directory-files``: the files of a folder, without its folders; those that a pattern such as ``"*.lisp"`` matches."""
    where = ensure_directory_pathname(folder)
    named = Pathname(name=WILD, type=WILD) if pattern is None else pathname(pattern)
    entries = directory(merge_pathnames(named, where), resolve_symlinks=None)
    return list_from([entry for entry in entries or () if not os.path.isdir(path_of(entry))])


def subdirectories(folder: Any) -> Any:
    """``uiop:subdirectories``: the folders in a folder."""
    where = path_of(ensure_directory_pathname(folder))
    try:
        return list_from([lisp_path(entry.path) for entry in sorted(os.scandir(where), key=lambda entry: entry.name) if entry.is_dir()])
    except OSError:
        return None


def collect_subfolders(folder: Any, collectp: Any, recursep: Any, collector: Any) -> None:
    """``uiop:collect-sub*directories``: call ``collector`` with a folder and the folders below it, as the two predicates allow."""
    if truth(one(call_function(collectp, folder))):
        call_function(collector, folder)
    for each in subdirectories(folder) or ():
        if truth(one(call_function(recursep, each))):
            collect_subfolders(each, collectp, recursep, collector)


def default_temporary_directory() -> Pathname:
    """``uiop:default-temporary-directory``: where the system wants files that do not stay."""
    return lisp_path(os.path.join(tempfile.gettempdir(), ""))


def temporary_directory() -> Any:
    """``uiop:temporary-directory``: the value of ``uiop:*temporary-directory*``, or `default_temporary_directory`."""
    return sym("UIOP::*TEMPORARY-DIRECTORY*").value or default_temporary_directory()


def tmpize_pathname(path: Any) -> Pathname:
    """``uiop:tmpize-pathname``: the name of a new, empty file beside ``path``."""
    given = pathname(path)
    handle, name = tempfile.mkstemp(prefix=f"{given.name}-tmp", suffix=f".{given.type}" if given.type else "", dir=path_of(_folder(given)))
    os.close(handle)
    return lisp_path(name)


def _folder(path: Any) -> Any:
    return pathname_directory_pathname(merge_pathnames(path, DEFAULTS.value) if DEFAULTS.value is not None else path)


def call_with_temporary_file(
    thunk: Any,
    *,
    want_stream_p: Any = True,
    want_pathname_p: Any = True,
    direction: Any = keyword("IO"),
    keep: Any = None,
    after: Any = None,
    directory: Any = None,
    type: Any = "tmp",
    prefix: Any = None,
    suffix: Any = None,
    element_type: Any = sym("CHARACTER"),
    external_format: Any = keyword("UTF-8"),
) -> Any:
    """``uiop:call-with-temporary-file``: the values of ``thunk`` of a stream to a new file and its pathname. It is removed at the end.

    keep: whether it stays. after: what is called with the pathname when the stream is closed.
    """
    kind = "" if type is None or is_symbol(type) else f".{type}"
    handle, name = tempfile.mkstemp(prefix=prefix or "tmp", suffix=(suffix or "") + kind, dir=path_of(directory or temporary_directory()))
    os.close(handle)
    path = lisp_path(name)

    def given(stream: Any = None) -> Any:
        arguments = [*([stream] if truth(want_stream_p) else []), *([path] if truth(want_pathname_p) else [])]
        return function_of(thunk)(*arguments)

    try:
        result = None
        if thunk is not None and truth(want_stream_p):
            result = with_open_file(
                given,
                path,
                direction=direction,
                if_exists=keyword("OVERWRITE") if direction is not keyword("INPUT") else keyword("ERROR"),
                element_type=element_type,
                external_format=external_format,
            )
        elif thunk is not None:
            result = given()
        return result if after is None else function_of(after)(path)
    finally:
        if not truth(one(call_function(keep)) if callable(keep) else keep):
            delete_file_if_exists(path)


def call_with_staging_pathname(path: Any, fun: Any) -> Any:
    """``uiop:call-with-staging-pathname``: the values of ``fun`` of another name; its file gets the name ``path`` at the end."""
    staged = tmpize_pathname(path)
    try:
        result = function_of(fun)(staged)
        rename_file_overwriting_target(staged, path)
        return result
    finally:
        delete_file_if_exists(staged)


def call_with_current_directory(folder: Any, thunk: Any) -> Any:
    """``uiop:call-with-current-directory``: the values of ``thunk``, for which relative names are those in ``folder``."""
    if folder is None:
        return function_of(thunk)()
    with binding(DEFAULTS, ensure_directory_pathname(merge_pathnames(folder, lisp_path(os.getcwd())))):
        return function_of(thunk)()


def get_pathname_defaults(defaults: Any = None) -> Any:
    """``uiop:get-pathname-defaults``: the folder from the root on that relative names mean."""
    return merge_pathnames(defaults or DEFAULTS.value or Pathname(), lisp_path(os.getcwd()))


def chdir(folder: Any) -> None:
    """``uiop:chdir``: make it the working directory of the process."""
    os.chdir(path_of(folder))


def hostname() -> str:
    """``uiop:hostname``: the name of this computer."""
    return FreshString(socket.gethostname())


# ----------------------------------------------------------------------------------------------------------- environment


def set_getenv(value: Any, name: Any) -> Any:
    """``(setf uiop:getenv)``"""
    os.environ[str(name)] = str(value)
    return value


def getenv_pathname(name: Any, *, want_absolute: Any = None, **checks: Any) -> Any:
    """``uiop:getenv-pathname``: the pathname that a variable of the environment has; checks: those of ``ensure-pathname``."""
    from .pathnames import parse_native_namestring

    return parse_native_namestring(os.environ.get(str(name)) or None, want_absolute=want_absolute, **checks)


def getenv_pathnames(name: Any, *, want_absolute: Any = None, **checks: Any) -> Any:
    """``uiop:getenv-pathnames``: the pathnames in a variable such as PATH."""
    return split_native_pathnames_string(os.environ.get(str(name)), want_absolute=want_absolute, **checks)


def getenv_absolute_directory(name: Any) -> Any:
    """``uiop:getenv-absolute-directory``: the folder that a variable has."""
    return getenv_pathname(name, want_absolute=True, ensure_directory=True)


def getenv_absolute_directories(name: Any) -> Any:
    """``uiop:getenv-absolute-directories``: the folders in a variable such as PATH."""
    return getenv_pathnames(name, want_absolute=True, ensure_directory=True)


def featurep(expression: Any, features: Any = None) -> bool | None:
    """``uiop:featurep``: whether a feature expression holds."""
    from ..systems.system_definitions import holds

    with binding(FEATURES, FEATURES.value if features is None else features):
        return boolean(holds(expression))


def os_unix_p() -> Any:
    """``uiop:os-unix-p``"""
    return boolean(os.name == "posix")


def os_windows_p() -> Any:
    """``uiop:os-windows-p``"""
    return boolean(os.name == "nt")


def os_macosx_p() -> Any:
    """``uiop:os-macosx-p``"""
    return boolean(sys.platform == "darwin")


def os_genera_p() -> None:
    """``uiop:os-genera-p``: cramhy does not run there."""


def detect_os() -> Any:
    """``uiop:detect-os``: the feature that stands for the system."""
    return keyword("OS-WINDOWS" if os.name == "nt" else "OS-MACOSX" if sys.platform == "darwin" else "OS-UNIX")


def operating_system() -> Any:
    """``uiop:operating-system``: a keyword such as :LINUX."""
    return keyword({"win32": "WIN", "darwin": "MACOSX"}.get(sys.platform, sys.platform.upper()))


def architecture() -> Any:
    """``uiop:architecture``: a keyword such as :X64."""
    machine = platform.machine().upper()
    return keyword({"X86_64": "X64", "AMD64": "X64", "AARCH64": "ARM64"}.get(machine, machine))


def implementation_type() -> Any:
    """``uiop:implementation-type``"""
    return keyword("CRAMHY")


def lisp_version_string() -> str:
    """``uiop:lisp-version-string``: the version of cramhy."""
    from ..evaluation.environment import lisp_implementation_version

    return FreshString(lisp_implementation_version())


def implementation_identifier() -> str:
    """``uiop:implementation-identifier``: a name for folders of compiled files."""
    return FreshString(f"cramhy-{lisp_version_string()}-{operating_system().name.lower()}-{architecture().name.lower()}")


def lisp_implementation_directory(*, truename: Any = None) -> Pathname:
    """``uiop:lisp-implementation-directory``: the folder of cramhy."""
    import cramhy_runtime

    return lisp_path(os.path.dirname(cramhy_runtime.__file__))


def load_pathname() -> Any:
    """``uiop:load-pathname``: the file that is being loaded or compiled, nil outside of one."""
    return sym("*COMPILE-FILE-PATHNAME*").value or sym("*LOAD-PATHNAME*").value


current_lisp_file_pathname = load_pathname


def argv0() -> Any:
    """``uiop:argv0``: how the program was called."""
    return FreshString(sys.argv[0])


def raw_command_line_arguments() -> Any:
    """``uiop:raw-command-line-arguments``: the program and its arguments."""
    return list_from([FreshString(word) for word in sys.argv])


def _xdg(variable: str, usual: str, more: tuple[Any, ...]) -> Any:
    home = os.environ.get(variable) or os.path.join(path_of(user_homedir_pathname()), usual)
    folder: Any = lisp_path(home.rstrip("/") + "/") if os.path.isdir(home) else pathname(home.rstrip("/") + "/")
    return subpathname(folder, more[0]) if more and more[0] is not None else folder


def xdg_config_home(*more: Any) -> Any:
    """``uiop:xdg-config-home``: the user's folder of settings, or a path below it."""
    return _xdg("XDG_CONFIG_HOME", ".config", more)


def xdg_cache_home(*more: Any) -> Any:
    """``uiop:xdg-cache-home``: the user's folder of what can be made again, or a path below it."""
    return _xdg("XDG_CACHE_HOME", ".cache", more)


def xdg_data_home(*more: Any) -> Any:
    """``uiop:xdg-data-home``: the user's folder of data, or a path below it."""
    return _xdg("XDG_DATA_HOME", ".local/share", more)


def truename_if_any(path: Any) -> Any:
    """``uiop:truename*``: the truename, nil if there is no such file."""
    name = None if path is None else path_of(path)
    return lisp_path(os.path.realpath(name)) if name is not None and os.path.exists(name) else None
