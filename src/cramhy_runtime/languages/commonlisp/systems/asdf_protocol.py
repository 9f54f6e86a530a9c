"""The names of ASDF that are seldom called: operations and components as objects, plans, configuration, conditions (ASDF manual, 7 to 12).

Programs add methods to these functions, ask a file for its output, or set where compiled files go. There are no compiled files here, so
the output of an operation is an empty list, translations of such names change nothing, and an operation that would write a library or
a program is an error that says so.
"""

from __future__ import annotations

import platform
from pathlib import Path

from cramhy_runtime.lisp_core.conditions import Error, SimpleError, Warning_, error
from cramhy_runtime.lisp_core.data import Cons, Keyword, all_values, list_from, lisp_list, one
from cramhy_runtime.lisp_core.functions import function_of
from cramhy_runtime.lisp_core.packages import is_symbol, keyword, string_designator, sym, symbol_name
from cramhy_runtime.kernel.images import per_image
from cramhy_runtime.kernel.typing_names import Any

from ..files.files import lisp_path
from ..objects.classes import find_class
from ..objects.slots import slot_boundp, slot_exists_p, slot_value
from . import performing, systems
from .component_order import components_of
from .system_definitions import (
    OPERATIONS,
    PERFORM,
    Component,
    Module,
    Operation,
    SourceFile,
    StaticFile,
    System,
    component_name,
    is_of_program,
)

_CLASSES = {
    Operation: """BUILD-OP DEFINE-OP PREPARE-SOURCE-OP DOWNWARD-OPERATION UPWARD-OPERATION SIDEWAY-OPERATION
        SELFWARD-OPERATION NON-PROPAGATING-OPERATION SEQUENTIAL-PLAN""",
    StaticFile: "C-SOURCE-FILE JAVA-SOURCE-FILE COMPILED-FILE",
    System: "PRECOMPILED-SYSTEM PROGRAM-SYSTEM PACKAGE-SYSTEM",
    SimpleError: """OPERATION-ERROR COMPILE-ERROR COMPILE-FAILED COMPILE-WARNED COMPILE-FILE-ERROR COMPILE-FAILED-ERROR COMPILE-WARNED-ERROR
        LOAD-SYSTEM-DEFINITION-ERROR CIRCULAR-DEPENDENCY DUPLICATE-NAMES SYSTEM-OUT-OF-DATE OPERATION-DEFINITION-ERROR NON-SYSTEM-SYSTEM
        NON-TOPLEVEL-SYSTEM PACKAGE-INFERRED-SYSTEM-MISSING-PACKAGE-ERROR""",
    Warning_: "COMPILE-FAILED-WARNING COMPILE-WARNED-WARNING OPERATION-DEFINITION-WARNING BAD-SYSTEM-NAME",
    Error: "COMPILE-CONDITION",
}
"""Classes that programs name, by what they are made of here."""
_BUNDLES = """BUNDLE-OP COMPILE-BUNDLE-OP CONCATENATE-SOURCE-OP COMPILE-CONCATENATED-SOURCE-OP DELIVER-ASD-OP DLL-OP IMAGE-OP LIB-OP
LOAD-BUNDLE-OP LOAD-COMPILED-CONCATENATED-SOURCE-OP LOAD-CONCATENATED-SOURCE-OP MONOLITHIC-BUNDLE-OP MONOLITHIC-COMPILE-BUNDLE-OP
MONOLITHIC-COMPILE-CONCATENATED-SOURCE-OP MONOLITHIC-CONCATENATE-SOURCE-OP MONOLITHIC-DELIVER-ASD-OP MONOLITHIC-DLL-OP
MONOLITHIC-LIB-OP MONOLITHIC-LOAD-BUNDLE-OP MONOLITHIC-LOAD-COMPILED-CONCATENATED-SOURCE-OP MONOLITHIC-LOAD-CONCATENATED-SOURCE-OP
PREPARE-BUNDLE-OP PROGRAM-OP"""


class BundleOp(Operation):
    """An operation that writes what it makes of a system to a file."""

    lisp_name = "ASDF::BASIC-COMPILE-BUNDLE-OP"


