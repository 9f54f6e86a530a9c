"""Values that were computed from files, as long as the files do not change; and forms in a string. Source: cpl.md 13.3."""

from __future__ import annotations

import os

from cramhy_runtime.lisp_core.conditions import error, type_error
from cramhy_runtime.lisp_core.data import LispString, one

_values: dict = {}


def _date(file):
    if not isinstance(file, (str, LispString, os.PathLike)):
        return type_error(file, "(OR PATHNAME STRING)")
    name = os.path.abspath(str(file) if isinstance(file, LispString) else os.fspath(file))
    try:
        status = os.stat(name)
    except OSError as problem:
        return error("The file ~A cannot be looked at: ~A.", name, problem.strerror)
    return name, (status.st_mtime_ns, status.st_size)


def cached_file_value(file):
    """``cut:cached-file-value``: the value kept for a file, nil when there is none or the file has changed since."""
    name, date = _date(file)
    kept = _values.get(name)
    return kept[1] if kept is not None and kept[0] == date else None


def set_cached_file_value(value, file):
    """``(setf cut:cached-file-value)``: keep ``value`` until the file changes."""
    name, date = _date(file)
    _values[name] = (date, value)
    return value


def file_value(file, compute):
    """The value kept for a file; ``compute`` makes it when the file is new or has changed."""
    name, date = _date(file)
    kept = _values.get(name)
    if kept is None or kept[0] != date:
        kept = _values[name] = (date, one(compute()))
    return kept[1]


def execute_string(string, *, filename=None, cleanup=True):
    """``cut:execute-string``: evaluate the forms in a string; T."""
    from ...systems.loader import load_text

    load_text(str(string), filename and str(filename) or "<string>")
    return True
