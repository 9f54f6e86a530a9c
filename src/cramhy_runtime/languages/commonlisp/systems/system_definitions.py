"""What a system consists of, as its ``defsystem`` form says: components, what they depend on, and what its operations do.

The classes are those of the package ASDF, so that methods such as ``(defmethod asdf:perform ((o asdf:test-op) (s (eql
(asdf:find-system :x)))) ...)`` can be written. Shapes that are wrong are errors that say what was expected. Source: the ASDF
manual, chapter 6.
"""

from __future__ import annotations

from pathlib import Path

from cramhy_runtime.kernel.images import per_image
from cramhy_runtime.lisp_core.conditions import CompileError, error, style_warn
from cramhy_runtime.lisp_core.data import Cons, Keyword, Symbol, list_from, lisp_list
from ..evaluation.evaluator import PACKAGE, evaluate
from ..objects.class_definition import default_initargs
from ..objects.classes import find_class
from cramhy_runtime.lisp_core.dispatch.generic_functions import EqlSpecializer, add_method, generic, remove_method
from cramhy_runtime.lisp_core.packages import (
    COMMON_LISP,
    ensure_package,
    find_package,
    is_symbol,
    keyword,
    string_designator,
    sym,
    symbol_name,
)
from ..files.files import lisp_path
from ..printer.printer import define_printer
from ..reader.dispatch_macros import FEATURES

_PARTS_OF_UIOP = """DRIVER PACKAGE UTILITY VERSION OS PATHNAME FILESYSTEM STREAM IMAGE LISP-BUILD LAUNCH-PROGRAM RUN-PROGRAM CONFIGURATION
BACKWARD-DRIVER"""
_PARTS_OF_ASDF = """INTERFACE COMPONENT SYSTEM SYSTEM-REGISTRY FIND-SYSTEM FIND-COMPONENT OPERATION ACTION LISP-ACTION PLAN OPERATE
OUTPUT-TRANSLATIONS SOURCE-REGISTRY PARSE-DEFSYSTEM BUNDLE CONCATENATE-SOURCE PACKAGE-INFERRED-SYSTEM BACKWARD-INTERFACE USER"""
ensure_package("UIOP", "ASDF-UTILS", "ASDF-DRIVER", *[f"UIOP/{part}" for part in _PARTS_OF_UIOP.split()], use=[COMMON_LISP])
ensure_package("ASDF", *[f"ASDF/{part}" for part in _PARTS_OF_ASDF.split()], use=[COMMON_LISP, ensure_package("UIOP")])


class Operation:
    """What can be done with a system."""

    lisp_name = "ASDF::OPERATION"


class LoadOp(Operation):
    lisp_name = "ASDF::LOAD-OP"


class LoadSourceOp(Operation):
    lisp_name = "ASDF::LOAD-SOURCE-OP"


class CompileOp(Operation):
    lisp_name = "ASDF::COMPILE-OP"


class PrepareOp(Operation):
    lisp_name = "ASDF::PREPARE-OP"


class TestOp(Operation):
    lisp_name = "ASDF::TEST-OP"
    __test__ = False  # pytest takes classes of this name for tests


OPERATIONS = {cls.lisp_name.partition("::")[2]: cls for cls in (LoadOp, LoadSourceOp, CompileOp, PrepareOp, TestOp)}


class Component:
    """A part of a system. name, and ``depends_on``: the names of siblings that come first; ``path``: where it lies, if it says so.

    methods: those that its definition adds to ``asdf:perform``. around_compile: a function that calls the one that compiles a file.
    """

    lisp_name = "ASDF::COMPONENT"
    lisp_slots = {"RELATIVE-PATHNAME": "relative_pathname"}

    def __init__(self, name, parent=None, depends_on=(), path=None):
        self.name, self.parent, self.depends_on, self.path = name, parent, list(depends_on), path
        self.methods, self.around_compile = [], None

    @property
    def pathname(self):
        """The file or folder."""
        return self.parent.pathname / (self.name if self.path is None else self.path)

    @property
    def relative_pathname(self):
        """The slot that older libraries read: what its definition says of where it lies."""
        return self.name if self.path is None else lisp_path(self.path)

    @property
    def system(self):
        return self if self.parent is None else self.parent.system