@PERFORM.method(BundleOp, object)
def refuse(operation: BundleOp, component: Component) -> object:
    """There is no machine code that could be written."""
    name = type(operation).lisp_name.partition("::")[2]
    return error(
        "~A of the system ~A writes a file of machine code, and cramhy makes none. (asdf:load-system ~S) loads it.",
        name,
        component.name,
        component.name,
    )


def _make_classes() -> list[type]:
    tables = {**_CLASSES, BundleOp: _BUNDLES}
    names = {"__module__": "cramhy_runtime.languages.commonlisp.systems.system_definitions"}
    return [type(name, (base,), {"lisp_name": f"ASDF::{name}", **names}) for base, words in tables.items() for name in words.split()]


CLASSES = _make_classes()


def operation_of(designator: Any) -> Operation | None:
    """The operation that an instance, a class or the name of a class means; ``None`` if there is no such class of operations."""
    if isinstance(designator, Operation):
        return designator
    cls = designator if isinstance(designator, type) else find_class(designator, None) if is_symbol(designator) else None
    if cls is None:
        name = symbol_name(designator) if is_symbol(designator) else string_designator(designator).upper()
        cls = OPERATIONS.get(name) or find_class(sym(f"ASDF::{name}"), None)
    if not (isinstance(cls, type) and issubclass(cls, Operation)):
        return None
    return cls() if cls.__module__ == Operation.__module__ else one(sym("MAKE-INSTANCE").function(cls))


def make_operation(designator: Any) -> object:
    """``asdf:make-operation``"""
    found = operation_of(designator)
    return error("There is no operation ~A for systems", designator) if found is None else found


def system_of(designator: Any) -> Any:
    """The `System` that a system or its name means."""
    return designator if isinstance(designator, Component) else systems.find_system(component_name(designator))


# ------------------------------------------------------------------------------------------- what an operation means to a component


def input_files(operation: Any, component: Any) -> object:
    """``asdf:input-files``: the file itself."""
    return lisp_list(lisp_path(performing.path_of(component))) if isinstance(component, SourceFile) else None


def nothing(*arguments: object) -> None:
    """What is asked for is an empty list here, or there is nothing to do."""


def operation_done_p(operation: Any, component: Any) -> object:
    """``asdf:operation-done-p``: whether it is loaded."""
    if isinstance(component, System):
        return True if component.name in systems.loaded else None
    return True if performing.path_of(component) in performing.loaded_files() else None


def component_depends_on(operation: Any, component: Any) -> object:
    """``asdf:component-depends-on``: the same operation on the systems or siblings that come first."""
    if isinstance(component, System):
        names: list[str] = [name for name, _ in component.depends_on]
    else:
        names = component.depends_on
    return lisp_list(Cons(sym(f"ASDF::{type(operation).lisp_name.partition('::')[2]}"), list_from(names))) if names else None


def perform_with_restarts(operation: Any, component: Any) -> object:
    """``asdf:perform-with-restarts``: as ``perform``, whose errors offer restarts anyway."""
    return PERFORM(operation, component)


def action_description(operation: Any, component: Any) -> str:
    """``asdf:action-description``"""
    return f"{type(operation).lisp_name.partition('::')[2].lower()} on {component.name}"


def source_file_type(component: Any, system: Any) -> object:
    """``asdf:source-file-type``: the slot ``type`` of a class of the program, else what its files of Lisp are called."""
    slot = sym("COMMON-LISP::TYPE")
    if is_of_program(component) and one(slot_exists_p(component, slot)) and one(slot_boundp(component, slot)):
        return one(slot_value(component, slot))
    return component.suffix if isinstance(component, SourceFile) else None


def component_relative_pathname(component: Any) -> object:
    """``asdf:component-relative-pathname``: from what it is part of."""
    path, parent = component.pathname, component.parent
    return lisp_path(path if parent is None else Path(path).relative_to(parent.pathname))


_properties: dict[tuple[Any, Any], object] = per_image({})


def component_property(component: Any, name: Any) -> object:
    """``asdf:component-property``: what `set_component_property` has stored."""
    return _properties.get((component, name))


def set_component_property(value: object, component: Any, name: Any) -> object:
    """``(setf asdf:component-property)``"""
    _properties[component, name] = value
    return value


