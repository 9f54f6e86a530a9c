"""UIOP's functions of pathnames: what a name says, without looking at files (UIOP's manual, "Pathname")."""

from __future__ import annotations

import os

from cramhy_runtime.lisp_core.condition_types import SimpleError
from cramhy_runtime.lisp_core.conditions import error
from cramhy_runtime.lisp_core.data import FreshString, Keyword, MultipleValues, boolean, list_from, truth
from cramhy_runtime.lisp_core.packages import is_symbol, sym, symbol_name
from cramhy_runtime.kernel.typing_names import Any

from ..files.files import lisp_path, path_of, truename
from ..pathnames.namestrings import native_namestring as native_text, parse_native
from ..pathnames.pathname_objects import ABSOLUTE, UNSPECIFIC, WILD, WILD_INFERIORS, LogicalPathname, Pathname
from ..pathnames.pathnames import enough_namestring, make_pathname, merge_pathnames, pathname
from ..pathnames.wild_pathnames import translate_pathname, wild_pathname_p
from .utilities import TEXT, call_function, parameter_error

FUNCTIONS = """absolute-pathname-p relative-pathname-p directory-pathname-p file-pathname-p hidden-pathname-p logical-pathname-p
    physical-pathname-p ensure-directory-pathname ensure-pathname ensure-absolute-pathname subpathname subpathname* subpathp
    enough-pathname pathname-equal pathname-directory-pathname pathname-parent-directory-pathname pathname-root pathname-host-pathname
    parse-unix-namestring unix-namestring native-namestring parse-native-namestring split-name-type split-native-pathnames-string
    split-unix-namestring-directory-components add-pathname-suffix wilden relativize-directory-component relativize-pathname-directory
    nil-pathname inter-directory-separator directory-separator-for-host null-device-pathname denormalize-pathname-directory-component
    normalize-pathname-directory-component merge-pathname-directory-components lispize-pathname call-with-enough-pathname
    physicalize-pathname"""

RELATIVE = sym(":RELATIVE")
NIL = Pathname()


def _given(designator: Any) -> Pathname | None:
    return None if designator is None else pathname(designator)


def absolute_pathname_p(pathspec: Any) -> Any:
    """``uiop:absolute-pathname-p``: the pathname if it begins at the root, else nil."""
    path = _given(pathspec)
    return path if path is not None and path.directory and path.directory[0] is ABSOLUTE else None


def relative_pathname_p(pathspec: Any) -> Any:
    """``uiop:relative-pathname-p``: the pathname if it does not begin at the root, else nil."""
    path = _given(pathspec)
    return path if path is not None and absolute_pathname_p(path) is None else None


def directory_pathname_p(pathspec: Any) -> bool | None:
    """``uiop:directory-pathname-p``: whether it is written as the name of a folder, with a slash at its end."""
    path = _given(pathspec)
    return boolean(path is not None and path.name in (None, "", UNSPECIFIC) and path.type in (None, UNSPECIFIC) and not _wild(path))


def _wild(path: Pathname) -> bool:
    return wild_pathname_p(path) is not None


def file_pathname_p(pathspec: Any) -> Any:
    """``uiop:file-pathname-p``: the pathname if it has a name, else nil."""
    path = _given(pathspec)
    return path if path is not None and path.name not in (None, "", UNSPECIFIC) else None


def hidden_pathname_p(pathspec: Any) -> bool | None:
    """``uiop:hidden-pathname-p``: whether its name begins with a dot."""
    path = _given(pathspec)
    return boolean(path is not None and isinstance(path.name, str) and path.name.startswith("."))


def logical_pathname_p(thing: Any) -> bool | None:
    """``uiop:logical-pathname-p``"""
    return boolean(isinstance(thing, LogicalPathname))


def physical_pathname_p(thing: Any) -> bool | None:
    """``uiop:physical-pathname-p``"""
    return boolean(isinstance(thing, Pathname) and not isinstance(thing, LogicalPathname))


def physicalize_pathname(pathspec: Any) -> Pathname:
    """``uiop:physicalize-pathname``: logical pathnames translated."""
    return lisp_path(path_of(pathspec)) if isinstance(pathspec, LogicalPathname) else pathname(pathspec)