class StaticFile(Component):
    lisp_name = "ASDF::STATIC-FILE"


class DocFile(StaticFile):
    lisp_name = "ASDF::DOC-FILE"


class HtmlFile(DocFile):
    lisp_name = "ASDF::HTML-FILE"


class SourceFile(Component):
    lisp_name = "ASDF::CL-SOURCE-FILE"
    suffix = "lisp"

    @property
    def pathname(self):
        """The ``.lisp`` or ``.hy`` file; the ``.lisp`` file if there is none of them. A class may want another suffix than ``.lisp``."""
        folder, name = self.parent.pathname, str(self.name if self.path is None else self.path)
        if is_of_program(self):
            suffix = sym("ASDF::SOURCE-FILE-TYPE").function(self, self.parent)
            return folder / (name if not suffix or name.endswith(f".{suffix}") else f"{name}.{suffix}")
        candidates = [folder / name, folder / f"{name}.{self.suffix}", folder / f"{name}.hy"]
        return next(
            (candidate for candidate in candidates if candidate.is_file()),
            candidates[0] if name.endswith((f".{self.suffix}", ".hy")) else candidates[1],
        )


class ClFile(SourceFile):
    """A file of Lisp that is called ``.cl``."""

    lisp_name = "ASDF::CL-SOURCE-FILE.CL"
    suffix = "cl"


class LspFile(SourceFile):
    """A file of Lisp that is called ``.lsp``."""

    lisp_name = "ASDF::CL-SOURCE-FILE.LSP"
    suffix = "lsp"


class Module(Component):
    """A folder of components. without: the names of those that are left out, since a feature that they need is missing."""

    lisp_name = "ASDF::MODULE"

    def __init__(self, name, parent=None, depends_on=(), path=None):
        super().__init__(name, parent, depends_on, path)
        self.components, self.without, self.default_component_class = [], set(), None


class System(Module):
    """A system: its folder, the systems that it depends on, what it does for operations, and the options of its form."""

    lisp_name = "ASDF::SYSTEM"

    def __init__(self, name, folder=None):
        super().__init__(name)
        self.folder, self.file = folder, None
        self.options, self.in_order_to = {}, {}
        self.without_sbcl = False  # whether its definition was read as on a Lisp that it does not know; then its files are, too

    @property
    def pathname(self):
        return self.folder if self.path is None else self.folder / self.path

    @property
    def relative_pathname(self):
        return lisp_path(self.pathname)

    @property
    def version(self):
        return self.options.get("VERSION")


class PackageInferredSystem(System):
    """A system of which each file is one, too; see ``package_inferred.py``."""

    lisp_name = "ASDF::PACKAGE-INFERRED-SYSTEM"


define_printer(
    Component,
    lambda component, stream: stream.write(
        f'#<ASDF/{"SYSTEM:SYSTEM" if isinstance(component, System) else "COMPONENT:COMPONENT"} "{component.name}">'
    ),
)

PERFORM = generic("ASDF::PERFORM", "(operation component)")


@PERFORM.method(object, object)
def perform(operation, component):
    """``asdf:perform`` of a system that says nothing about an operation does nothing."""


systems: dict = per_image({})
"""Name → `System`; a definition that is read again changes the object, so methods on it stay valid."""

_TEXT_OPTIONS = {
    "NAME",
    "AUTHOR",
    "MAINTAINER",
    "LICENSE",
    "LICENCE",
    "DESCRIPTION",
    "LONG-DESCRIPTION",
    "VERSION",
    "LONG-NAME",
    "MAILTO",
    "DEFSYSTEM-DEPENDS-ON",
    "WEAKLY-DEPENDS-ON",
    "HOMEPAGE",
    "BUG-TRACKER",
    "SOURCE-CONTROL",
}


