"""Lisp packages as Python modules.

``import cram_my_beginner_tutorial`` loads the system of that name (underscores for dashes) and gives its Lisp package as a
module: ``cram_my_beginner_tutorial.drive`` is ``tut::drive``. A name that is a function gives the function, a special variable
its current value. The definitions live in the symbols, so a redefinition at the REPL is seen by Python at once.
"""

from __future__ import annotations

import importlib.machinery
import importlib.util
import os
import sys
import types
from pathlib import Path

from cramhy_runtime.lisp_core.data import Symbol
from cramhy_runtime.lisp_core.python_names import attribute_symbols
from cramhy_runtime.lisp_core.python_names import python_name
from cramhy_runtime.lisp_core.packages import all_packages, find_package
from cramhy_runtime.kernel.images import part
from ..python import python_face
from . import loader, systems


_names: set[str] = set()
"""Under which names packages were imported in any image. To look through all modules of Python takes milliseconds."""


class PackageModule(types.ModuleType):
    """The Python face of a Lisp package."""

    def __init__(self, name):
        _names.add(name)
        super().__init__(name)

    def __getattr__(self, name):
        package = self.__dict__.get("lisp_package")
        if package is None or name.startswith("__"):
            raise AttributeError(name)
        return python_face.find(package, name)

    def __setattr__(self, name, value):
        package = self.__dict__.get("lisp_package")
        for symbol in attribute_symbols(package, name) if package is not None else ():
            if isinstance(symbol, Symbol) and symbol.special:
                symbol.value = value
                return
        super().__setattr__(name, value)

    def __dir__(self):
        return python_face.names(self.lisp_package)


@part
class _PackageModules:
    """The packages that Python has imported: in another image the same name is another package."""

    @staticmethod
    def take():
        modules = {name: sys.modules.get(name) for name in list(_names)}
        return {name: module for name, module in modules.items() if module.__class__ is PackageModule}

    @staticmethod
    def put(state):
        for name in _PackageModules.take():
            del sys.modules[name]
        sys.modules.update(state)

    copy = staticmethod(dict)


def show_package(module, package):
    """Let a module of Python, which is being imported, show a Lisp package from now on."""
    _names.add(module.__name__)
    module.__dict__["lisp_package"] = package
    module.__class__ = PackageModule


def package_for(name):
    """The Lisp package whose Python name is ``name``, or ``None``."""
    direct = find_package(name.replace("_", "-").upper())
    if direct is not None:
        return direct
    for package in all_packages():
        if any(python_name(each) == name for each in package.names):
            return package
    return None


class PackageLoader:
    """Loads a system as the module of its package."""

    def __init__(self, system):
        self.system = system

    def create_module(self, spec):
        return PackageModule(spec.name)

    def exec_module(self, module):
        systems.load_system(self.system)
        package = package_for(module.__name__)
        if package is None:
            raise ImportError(f"the system {self.system} defines no Lisp package called {module.__name__}", name=module.__name__)
        module.__dict__["lisp_package"] = package
        module.__doc__ = package.documentation


class FileLoader:
    """Loads one ``.lisp`` file as a module: the face of the package that is current at its end."""

    def __init__(self, path):
        self.path = path

    def create_module(self, spec):
        return PackageModule(spec.name)

    def get_source(self, name):
        return Path(self.path).read_text(encoding="utf-8")

    def exec_module(self, module):
        packages = []
        loader.load_file(self.path, finished=packages.append)
        module.__dict__["lisp_package"] = packages[0]
        module.__doc__ = packages[0].documentation


class SystemFinder:
    """Finds a ``.lisp`` file beside Python's, or a system, for a module name that nothing else provides.

    It stands last in ``sys.meta_path``. Underscores in the name may be dashes in the file's.
    """

    def find_spec(self, name, path=None, target=None):
        short = name.rpartition(".")[2]
        if short.startswith("_"):
            return None
        for folder in sys.path if path is None else path:
            for spelling in (short, short.replace("_", "-")):
                file = Path(folder or ".", f"{spelling}.lisp")
                if os.path.isfile(file):
                    return importlib.util.spec_from_file_location(name, file, loader=FileLoader(str(file)))
        system = name.replace("_", "-")
        if path is not None or "." in name or systems.find_asd(system) is None:
            return None
        return importlib.machinery.ModuleSpec(name, PackageLoader(system), origin=f"the system {system}")


class FolderFinder:
    """Finds a system whose folder, with a ``.asd`` file of that name in it, stands in a folder of ``sys.path``.

    Without it, Python would take the folder for a package without ``__init__``, and the module would be empty: so in ``ros/src`` of a
    workspace. It stands first in ``sys.meta_path``. A module or a package that Python finds itself goes before the system.
    """

    def find_spec(self, name, path=None, target=None):
        if path is not None or "." in name:
            return None
        system = name.replace("_", "-")
        if not any(os.path.isfile(os.path.join(folder, name, f"{system}.asd")) for folder in sys.path):
            return None
        spec = importlib.machinery.PathFinder.find_spec(name)
        if (spec is not None and spec.origin is not None) or systems.find_asd(system) is None:
            return None
        return importlib.machinery.ModuleSpec(name, PackageLoader(system), origin=f"the system {system}")


def install():
    """Let Python import Lisp systems from now on."""
    if not any(isinstance(finder, SystemFinder) for finder in sys.meta_path):
        sys.meta_path.append(SystemFinder())
        sys.meta_path.insert(0, FolderFinder())
