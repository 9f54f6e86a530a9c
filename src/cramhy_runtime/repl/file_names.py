"""What the Tab key offers inside of a string: names of files and folders."""

from __future__ import annotations

import os
import re

from cramhy_runtime.lisp_core.conditions import Error, handler_case
from cramhy_runtime.languages.commonlisp.pathnames.namestrings import native_namestring
from cramhy_runtime.languages.commonlisp.pathnames.pathnames import DEFAULTS

from .open_forms import OpenForms


def begun_string(text: str, hy: bool = False) -> str | None:
    """What is typed of the string that is open at the end of ``text``; ``None`` if none is. hy: whether it is Hy's text, and not Lisp's."""
    opened = OpenForms(hy)
    opened.read(text)
    return text[opened.within_from :] if opened.within == '"' else None


def file_names(typed: str, folder: str | None = None) -> list[str]:
    """The strings that ``typed``, the beginning of one, may become, as they are written between quotes. The name of a folder ends in ``/``.

    folder: where a relative name begins; by default ``*default-pathname-defaults*``, where Lisp looks. ``~`` is the user's home. A file
    whose name begins with a dot is offered when the dot is typed.
    """
    above, slash, begun = _plain(typed).rpartition("/")
    above += slash
    start = _current() if folder is None else folder
    try:
        with os.scandir(os.path.join(start, os.path.expanduser(above)) or ".") as entries:
            found = [
                f"{_written(above + entry.name)}{'/' if entry.is_dir() else ''}"
                for entry in entries
                if entry.name.startswith(begun) and (begun or not entry.name.startswith(".")) and entry.name.isprintable()
            ]
    except (OSError, ValueError):  # there is no such folder, or we may not look into it
        return []
    return sorted(found)


def _plain(typed):
    """The text that is written so in a string."""
    return re.sub(r"\\(.)", r"\1", typed, flags=re.S)


def _written(text):
    return re.sub(r'(["\\])', r"\\\1", text)


def _current():
    """Where Lisp looks for files; where Python does if a program has made something of the variable that is not a folder."""
    return handler_case([(Error, lambda problem: os.getcwd())], lambda: native_namestring(DEFAULTS.value))


__all__ = ["begun_string", "file_names"]