def ensure_directory_pathname(pathspec: Any, on_error: Any = None) -> Any:
    """``uiop:ensure-directory-pathname``: as the name of a folder: ``/a/b`` becomes ``/a/b/``."""
    path = _given(pathspec)
    if path is None or directory_pathname_p(path):
        return path
    if path.name is WILD or _wild(path) and path.name is not None and not isinstance(path.name, str):
        return error("Can't reliably convert wild pathname ~S", path)
    last = native_text(Pathname(name=path.name, type=path.type))
    return path.replace(directory=(*(path.directory or (RELATIVE,)), last), name=None, type=None, version=None)


def pathname_directory_pathname(pathspec: Any) -> Any:
    """``uiop:pathname-directory-pathname``: the folder, without a name."""
    path = _given(pathspec)
    return path and path.replace(name=None, type=None, version=None)


def pathname_parent_directory_pathname(pathspec: Any) -> Any:
    """``uiop:pathname-parent-directory-pathname``: the folder in which the pathname's folder lies."""
    path = pathname_directory_pathname(pathspec)
    if path is None or not path.directory or len(path.directory) == 1:
        return path if path is None or path.directory else path.replace(directory=(RELATIVE, sym(":UP")))
    return path.replace(directory=path.directory[:-1])


def pathname_root(pathspec: Any) -> Pathname:
    """``uiop:pathname-root``: ``/``"""
    return pathname(pathspec).replace(directory=(ABSOLUTE,), name=None, type=None, version=None)


def pathname_host_pathname(pathspec: Any) -> Pathname:
    """``uiop:pathname-host-pathname``: the host alone."""
    return pathname(pathspec).replace(directory=None, name=None, type=None, version=None)


def split_name_type(filename: Any) -> MultipleValues:
    """``uiop:split-name-type``: two values, the name and the type of a file's name; :unspecific where there is no type."""
    name, dot, type = str(filename).rpartition(".")
    return MultipleValues((FreshString(name), FreshString(type)) if name else (filename, UNSPECIFIC))


def parse_unix_namestring(
    name: Any, *, type: Any = None, defaults: Any = None, dot_dot: Any = None, ensure_directory: Any = None, **checks: Any
) -> Any:
    """``uiop:parse-unix-namestring``: the pathname that a text with slashes means on every system.

    type: the type, so that dots belong to the name; :directory for the name of a folder. checks: those of `ensure_pathname`.
    """
    if name is None or isinstance(name, Pathname):
        return name and ensure_pathname(name, defaults=defaults, ensure_directory=ensure_directory, **checks)
    text = symbol_name(name).lower() if is_symbol(name) else str(name)
    is_folder = truth(ensure_directory) or isinstance(type, Keyword)
    path = pathname_of_text(text, is_folder, type if isinstance(type, TEXT) else None)
    return ensure_pathname(path, defaults=defaults, **checks) if checks or defaults is not None else path


def pathname_of_text(text: str, is_folder: bool, type: Any = None) -> Pathname:
    """The pathname of a text with slashes; ``..`` takes the folder before it away."""
    folders: list[Any] = []
    *above, last = text.split("/")
    if is_folder or last in (".", ".."):
        above, last = [*above, last], ""
    for part in above:
        if part == ".." and folders and isinstance(folders[-1], str):
            folders.pop()
        elif part == "..":
            folders.append(sym(":UP"))
        elif part not in ("", "."):
            folders.append(part)
    begins = ABSOLUTE if text.startswith("/") else RELATIVE
    name, kind = (last, type) if type is not None else split_name_type(last)
    kind = None if kind is UNSPECIFIC else kind
    return Pathname(
        directory=(begins, *folders) if folders or begins is ABSOLUTE else None, name=str(name) or None, type=kind and str(kind)
    )


