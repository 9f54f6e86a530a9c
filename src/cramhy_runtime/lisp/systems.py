"""Systems: ``.asd`` files, where they are found, and loading what they name in the right order.

A system is a set of files with an order, described by ``defsystem``. Packages (folders with a ``package.xml``) and systems
are found below the folders of ``ROS_PACKAGE_PATH``, below ``src`` of the workspace and in the current folder, and in
``tutorials``. Systems of CRAM and ROS that cramhy itself contains are known by name and need no file. Sources: the ASDF
manual; roslisp.md section 12.
"""

from __future__ import annotations

import functools
import os
from dataclasses import dataclass, field
from pathlib import Path

from . import loader
from .compilation_unit import compilation_unit
from .conditions import CompileError, SimpleError, error, style_warn
from .data import Cons, Symbol, list_from
from .dynamic import binding
from .evaluator import PACKAGE, evaluate
from .packages import Package, find_package, near_names, register, string_designator, symbol_name


@dataclass
class Component:
    """A file or module of a system; ``depends_on`` names siblings."""

    kind: str
    name: str
    depends_on: list = field(default_factory=list)
    components: list = field(default_factory=list)
    path: str = None


@dataclass
class System:
    name: str
    folder: Path
    depends_on: list
    components: list
    description: str = None


class MissingComponent(SimpleError):
    lisp_name = "ASDF::MISSING-COMPONENT"


built_in: set = set()
"""Names of systems that are part of cramhy; rooms add theirs with `provide_system`."""
_systems: dict = {}
_loaded: dict = {}
_loading: list = []
extra_folders: list = []
"""Folders to look in besides the standard ones."""


def provide_system(names):
    built_in.update(names.split())


def search_folders():
    """The folders below which packages and systems are looked for, in order."""
    folders = [Path(entry) for entry in os.environ.get("ROS_PACKAGE_PATH", "").split(os.pathsep) if entry]
    folders += [Path(entry) for entry in extra_folders]
    here = Path.cwd()
    folders += [here, *(parent / "src" for parent in [here, *here.parents][:6] if (parent / "src").is_dir())]
    if here.name == "src":
        folders.append(here)
    root = Path(__file__).parents[3]
    folders += [root / "tutorials", Path(__file__).parents[1] / "tutorials"]
    return [folder for folder in dict.fromkeys(folders) if folder.is_dir()]


LIBRARIES = Path(__file__).parents[1] / "libraries"
"""The libraries that come with cramhy, each a folder with a ``.asd``; they are loaded when somebody asks for them."""
LIBRARY_PACKAGES = {"ALEXANDRIA": "alexandria", "ALEXANDRIA-1": "alexandria", "LISP-UNIT": "lisp-unit",
                    "FIVEAM": "fiveam", "5AM": "fiveam", "IT.BESE.FIVEAM": "fiveam"}
"""Their packages: the library is loaded when its package is first named."""


@functools.cache
def libraries():
    """The ``.asd`` files in `LIBRARIES`: the path there by the file's name."""
    return {path.name: path.relative_to(LIBRARIES) for path in LIBRARIES.glob("*/*.asd")}


def _asd_files(folder, depth=4):
    try:
        entries = sorted(os.scandir(folder), key=lambda entry: entry.name)
    except OSError:
        return
    for entry in entries:
        if entry.name.endswith(".asd") and entry.is_file():
            yield Path(entry.path)
    for entry in entries:
        if depth and entry.is_dir() and not entry.name.startswith((".", "__")) and entry.name not in _skipped:
            yield from _asd_files(entry.path, depth - 1)


_skipped = {"node_modules", "build", "devel", "venv", "site-packages", "tests"}


def find_asd(name):
    """The ``.asd`` file that defines the system ``name`` (its file name, or its secondary name after the slash), or ``None``."""
    wanted = name.partition("/")[0] + ".asd"
    if wanted in libraries():
        return LIBRARIES / libraries()[wanted]
    for folder in search_folders():
        for path in _asd_files(folder):
            if path.name == wanted:
                return path
    return None


def find_package_folder(name):
    """The folder of the ROS package ``name``: it is called so, or its ``package.xml`` says so; ``None`` if there is none."""
    for folder in search_folders():
        for candidate in [folder, *sorted(entry for entry in folder.iterdir() if entry.is_dir())]:
            if candidate.name == name and ((candidate / "package.xml").exists() or any(candidate.glob("*.asd"))):
                return candidate
    return None