def output_file(operation: Any, component: Any) -> object:
    """``asdf:output-file``: the only one of its output files."""
    files = one(sym("ASDF::OUTPUT-FILES").function(operation, component))
    return files.car if isinstance(files, Cons) else None


def traverse(operation: Any, component: Any, *options: Any) -> object:
    """``asdf:traverse``: a list of (operation . component) for each file, in the order of loading."""
    found, system = operation_of(operation), system_of(component)
    return list_from([Cons(found, each) for each in components_of(system)] if isinstance(system, Module) else [Cons(found, system)])


def required_components(system: Any, *options: Any) -> object:
    """``asdf:required-components``: the systems that it depends on, those that come first before it, and itself."""
    return list_from(list(_required(system_of(system), {})))


def _required(system: Any, seen: dict[str, Any]) -> list[Any]:
    if system.name not in seen:
        seen[system.name] = system
        for name, _ in getattr(system, "depends_on", ()):
            seen.pop(system.name)
            _required(systems.find_system(name, system.name), seen)
            seen[system.name] = system
    return list(seen.values())


def find_component_path(component: Any) -> object:
    """``asdf:component-find-path``: the names from the system down to it."""
    names = []
    while component is not None:
        names.append(component.name)
        component = component.parent
    return list_from(names[::-1])


def sideway_dependencies(component: Any) -> object:
    """``asdf:component-sideway-dependencies``"""
    return list_from([each if isinstance(each, str) else each[0] for each in component.depends_on])


# ------------------------------------------------------------------------------------------------------------- finding systems


def coerce_name(name: Any) -> str:
    """``asdf:coerce-name``"""
    return name.name if isinstance(name, Component) else component_name(name)


def registered_system(name: Any) -> object:
    """``asdf:registered-system``: the system, if its definition has been read."""
    return systems.systems.get(coerce_name(name))


def search_for_system_definition(system: Any) -> object:
    """``asdf:search-for-system-definition``: the ``.asd`` file that would be read."""
    path = systems.find_asd(coerce_name(system))
    return path and lisp_path(path)


def map_systems(function: Any) -> None:
    """``asdf:map-systems``: call the function with each system whose definition has been read."""
    for system in list(systems.systems.values()):
        function_of(function)(system)


def implementation_identifier() -> str:
    """``asdf:implementation-identifier``"""
    return f"cramhy-{platform.system().lower()}-{platform.machine().lower()}"


def run_shell_command(control: str, *arguments: Any) -> object:
    """``asdf:run-shell-command``: the exit code of the command that ``format`` makes."""
    options = (keyword("IGNORE-ERROR-STATUS"), True, keyword("OUTPUT"), keyword("INTERACTIVE"))
    command = one(sym("FORMAT").function(None, control, *arguments))
    return all_values(sym("UIOP::RUN-PROGRAM").function(command, *options))[2]


def accessor(option: str) -> Any:
    """A function that gives the option of that name of a system."""

    def read(system: Any) -> object:
        return system_of(system).options.get(option)

    return read


GENERIC: dict[str, tuple[str, Any]] = {
    "input-files": ("(operation component)", input_files),
    "output-files": ("(operation component)", nothing),
    "additional-input-files": ("(operation component)", nothing),
    "operation-done-p": ("(operation component)", operation_done_p),
    "needed-in-image-p": ("(operation component)", lambda operation, component: True),
    "component-depends-on": ("(operation component)", component_depends_on),
    "explain": ("(operation component)", nothing),
    "action-description": ("(operation component)", action_description),
    "perform-with-restarts": ("(operation component)", perform_with_restarts),
    "operation-on-failure": ("(operation)", lambda operation: keyword("ERROR")),
    "operation-on-warnings": ("(operation)", lambda operation: keyword("WARN")),
    "source-file-type": ("(component system)", source_file_type),
    "file-type": ("(component)", lambda component: source_file_type(component, None)),
    "component-relative-pathname": ("(component)", component_relative_pathname),
    "component-property": ("(component property)", component_property),
    "component-encoding": ("(component)", lambda component: keyword("UTF-8")),
    "component-external-format": ("(component)", lambda component: keyword("UTF-8")),
    "component-sideway-dependencies": ("(component)", sideway_dependencies),
    "traverse": ("(operation component &key &allow-other-keys)", traverse),
    "make-plan": ("(plan operation component &key &allow-other-keys)", lambda plan, *action: traverse(*action)),
    "perform-plan": ("(plan &key)", lambda plan: [PERFORM(step.car, step.cdr) for step in plan or ()] and None),
    **{
        f"system-{option.lower()}": ("(component)", accessor(option))
        for option in ("HOMEPAGE", "BUG-TRACKER", "LONG-NAME", "MAILTO", "SOURCE-CONTROL", "DEFSYSTEM-DEPENDS-ON", "WEAKLY-DEPENDS-ON")
    },
}
_ENDINGS = {"OBJECT": "o", "SHARED-LIBRARY": "so", "DLL": "so", "STATIC-LIBRARY": "a", "LIB": "a", "FASL": "fasl", "IMAGE": "image"}


