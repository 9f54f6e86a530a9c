"""The house keeps its order: floors, size of files, who may use threads and the wall clock."""

from __future__ import annotations

import ast
import collections
import functools
import importlib
import importlib.util
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from source_trees import nodes_of, tree_of
from systems import SOAK

from cramhy_runtime.lisp_core import ports

ROOT = Path(__file__).parents[1]
SOURCE = ROOT / "src" / "cramhy_runtime"
FLOORS = [
    ["extras"],
    ["kernel", "storage"],
    ["lisp_core"],
    ["utilities", "transforms"],
    ["cpl", "prolog", "ros"],
    ["designators", "turtlesim", "episodes", "actionlib", "rosbridge", "robot_world"],
    ["occasions", "tf"],
    ["process_modules"],
    ["projection"],
    ["languages"],
    ["session"],
    ["chronicle", "ros_tools", "testing", "robot"],
    ["view", "repl", "swank", "jupyter", "lsp", "grading"],
    ["course"],
    ["browser"],
    ["cli", "pytest_plugin", "coverage_plugin", "__init__"],
]
FLOOR = {room: number for number, rooms in enumerate(FLOORS) for room in rooms}

FILES = sorted(SOURCE.rglob("*.py"))
TEXTS = sorted(
    {
        *FILES,
        *(
            path
            for folder in ("hy_src", "tests", "tutorials", "benchmarks")
            for ending in ("*.py", "*.hy", "*.lisp")
            for path in (ROOT / folder).rglob(ending)
        ),
    }
)


@functools.cache
def imports_of(path):
    """The import statements of a file, wherever they stand, and those of them that only type checkers read."""
    unread = {
        inner
        for node in nodes_of(tree_of(path))
        if isinstance(node, ast.If) and isinstance(node.test, ast.Name) and node.test.id == "TYPE_CHECKING"
        for statement in node.body
        for inner in ast.walk(statement)
    }
    found = [node for node in nodes_of(tree_of(path)) if isinstance(node, (ast.Import, ast.ImportFrom))]
    return found, unread


def offences(check, paths=FILES):
    """What ``check`` finds wrong, by the file's path: all at once, since a test for each file and each rule would be thousands."""
    return {str(path.relative_to(ROOT)): wrong for path in paths if (wrong := check(path))}


def room_of(path):
    return path.relative_to(SOURCE).parts[0].removesuffix(".py")


def imported_names(path, when_run=False):
    """The dotted names of modules, or of things in them, that a file imports, wherever in it the import stands; WHEN_RUN: without those
    that only type checkers read, below ``if TYPE_CHECKING:``."""
    package = ["cramhy_runtime", *path.relative_to(SOURCE).with_suffix("").parts[:-1]]
    found, unread = imports_of(path)
    for node in found:
        if when_run and node in unread:
            continue
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        else:
            base = package[: len(package) - node.level + 1] if node.level else []
            module = [*base, *(node.module or "").split(".")] if node.module else base
            names = []
            for alias in node.names:  # a module of the package, or something in its ``__init__``
                part = SOURCE.parent.joinpath(*module, alias.name)
                names.append(".".join([*module, alias.name] if part.is_dir() or part.with_suffix(".py").exists() else module))
        yield from names


def bound_modules(path):
    """For each local name of a file that stands for a module of cramhy_runtime, wherever the import stands: the dotted name."""
    package = ["cramhy_runtime", *path.relative_to(SOURCE).with_suffix("").parts[:-1]]
    bound = {}
    for node in imports_of(path)[0]:
        if isinstance(node, ast.Import):
            bound |= {alias.asname or alias.name.split(".")[0]: alias.name for alias in node.names if alias.name.startswith("cramhy")}
        elif isinstance(node, ast.ImportFrom):
            base = package[: len(package) - node.level + 1] if node.level else []
            module = [*base, *(node.module or "").split(".")] if node.module else base
            for alias in node.names:
                part = SOURCE.parent.joinpath(*module, alias.name)
                if part.is_dir() or part.with_suffix(".py").exists():
                    bound[alias.asname or alias.name] = ".".join([*module, alias.name])
    return bound


def patches(path):
    """The statements of a file that set or delete a name of an imported module: ``module.name = value``, ``setattr(module, ...)``."""
    modules = bound_modules(path)

    def is_module(node, shadowed):
        """Whether ``node`` is a module: its name, or a module as the attribute of a package."""
        if isinstance(node, ast.Name):
            return node.id in modules and node.id not in shadowed
        return isinstance(node, ast.Attribute) and ast.unparse(node).replace(".", "/") in parts and is_module(node.value, shadowed)

    parts = {
        f"{name}/{'/'.join(other.removeprefix(dotted + '.').split('.'))}"
        for name, dotted in modules.items()
        for other in MODULES
        if other.startswith(dotted + ".")
    }

    def look(node, shadowed):
        if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef, ast.Lambda)):
            shadowed = shadowed | {argument.arg for argument in ast.walk(node.args) if isinstance(argument, ast.arg)}
        if isinstance(node, ast.Attribute) and not isinstance(node.ctx, ast.Load) and is_module(node.value, shadowed):
            yield f"line {node.lineno}: {ast.unparse(node)}"
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in ("setattr", "delattr"):
            if is_module(node.args[0], shadowed):
                yield f"line {node.lineno}: {ast.unparse(node)}"
        for child in ast.iter_child_nodes(node):
            yield from look(child, shadowed)

    return list(look(tree_of(path), frozenset()))