def known_systems():
    """Names of all systems that could be loaded, for "did you mean"."""
    return {*built_in, *(name.removesuffix(".asd") for name in libraries()),
            *(path.stem for folder in search_folders() for path in _asd_files(folder))}


# --------------------------------------------------------------------------------------------------------------- defsystem


def define_system(form, folder):
    """Enter the system of a ``(defsystem name . options)`` form; bad shapes are errors that say what was expected."""
    name = string_designator(form.cdr.car).lower()
    options = list(form.cdr.cdr or ())
    if len(options) % 2:
        return error(CompileError("DEFSYSTEM ~A: the options must be pairs of a keyword and a value.", name))
    table = _options(name, options)
    depends = [_dependency(item) for item in _listed(name, "DEPENDS-ON", table.get("DEPENDS-ON"))]
    folder = folder / table["PATHNAME"] if isinstance(table.get("PATHNAME"), str) else folder
    system = System(name, folder, [item for item in depends if item], _components(name, table.get("COMPONENTS")),
                    table.get("DESCRIPTION"))
    if table.get("SERIAL") is not None:
        _make_serial(system.components)
    _systems[name] = system
    return system


def _options(system, items):
    """The options in the list ``items`` of keywords and values, by name."""
    table = {}
    for key, value in zip(items[::2], items[1::2]):
        if not isinstance(key, Symbol):
            error(CompileError("DEFSYSTEM ~A: the name of an option is a keyword such as :COMPONENTS, not ~S.", system, key))
        table[symbol_name(key)] = value
    return table


def _listed(system, option, value):
    """The elements of the ``value`` of an option that must be a list."""
    if value is not None and not isinstance(value, Cons):
        error(CompileError("DEFSYSTEM ~A: :~A must be a list, but it is ~S.", system, option, value))
    return list(value or ())


def _component_name(designator):
    """As a string; a symbol stands for its name in lower case, as for ASDF."""
    name = string_designator(designator)
    return name if isinstance(designator, str) else name.lower()


def _dependency(item):
    if isinstance(item, Cons):  # (:version "x" "1.0"), (:feature :sbcl "x")
        parts = list(item)
        return None if symbol_name(parts[0]) == "FEATURE" else string_designator(parts[1]).lower()
    return string_designator(item).lower()


def _components(system, form):
    if isinstance(form, Cons) and isinstance(form.car, Symbol):
        style_warn("DEFSYSTEM ~A: :COMPONENTS should be a list of components, but it is the single component (~S ...); taken as "
                   "a list of one.", system, form.car)
        form = Cons(form, None)
    return [_component(system, item) for item in _listed(system, "COMPONENTS", form)]


def _component(system, form):
    if not isinstance(form, Cons) or not isinstance(form.cdr, Cons) or not isinstance(form.car, Symbol) \
            or not isinstance(form.cdr.car, (str, Symbol)):
        return error(CompileError("DEFSYSTEM ~A: a component is (:file \"name\" ...) or (:module \"name\" ...), not ~S.", system, form))
    kind, name = symbol_name(form.car), form.cdr.car
    options, rest = {}, form.cdr.cdr
    while isinstance(rest, Cons) and isinstance(rest.cdr, Cons) and isinstance(rest.car, Symbol):
        options[symbol_name(rest.car)] = rest.cdr.car
        if symbol_name(rest.car) == "COMPONENTS" and isinstance(rest.cdr.car, Cons) and isinstance(rest.cdr.car.car, Symbol):
            # (:module "src" :components (:file ...) (:file ...)): the list was forgotten, as on a slide of lecture 38
            style_warn("DEFSYSTEM ~A: :COMPONENTS of ~S should be a list of components; the components that follow are taken "
                       "as that list.", system, name)
            options["COMPONENTS"] = rest.cdr
            break
        rest = rest.cdr.cdr
    if rest is not None and not isinstance(options.get("COMPONENTS"), Cons):
        return error(CompileError("DEFSYSTEM ~A: after its name, the component ~S has pairs of a keyword and a value.", system, form))
    depends = [_component_name(item) for item in _listed(system, "DEPENDS-ON", options.get("DEPENDS-ON"))]
    path = options.get("PATHNAME")
    component = Component(kind, _component_name(name), depends, path=path if isinstance(path, str) else None)
    if kind == "MODULE":
        component.components = [_component(system, item) for item in _listed(system, "COMPONENTS", options.get("COMPONENTS"))]
        if options.get("SERIAL") is not None:
            _make_serial(component.components)
    return component


