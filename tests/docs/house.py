"""``make house``: write the table of ``docs/explanation/house.md``, the size of the house, and lower the budgets that it has outgrown.

Every figure comes from the files and from a session that is asked, so anybody gets the same. ``--print`` only shows the table. A budget
(`BUDGETS`) is the figure that a test allows; it is written by this script and only falls, unless somebody raises it by hand and says
in the commit what was worth it.
"""

from __future__ import annotations

import argparse
import ast
import functools
import json
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "explanation" / "house.md"
BUDGETS = Path(__file__).with_name("house.json")
SOURCES = ("src", "hy_src")
OURS = "cramhy_runtime"


def python_files():
    return sorted(path for folder in SOURCES for path in (ROOT / folder).rglob("*.py"))


@functools.cache
def tree_of(path):
    return ast.parse(path.read_text(encoding="utf-8"))


# ------------------------------------------------------------------------------------------------------------------ classes


def module_of(path):
    parts = path.relative_to(ROOT / "src").with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


@functools.cache
def classes():
    """(Module, name) → (the file, the names of its methods, its bases as such pairs) of each class at the top of a module."""
    found, imported = {}, {}
    for path in (ROOT / "src").rglob("*.py"):
        module, package = module_of(path), module_of(path.with_name("__init__.py"))
        names = {}
        for node in ast.walk(tree_of(path)):
            if isinstance(node, ast.ImportFrom):
                base = package.split(".")[: len(package.split(".")) - node.level + 1] if node.level else []
                origin = ".".join([*base, *([node.module] if node.module else [])])
                names |= {alias.asname or alias.name: (origin, alias.name) for alias in node.names}
        for node in tree_of(path).body:
            if isinstance(node, ast.ClassDef):
                names[node.name] = module, node.name
        for node in tree_of(path).body:
            if isinstance(node, ast.ClassDef):
                methods = {each.name for each in node.body if isinstance(each, (ast.FunctionDef, ast.AsyncFunctionDef))}
                bases = [names.get(ast.unparse(base).split("[")[0]) for base in node.bases]
                found[module, node.name] = path, methods, [base for base in bases if base is not None]
        imported |= {(module, name): origin for name, origin in names.items()}

    def home(key):
        """Where a class really stands that a package has from one of its modules."""
        while key not in found and imported.get(key, key) != key:
            key = imported[key]
        return key

    return {key: (path, methods, [*map(home, bases)]) for key, (path, methods, bases) in found.items()}


@functools.cache
def whole_class(key):
    """(The methods of a class and of its bases of ours, the files that they stand in.)"""
    path, methods, bases = classes()[key]
    methods, files = set(methods), {path}
    for base in bases:
        if base in classes():
            more, others = whole_class(base)
            methods |= more
            files |= others
    return methods, files


def largest_class():
    """(Its name, the number of its methods, of its files), with all that it inherits of ours."""
    sizes = {key: whole_class(key) for key in classes()}
    key = max(sizes, key=lambda each: (len(sizes[each][0]), each))
    return key[1], len(sizes[key][0]), len(sizes[key][1])


def large_classes(most=40):
    """The number of classes with more than ``most`` methods, inherited ones of ours included."""
    return sum(len(whole_class(key)[0]) > most for key in classes())


# ---------------------------------------------------------------------------------------------------------------- operators


def names_of_code(path):
    """The words of a file of Python that are code: names, and constant texts word by word; docstrings and comments are none."""
    tree, found = tree_of(path), set()
    documentation = {
        id(node.body[0].value)
        for node in ast.walk(tree)
        if isinstance(node, (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef))
        and node.body
        and isinstance(node.body[0], ast.Expr)
    }
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in documentation and len(node.value) < 2000:
            found.update(re.findall(r"[\w%*<>=+-]+", node.value.lower()))
        elif isinstance(node, (ast.Name, ast.Attribute)):
            found.add((node.id if isinstance(node, ast.Name) else node.attr).lower())
        elif isinstance(node, (ast.FunctionDef, ast.ClassDef)):
            found.add(node.name.lower())
        elif isinstance(node, ast.alias):
            found.update({node.name.split(".")[-1].lower(), (node.asname or "").lower()})
    return found


@functools.cache
def places_of_operators():
    """Operator → the number of files of ours whose code names it."""
    from cramhy_runtime.languages.operators import OPERATORS

    names = sorted({name.lower() for _, name in OPERATORS})
    words = {path: names_of_code(path) for path in python_files()}
    for path in (ROOT / "hy_src").rglob("*.hy"):
        text = re.sub(r'"(?:[^"\\]|\\.)*"|;.*', " ", path.read_text(encoding="utf-8"))
        words[path] = set(re.findall(r"[^\s()\[\]{}'`~@\"]+", text.lower()))
    return {
        name: sum(bool({name, "%" + name, name.replace("-", "_")} & found) for found in words.values())
        for name in names
        if "-" in name  # one-word names are words of other things, too
    }