def imported_rooms(path):
    """The rooms of cramhy_runtime that a file imports."""
    for name in imported_names(path):
        parts = name.split(".")
        if parts[0] == "cramhy_runtime" and len(parts) > 1 and parts[1] in FLOOR:
            yield parts[1]


def test_a_room_imports_only_from_floors_below_its_own():
    def above(path):
        room = room_of(path)
        return [other for other in set(imported_rooms(path)) - {room} if FLOOR[other] >= FLOOR[room]]

    assert offences(above) == {}


def circles(edges):
    """The sets of nodes that reach each other, largest first; those of one node are none (Tarjan's algorithm)."""
    index, low, stack, on_stack, found = {}, {}, [], set(), []

    def visit(node):
        index[node] = low[node] = len(index)
        stack.append(node)
        on_stack.add(node)
        for other in edges.get(node, ()):
            if other not in index:
                visit(other)
                low[node] = min(low[node], low[other])
            elif other in on_stack:
                low[node] = min(low[node], index[other])
        if low[node] == index[node]:
            members = []
            while not members or members[-1] != node:
                members.append(stack.pop())
                on_stack.discard(members[-1])
            if len(members) > 1:
                found.append(sorted(members))

    for node in edges:
        if node not in index:
            visit(node)
    return sorted(found, key=len, reverse=True)


def module_name(path):
    return ".".join(["cramhy_runtime", *path.relative_to(SOURCE).with_suffix("").parts]).removesuffix(".__init__")


MODULES = {module_name(path): path for path in FILES}

LISTED = {
    "cramhy_runtime.cli.shims": lambda module: {f"cramhy_runtime.cli.{home}" for home in module._HOMES.values()},
    "cramhy_runtime.ros_tools.running": lambda module: {
        f"cramhy_runtime.ros_tools.{each}" for homes in module._HOMES.values() for each in homes
    },
    "cramhy_runtime.ros_tools.executables": lambda module: {
        f"cramhy_runtime.{home}" for rows in module.EXECUTABLES.values() for home, _ in rows.values()
    },
    "cramhy_runtime.languages.commonlisp.package": lambda module: {
        f"cramhy_runtime.{name}" if name.startswith("lisp_core.") else f"cramhy_runtime.languages.commonlisp.{name}"
        for name in (*module.MODULES, *module.HELPERS)
    },
}
"""Modules that import modules of ours by a computed name, and the list that the name comes from."""
OF_OTHERS = {
    "cramhy_runtime.browser.packing",  # the macros, too
    "cramhy_runtime.languages.commonlisp.syntax.macros",  # the macros, which are written in Hy (hy_src)
    "cramhy_runtime.languages.commonlisp.python.python_calls",  # (py:call "math.sqrt" 2): a module of the user's
    "cramhy_runtime.languages.commonlisp.python.python_packages",  # the same, as a package
    "cramhy_runtime.grading.performing",  # the module that a student hands in
}
"""Modules that import modules of others by a computed name."""


def names_in_strings(name):
    """The modules of ours that a module imports by a string, which may stand in a list."""
    computed = False
    text = MODULES[name].read_text()
    for node in nodes_of(tree_of(MODULES[name])) if "import_module(" in text or "__import__(" in text else ():
        if isinstance(node, ast.Call) and ast.unparse(node.func) in ("import_module", "importlib.import_module", "__import__"):
            if isinstance(node.args[0], ast.Constant):
                yield importlib.util.resolve_name(node.args[0].value, name.rpartition(".")[0])
            else:
                computed = True
    if computed and name not in OF_OTHERS:
        assert name in LISTED, f"{name} imports by a computed name; list in LISTED what it may be"
        yield from LISTED[name](importlib.import_module(name))


@functools.cache
def edges():
    """Which module imports which, wherever in it the import stands. A function that imports when it is called counts, and so does a string;
    what is imported for type checkers does not."""
    return {
        name: {other for other in (*imported_names(path, when_run=True), *names_in_strings(name)) if other in MODULES} - {name}
        for name, path in MODULES.items()
    }


