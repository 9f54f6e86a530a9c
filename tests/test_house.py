"""The house keeps its order: floors, size of files, who may use threads and the wall clock (design.md section 3)."""

from __future__ import annotations

import ast
import os
import re
import subprocess
import sys
from graphlib import TopologicalSorter
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
SOURCE = ROOT / "src" / "cramhy_runtime"
FLOORS = [["extras"], ["kernel", "storage"], ["lisp"], ["utilities"], ["transforms", "cpl", "prolog", "ros"],
          ["designators", "turtlesim", "episodes", "actionlib", "rosbridge"],
          ["occasions", "tf"], ["process_modules"], ["projection"], ["chronicle", "ros_tools"], ["view", "repl", "testing"],
          ["cli", "image", "pytest_plugin", "__init__"]]
FLOOR = {room: number for number, rooms in enumerate(FLOORS) for room in rooms}
ALLOWED_UPWARDS = {("repl", "image"), ("testing", "image"), ("pytest_plugin", "image"), ("cli", "image")}
"""``image`` puts all rooms together, so that a session can begin with it; nothing below the surfaces may import it."""

FILES = sorted(SOURCE.rglob("*.py"))
TEXTS = sorted({*FILES, *(path for folder in ("hy_src", "tests", "tutorials", "benchmarks") for ending in ("*.py", "*.hy", "*.lisp")
                          for path in (ROOT / folder).rglob(ending))})


def room_of(path):
    return path.relative_to(SOURCE).parts[0].removesuffix(".py")


def imported_names(path):
    """The dotted names of modules, or of things in them, that a file imports, wherever in it the import stands."""
    package = ["cramhy_runtime", *path.relative_to(SOURCE).with_suffix("").parts[:-1]]
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            base = package[:len(package) - node.level + 1] if node.level else []
            module = [*base, *(node.module or "").split(".")] if node.module else base
            names = [".".join(module)] + [".".join([*module, alias.name]) for alias in node.names]
        else:
            continue
        yield from names


def imported_rooms(path):
    """The rooms of cramhy_runtime that a file imports."""
    for name in imported_names(path):
        parts = name.split(".")
        if parts[0] == "cramhy_runtime" and len(parts) > 1 and parts[1] in FLOOR:
            yield parts[1]


@pytest.mark.parametrize("path", FILES, ids=lambda path: str(path.relative_to(SOURCE)))
def test_a_room_imports_only_from_floors_below_its_own(path):
    room = room_of(path)
    for other in set(imported_rooms(path)) - {room}:
        assert FLOOR[other] < FLOOR[room] or (room, other) in ALLOWED_UPWARDS, f"{room} imports {other}"


@pytest.mark.parametrize("room", FLOOR)
def test_the_modules_of_a_room_import_each_other_without_circles(room):
    """Not even within functions: what a lower module needs of a higher one goes through one seam, as ``lisp/late.py``."""
    modules = {".".join(["cramhy_runtime", *path.relative_to(SOURCE).with_suffix("").parts]).removesuffix(".__init__"): path
               for path in FILES if room_of(path) == room}
    TopologicalSorter({name: {other for other in imported_names(path) if other in modules and other != f"cramhy_runtime.{room}"} - {name}
                       for name, path in modules.items()}).prepare()


@pytest.mark.parametrize("path", [path for path in FILES if room_of(path) != "kernel"], ids=lambda path: str(path.relative_to(SOURCE)))
def test_threads_and_the_wall_clock_are_the_kernels(path):
    text = path.read_text()
    assert not re.search(r"^\s*(import|from) (_?threading|_thread|concurrent)\b", text, re.M)
    assert not re.search(r"\btime\.(sleep|time)\(|from time import", text)


@pytest.mark.parametrize("path", TEXTS, ids=lambda path: str(path.relative_to(ROOT)))
def test_no_file_is_longer_than_600_lines(path):
    assert len(path.read_text().splitlines()) <= 600


@pytest.mark.parametrize("path", FILES, ids=lambda path: str(path.relative_to(SOURCE)))
def test_every_module_opens_with_a_paragraph(path):
    assert ast.get_docstring(ast.parse(path.read_text()))


@pytest.mark.skipif(not hasattr(os, "fork"), reason="each module gets a fresh interpreter by a fork")
@pytest.mark.parametrize("room", [path.parent for path in FILES
                                  if path.name == "__init__.py" and "Where the parts are" in path.read_text()],
                         ids=lambda room: str(room.relative_to(SOURCE)))
def test_a_room_that_says_where_its_parts_are_names_them_all(room):
    told = ast.get_docstring(ast.parse((room / "__init__.py").read_text())).partition("Where the parts are")[2]
    parts = {path.stem for path in room.glob("*.py")} | {path.parent.name for path in room.glob("*/__init__.py")}
    assert parts - set(re.findall(r"`(\w+)`", told)) == {"__init__"}


def test_any_module_can_be_imported_first():
    """No module relies on another one having been imported before it."""
    names = [".".join(["cramhy_runtime", *path.relative_to(SOURCE).with_suffix("").parts]).removesuffix(".__init__") for path in FILES]
    done = subprocess.run([sys.executable, "-c", IMPORT_EACH, *names], capture_output=True, text=True)
    assert not done.stdout, done.stdout
    assert done.returncode == 0, done.stderr


IMPORT_EACH = """
import importlib, os, sys, traceback
import hy, PIL.Image  # what every child would import again
for count, name in enumerate(sys.argv[1:]):
    if count >= (os.cpu_count() or 1):
        os.wait()
    child = os.fork()
    if not child:
        try:
            importlib.import_module(name)
        except BaseException:
            print(name, traceback.format_exc(limit=-3), sep="\\n", flush=True)
        os._exit(0)
while True:
    try:
        os.wait()
    except ChildProcessError:
        break
"""


def test_nothing_names_a_path_of_a_machine():
    for path in TEXTS:
        assert not re.search(r"(?<![\w.])/(home|work|Users|root)/\w", path.read_text()), path


def test_test_modules_outside_of_packages_have_names_of_their_own():
    # pytest imports them by their bare names, so that two alike are an error, which only a run of the whole suite shows.
    paths = [path for path in (ROOT / "tests").rglob("*.py") if not (path.parent / "__init__.py").exists() and path.name != "conftest.py"]
    names = [path.stem for path in paths]
    assert not {name for name in names if names.count(name) > 1}
