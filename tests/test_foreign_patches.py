"""Patches of foreign code: what we set in modules, classes and objects of other libraries, Python's own among them, is counted here.

Each ties us to how that library is written today. A patch of Hy that cannot be done otherwise stands in `languages/hy/patches.py`.
"""

from __future__ import annotations

import ast
import builtins
import functools
import importlib
import inspect
import io
import sys

import pytest

from source_trees import nodes_of, tree_of
from test_house import FILES, ROOT, SOURCE

OURS = ("cramhy_runtime", "cramhy")
PATHS = (*FILES, *sorted((ROOT / "hy_src").rglob("*.py")))
SETTINGS = (
    "tempfile.tempdir",
    "sys.?",
    *(f"sys.{name}" for name in ("argv", "path", "stdin", "stdout", "stderr", "ps1", "ps2", "executable")),
    *(f"sys.{name}" for name in ("excepthook", "unraisablehook", "displayhook", "dont_write_bytecode", "last_exc")),
)
"""What Python's manual says that programs may set."""
STREAMS = {name for name in dir(io.TextIOWrapper) if not name.startswith("_")} - {"name", "encoding", "errors", "closed", "mode", "buffer"}
FACTS_OF_CLASSES = ("__doc__", "__name__", "__qualname__", "__module__", "__notes__")
LIBRARIES = ("hy", "code", "codeop", "mcap", "asyncio", "importlib", "greenlet", "IPython", "ipykernel", "pygls")
"""The libraries with objects that live longer than one call of ours: an attribute that hides a method of theirs is a patch."""


@functools.cache
def foreign_names(tree):
    """For each local name of a file that stands for a module of others, or for something in one: its dotted name. Aliases count, too."""
    names = {}
    for node in nodes_of(tree):
        if isinstance(node, ast.Import):
            for alias in node.names:
                names[alias.asname or alias.name.split(".")[0]] = alias.name if alias.asname else alias.name.split(".")[0]
        elif isinstance(node, ast.ImportFrom) and not node.level:
            names |= {alias.asname or alias.name: f"{node.module}.{alias.name}" for alias in node.names}
    names = {name: dotted for name, dotted in names.items() if dotted.split(".")[0] not in (*OURS, "__future__")}
    for node in nodes_of(tree):  # _loader = importlib.machinery.SourceFileLoader
        if isinstance(node, ast.Assign) and len(node.targets) == 1 and isinstance(node.targets[0], ast.Name):
            dotted = dotted_name(node.value, names)
            if dotted is not None and isinstance(node.value, ast.Attribute):
                names.setdefault(node.targets[0].id, dotted)
    return names


def dotted_name(node, names):
    """The dotted name of a chain of attributes that begins with one of ``names``, or ``None``."""
    if isinstance(node, ast.Name):
        return names.get(node.id)
    if isinstance(node, ast.Attribute):
        before = dotted_name(node.value, names)
        return None if before is None else f"{before}.{node.attr}"
    return None


def constants(tree):
    """Local names that stand for one string, for ``setattr(writer, name, value)``."""
    return {
        node.targets[0].id: node.value.value
        for node in nodes_of(tree)
        if isinstance(node, ast.Assign)
        and len(node.targets) == 1
        and isinstance(node.targets[0], ast.Name)
        and isinstance(node.value, ast.Constant)
        and isinstance(node.value.value, str)
    }


def targets(tree):
    """The attributes that a file sets or deletes: (object, name of the attribute, value or ``None``)."""
    known = constants(tree)
    for node in nodes_of(tree):
        if isinstance(node, (ast.Assign, ast.Delete)):
            for target in node.targets:
                for part in target.elts if isinstance(target, (ast.Tuple, ast.List)) else [target]:
                    if isinstance(part, ast.Attribute):
                        yield part.value, part.attr, getattr(node, "value", None)
        elif isinstance(node, (ast.AnnAssign, ast.AugAssign)) and isinstance(node.target, ast.Attribute):
            yield node.target.value, node.target.attr, node.value
        elif isinstance(node, ast.Call) and getattr(node.func, "id", None) in ("setattr", "delattr") and len(node.args) > 1:
            name = node.args[1]
            text = name.value if isinstance(name, ast.Constant) else known.get(getattr(name, "id", ""), "?")
            yield node.args[0], str(text), node.args[2] if len(node.args) > 2 else None


@functools.cache
def our_classes():
    """Our classes by name → the dotted or bare names of their bases."""
    return {
        node.name: [dotted_name(base, foreign_names(tree_of(path))) or ast.unparse(base) for base in node.bases]
        for path in PATHS
        for node in nodes_of(tree_of(path))
        if isinstance(node, ast.ClassDef)
    }


def foreign_base(name):
    """The class of another library that our class ``name`` is made of; ``None`` if there is none but Python's built-in ones."""
    for base in our_classes().get(name, ()):
        if "." in base and base.split(".")[0] in LIBRARIES:
            return base
        if base != name and (found := foreign_base(base)):
            return found
    return None


@functools.cache
def methods_of_libraries():
    """The names of the methods of Hy's and other libraries' classes → one class that has it."""
    found = {}
    for module in ("hy.repl", "hy.reader.hy_reader", "hy.reader.reader", "hy.compiler", "hy.macros", "code", "codeop", "hy.models"):
        for cls in vars(importlib.import_module(module)).values():
            if inspect.isclass(cls) and not hasattr(builtins, cls.__name__):
                for name, value in vars(cls).items():
                    if inspect.isfunction(value) and not name.startswith("__") and name != "ast_callback":  # it is an argument of HyCompile
                        found.setdefault(name, cls.__name__)
    return found


