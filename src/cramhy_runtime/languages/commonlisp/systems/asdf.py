"""The package ASDF: what users do with systems by hand, and with the objects that describe them (ASDF manual, chapters 4 and 8)."""

from __future__ import annotations

from pathlib import Path

from cramhy_runtime.lisp_core.conditions import error
from cramhy_runtime.lisp_core.data import Cons, list_from, lisp_list, truth
from ..packages.face_definition import define_face
from ..files.files import lisp_path
from ..objects.classes import alias_class
from cramhy_runtime.lisp_core.dispatch.generic_functions import protocol_function
from cramhy_runtime.lisp_core.keyword_calls import lispify
from cramhy_runtime.lisp_core.packages import ensure_package, is_symbol, keyword, string_designator, sym, symbol_name
from ..reader.dispatch_macros import FEATURES
from ..streams.streams import STANDARD_OUTPUT
from cramhy_runtime.ros import search_folders
from . import asdf_protocol, package_inferred, systems
from .loader import folder_of_load
from .system_definitions import Component, OPERATIONS, PERFORM, System, TestOp, component_name, define_system

LOADING = {"LOAD-OP", "LOAD-SOURCE-OP", "COMPILE-OP", "PREPARE-OP"}
_active: list = []


def system_of(designator):
    """The `System` that a system or its name means."""
    return designator if isinstance(designator, Component) else systems.find_system(component_name(designator))


def find_system(name, error_p=True):
    """``asdf:find-system``: the system; when there is none nil or, with ``error_p``, an error."""
    if isinstance(name, Component):
        return name
    known = component_name(name)
    if not truth(error_p) and not systems.is_built_in(known) and known not in systems.LEFT_OUT and systems.find_asd(known) is None:
        return systems.systems.get(known)
    return systems.find_system(known)


def load_system(system, *, force=None, verbose=None, version=None, **others):
    """``asdf:load-system``: load it, and what it depends on, as far as that has changed. Returns T."""
    with search_folders.crawling_once():
        found = system_of(system).name
        systems.load_system(found, truth(force), version=version)
    return True


def load_systems(*names):
    """``asdf:load-systems``"""
    for name in names:
        load_system(name)
    return True


def require_system(system, **others):
    """``asdf:require-system``: load it unless it is loaded."""
    return None if component_name(system) in systems.loaded else load_system(system)


def operate(operation, component, *, force=None, verbose=None, version=None, **others):
    """``asdf:operate``: do what ``operation``, the name of a class of operations or an instance, means to a system.

    Every operation loads the system; ``test-op`` then does what ``:in-order-to`` says and calls ``asdf:perform``.
    """
    done = asdf_protocol.operation_of(operation)
    if done is None:
        name = symbol_name(operation) if is_symbol(operation) else string_designator(operation).upper()
        near = systems.near_names(name, OPERATIONS)
        return error("There is no operation ~A for systems~@[; did you mean ~A?~]", name, near[0] if near else None)
    name = type(done).__dict__.get("lisp_name", type(done).__name__).rpartition(":")[2]
    load_system(component, force=force, version=version)
    system = system_of(component)
    if (name, system) in _active:
        return None
    _active.append((name, system))
    try:
        for needed, others_ in system.in_order_to.get(name, ()):
            for other in others_:
                operate(sym(f"ASDF::{needed}"), other)
        if name not in LOADING:  # performed when it was loaded
            PERFORM(done, system)
    finally:
        _active.pop()
    return None


def test_system(system, **others):
    """``asdf:test-system``: ``test-op``. Returns T."""
    operate(sym("ASDF::TEST-OP"), system)
    return True


def clear_system(system):
    """``asdf:clear-system``: forget it; it is read and loaded anew the next time."""
    return True if systems.forget_system(component_name(system.name if isinstance(system, Component) else system)) else None


def load_asd(pathname, *, name=None):
    """``asdf:load-asd``: read a file of system definitions."""
    path = Path(str(pathname))
    path = path if path.is_absolute() else folder_of_load() / path
    if not path.is_file():
        return error(systems.MissingComponent("There is no file ~A.", str(path)))
    systems.load_asd(path, force=True)
    systems.choose_file(systems.really_at(path))
    return None


def registered_systems():
    """``asdf:registered-systems``: the names of the systems whose definitions have been read."""
    return list_from(sorted({*systems.systems, *systems.built_in}))


def already_loaded_systems():
    return list_from([*systems.loaded, *sorted(systems.built_in)])


def component_loaded_p(component):
    return True if system_of(component).name in {*systems.loaded, *systems.built_in} else None


def system_source_file(system):
    """``asdf:system-source-file``: its ``.asd`` file."""
    found = system_of(system)
    return found.file and lisp_path(found.file)


def system_source_directory(system):
    """``asdf:system-source-directory``: the folder of its ``.asd`` file."""
    found = system_of(system)
    return lisp_path(found.folder)


def system_relative_pathname(system, name, *, type=None):
    """``asdf:system-relative-pathname``: a path below the folder of the system's ``.asd`` file."""
    path = system_of(system).folder / str(name)
    return lisp_path(path if type is None or not truth(type) else path.with_name(f"{path.name}.{type}"))


def component_pathname(component):
    return lisp_path(Path(system_of(component).pathname))


def component_name_of(component):
    return system_of(component).name


def component_parent(component):
    return system_of(component).parent


def component_system(component):
    return system_of(component).system


def component_children(component):
    return list_from(getattr(system_of(component), "components", ()))


def component_version(component):
    return getattr(system_of(component), "version", None)