def bundle_pathname_type(bundle: Any) -> Any:
    """``asdf:bundle-pathname-type``: the ending of the file names of a kind of bundle, on Linux; nil is that of a program.

    A string is the ending itself. An error says that there is not such a kind.
    """
    if bundle is None or isinstance(bundle, str):
        return bundle
    if bundle is keyword("PROGRAM"):
        return None
    if isinstance(bundle, Keyword) and bundle.name in _ENDINGS:
        return _ENDINGS[bundle.name]
    return error("~S is not a kind of bundle. ASDF knows :program~{, :~(~A~)~}.", bundle, list_from([*_ENDINGS]))


FUNCTIONS: dict[str, Any] = {
    "bundle-pathname-type": bundle_pathname_type,
    "make-operation": make_operation,
    "find-operation": lambda context, operation: make_operation(operation),
    "output-file": output_file,
    "required-components": required_components,
    "component-find-path": find_component_path,
    "component-load-dependencies": sideway_dependencies,
    "coerce-name": coerce_name,
    "primary-system-name": lambda name: coerce_name(name).partition("/")[0],
    "registered-system": registered_system,
    "system-registered-p": registered_system,
    "search-for-system-definition": search_for_system_definition,
    "locate-system": search_for_system_definition,
    "system-definition-pathname": search_for_system_definition,
    "map-systems": map_systems,
    "implementation-identifier": implementation_identifier,
    "implementation-type": lambda: keyword("CRAMHY"),
    "hostname": platform.node,
    "run-shell-command": run_shell_command,
    "apply-output-translations": lambda path: path,
    "operation-monolithic-p": lambda operation: None,
    "asdf-message": lambda control, *arguments: sym("FORMAT").function(sym("*STANDARD-OUTPUT*").value, control, *arguments),
    **dict.fromkeys(
        """clear-configuration clear-output-translations clear-source-registry disable-output-translations ensure-output-translations
        ensure-source-registry initialize-output-translations enable-asdf-binary-locations-compatibility enable-deferred-warnings-check
        disable-deferred-warnings-check upgrade-asdf register-immutable-system user-output-translations-pathname
        system-output-translations-pathname user-source-registry system-source-registry user-source-registry-directory
        system-source-registry-directory user-output-translations-directory-pathname
        system-output-translations-directory-pathname sysdef-preloaded-system-search sysdef-immutable-system-search""".split(),
        lambda *arguments: None,
    ),
    "register-preloaded-system": lambda name, *options: systems.provide_system(coerce_name(name)),
}
EXPORT = """accept retry try-recompiling coerce-entry-to-directory remove-entry-from-registry clear-configuration-and-retry version feature
source-file file-component parent-component child-component package-inferred-system missing-component-of-version
missing-dependency-of-version system-definition-error error-name error-pathname error-component error-operation"""
ALIASES = {"SOURCE-FILE": SourceFile, "FILE-COMPONENT": StaticFile, "PARENT-COMPONENT": Module, "CHILD-COMPONENT": Component}


__all__ = ["ALIASES", "CLASSES", "EXPORT", "FUNCTIONS", "GENERIC", "operation_of", "set_component_property"]