def define_system(form, folder, file=None, positions=None, load=None):
    """Enter the system of a ``(defsystem name . options)`` form.

    folder: where its files lie. file and positions: where the form stands, for the forms inside it. load: called with the name
    of each system that the definition needs before it can be read (``:defsystem-depends-on``).
    """
    if not isinstance(form.cdr, Cons) or not isinstance(form.cdr.car, (str, Symbol)):
        return error(CompileError("DEFSYSTEM: the name of a system comes first, a string or a symbol, in ~S.", form))
    name = component_name(form.cdr.car)
    items = list(form.cdr.cdr or ())
    if len(items) % 2:
        return error(CompileError("DEFSYSTEM ~A: the options must be pairs of a keyword and a value.", name))
    table = _options(name, items)
    for other in _listed(name, "DEFSYSTEM-DEPENDS-ON", table.get("DEFSYSTEM-DEPENDS-ON")):
        if load is not None and (needed := _dependency(name, other)):
            load(needed[0])
    cls = _class_named(table["CLASS"], PackageInferredSystem) if table.get("CLASS") else System
    table = {**{symbol_name(key): thunk() for key, thunk in default_initargs(cls).items()}, **table}
    made = _made(cls, name, folder)
    made.file = file
    made.path = _path(table.get("PATHNAME"))
    made.options = {key: value for key, value in table.items() if key in _TEXT_OPTIONS}
    made.options["VERSION"] = _version(table.get("VERSION"), folder)
    made.depends_on = [needed for item in _listed(name, "DEPENDS-ON", table.get("DEPENDS-ON")) if (needed := _dependency(name, item))]
    made.around_compile = table.get("AROUND-COMPILE")
    made.components = _components(made, table)
    _in_order_to(made, table.get("IN-ORDER-TO"))
    system = systems.get(name)
    if system is None:
        system = systems[name] = made
    else:
        for method in system.methods:
            remove_method(PERFORM, method)
        system.__class__ = type(made)
        vars(system).update(vars(made))
        for component in system.components:
            component.parent = system
    _perform_methods(system, items, positions)
    return system


def _perform_methods(component, items, positions=None):
    """Add the methods of the options ``:perform`` in the list ``items`` of keywords and values."""
    for key, value in zip(items[::2], items[1::2]):
        if isinstance(key, Symbol) and symbol_name(key) == "PERFORM":
            _perform_method(component, value, positions)


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


def component_name(designator):
    """As a string; a symbol stands for its name in lower case, as for ASDF."""
    name = string_designator(designator)
    return name if isinstance(designator, str) else name.lower()


def _path(value):
    """The path in an option ``:pathname``, a string or a pathname; ``None`` without one."""
    return None if value is None else Path(value)


def _version(value, folder):
    """The version: a string, or ``(:read-file-form "file")``, ``(:read-file-line "file")``."""
    if isinstance(value, Cons) and is_symbol(value.car) and isinstance(value.cdr, Cons):
        text = (Path(folder) / str(value.cdr.car)).read_text(encoding="utf-8")
        line = next((line for line in text.splitlines() if line.strip() and not line.startswith(";")), "")
        return line.strip().strip('"')
    return value if isinstance(value, str) else None


def holds(expression):
    """Whether a feature expression holds."""
    if isinstance(expression, Cons):
        operator, operands = symbol_name(expression.car), list(expression.cdr or ())
        if operator == "NOT":
            return not holds(operands[0])
        return (all if operator == "AND" else any)(map(holds, operands))
    return any(present is keyword(symbol_name(expression)) for present in FEATURES.value or ())