PORT_INSTALLERS = {
    "lisp_core.conditions": {"signals"},
    "lisp_core.plain_answers": {"printer", "classes", "types", "output", "user", "systems", "definitions"},
    "languages.commonlisp.answers": {"printer", "classes", "types", "output", "user", "systems", "definitions"},
    "course.asked": {"user"},
}
"""Who installs which ports of the core: the plain answers, those of the one language that is started, and the course, which asks students."""
SERVICE_INSTALLERS = {
    "prolog.compiler.compiler": {"compile_clauses"},
    "prolog.explanations.undefined": {"warn_undefined"},
    "prolog.tracing": {"watch_predicate", "watch_construct"},
}
"""Who installs what the engine of Prolog asks of the folders above it."""


def installers(holder):
    """For each module: the names that it gives to ``holder.install``."""
    found = {}
    for name, path in MODULES.items():
        for node in nodes_of(tree_of(path)) if f"{holder}.install(" in path.read_text() else ():
            if isinstance(node, ast.Call) and ast.unparse(node.func) == f"{holder}.install":
                found.setdefault(name.removeprefix("cramhy_runtime."), set()).update(keyword.arg for keyword in node.keywords)
    return found


def test_ports_are_few_and_it_is_known_who_installs_them():
    assert len(ports.Ports.__annotations__) <= 8
    assert installers("PORTS") == PORT_INSTALLERS
    assert installers("SERVICES") == SERVICE_INSTALLERS
    assert [name for name, path in MODULES.items() if "install_reporter(" in path.read_text() and room_of(path) != "kernel"] == [
        "cramhy_runtime.session.boot"
    ]


def parts_of(room):
    """For each part of a room, a folder or a module beside the folders: the other parts that it imports."""
    parts = {}
    for name, others in edges().items():
        here = _part_of(room, MODULES[name])
        if here:
            parts.setdefault(here, set()).update({_part_of(room, MODULES[other]) for other in others} - {None, here})
    return parts


def _part_of(room, path):
    """The folder of a room that a file is in, or its own name if it is beside the folders; ``None`` for others and ``__init__``."""
    parts = path.relative_to(SOURCE).with_suffix("").parts
    depth = room.count("/") + 1
    return parts[depth] if "/".join(parts[:depth]) == room and parts[depth:] != ("__init__",) else None


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("room", sorted({str(path.parents[1].relative_to(SOURCE)) for path in SOURCE.glob("*/**/__init__.py")} - {"."}))
def test_the_folders_of_a_room_are_in_no_circle(room):
    assert not circles(parts_of(room))


def test_the_parts_of_common_lisp_import_only_what_is_named_before_them():
    told = ast.get_docstring(ast.parse((SOURCE / "languages" / "commonlisp" / "__init__.py").read_text()))
    order = re.findall(r"(?<!`)`(\w+)`(?!`)", told)
    parts = parts_of("languages/commonlisp")
    assert sorted(order) == sorted(parts)
    for part, others in parts.items():
        assert others <= set(order[: order.index(part)]), part


def test_no_circle_of_modules_is_large_and_none_leaves_its_folder():
    for circle in circles(edges()):
        assert len(circle) <= 8, circle
        assert len({MODULES[name].parent for name in circle}) == 1, circle


def test_rooms_are_in_no_circle():
    rooms = {}
    for name, others in edges().items():
        room = room_of(MODULES[name])
        rooms.setdefault(room, set()).update(room_of(MODULES[each]) for each in others)
    assert not circles(rooms)


def test_no_module_makes_up_names_when_they_are_asked_for():
    """A module-level ``__getattr__`` (PEP 562) hides from editors and type checkers where a name comes from."""

    def made_up(path):
        return [node for node in tree_of(path).body if getattr(node, "name", None) == "__getattr__"]

    assert offences(made_up) == {}


def test_rooms_beside_the_languages_know_one_kind_of_floats():
    """Only Lisp has single-floats. Messages, poses and worlds have floats, and `lisp_core/floats.py` says for all what a single is."""

    def names_singles(path):
        if room_of(path) == "languages":
            return []
        names = (
            getattr(node, "id", None) or getattr(node, "attr", None) or getattr(node, "name", None) for node in nodes_of(tree_of(path))
        )
        return sorted({name for name in names if isinstance(name, str) and "single" in name.lower() and "float" in name.lower()})

    assert offences(names_singles) == {"src/cramhy_runtime/lisp_core/floats.py": ["SingleFloat"]}


def test_nobody_sets_the_names_of_another_module():
    assert offences(patches) == {}


def test_a_patch_is_found(monkeypatch):
    path = SOURCE / "image_that_patches.py"  # it is never written
    text = "from cramhy_runtime import kernel\nkernel.now = kernel.reports.LIMIT = 1\nsetattr(kernel, 'now', 2)\nkernel.cleanup.limit = 3\n"
    monkeypatch.setattr(Path, "read_text", lambda self, **options: text)
    assert [line.split(":")[0] for line in patches(path)] == ["line 2", "line 2", "line 3", "line 4"]


