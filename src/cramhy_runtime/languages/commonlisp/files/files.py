"""Files of the operating system: whether they are there, their names without links, folders, dates (ANSI chapter 20).

Errors are file-errors with SBCL's texts, and the reason in the system's words. A relative pathname is one of the folder that
``*default-pathname-defaults*`` names, else of the working directory.
"""

from __future__ import annotations

import os
import stat
from pathlib import Path

from cramhy_runtime.lisp_core.conditions import FileError, SimpleFileError, error
from cramhy_runtime.lisp_core.data import MultipleValues, boolean, list_from
from cramhy_runtime.storage import owners
from ..streams.streams import standard_output
from ..pathnames.logical_pathnames import translate_logical_pathname
from ..pathnames.namestrings import directory_text, native_namestring, parse_native, root_text
from ..pathnames.pathname_objects import ABSOLUTE, BACK, HOME, UP, WILD, WILD_INFERIORS, Pathname, Pattern
from ..pathnames.pathnames import merge_pathnames, pathname
from ..pathnames.wild_pathnames import component_matches, wild_pathname_p

LISP_NAMES = """directory probe-file truename ensure-directories-exist file-author file-write-date rename-file delete-file
user-homedir-pathname"""
EXTENSION_NAMES = "delete-directory"
"""Names of the package SB-EXT."""

UNIVERSAL_EPOCH = 2208988800
"""1970 in seconds since 1900."""


class FileDoesNotExist(FileError):
    lisp_name = "SB-EXT::FILE-DOES-NOT-EXIST"


class FileExists(FileError):
    lisp_name = "SB-EXT::FILE-EXISTS"


class DeleteFileError(FileError):
    lisp_name = "SB-EXT::DELETE-FILE-ERROR"


def reason(problem):
    """Why the system refused, in its words."""
    return os.strerror(problem.errno) if problem.errno else str(problem)


def physical(designator):
    """The pathname of the file itself: logical pathnames translated, what is missing taken from the defaults."""
    path = merge_pathnames(translate_logical_pathname(designator))
    return path if type(path) is Pathname else translate_logical_pathname(path)


def absolute(path):
    """``path`` from the root on."""
    if path.directory and path.directory[0] is ABSOLUTE:
        return path
    return merge_pathnames(path, parse_native(os.getcwd() + "/"))


def path_of(designator):
    """What the operating system calls the file that ``designator`` names; a wild one is a file-error."""
    return native_namestring(absolute(physical(designator)))


def lisp_path(name):
    """The pathname of the file that the operating system calls ``name``; that of a folder ends in a slash."""
    name = os.fspath(name)
    return parse_native(name.rstrip("/") + "/" if os.path.isdir(name) else name)


def _existing(designator, what):
    path = absolute(physical(designator))
    if wild_pathname_p(path) is not None:
        return error(
            SimpleFileError(path, "Can't find the ~A of wild pathname ~A (physicalized from ~A).", what, path, pathname(designator))
        )
    name = native_namestring(path)
    try:
        return name, os.stat(name if len(name) == 1 or not os.path.isfile(name.rstrip("/")) else name.rstrip("/"))
    except OSError as problem:
        return error(SimpleFileError(path, "Failed to find the ~A of ~A: ~A", what, path, reason(problem)))
    except ValueError as problem:  # a name with a null character in it
        return error(SimpleFileError(path, "Failed to find the ~A of ~A: ~A", what, path, str(problem)))


def probe_file(designator):
    """``probe-file``: the truename of the file, nil if there is none."""
    path = absolute(physical(designator))
    if wild_pathname_p(path) is not None:
        return _existing(designator, "TRUENAME")
    name = native_namestring(path)
    name = name.rstrip("/") if os.path.isfile(name.rstrip("/")) else name
    return lisp_path(os.path.realpath(name)) if os.path.lexists(name) else None


def truename(designator):
    """``truename``: the pathname of an existing file, from the root and without links; a file-error when there is none."""
    name, _ = _existing(designator, "TRUENAME")
    return lisp_path(os.path.realpath(name.rstrip("/") or "/"))


def file_author(designator):
    """``file-author``: the name of the user who owns the file, nil where the system does not know one."""
    _, status = _existing(designator, "AUTHOR")
    return owners.name_of(status.st_uid)


def file_write_date(designator):
    """``file-write-date``: when the file was changed last, as a universal time. This is the wall's time also in virtual time."""
    _, status = _existing(designator, "WRITE-DATE")
    return int(status.st_mtime) + UNIVERSAL_EPOCH


def delete_file(designator):
    """``delete-file``: remove the file. Returns T. Errors: `DeleteFileError`."""
    name = path_of(designator)
    try:
        os.unlink(name)
    except (OSError, ValueError) as problem:
        text = reason(problem) if isinstance(problem, OSError) else str(problem)
        return error(DeleteFileError(pathname(designator), "Could not delete the file ~S: ~A", name, text))
    return True