def _dependency(system, item):
    """(name, least version or ``None``) of a system; ``None`` when a feature that it is needed for is missing."""
    if isinstance(item, Cons) and is_symbol(item.car) and isinstance(item.cdr, Cons):
        kind, parts = symbol_name(item.car), list(item)
        if kind == "FEATURE" and len(parts) == 3:
            return _dependency(system, parts[2]) if holds(parts[1]) else None
        if kind == "VERSION" and len(parts) == 3 and isinstance(parts[2], str):
            return component_name(parts[1]), parts[2]
        if kind == "REQUIRE" and len(parts) == 2:
            return string_designator(parts[1]).lower(), None
    elif isinstance(item, (str, Symbol)):
        return component_name(item), None
    return error(
        CompileError(
            'DEFSYSTEM ~A: a system to depend on is a name, (:version name "1.0"), (:feature feature name) or (:require name), not ~S.',
            system,
            item,
        )
    )


# ------------------------------------------------------------------------------------------------------------- components


def _components(parent, table):
    """The components of a system or module, those that its features allow, each with ``parent``."""
    system, form = parent.system.name, table.get("COMPONENTS")
    if isinstance(form, Cons) and isinstance(form.car, Symbol):
        style_warn(
            "DEFSYSTEM ~A: :COMPONENTS should be a list of components, but it is the single component (~S ...); taken as a list of one.",
            system,
            form.car,
        )
        form = Cons(form, None)
    inherited = parent.parent and parent.parent.default_component_class
    parent.default_component_class = table.get("DEFAULT-COMPONENT-CLASS") or inherited
    made = [component for item in _listed(system, "COMPONENTS", form) if (component := _component(parent, item)) is not None]
    if table.get("SERIAL") is not None:
        for earlier, later in zip(made, made[1:]):
            later.depends_on.append(earlier.name)
    return made


_KINDS = {
    "FILE": SourceFile,
    "CL-SOURCE-FILE": SourceFile,
    "CL-SOURCE-FILE.CL": ClFile,
    "CL-SOURCE-FILE.LSP": LspFile,
    "MODULE": Module,
    "DOC-FILE": DocFile,
    "HTML-FILE": HtmlFile,
}


def _component(parent, form):
    system = parent.system.name
    if (
        not isinstance(form, Cons)
        or not isinstance(form.cdr, Cons)
        or not isinstance(form.car, Symbol)
        or not isinstance(form.cdr.car, (str, Symbol))
    ):
        return error(CompileError('DEFSYSTEM ~A: a component is (:file "name" ...) or (:module "name" ...), not ~S.', system, form))
    options = _component_options(system, form)
    if "IF-FEATURE" in options and not holds(options["IF-FEATURE"]):
        parent.without.add(component_name(form.cdr.car))
        return None
    depends = [
        component_name(item.cdr.cdr.car if isinstance(item, Cons) else item)
        for item in _listed(system, "DEPENDS-ON", options.get("DEPENDS-ON"))
        if not isinstance(item, Cons) or holds(item.cdr.car)
    ]  # (:feature f "x")
    made = _made(_class_of_component(parent, form.car), component_name(form.cdr.car), parent, depends, _path(options.get("PATHNAME")))
    made.around_compile = options.get("AROUND-COMPILE")
    _perform_methods(made, list(form.cdr.cdr or ()))
    if isinstance(made, Module):
        made.components = _components(made, options)
    return made


def _class_of_component(parent, kind):
    """The class of a component: ASDF's, or one that the program has made of it with ``defclass``, in the current package or ASDF."""
    if symbol_name(kind) == "FILE" and parent.default_component_class is not None:
        kind = parent.default_component_class
    return _class_named(kind, _KINDS.get(symbol_name(kind), StaticFile))


def _class_named(kind, default):
    """The class of components that the symbol or string ``kind`` names: that of the program, or ``default``."""
    places = [kind.package] if isinstance(kind, Symbol) and not isinstance(kind, Keyword) else [PACKAGE.value, find_package("ASDF")]
    symbols = [place.lookup(string_designator(kind).upper())[0] for place in places if place is not None]
    known = [cls for symbol in symbols if isinstance(symbol, Symbol) and issubclass(cls := find_class(symbol, None) or object, Component)]
    return known[0] if known else default


def _own_class(cls):
    """The class of ASDF that a class of components is, or is made of."""
    return next(base for base in cls.__mro__ if base.__module__ == __name__)