def split_unix_namestring_directory_components(namestring: Any, *, ensure_directory: Any = None, dot_dot: Any = None) -> MultipleValues:
    """``uiop:split-unix-namestring-directory-components``: four values: :absolute or :relative, the folders, the file or nil, and whether
    there is a name alone."""
    path = pathname_of_text(str(namestring), truth(ensure_directory))
    folders = list(path.directory or (RELATIVE,))
    last = None if path.name is None else native_text(Pathname(name=path.name, type=path.type))
    return MultipleValues((folders[0], list_from(folders[1:]), last, boolean("/" not in str(namestring))))


def unix_namestring(path: Any) -> Any:
    """``uiop:unix-namestring``: the text with slashes of a pathname."""
    return path if path is None or isinstance(path, TEXT) else FreshString(native_text(pathname(path)))


def native_namestring(path: Any) -> Any:
    """``uiop:native-namestring``: what the operating system calls it."""
    return None if path is None else FreshString(native_text(pathname(path)))


def parse_native_namestring(string: Any, *, ensure_directory: Any = None, **checks: Any) -> Any:
    """``uiop:parse-native-namestring``: the pathname of what the operating system calls so; checks: those of `ensure_pathname`."""
    path = None if string is None else parse_native(str(string))
    return ensure_pathname(path, ensure_directory=ensure_directory, **checks)


def split_native_pathnames_string(string: Any, *, want_absolute: Any = None, **checks: Any) -> Any:
    """``uiop:split-native-pathnames-string``: the pathnames in a text such as the value of PATH."""
    parts = str(string).split(os.pathsep) if string else ()
    return list_from([parse_native_namestring(part, want_absolute=want_absolute, **checks) if part else None for part in parts])


def merge_pathnames_as_given(specified: Any, defaults: Any = None) -> Any:
    """``uiop:merge-pathnames*``: ``merge-pathnames``; without defaults the pathname as it is."""
    if specified is None:
        return _given(defaults)
    return specified if defaults is None else merge_pathnames(specified, defaults)


def subpathname(path: Any, subpath: Any, *, type: Any = None) -> Any:
    """``uiop:subpathname``: a path below that of a folder or of a file's folder."""
    below = parse_unix_namestring(subpath, type=type, want_relative=True)
    return merge_pathnames_as_given(below, pathname_directory_pathname(path))


def subpathname_of_folder(path: Any, subpath: Any, *, type: Any = None) -> Any:
    """``uiop:subpathname*``: a path below that of a folder, written with or without a slash; nil without a folder."""
    return None if path is None else subpathname(ensure_directory_pathname(path), subpath, type=type)


def subpathp(maybe_below: Any, base: Any) -> Any:
    """``uiop:subpathp``: the pathname as seen from the folder ``base``, nil if it is not below it. Both are pathnames from the root on."""
    if not (
        isinstance(maybe_below, Pathname) and isinstance(base, Pathname) and absolute_pathname_p(maybe_below) and absolute_pathname_p(base)
    ):
        return None
    if not directory_pathname_p(base) or _wild(base):
        return None
    return relative_pathname_p(pathname(enough_namestring(maybe_below, base)))


def enough_pathname(maybe_below: Any, base: Any) -> Any:
    """``uiop:enough-pathname``: the pathname as seen from a folder; itself if it is not below it."""
    return maybe_below and subpathp(pathname(maybe_below), _given(base)) or _given(maybe_below)


def call_with_enough_pathname(maybe_below: Any, defaults: Any, thunk: Any) -> Any:
    """``uiop:call-with-enough-pathname``: the values of ``thunk`` for `enough_pathname`."""
    return call_function(thunk, enough_pathname(maybe_below, defaults))


def pathname_equal(first: Any, second: Any) -> bool | None:
    """``uiop:pathname-equal``: whether two designators mean the same pathname; nil is like itself only."""
    if first is None or second is None:
        return boolean(first is second)
    return boolean(_written(pathname(first)) == _written(pathname(second)))


def _written(path: Pathname) -> tuple[Any, ...]:
    return tuple(None if part is UNSPECIFIC or part == (RELATIVE,) else part for part in path.key)


def add_pathname_suffix(path: Any, suffix: Any) -> Pathname:
    """``uiop:add-pathname-suffix``: the pathname with a text behind its name."""
    given = pathname(path)
    return make_pathname(name=f"{given.name or ''}{suffix}", defaults=given)