def foreign_patches(path):
    """What a file sets in modules, classes and objects of other libraries, as sorted texts."""
    tree = tree_of(path)
    names, found = foreign_names(tree), set()
    hy_file = any(dotted.split(".")[0] in ("hy", "code") for dotted in names.values())
    classes = {node.name.lstrip("_") for node in nodes_of(tree) if isinstance(node, ast.ClassDef)}
    arguments = {
        node.arg for node in nodes_of(tree) if isinstance(node, ast.arg) and node.annotation and "hy." in ast.unparse(node.annotation)
    }
    modules = {
        node.arg
        for node in nodes_of(tree)
        if isinstance(node, ast.arg) and node.annotation and "ModuleType" in ast.unparse(node.annotation)
    }
    for holder, attribute, value in targets(tree):
        dotted = dotted_name(holder, names)
        if dotted is not None:
            if f"{dotted}.{attribute}" not in SETTINGS and attribute not in FACTS_OF_CLASSES:
                found.add(f"{dotted}.{attribute}")
        elif attribute == "__class__":
            cls = ast.unparse(value).rpartition(".")[2] if value is not None else ""
            base = names.get(cls) or foreign_base(cls)
            if base is None and cls in arguments:  # a class that the caller gives
                found.add(f"{ast.unparse(holder)}.__class__ = {cls}")
            if base is not None and base.split(".")[0] in LIBRARIES:
                found.add(f"{ast.unparse(holder)}.__class__ = {cls}, of {base}")
        elif attribute.startswith("_") and "__" in attribute[1:] and not attribute.startswith("__"):
            if attribute[1:].split("__")[0] not in classes:
                found.add(f"{ast.unparse(holder)}.{attribute}, a private")
        elif isinstance(holder, ast.Name) and holder.id in modules:
            found.add(f"{holder.id}.{attribute}, of a module")
        elif attribute in STREAMS and isinstance(holder, ast.Name) and holder.id != "self" and holder.id in ("file", "stream"):
            found.add(f"{holder.id}.{attribute}, a method of streams")
        elif hy_file and attribute in methods_of_libraries() and ast.unparse(holder) != "self":
            found.add(f"{ast.unparse(holder)}.{attribute}, a method of {methods_of_libraries()[attribute]}")
    for node in nodes_of(tree):  # models that are not what they look like
        if isinstance(node, ast.ClassDef) and any((dotted_name(base, names) or "").startswith("hy.models") for base in node.bases):
            for method in node.body:
                if isinstance(method, ast.FunctionDef) and method.name in ("__copy__", "__getattribute__", "__iter__", "__eq__"):
                    found.add(f"{node.name}.{method.name}, of a model of Hy")
    return sorted(found)


FOREIGN_PATCHES = {
    "src/cramhy_runtime/jupyter/notebook_kernel.py": ["getpass.getpass"],
    "src/cramhy_runtime/kernel/backends/jspi.py": ["asyncio.ensure_future"],
    "src/cramhy_runtime/kernel/patient_calls.py": ["builtins.input", "time.sleep"],
    "src/cramhy_runtime/languages/hy/patches.py": ["hy.macros.inspect", "hy.models.Keyword.__hash__", "repl.__class__ = cls"],
    "src/cramhy_runtime/repl/progress.py": ["sys.stdout.write"],
}
"""File by file, what is set today."""


def test_the_patches_of_other_libraries_are_counted():
    found = {path.relative_to(ROOT).as_posix(): foreign_patches(path) for path in PATHS}
    assert {path: patched for path, patched in found.items() if patched} == FOREIGN_PATCHES


KINDS = {
    "an attribute of a module": ("import hy, sys\nsetattr(hy.macros, 'require', 3)\nsys.argv = []\n", ["hy.macros.require"]),
    "of a class": ("from hy import models\nmodels.A.b, x = 1, 2\ndel models.C.d\n", ["hy.models.A.b", "hy.models.C.d"]),
    "of Python's own library": ("import asyncio\nasyncio.ensure_future = None\n", ["asyncio.ensure_future"]),
    "of a function that Python's module names": ("import sys\nfile = sys.stdout\nfile.write = print\n", ["sys.stdout.write"]),
    "by another name": (
        "import importlib.machinery\n_loader = importlib.machinery.SourceFileLoader\n_loader.get_code = None\n",
        ["importlib.machinery.SourceFileLoader.get_code"],
    ),
    "of a module that is an argument": (
        "from types import ModuleType\ndef mend(module: ModuleType):\n    setattr(module, 'hashlib', 1)\n",
        ["module.hashlib, of a module"],
    ),
    "the class of an object": (
        "from hy.reader import HyReader\nx.__class__ = HyReader\n",
        ["x.__class__ = HyReader, of hy.reader.HyReader"],
    ),
    "a method of an object": (
        "import hy\ndef attend(repl):\n    repl.runsource = None\n    repl.ps1 = ''\n",
        ["repl.runsource, a method of REPL"],
    ),
    "a private attribute, by a name that a variable has": (
        "name = '_Writer__x'\nsetattr(writer, name, 1)\n",
        ["writer._Writer__x, a private"],
    ),
    "a model that is not what it looks like": (
        "from hy.models import Object\nclass Refused(Object):\n    def __copy__(self):\n        raise self.problem\n",
        ["Refused.__copy__, of a model of Hy"],
    ),
    "what is ours": ("class _Own:\n    pass\nx = _Own()\nx.__class__ = _Own\nx.value = x._Own__y = 1\n", []),
}


@pytest.mark.parametrize("kind", KINDS)
def test_a_patch_is_found(kind, monkeypatch):
    text, found = KINDS[kind]
    monkeypatch.setattr(sys.modules[__name__], "tree_of", lambda path: ast.parse(text))
    our_classes.cache_clear()
    try:
        assert foreign_patches(SOURCE / "never_written.py") == found
    finally:
        our_classes.cache_clear()
