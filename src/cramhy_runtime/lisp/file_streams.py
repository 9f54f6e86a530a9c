"""Files as streams: ``open``, ``with-open-file``, ``probe-file``, ``delete-file``.

Only text files, in UTF-8. A pathname is a ``pathlib`` path; a string stands for one, relative to
``*default-pathname-defaults*`` if that is set, else to the working directory. Source: ANSI 21.2 (open) and chapter 20; texts
are SBCL's.
"""

from __future__ import annotations

import os
import pathlib

from .conditions import FileError, error, type_error
from .data import UNSUPPLIED, LispString, Symbol
from .packages import sym
from .streams import FileInput, FileOutput

DEFAULT_PATHNAME = sym("*DEFAULT-PATHNAME-DEFAULTS*")


class FileDoesNotExist(FileError):
    lisp_name = "SB-EXT::FILE-DOES-NOT-EXIST"


class FileExists(FileError):
    lisp_name = "SB-EXT::FILE-EXISTS"


class DeleteFileError(FileError):
    lisp_name = "SB-EXT::DELETE-FILE-ERROR"


def path_of(designator):
    """The path that a string, a path or a file stream stands for."""
    if isinstance(designator, (FileInput, FileOutput)):
        designator = designator.label.removeprefix("file ")
    if isinstance(designator, LispString):
        designator = str(designator)
    if not isinstance(designator, (str, pathlib.PurePath)):
        return type_error(designator, "(OR PATHNAME STRING)")
    path = pathlib.Path(designator).expanduser()
    start = DEFAULT_PATHNAME.value
    return pathlib.Path(start) / path if isinstance(start, (str, pathlib.PurePath)) else path


def _keyword(value, default):
    if value is UNSUPPLIED:
        return default
    return value.name if isinstance(value, Symbol) else value


def open_(
    filespec,
    *,
    direction=UNSUPPLIED,
    element_type=None,
    if_exists=UNSUPPLIED,
    if_does_not_exist=UNSUPPLIED,
    external_format=None,
):
    """``open``: a stream on a text file; nil where the arguments say so.

    direction: :input (default), :output, :io or :probe. if_exists: :error (default), :supersede, :append, :overwrite,
    :rename, nil. if_does_not_exist: :error, :create, nil. Errors: `FileDoesNotExist`, `FileExists`, `FileError`.
    """
    path, direction = path_of(filespec), _keyword(direction, "INPUT")
    writing = direction in ("OUTPUT", "IO")
    if_exists = _keyword(if_exists, "ERROR")
    missing = _keyword(if_does_not_exist, "CREATE" if writing and if_exists not in ("APPEND", "OVERWRITE") else "ERROR")
    if not path.exists():
        if missing is None or (direction == "PROBE" and if_does_not_exist is UNSUPPLIED):
            return None
        if missing == "ERROR":
            return error(FileDoesNotExist(path, "The file ~S does not exist: No such file or directory", path))
    elif writing and if_exists in (None, "ERROR"):
        return None if if_exists is None else error(FileExists(path, "The file ~S already exists: File exists", path))
    mode = "r" if not writing else {"APPEND": "a", "OVERWRITE": "r+"}.get(if_exists, "w")
    if mode == "r+" and not path.exists():
        mode = "w"
    try:
        file = open(path, mode, encoding="utf-8")  # noqa: SIM115  the stream closes it
    except OSError as problem:
        return error(FileError(path, "Error opening ~S: ~A", path, os.strerror(problem.errno)))
    stream = (FileOutput if writing else FileInput)(file, f"file {path}")
    if direction == "PROBE":
        stream.close()
    return stream


def with_open_file(
    function,
    filespec,
    *,
    direction=UNSUPPLIED,
    element_type=None,
    if_exists=UNSUPPLIED,
    if_does_not_exist=UNSUPPLIED,
    external_format=None,
):
    """What the macro ``with-open-file`` becomes: the values of ``function(stream)``; the file is always closed. Keywords: `open_`."""
    stream = open_(filespec, direction=direction, if_exists=if_exists, if_does_not_exist=if_does_not_exist)
    try:
        return function(stream)
    finally:
        if stream is not None:
            stream.close()


def probe_file(filespec):
    """``probe-file``: the path of the file if it exists, without links; else nil."""
    path = path_of(filespec)
    return path.resolve() if path.exists() else None


def delete_file(filespec):
    """``delete-file``: remove the file. Returns T. Errors: `DeleteFileError`."""
    path = path_of(filespec)
    try:
        path.unlink()
    except OSError as problem:
        return error(DeleteFileError(path, "Could not delete the file ~S: ~A", str(path), os.strerror(problem.errno)))
    return True


LISP_NAMES = "open probe-file delete-file"