def wilden(path: Any) -> Pathname:
    """``uiop:wilden``: the pathname that all files below a folder match."""
    return merge_pathnames(Pathname(directory=(RELATIVE, WILD_INFERIORS), name=WILD, type=WILD), pathname(path))


def nil_pathname(defaults: Any = None) -> Pathname:
    """``uiop:nil-pathname``: the pathname without parts."""
    return NIL


def relativize_directory_component(directory: Any) -> Any:
    """``uiop:relativize-directory-component``: the list of a directory as one that does not begin at the root."""
    parts = list(directory or ())
    return list_from([RELATIVE, *parts[1:]]) if parts and parts[0] is ABSOLUTE else directory


def relativize_pathname_directory(pathspec: Any) -> Pathname:
    """``uiop:relativize-pathname-directory``: the pathname as one that does not begin at the root."""
    path = pathname(pathspec)
    return path.replace(directory=(RELATIVE, *path.directory[1:])) if path.directory else path


def normalize_pathname_directory_component(directory: Any) -> Any:
    """``uiop:normalize-pathname-directory-component``: the list of a directory, if it is one."""
    if directory is None or not isinstance(directory, TEXT) and list(directory)[0] in (ABSOLUTE, RELATIVE):
        return directory
    return parameter_error(
        "~S: Unrecognized pathname directory component ~S", sym("UIOP::NORMALIZE-PATHNAME-DIRECTORY-COMPONENT"), directory
    )


def denormalize_pathname_directory_component(directory: Any) -> Any:
    """``uiop:denormalize-pathname-directory-component``: the list of a directory as ``make-pathname`` takes it."""
    return directory


def merge_pathname_directory_components(specified: Any, defaults: Any) -> Any:
    """``uiop:merge-pathname-directory-components``: the list of a directory as seen from another."""
    if specified is None:
        return defaults
    return specified if list(specified)[0] is ABSOLUTE else list_from([*(defaults or (RELATIVE,)), *list(specified)[1:]])


def translate_pathname_or_function(path: Any, source: Any, destination: Any, root: Any = None, origin: Any = None) -> Any:
    """``uiop:translate-pathname*``: ``translate-pathname``; the destination may be a function of the pathname, or T for none."""
    if destination is True:
        return path
    if callable(destination):
        return destination(path, source)
    if not isinstance(destination, Pathname):
        return parameter_error("~S: Invalid destination", sym("UIOP::TRANSLATE-PATHNAME*"))
    return translate_pathname(path, source, destination)


def inter_directory_separator() -> Any:
    """``uiop:inter-directory-separator``: the character between folders in the value of PATH."""
    return sym_character(os.pathsep)


def directory_separator_for_host(path: Any = None) -> Any:
    """``uiop:directory-separator-for-host``: the character between folders of a name."""
    return sym_character("/")


def sym_character(char: str) -> Any:
    """The Lisp character of a text of one."""
    from cramhy_runtime.lisp_core.data import Character

    return Character(char)


def null_device_pathname() -> Pathname:
    """``uiop:null-device-pathname``: the file that is empty and forgets what is written into it."""
    return pathname(os.devnull)


def lispize_pathname(path: Any) -> Pathname:
    """``uiop:lispize-pathname``: with the type ``lisp``."""
    return make_pathname(type="lisp", defaults=path)


def ensure_absolute_pathname(path: Any, defaults: Any = None, on_error: Any = None) -> Any:
    """``uiop:ensure-absolute-pathname``: the pathname from the root on, as seen from ``defaults``: a pathname or a function of one."""
    given = _given(path)
    if given is not None and absolute_pathname_p(given):
        return given
    base = call_function(defaults) if defaults is not None and not isinstance(defaults, Pathname) else defaults
    if given is not None and base is not None and absolute_pathname_p(base):
        return merge_pathnames(given, base)
    return call_function(on_error or "error", "Failed to ensure absolute pathname for ~S with defaults ~S", path, base)


