"""Pathnames: names of files taken apart and put together (ANSI chapter 19), as far as plans need them.

A pathname is a ``pathlib`` path, and a string stands for one. What this leaves out of the standard: hosts, devices, versions,
logical pathnames and wild cards, none of which a path of this system has. The name of a folder may or may not end in a slash.
"""

from __future__ import annotations

import os
import pathlib

from .conditions import type_error
from .data import LispString, list_from, python_list
from .file_streams import DEFAULT_PATHNAME
from .packages import keyword

LISP_NAMES = """pathname pathnamep parse-namestring namestring file-namestring directory-namestring pathname-name pathname-type
pathname-directory merge-pathnames make-pathname truename user-homedir-pathname"""


def pathname(designator):
    """The path that a string or a path stands for; the working directory plays no part."""
    if isinstance(designator, LispString):
        designator = str(designator)
    if isinstance(designator, str):
        return pathlib.PurePath(designator)
    return designator if isinstance(designator, pathlib.PurePath) else type_error(designator, "(OR PATHNAME STRING)")


parse_namestring = pathname


def pathnamep(obj):
    return True if isinstance(obj, pathlib.PurePath) else None


def namestring(designator):
    return designator if isinstance(designator, str) else str(pathname(designator))


def file_namestring(designator):
    return os.path.basename(namestring(designator))


def directory_namestring(designator):
    folder = os.path.dirname(namestring(designator))
    return folder + "/" if folder and folder != "/" else folder


def pathname_name(designator):
    """The name of the file without its type; nil for a folder."""
    return os.path.splitext(file_namestring(designator))[0] or None


def pathname_type(designator):
    return os.path.splitext(file_namestring(designator))[1][1:] or None


def pathname_directory(designator):
    """A list of :absolute or :relative and the names of the folders; nil when there are none."""
    parts = pathlib.PurePath(directory_namestring(designator)).parts
    if not parts:
        return None
    absolute = parts[0] == "/"
    return list_from([keyword("ABSOLUTE" if absolute else "RELATIVE"), *parts[absolute:]])


def make_pathname(*, name=None, type=None, directory=None, defaults=None, host=None, device=None, version=None, case=None):
    """The path of these parts; those that are missing come from ``defaults``."""
    if defaults is not None:
        name = pathname_name(defaults) if name is None else name
        type = pathname_type(defaults) if type is None else type
        directory = pathname_directory(defaults) if directory is None else directory
    if isinstance(directory, str):
        folder = pathlib.PurePath("/", directory)
    else:
        kind, *folders = python_list(directory) or [None]
        start = "/" if kind is keyword("ABSOLUTE") else ""
        folder = pathlib.PurePath(start, *[".." if each in (keyword("UP"), keyword("BACK")) else str(each) for each in folders])
    file = "" if name is None else str(name)
    return folder / (file if type is None else f"{file}.{type}")


def merge_pathnames(designator, defaults=None, default_version=None):
    """The path with the folder, name and type that it lacks taken from ``defaults`` (``*default-pathname-defaults*``)."""
    defaults = DEFAULT_PATHNAME.value if defaults is None else defaults
    path, given = pathname(designator), namestring(designator)
    if not isinstance(defaults, (str, pathlib.PurePath)):
        return path
    name, kind = pathname_name(given) or pathname_name(defaults), pathname_type(given) or pathname_type(defaults)
    folder = pathlib.PurePath(directory_namestring(defaults), directory_namestring(given))
    file = "" if name is None else name if kind is None else f"{name}.{kind}"
    return folder / file


def truename(designator):
    """The path of an existing file, absolute and without links; a file-error when there is none."""
    from .conditions import error
    from .file_streams import FileDoesNotExist, path_of

    path = path_of(designator)
    if not path.exists():
        return error(FileDoesNotExist(str(path), "Failed to find the TRUENAME of ~A: No such file or directory", str(path)))
    return path.resolve()


def user_homedir_pathname(host=None):
    return pathlib.Path.home()