def _make_serial(components):
    for earlier, later in zip(components, components[1:]):
        later.depends_on.append(earlier.name)


def load_asd(path):
    """Read a ``.asd`` file: define its systems, evaluate its other forms."""
    from .reader import Reader

    path = Path(path)
    package = find_package("ASDF-USER") or register(Package("ASDF-USER", (), [find_package("COMMON-LISP")]))
    reader = Reader(path.read_text(encoding="utf-8"), filename=str(path))
    end = object()
    with binding(PACKAGE, package):
        while (form := reader.read(eof_error=False, eof_value=end)) is not end:
            if isinstance(form, Cons) and isinstance(form.car, Symbol) and form.car.name == "DEFSYSTEM":
                define_system(form, path.parent)
            else:
                evaluate(form, str(path), reader.positions)


# ----------------------------------------------------------------------------------------------------------------- loading


def find_system(name, required_by=None):
    """The `System` called ``name``; an unknown one is an error that names its neighbours."""
    path = find_asd(name)
    if path is not None:
        load_asd(path)
    system = _systems.get(name)
    if system is None:
        near = near_names(name, known_systems())
        hint = f" Did you mean {' or '.join(near)}?" if near else ""
        by = f", required by #<SYSTEM {required_by!r}>".replace("'", '"') if required_by else ""
        where = ", ".join(str(folder) for folder in search_folders())
        condition = MissingComponent(f"Component ~S not found{by}", name)
        condition.hint = f"There is no file {name}.asd below {where}.{hint}"
        return error(condition)
    return system


def load_system(name, force=False):
    """Load the system ``name`` and what it depends on, each file that has changed or was not loaded yet.

    Returns the fingerprint of all that was loaded. A circle of dependencies is an error.
    """
    with compilation_unit("file"):
        return _load_system(name, force)


def _load_system(name, force=False, required_by=None):
    name = string_designator(name).lower()
    if name in built_in:
        return name
    if name in _loading:
        return error("Circular dependency: ~{~A~^ -> ~} -> ~A", list_from(_loading), name)
    _loading.append(name)
    try:
        system = find_system(name, required_by)
        chain = "".join(_load_system(other, required_by=name) for other in system.depends_on)
        for component, path in files_of(system):
            chain = _load_component(system, component, path, chain, force)
        return chain
    finally:
        _loading.pop()


def _load_component(system, component, path, chain, force):
    status = path.stat() if path.exists() else None
    key = (status.st_mtime_ns, status.st_size, chain) if status else None
    kept = _loaded.get(path)
    if kept is not None and kept[0] == key and not force:
        return kept[1]
    fingerprint = loader.load_file(path, chain)
    _loaded[path] = (key, fingerprint)
    return fingerprint


def files_of(system):
    """(component, path) of every file of ``system`` in the order of loading."""
    yield from _ordered_files(system, system.components, system.folder)


def _ordered_files(system, components, folder):
    for component in _ordered(system, components):
        if component.kind == "MODULE":
            inner = component.path if component.path is not None else component.name
            yield from _ordered_files(system, component.components, folder / inner)
        elif component.kind == "FILE":
            yield component, _file(folder, component)


def _file(folder, component):
    name = component.path or component.name
    for candidate in (folder / name, folder / f"{name}.lisp", folder / f"{name}.hy"):
        if candidate.is_file():
            return candidate
    return folder / f"{name}.lisp"


def _ordered(system, components):
    """``components`` so that each comes after those it depends on, otherwise as they stand."""
    by_name = {component.name: component for component in components}
    done, active, order = set(), [], []

    def visit(component):
        if component.name in done:
            return
        if component.name in active:
            error("Circular dependency in system ~A: ~{~A~^ -> ~} -> ~A", system.name, list_from(active), component.name)
        active.append(component.name)
        for other in component.depends_on:
            if other not in by_name:
                error(CompileError("DEFSYSTEM ~A: ~S depends on ~S, which is no component beside it.", system.name, component.name, other))
            visit(by_name[other])
        active.pop()
        done.add(component.name)
        order.append(component)

    for component in components:
        visit(component)
    return order