# ------------------------------------------------------------------------------------------------------------------- running

ASKED = """
import io, json, os, sys
import cramhy_runtime
from cramhy_runtime.cli import roslisp_repl
from cramhy_runtime.kernel import images

root = os.path.dirname(cramhy_runtime.__file__) + os.sep
calls, files, told = 0, set(), {}
lines = iter([
    '(ros-load:load-system "cram_my_beginner_tutorial" "cram-my-beginner-tutorial")', "(in-package :tut)", '(start-ros-node "turtle1")',
    '(init-ros-turtle "turtle1")', "(drive 5 2)", "(drive 5 2)",
])

def seen(frame, event, argument):
    global calls
    name = frame.f_code.co_filename
    if event == "call" and name.startswith(root):
        calls += 1
        files.add(name[len(root):])

class Typed(io.TextIOBase):
    def readline(self, size=-1):
        global calls
        sys.setprofile(None)
        told.update(calls=calls, files=len(files), rooms=len({each.split(os.sep)[0] for each in files}), cells=len(images._parts))
        told.setdefault("modules", sum(each.startswith("cramhy") for each in sys.modules))
        calls = 0
        files.clear()
        line = next(lines, None)
        if line is None:
            print(json.dumps(told), file=sys.stderr)
            return ""
        sys.setprofile(seen)
        return line + chr(10)

sys.stdin, sys.argv = Typed(), ["roslisp_repl", "--time", "virtual", "--backend", "greenlet"]
roslisp_repl()
"""


@functools.cache
def asked():
    """What was counted at a prompt where a turtle is driven twice: calls, files and rooms of the second time, globals that images swap, and
    the modules that were loaded at the first line."""
    done = subprocess.run([sys.executable, "-c", ASKED], capture_output=True, text=True, timeout=300)
    lines = [line for line in done.stderr.splitlines() if line.startswith("{")]
    if done.returncode or not lines:
        raise SystemExit(done.stderr)
    return json.loads(lines[-1])


def patches():
    sys.path.insert(0, str(ROOT / "tests"))
    from test_foreign_patches import PATHS, foreign_patches

    return sum(len(foreign_patches(path)) for path in PATHS)


ROWS = {
    "lines": (
        "lines of Python in `src` and `hy_src`",
        125_000,
        lambda: sum(len(path.read_bytes().splitlines()) for path in python_files()),
    ),
    "files": ("files of Python there", 800, lambda: len(python_files())),
    "methods": ("methods of the largest class, with those that it inherits from classes of ours", 40, lambda: largest_class()[1]),
    "class files": ("files that this class stands in", 1, lambda: largest_class()[2]),
    "large classes": ("classes with more than 40 methods, inherited ones included", 0, large_classes),
    "operator": (
        "files whose code names an operator, the median of all",
        3,
        lambda: sorted(places_of_operators().values())[len(places_of_operators()) // 2],
    ),
    "patches": ("patches of foreign code", 4, patches),
    "cells": ("globals that are swapped when a thread changes images", None, lambda: asked()["cells"]),
    "calls": ("calls of Python functions of ours for `(drive 5 2)` at the prompt, once it was typed before", 450, lambda: asked()["calls"]),
    "drive files": ("files in which they are", 60, lambda: asked()["files"]),
    "drive rooms": ("rooms in which they are", None, lambda: asked()["rooms"]),
    "modules": ("modules of ours that a prompt without a terminal has loaded before its first line", None, lambda: asked()["modules"]),
}
"""Key → (what is counted, the goal of the issue, the function that counts)."""


def measured():
    return {key: count() for key, (_, _, count) in ROWS.items()}


def table(figures, known):
    lines = ["| what | before | now | budget | goal |", "|---|---:|---:|---:|---:|"]
    for key, (what, goal, _) in ROWS.items():
        row = [what, known["before"].get(key), figures[key], known["budget"].get(key, figures[key]), goal]
        lines.append("| " + " | ".join(each if isinstance(each, str) else "" if each is None else f"{each:,}" for each in row) + " |")
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--print", action="store_true", dest="only_shown")
    options = parser.parse_args()
    known = json.loads(BUDGETS.read_text()) if BUDGETS.exists() else {"before": {}, "budget": {}}
    figures = measured()
    if not options.only_shown:
        if not known["before"]:
            known["before"] = figures
        known["budget"] = {key: min(figure, known["budget"].get(key, figure)) for key, figure in figures.items()}
        BUDGETS.write_text(json.dumps(known, indent=2) + "\n")
        if PAGE.exists():
            text = PAGE.read_text(encoding="utf-8")
            PAGE.write_text(
                re.sub(r"\| what \|.*?\n\n", lambda _: table(figures, known) + "\n\n", text, count=1, flags=re.S), encoding="utf-8"
            )
    print(table(figures, known))


if __name__ == "__main__":
    main()
