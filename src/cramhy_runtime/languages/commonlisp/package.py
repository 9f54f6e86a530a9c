"""The packages COMMON-LISP, COMMON-LISP-USER and CRAMHY: which function each symbol names.

Every module of this room lists its Lisp names in ``LISP_NAMES`` and its setters in ``SETTERS``; here they come together.
"""

from __future__ import annotations

import importlib

from . import answers
from .packages.face_definition import define_face
from cramhy_runtime.lisp_core.data import lisp_list
from cramhy_runtime.lisp_core.keyword_calls import lispify
from cramhy_runtime.lisp_core.packages import STANDARD_NAMES, COMMON_LISP, sym
from .python import python_packages
from . import extension_packages

MODULES = tuple(
    """lisp_core.equality lisp_core.functions collections.lists collections.list_search collections.sequences
    collections.sequence_change collections.sequence_mapping collections.sequence_search collections.sequence_sort
    collections.strings collections.characters lisp_core.hash_tables collections.arrays collections.array_making
    numbers.arithmetic numbers.rounding numbers.irrational numbers.bits numbers.random_state numbers.numbers
    types.types types.coercion types.type_relations objects.classes objects.class_definition objects.slots
    objects.protocol lisp_core.dispatch.generic_functions objects.structures streams.streams streams.stream_functions
    files.file_streams pathnames.pathnames pathnames.wild_pathnames pathnames.logical_pathnames files.files files.file_stream_functions
    evaluation.universal_time evaluation.environment systems.program_files printer.printer printer.print_methods printer.pretty
    printer.pprint_dispatch format.format reader.reader reader.tokens reader.readtables reader.reader_functions
    evaluation.symbols packages.package_functions evaluation.declarations evaluation.control evaluation.forms
    tools.documentation tools.describing tools.inspecting tools.apropos tools.disassembling tools.tracing""".split()
)
"""The modules that define functions of Common Lisp; later ones win where two define a name."""

HELPERS = {
    "objects.class_definition": "slot-spec define-class define-condition",
    "lisp_core.dispatch.generic_functions": "define-generic define-method",
    "lisp_core.dispatch.method_combination": "define-short-combination",
    "evaluation.long_combination": "define-long-combination",
    "objects.structures": "structure-slot define-structure slot-default",
    "types.types": "define-type",
    "printer.printing_support": """pprint-logical-block pprint-pop pprint-list-exhausted print-unreadable-object
        make-fill-pointer-output-stream stream-position with-standard-io-syntax""",
    "format.format": "formatter",
    "files.file_streams": "with-open-file with-open-stream",
    "collections.list_search": "with-property",
    "evaluation.assertions": "assertion-failed assertion-prompt",
    "evaluation.forms": "define-compiler-macro",
    "evaluation.declarations": "declaim",
    "compiler.compilation_unit": "with-compilation-unit",
    "compiler.failing_macros": "reached-failing-macro",
    "evaluation.definitions": "define-function define-macro define-variable define-constant define-symbol-macro",
    "loop.loop_support": "car-of-cons cdr-of-cons end-of-list collect collect-append collect-nconc loop-vector table-entries loop-symbols",
    "lisp_core.source_places": "source-position",
    "evaluation.setf_places": "define-modifier define-setf-function define-setf-form define-expander",
    "evaluation.expansion_support": """next-values check-shape key-table key-given-p key-value case-failure ask-for-value check-type-failed
        handler-bind handler-case restart-report restart-case restart-bind with-simple-restart
        signal-with-restarts with-condition-restarts hash-table-iterator
        remove-property next-method-exists""",
    "packages.package_definition": "define-package set-package package-symbols all-symbols package-iterator call-unlocked",
    "tools.tracing": "trace untrace timed step",
}


_filled: list = []


def fill():
    """Define the faces. Called by `boot`, and by Python code that uses a room without an image; calling it again does nothing."""
    if _filled:
        return
    _filled.append(True)
    answers.install()
    for name in MODULES:
        module = _module(name)
        names = (
            " ".join(lisp_name for lisp_name in module.LISP_NAMES.split() if lisp_name in _standard)
            if hasattr(module, "LISP_NAMES")
            else ""
        )
        functions = {module: names, **getattr(module, "LISP_FUNCTIONS", {})}
        define_face("COMMON-LISP", functions=functions, variables=getattr(module, "VARIABLES", None))
        for constant in getattr(module, "CONSTANTS", ()):
            sym(constant).constant = True
        for lisp_name, setter in getattr(module, "SETTERS", {}).items():
            function = sym(lisp_name).setf_function = lispify(setter)
            if not hasattr(function, "__lisp_name__"):
                function.__lisp_name__ = lisp_list(sym("SETF"), sym(lisp_name))
    _module("objects.protocol").open_functions()
    for name in ("printer.clos_printing", "printer.file_printers"):  # teach the printer about classes, pathnames, streams
        _module(name)
    for name, names in HELPERS.items():
        define_face("CRAMHY", functions={_module(name): names})
    extension_packages.define_faces()
    python_packages.define_faces()
    COMMON_LISP.locked = True


_standard = set(STANDARD_NAMES.split())


def _module(name):
    return importlib.import_module(f"cramhy_runtime.{name}" if name.startswith("lisp_core.") else f"{__package__}.{name}")
