"""The names of UIOP that ``.asd`` files use all the time: of symbols, the environment, files that are there, texts and versions."""

from __future__ import annotations

import os
import sys

from cramhy_runtime.lisp_core import packages
from cramhy_runtime.lisp_core.conditions import error
from cramhy_runtime.lisp_core.data import Cons, FreshString, MultipleValues, list_from, one, truth
from ..evaluation.evaluator import PACKAGE
from ..pathnames.pathname_objects import Pathname
from ..packages.face_definition import define_face
from ..files.files import absolute, lisp_path, path_of, physical
from cramhy_runtime.lisp_core.packages import find_package, is_symbol, keyword, string_designator, sym


def find_package_(designator, errorp=True):
    """``uiop:find-package*``"""
    return packages.find_package_or_error(designator) if truth(errorp) else find_package(designator)


def find_symbol_(name, package=None, error_p=True):
    """``uiop:find-symbol*``: two values, the symbol of that name and its status; without one nil or, with ``error_p``, an error."""
    home = packages.find_package_or_error(PACKAGE.value if package is None else package) if truth(error_p) else find_package(package)
    symbol, status = home.lookup(string_designator(name)) if home is not None else (None, None)
    if status is None and truth(error_p):
        return error("There is no symbol ~S in package ~S", string_designator(name), home.name)
    return MultipleValues((symbol, status and keyword(status.upper())))


def symbol_call(package, name, *arguments):
    """``uiop:symbol-call``: call the function of a symbol that need not be there when the call is read."""
    return one(find_symbol_(name, package)).function(*arguments)


def getenv(name):
    """``uiop:getenv``: a variable of the environment, or nil."""
    value = os.environ.get(str(name))
    return None if value is None else FreshString(value)


def getenvp(name):
    return getenv(name) or None


def file_exists_p(path):
    """``uiop:file-exists-p``: the pathname of the file, or nil."""
    return lisp_path(path) if path is not None and os.path.isfile(path_of(path)) else None


def directory_exists_p(path):
    """``uiop:directory-exists-p``: the pathname of the folder, or nil."""
    return lisp_path(path) if path is not None and os.path.isdir(path_of(path)) else None


def probe_file(path, **options):
    """``uiop:probe-file*``: the pathname from the root on if there is such a file, else nil."""
    return absolute(physical(path)) if path is not None and os.path.exists(path_of(path)) else None


def getcwd():
    """``uiop:getcwd``: the folder that relative names mean."""
    return absolute(physical(Pathname()))


def split_string(string, *, max=None, separator=" \t"):
    """``uiop:split-string``: the parts between single separators; with ``max`` that many, the first of them with the rest."""
    characters = {getattr(item, "char", item) for item in separator}
    parts, current = [], []
    for char in reversed(str(string)):
        if char in characters and (max is None or len(parts) < max - 1):
            parts.append("".join(reversed(current)))
            current = []
        else:
            current.append(char)
    return list_from([FreshString(part) for part in ("".join(reversed(current)), *reversed(parts))])


def strcat(*strings):
    """``uiop:strcat``: the strings, one after the other; nil counts as empty."""
    return FreshString("".join("" if item is None else str(getattr(item, "char", item)) for item in strings))


def string_prefix_p(prefix, string):
    return True if string_designator(string).startswith(string_designator(prefix)) else None


def string_suffix_p(string, suffix):
    return True if string_designator(string).endswith(string_designator(suffix)) else None


def emptyp(thing):
    return True if thing is None or (not is_symbol(thing) and not isinstance(thing, Cons) and len(thing) == 0) else None


def ensure_list(thing):
    return thing if thing is None or isinstance(thing, Cons) else Cons(thing, None)


def _version(text):
    return [int(part) for part in text.split(".")] if isinstance(text, str) and text.replace(".", "").isdigit() else None


def version_le(version1, version2):
    """``uiop:version<=``: whether a version such as ``"1.10"`` is no later than another."""
    return True if None not in (_version(version1), _version(version2)) and _version(version1) <= _version(version2) else None


def version_lt(version1, version2):
    return True if None not in (_version(version1), _version(version2)) and _version(version1) < _version(version2) else None


def command_line_arguments():
    """``uiop:command-line-arguments``: the value of the variable of that name, what the command line says after the program."""
    return sym("UIOP::*COMMAND-LINE-ARGUMENTS*").value


def define_faces():
    """Make the package UIOP, of which the greater part comes late."""
    define_face(
        "UIOP",
        functions={
            "find-package*": find_package_,
            "find-symbol*": find_symbol_,
            "symbol-call": symbol_call,
            "getenv": getenv,
            "getenvp": getenvp,
            "file-exists-p": file_exists_p,
            "directory-exists-p": directory_exists_p,
            "probe-file*": probe_file,
            "getcwd": getcwd,
            "split-string": split_string,
            "strcat": strcat,
            "string-prefix-p": string_prefix_p,
            "string-suffix-p": string_suffix_p,
            "version<=": version_le,
            "version<": version_lt,
            "emptyp": emptyp,
            "ensure-list": ensure_list,
            "command-line-arguments": command_line_arguments,
        },
        variables={"*command-line-arguments*": list_from(sys.argv[1:])},
    )
