"""Python modules as Lisp packages: after ``(py:import math)`` one writes ``(math:sqrt 2)`` and ``math:pi``.

The package of a module has no symbols at first. A name that is read is looked for in the module (`python_names` tells how it is
spelled there) and gets a symbol then, whose function calls the module's function and whose value, as a symbol macro, is the
module's attribute at the moment; ``setf`` sets it. A symbol of an exception class names the class of conditions, that of another
class the class, for ``typep`` and ``defmethod``. The package PYTHON itself is that of Python's built-in functions, with what
`python_calls` adds.
"""

from __future__ import annotations

import builtins
import importlib

from cramhy_runtime.lisp_core.conditions import error
from cramhy_runtime.lisp_core.data import Symbol, lisp_list
from ..evaluation.definitions import data
from ..packages.face_definition import define_face
from ..objects.classes import alias_class
from cramhy_runtime.lisp_core.packages import Package, find_package, is_symbol, ours, register, string_designator, sym, symbol_name
from ..packages.package_functions import add_nicknames
from . import python_calls
from .python_calls import apply_python, guarded
from cramhy_runtime.lisp_core.python_exceptions import PYTHON, condition_class
from cramhy_runtime.lisp_core.python_names import lisp_spelling, python_spelling

ATTRIBUTE = sym("CRAMHY::MODULE-ATTRIBUTE")


class PythonPackage(Package):
    """The package of the Python module ``module``."""

    def __init__(self, name, module):
        super().__init__(name, documentation=module.__doc__)
        self.module = module
        self.completed = False
        self.locked = True

    def lookup(self, name):
        found = super().lookup(name)
        if found[1] is None:
            attribute = python_spelling(name, lambda attribute: hasattr(self.module, attribute), lambda: dir(self.module))
            if attribute is not None:
                return self.define(name, attribute), "external"
            self.complete()  # for advice about names that are near
        return found

    def define(self, name, attribute):
        """The symbol ``name`` for an attribute of the module."""
        symbol = self.external[name] = Symbol(name, self)
        value = getattr(self.module, attribute)
        data(symbol)["symbol-macro"] = lisp_list(ATTRIBUTE, self.module.__name__, attribute)
        if callable(value):
            symbol.function = _function(symbol, self.module, attribute)
        if isinstance(value, type):
            alias_class(symbol, condition_class(value) if issubclass(value, Exception) else value)
        return symbol

    def complete(self):
        """Make symbols for all public names of the module: what ``use-package`` and ``apropos`` see."""
        if self.completed:
            return
        self.completed = True
        names = getattr(self.module, "__all__", None) or [name for name in vars(self.module) if not name.startswith("_")]
        for attribute in names:
            name = lisp_spelling(attribute)
            if attribute.isupper() and attribute.lower() in names:
                name = f"+{name}+"
            if name not in self.external and hasattr(self.module, attribute):
                self.define(name, attribute)


def _function(symbol, module, attribute):
    """The function of ``symbol``: it calls what the attribute is when it is called."""
    value = getattr(module, attribute)

    def call(*arguments, **keywords):
        return apply_python(getattr(module, attribute), arguments, keywords)

    call.__lisp_name__, call.__name__, call.__doc__, call.python = symbol, attribute, getattr(value, "__doc__", None), value
    return call


def module_attribute(module, attribute):
    """What a symbol of a module's package expands to."""
    return guarded(getattr, importlib.import_module(module), attribute)


def set_module_attribute(value, module, attribute):
    """What ``setf`` of a symbol of a module's package expands to."""
    guarded(setattr, importlib.import_module(module), attribute, python_calls.plain(value))
    return value


def import_module(name, nickname=None):
    """``py:import-module``: the Lisp package of a Python module, which is imported.

    name: a string, ``"numpy.random"``, or a symbol, whose dashes are underscores. nickname: a further name for the package, and
    its only one when the module's own name is taken by a package of Lisp.
    """
    module_name = symbol_name(name).lower().replace("-", "_") if is_symbol(name) else str(name)
    module = guarded(importlib.import_module, module_name)
    own = module_name.upper().replace("_", "-")
    wanted = string_designator(nickname) if nickname is not None else None
    for candidate in filter(None, (own, wanted)):
        package = find_package(candidate)
        if package is None:
            package = register(PythonPackage(candidate, module))
        if getattr(package, "module", None) is module:
            break
    else:
        return error(
            "The Python module ~A cannot have the package ~A: that name belongs to another package. Give it a name of its own, "
            "as in (py:import ~A :as py-~A).",
            module_name,
            wanted or own,
            module_name.replace("_", "-"),
            module_name.rpartition(".")[2].replace("_", "-"),
        )
    if wanted is not None and wanted not in package.names:
        add_nicknames(package, [wanted])
    return package


def define_faces():
    """Make the package PYTHON; called once, by `package.fill`."""
    package = ours(PYTHON, lambda: PythonPackage(PYTHON, builtins))
    add_nicknames(package, ["PY"])
    package.complete()
    more = "import -> for with"
    for name in f"{python_calls.NAMES} import-module {more}".upper().split():
        if not package.present(name):
            package.internal[name] = Symbol(name, package)  # Python has none of that name, so it is not asked for each spelling
    define_face(PYTHON, functions={python_calls: python_calls.NAMES, "import-module": import_module}, export=more)
    define_face(
        "CRAMHY",
        functions={"module-attribute": module_attribute, "iterate": python_calls.iterate, "with-context": python_calls.with_context},
    )
    for name, setter in (
        (f"{PYTHON}::GETATTR", python_calls.set_getattr),
        (f"{PYTHON}::ITEM", python_calls.set_item),
        ("CRAMHY::MODULE-ATTRIBUTE", set_module_attribute),
    ):
        sym(name).setf_function = setter
