"""Calls about packages and symbols: which there are, the current one, export, undefine, trace."""

from __future__ import annotations

import os

from cramhy_runtime.lisp_core.data import Symbol, lisp_list, list_from
from cramhy_runtime.lisp_core.packages import all_packages, sym
from cramhy_runtime.languages.commonlisp.evaluation.symbols import fmakunbound
from cramhy_runtime.languages.commonlisp.pathnames.namestrings import parse_native
from cramhy_runtime.languages.commonlisp.pathnames.pathnames import DEFAULTS
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string
from cramhy_runtime.languages.commonlisp.tools import tracing
from cramhy_runtime.session.arglists import symbol_named

from ..packages import package_called, prompt_of
from ..rpcs import Refused, rpc, text


def package_named(name):
    """The package that ``name``, as Emacs sends it, means. `Refused` if there is none."""
    found = package_called(text(name, "The name of a package"))
    if found is None:
        raise Refused(f"There is no package {name}.")
    return found


def symbol_of(call, name):
    """The symbol that ``name`` means in the buffer's package. `Refused` if there is none."""
    found = symbol_named(text(name, "The name of a symbol").lstrip("'#"), call.package)
    if found is None:
        raise Refused(f"There is no symbol {name} in the package {call.package.name}.")
    return found


def function_name(call, spec):
    """The name of a function that ``spec`` says as SLIME writes it: ``"drive"``, ``"(setf speed)"``, ``"(:defmethod drive (fast))"``."""
    written = text(spec, "What is to be traced").strip()
    if not written.startswith("("):
        return symbol_of(call, written)
    words = written.strip("()").split()
    kind = words[0].lower() if len(words) > 1 else ""
    if kind == "setf":
        return lisp_list(sym("SETF"), symbol_of(call, words[1].strip("()")))
    if kind in (":defun", ":defgeneric", ":defmethod", ":defmacro"):
        return symbol_of(call, words[1].strip("()"))
    raise Refused(f"cramhy traces functions by their names, and cannot trace {written}.")


@rpc("list-all-package-names")
def list_all_package_names(call, nicknames=None):
    names = [name for package in all_packages() for name in (package.names if nicknames else [package.name])]
    return sorted(set(names))


@rpc("set-package")
def set_package(call, name):
    package = call.connection.package = package_named(name)
    return [package.name, prompt_of(package)]


@rpc("set-default-directory")
def set_default_directory(call, folder):
    path = os.path.abspath(os.path.expanduser(text(folder)))
    if not os.path.isdir(path):
        raise Refused(f"There is no folder {path}.")
    os.chdir(path)
    DEFAULTS.value = parse_native(path + "/")
    return path + "/"


@rpc("default-directory")
def default_directory(call):
    return os.getcwd() + "/"


@rpc("undefine-function")
def undefine_function(call, name):
    symbol = symbol_of(call, name)
    fmakunbound(symbol)
    return prin1_to_string(symbol)


@rpc("unintern-symbol")
def unintern_symbol(call, name, package):
    symbol = symbol_named(text(name), package_named(package))
    if symbol is None:
        return f"There is no symbol {name}."
    package_named(package).unintern(symbol)
    return f"{name} is no longer in {package_named(package).name}."


@rpc("swank-toggle-trace")
def toggle_trace(call, spec):
    name = function_name(call, spec)
    entry = tracing.entry_of(name)
    traced = entry is not None and entry.prints
    (tracing.untrace if traced else tracing.trace)(list_from([name]))
    return f"{prin1_to_string(name)} is {'no longer' if traced else 'now'} traced."


@rpc("untrace-all")
def untrace_all(call):
    tracing.untrace(None)


@rpc("export-symbol-for-emacs")
def export_symbol(call, name, package):
    home = package_named(package)
    home.export(home.intern(text(name).rpartition(":")[2].upper()))
    return True


@rpc("unexport-symbol-for-emacs")
def unexport_symbol(call, name, package):
    home = package_named(package)
    symbol = symbol_named(text(name).rpartition(":")[2], home)
    if symbol is not None:
        home.unexport(symbol)
    return True


@rpc("re-evaluate-defvar", evaluates=True)
def re_evaluate_defvar(call, form):
    from .evaluating import evaluated, echo

    name = text(form).split()[1] if len(text(form).split()) > 1 else ""
    symbol = symbol_named(name, call.package)
    if isinstance(symbol, Symbol):
        from cramhy_runtime.languages.commonlisp.evaluation.symbols import makunbound

        makunbound(symbol)
    return echo(evaluated(call, text(form)))