_WANTED = {
    "want_pathname": ("Expected a pathname, not NIL", lambda path: path is not None),
    "want_logical": ("Expected a logical pathname", logical_pathname_p),
    "want_physical": ("Expected a physical pathname", physical_pathname_p),
    "want_relative": ("Expected a relative pathname", relative_pathname_p),
    "want_absolute": ("Expected an absolute pathname", absolute_pathname_p),
    "want_wild": ("Expected a wildcard pathname", _wild),
    "want_non_wild": ("Expected a non-wildcard pathname", lambda path: not _wild(path)),
    "want_file": ("Expected a file pathname", file_pathname_p),
    "want_directory": ("Expected a directory pathname", directory_pathname_p),
    "want_existing": ("Expected an existing pathname", lambda path: os.path.exists(path_of(path))),
}


def ensure_pathname(
    path: Any,
    *,
    on_error: Any = None,
    defaults: Any = None,
    type: Any = None,
    dot_dot: Any = None,
    namestring: Any = None,
    empty_is_nil: Any = None,
    want_pathname: Any = None,
    want_logical: Any = None,
    want_physical: Any = None,
    ensure_physical: Any = None,
    want_relative: Any = None,
    want_absolute: Any = None,
    ensure_absolute: Any = None,
    ensure_subpath: Any = None,
    want_non_wild: Any = None,
    want_wild: Any = None,
    wilden: Any = None,
    want_file: Any = None,
    want_directory: Any = None,
    ensure_directory: Any = None,
    want_existing: Any = None,
    ensure_directories_exist: Any = None,
    truename: Any = None,
    resolve_symlinks: Any = None,
    truenamize: Any = None,
) -> Any:
    """``uiop:ensure-pathname``: the pathname of a string or pathname, with what the arguments want checked and ensured.

    A wish that does not hold calls ``on_error`` with a format control and its arguments, by default `error`.
    """
    told = locals()

    def check(name: str, value: Any) -> None:
        text, holds = _WANTED[name]
        if truth(told[name]) and (value is not None or name == "want_pathname") and not holds(value):
            if on_error is None:
                error(SimpleError("Invalid pathname ~S: " + text, path))
            call_function(on_error, "Invalid pathname ~S: " + text, path)

    made = _parsed(path, namestring, type, empty_is_nil)
    check("want_pathname", made)
    if made is None:
        return None
    if truth(ensure_physical):
        made = physicalize_pathname(made)
    if truth(ensure_directory):
        made = ensure_directory_pathname(made)
    for name in ("want_logical", "want_physical", "want_relative"):
        check(name, made)
    if defaults is not None:
        made = merge_pathnames(made, call_function(defaults) if callable(defaults) else defaults)
    if truth(ensure_absolute):
        made = ensure_absolute_pathname(made, lambda: lisp_path(os.getcwd()))
    for name in ("want_absolute", "want_file", "want_directory", "want_non_wild", "want_wild"):
        check(name, made)
    if truth(ensure_subpath) and subpathp(made, _given(defaults)) is None:
        error(SimpleError("Invalid pathname ~S: Could not be made a subpath of ~S", path, defaults))
    if truth(wilden) and not _wild(made):
        made = _wildened(made)
    check("want_existing", made)
    return _resolved(made, told)


def _wildened(path: Pathname) -> Pathname:
    return wilden(path)


def _parsed(path: Any, namestring: Any, type: Any, empty_is_nil: Any) -> Any:
    if not isinstance(path, TEXT):
        return _given(path)
    if truth(empty_is_nil) and path == "":
        return None
    if namestring is sym(":NATIVE"):
        return parse_native(path)
    return pathname(path) if namestring is sym(":LISP") else pathname_of_text(str(path), False, type if isinstance(type, TEXT) else None)


def _resolved(path: Pathname, told: dict[str, Any]) -> Any:
    from ..files.files import ensure_directories_exist

    if truth(told["ensure_directories_exist"]):
        ensure_directories_exist(path)
    if any(truth(told[name]) for name in ("truename", "resolve_symlinks", "truenamize")):
        return truename(path) if truth(told["truename"]) or os.path.exists(path_of(path)) else path
    return path