def find_component(base, path):
    """``asdf:find-component``: the component of that name, or along a list of names; nil when there is none."""
    found = system_of(base)
    for name in path if isinstance(path, Cons) else [path]:
        found = next((child for child in getattr(found, "components", ()) if child.name == component_name(name)), None)
        if found is None:
            return None
    return found


def _option(*names):
    return lambda system: next((value for name in names if (value := system_of(system).options.get(name)) is not None), None)


def system_depends_on(system):
    return list_from([name for name, _ in system_of(system).depends_on])


def version_satisfies(version, wanted):
    """``asdf:version-satisfies``: whether a version, or that of a component, is at least ``wanted``."""
    version = version.version if isinstance(version, System) else version
    return True if isinstance(version, str) and systems._numbers(version) >= systems._numbers(wanted) else None


def initialize_source_registry(*parameters):
    """``asdf:initialize-source-registry``: look below the folders of ``(:tree ...)`` and ``(:directory ...)`` too."""
    for entry in (parameters[0].cdr or ()) if parameters and isinstance(parameters[0], Cons) else ():
        if isinstance(entry, Cons) and symbol_name(entry.car) in ("TREE", "DIRECTORY"):
            search_folders.extra_folders.append(str(entry.cdr.car))
    return None


def quickload(names, **others):
    """``ql:quickload``: ``asdf:load-system``, and says so. Returns the list of names."""
    listed = list(names) if isinstance(names, Cons) else [names]
    for name in listed:
        STANDARD_OUTPUT.value.write(f'; Loading "{component_name(name)}" with asdf:load-system; cramhy downloads nothing.\n')
        load_system(name)
    return list_from(listed)


def _defsystem(form, environment):
    return Cons(sym("CRAMHY::DEFINE-SYSTEM-HERE"), Cons(lisp_list(sym("QUOTE"), form), None))


def define_system_here(form):
    """A ``defsystem`` evaluated outside an ``.asd`` file: its folder is that of the file being loaded."""
    return define_system(form, folder_of_load(), load=systems.load_system)


GENERIC = {
    "operate": ("(operation component &key &allow-other-keys)", operate),
    "system-source-file": ("(component)", system_source_file),
    "system-source-directory": ("(component)", system_source_directory),
    "component-pathname": ("(component)", component_pathname),
    "component-name": ("(component)", component_name_of),
    "component-parent": ("(component)", component_parent),
    "component-system": ("(component)", component_system),
    "component-children": ("(component)", component_children),
    "component-version": ("(component)", component_version),
    "component-loaded-p": ("(component)", component_loaded_p),
    "find-component": ("(base path)", find_component),
    "find-system": ("(system &optional error-p)", find_system),
    "version-satisfies": ("(version wanted)", version_satisfies),
    "system-description": ("(component)", _option("DESCRIPTION")),
    "system-author": ("(component)", _option("AUTHOR")),
    "system-maintainer": ("(component)", _option("MAINTAINER")),
    "system-license": ("(component)", _option("LICENSE", "LICENCE")),
    "system-licence": ("(component)", _option("LICENSE", "LICENCE")),
    "system-long-description": ("(component)", _option("LONG-DESCRIPTION")),
    "system-depends-on": ("(component)", system_depends_on),
}
"""The functions to which programs add methods for classes of their own, as they may in ASDF: name, lambda list, what it says of ours."""


def define_faces():
    """Make the packages ASDF and QL."""
    FEATURES.value = list_from([*(FEATURES.value or ()), *(keyword(name) for name in ("ASDF", "ASDF2", "ASDF3", "ASDF3.1", "ASDF3.2"))])
    define_face(
        "ASDF",
        functions={
            "load-system": load_system,
            "load-systems": load_systems,
            "require-system": require_system,
            "compile-system": load_system,
            "make": load_system,
            "oos": lambda operation, component, *options: sym("ASDF::OPERATE").function(operation, component, *options),
            "test-system": test_system,
            "clear-system": clear_system,
            "load-asd": load_asd,
            "registered-systems": registered_systems,
            "already-loaded-systems": already_loaded_systems,
            "system-relative-pathname": system_relative_pathname,
            "module-components": component_children,
            "asdf-version": lambda: "3.3.1",
            "initialize-source-registry": initialize_source_registry,
            "perform": PERFORM,
            "register-system-packages": package_inferred.register_system_packages,
            **asdf_protocol.FUNCTIONS,
        },
        variables={"*central-registry*": None},
        export="defsystem operation component module system cl-source-file static-file doc-file html-file "
        "cl-source-file.cl cl-source-file.lsp "
        f"missing-component missing-dependency {asdf_protocol.EXPORT} " + " ".join(name.lower() for name in OPERATIONS),
    )
    package = ensure_package("ASDF")
    for cls in asdf_protocol.CLASSES:
        package.export(sym(cls.lisp_name))
    for name, cls in asdf_protocol.ALIASES.items():
        alias_class(sym(f"ASDF::{name}"), cls)
    sym("ASDF::COMPONENT-PROPERTY").setf_function = lispify(asdf_protocol.set_component_property)
    for name, (lambda_list, function) in {**GENERIC, **asdf_protocol.GENERIC}.items():
        made = protocol_function(f"ASDF::{name.upper()}", lambda_list, lispify(function))
        sym(f"ASDF::{name.upper()}").package.export(made.__lisp_name__)
    define_face("CRAMHY", functions={"define-system-here": define_system_here})
    define_face("QUICKLISP-CLIENT", nicknames=["QL"], functions={"quickload": quickload})
    sym("ASDF::DEFSYSTEM").macro = _defsystem


__all__ = ["define_faces", "operate", "test_system", "TestOp"]