def delete_directory(designator, *, recursive=None):
    """``sb-ext:delete-directory``: remove a folder, with all that is in it if ``recursive``. Returns its pathname."""
    name = path_of(designator)
    try:
        if recursive is not None and not os.path.islink(name.rstrip("/")):
            import shutil  # it reads four libraries that pack files

            shutil.rmtree(name)
        else:
            os.rmdir(name)
    except OSError as problem:
        return error(SimpleFileError(pathname(designator), "Could not delete directory ~S: ~A", name, reason(problem)))
    return lisp_path(name + "/")


def rename_file(file, new_name):
    """``rename-file``: what ``new_name`` leaves out stays. Three values: the new pathname, the old and the new truename."""
    before = truename(file)
    after = merge_pathnames(new_name, merge_pathnames(file))
    target = path_of(after)
    try:
        os.rename(native_namestring(before), target)
    except OSError as problem:
        return error(SimpleFileError(pathname(new_name), "couldn't rename ~A to ~A: ~A", before, after, reason(problem)))
    return MultipleValues((after, before, lisp_path(os.path.realpath(target))))


def ensure_directories_exist(designator, *, verbose=None, mode=0o777):
    """``ensure-directories-exist``: make the folders of the pathname. Second value: whether any was made."""
    path = absolute(physical(designator))
    if wild_pathname_p(path) is not None:
        return error(SimpleFileError(path, "bad place for a wild pathname"))
    folder = directory_text(path, native=True)
    missing = []
    while folder != root_text(path) and not os.path.isdir(folder):
        if os.path.lexists(folder.rstrip("/")):
            return error(SimpleFileError(path, "Can't create directory ~A,~%a file with the same name already exists.", folder.rstrip("/")))
        missing.append(folder)
        folder = os.path.dirname(folder.rstrip("/")).rstrip("/") + "/"
    for each in reversed(missing):
        if verbose is not None:
            say(f"creating directory: {each}")
        try:
            os.mkdir(each, mode)
        except FileExistsError:
            pass  # another process was faster
        except OSError as problem:
            return error(SimpleFileError(path, "Can't create directory ~A: ~A", each, reason(problem)))
    return MultipleValues((designator, boolean(missing)))


def say(line):
    """Print ``line`` to ``*standard-output*`` as a line of its own."""
    output = standard_output()
    output.fresh_line()
    output.write(line + "\n")


# ------------------------------------------------------------------------------------------------------------ wild names


def directory(designator, *, resolve_symlinks=True):
    """``directory``: the truenames of the files that a pathname with wild cards means, each once, in the order of their names.

    resolve_symlinks: nil gives links as they are.
    """
    path = absolute(physical(designator))
    _check_ways_up(path)
    found = {}
    for folder in _folders(root_text(path), path.directory[1:]):
        if path.name is None and path.type is None:
            names = [folder] if os.path.isdir(folder) else []
        elif isinstance(path.name, str) and not isinstance(path.type, Pattern) and path.type is not WILD:
            name = os.path.join(folder, path.name if path.type is None else f"{path.name}.{path.type}")
            names = [name] if os.path.lexists(name) else []
        else:
            names = [entry.path for entry in _entries(folder) if _fits(entry.name, path)]
        for name in names:
            found.setdefault(os.path.realpath(name) if resolve_symlinks is not None else name)
    return list_from([lisp_path(name) for name in found])


def _check_ways_up(path):
    """Signal a file-error if the directory of ``path`` goes up from the root, or from folders of any depth."""
    start, *parts = path.directory
    for before, part in zip([start, *parts], parts):
        if part is UP and before in (ABSOLUTE, WILD_INFERIORS) or part is BACK and before is ABSOLUTE:
            error(SimpleFileError(path, "The directory of ~S goes up from where there is no folder above.", path))


def _entries(folder):
    try:
        return sorted(os.scandir(folder), key=lambda entry: entry.name)
    except OSError:
        return []  # a folder that cannot be read has nothing to show


def _fits(name, path):
    parts = parse_native(name)
    return component_matches(parts.name, path.name) and (path.type is parts.type is None or component_matches(parts.type, path.type))


def _folders(folder, parts):
    """The folders below ``folder`` that the components ``parts`` mean."""
    if not parts:
        yield folder
        return
    part, rest = parts[0], parts[1:]
    if part is WILD_INFERIORS:
        yield from _folders(folder, rest)
        for entry in _entries(folder):
            if entry.is_dir(follow_symlinks=False):
                yield from _folders(entry.path, parts)
    elif part is WILD or isinstance(part, Pattern):
        for entry in _entries(folder):
            if component_matches(entry.name, part) and os.path.isdir(entry.path):  # entry.is_dir() would not bear a folder of others
                yield from _folders(entry.path, rest)
    elif part is HOME or isinstance(part, tuple):
        yield from _folders(os.path.expanduser("~" if part is HOME else f"~{part[1]}"), rest)
    else:
        name = os.path.join(folder, ".." if part is UP else part)
        if os.path.isdir(name):
            yield from _folders(name, rest)


def user_homedir_pathname(host=None):
    """``user-homedir-pathname``: the user's folder."""
    return parse_native(os.path.join(Path.home(), ""))


def is_regular(name):
    """Whether reading the file never waits: it is no terminal, pipe or device. Also true of what is not there."""
    try:
        return stat.S_ISREG(os.stat(name).st_mode) or os.path.isdir(name)
    except OSError:
        return True