@pytest.mark.soak
def test_threads_and_the_wall_clock_are_the_kernels():
    used = re.compile(r"^\s*(?:import|from) (?:_?threading|_thread|concurrent)\b|\btime\.(?:sleep|time)\(|from time import", re.M)
    assert offences(lambda path: used.findall(path.read_text()), [path for path in FILES if room_of(path) != "kernel"]) == {}


RUN_CODE = {
    "utilities/generated_functions.py": "the text that the library writes",
    "languages/commonlisp/evaluation/evaluator.py": "what the compiler made of a form that a user wrote",
    "languages/commonlisp/systems/loader.py": "the kept code of a user's file",
    "languages/commonlisp/systems/program_files.py": "the code of a user's compiled file",
    "languages/kept_hy.py": "the bytecode of a user's Hy file",
    "jupyter/cells.py": "a cell in Hy that a user wrote",
}
"""The files that call ``exec``, and what they run with it."""


def test_text_that_the_library_writes_is_run_in_one_place():
    running = set()
    for path in FILES:
        for node in nodes_of(tree_of(path)):
            if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in ("exec", "eval"):
                running.add(str(path.relative_to(SOURCE)))
    assert running == set(RUN_CODE)


def test_no_file_is_longer_than_600_lines():
    assert [str(path.relative_to(ROOT)) for path in TEXTS if len(path.read_text().splitlines()) > 600] == []


def test_no_folder_has_more_than_30_modules():
    modules = collections.Counter(path.parent.relative_to(ROOT) for path in FILES)
    assert [str(folder) for folder, number in modules.items() if number > 30] == []


def test_every_module_opens_with_a_paragraph():
    assert [str(path.relative_to(ROOT)) for path in FILES if not ast.get_docstring(tree_of(path))] == []


@pytest.mark.skipif(not hasattr(os, "fork"), reason="each module gets a fresh interpreter by a fork")
@pytest.mark.parametrize(
    "room",
    [path.parent for path in FILES if path.name == "__init__.py" and "Where the parts are" in path.read_text()],
    ids=lambda room: str(room.relative_to(SOURCE)),
)
def test_a_room_that_says_where_its_parts_are_names_them_all(room):
    told = ast.get_docstring(ast.parse((room / "__init__.py").read_text())).partition("Where the parts are")[2]
    parts = {path.stem for path in room.glob("*.py")} | {path.parent.name for path in room.glob("*/__init__.py")}
    assert parts - set(re.findall(r"`(\w+)`", told)) == {"__init__"}


@pytest.mark.soak
@pytest.mark.parametrize("files", ["packages", *(["all"] if SOAK else [])])
def test_any_module_can_be_imported_first(files):
    """No module relies on another one having been imported before it. The short form takes packages and each twentieth module."""
    wanted = FILES if files == "all" else [path for path in FILES if path.name == "__init__.py"] + FILES[::20]
    names = [".".join(["cramhy_runtime", *path.relative_to(SOURCE).with_suffix("").parts]).removesuffix(".__init__") for path in wanted]
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


@pytest.mark.soak
def test_nothing_names_a_path_of_a_machine():
    for path in TEXTS:
        assert not re.search(r"(?<![\w.])/(home|work|Users|root)/\w", path.read_text()), path


def test_test_modules_outside_of_packages_have_names_of_their_own():
    # pytest imports them by their bare names, so that two alike are an error, which only a run of the whole suite shows.
    paths = [path for path in (ROOT / "tests").rglob("*.py") if not (path.parent / "__init__.py").exists() and path.name != "conftest.py"]
    names = [path.stem for path in paths]
    assert not {name for name in names if names.count(name) > 1}


SINGLES = re.compile(r"single[-_]?float|new_single\b", re.I)
NAMED_ONLY = {"floats.py": "the kinds of floats", "packages.py": "the names that COMMON-LISP exports"}


def test_one_file_below_languages_knows_single_floats():
    below = [room for floor in FLOORS[: FLOORS.index(["languages"])] for room in floor]
    paths = [path for room in below for path in (SOURCE / room).rglob("*.py")] + [SOURCE / f"{room}.py" for room in below]
    found = {path.relative_to(SOURCE).as_posix() for path in paths if path.exists() and SINGLES.search(path.read_text(encoding="utf-8"))}
    assert found == {f"lisp_core/{name}" for name in NAMED_ONLY}
    listed = ast.parse((SOURCE / "lisp_core" / "packages.py").read_text(encoding="utf-8"))
    assert not [
        name for name in ast.walk(listed) if isinstance(name, ast.Name | ast.alias) and SINGLES.search(getattr(name, "id", "") or name.name)
    ]