def is_of_program(component):
    """Whether the class of a component is one of the program's own."""
    return type(component).__module__ != __name__


def _made(cls, *parts):
    """The component or system of the class ``cls``; one of the program's own is made as ``make-instance`` makes it."""
    ours = _own_class(cls)
    if cls is ours:
        return cls(*parts)
    made = sym("MAKE-INSTANCE").function(cls, keyword("NAME"), parts[0], keyword("ALLOW-OTHER-KEYS"), True)
    ours.__init__(made, *parts)
    return made


def _component_options(system, form):
    options, rest = {}, form.cdr.cdr
    while isinstance(rest, Cons) and isinstance(rest.cdr, Cons) and isinstance(rest.car, Symbol):
        name = symbol_name(rest.car)
        options[name] = rest.cdr.car
        if name == "COMPONENTS" and isinstance(rest.cdr.car, Cons) and isinstance(rest.cdr.car.car, Symbol):
            # (:module "src" :components (:file ...) (:file ...)): the list was forgotten, as on a slide of lecture 38
            style_warn(
                "DEFSYSTEM ~A: :COMPONENTS of ~S should be a list of components; the components that follow are taken as that list.",
                system,
                form.cdr.car,
            )
            options["COMPONENTS"] = rest.cdr
            return options
        rest = rest.cdr.cdr
    if rest is not None:
        error(CompileError("DEFSYSTEM ~A: after its name, the component ~S has pairs of a keyword and a value.", system, form))
    return options


# ------------------------------------------------------------------------------------------------------------- operations


def _in_order_to(system, form):
    """``:in-order-to ((test-op (test-op "x")))``: what is done first. What loading needs is another dependency."""
    for entry in _listed(system.name, "IN-ORDER-TO", form):
        if (
            not isinstance(entry, Cons)
            or not is_symbol(entry.car)
            or not all(isinstance(step, Cons) and is_symbol(step.car) for step in entry.cdr or ())
        ):
            return error(
                CompileError("DEFSYSTEM ~A: :IN-ORDER-TO is a list of (operation (operation system ...) ...), not ~S.", system.name, form)
            )
        for step in entry.cdr or ():
            names = [component_name(name) for name in step.cdr or ()]
            if symbol_name(entry.car) == "TEST-OP":
                system.in_order_to.setdefault("TEST-OP", []).append((symbol_name(step.car), names))
            else:
                system.depends_on += [(name, None) for name in names]


def _perform_method(component, form, positions):
    """``:perform (test-op [qualifier] (operation component) . body)``: a method for this system, file or module."""
    parts = list(form) if isinstance(form, Cons) else []
    qualifiers = [parts.pop(1)] if len(parts) > 1 and isinstance(parts[1], Symbol) else []
    if len(parts) < 2 or not is_symbol(parts[0]) or not isinstance(parts[1], Cons) or len(list(parts[1])) != 2:
        return error(CompileError("DEFSYSTEM ~A: :PERFORM is (operation (o c) form ...), not ~S.", component.name, form))
    operation = OPERATIONS.get(symbol_name(parts[0])) or find_class(parts[0], None)
    if not (isinstance(operation, type) and issubclass(operation, Operation)):
        return error(
            CompileError(
                "DEFSYSTEM ~A: :PERFORM of the unknown operation ~S; there are ~{~A~^, ~}.",
                component.name,
                parts[0],
                list_from([name.lower() for name in OPERATIONS]),
            )
        )
    variables = [item.car if isinstance(item, Cons) else item for item in parts[1]]
    function = evaluate(
        lisp_list(sym("LAMBDA"), list_from(variables), lisp_list(sym("DECLARE"), lisp_list(sym("IGNORABLE"), *variables)), *parts[2:]),
        str(component.system.file) if component.system.file else None,
        positions,
    )
    component.methods.append(add_method(PERFORM, qualifiers, [operation, EqlSpecializer(component)], function, uses_next=False))
    return None
