"""The packages COMMON-LISP, COMMON-LISP-USER and CRAMHY: which function each symbol names.

Every module of this room lists its Lisp names in ``LISP_NAMES`` and its setters in ``SETTERS``; here they come together.
"""

from __future__ import annotations

import importlib

from . import cl_names
from .faces import define_face, lispify
from .packages import COMMON_LISP, sym
from .python import python_packages
from .symbols import extension_packages

MODULES = tuple("""equality evaluation.functions collections.lists collections.list_search collections.sequences
    collections.sequence_change collections.sequence_mapping collections.sequence_search collections.sequence_sort
    collections.strings collections.characters collections.hash_tables collections.arrays collections.array_making
    numbers.arithmetic numbers.rounding numbers.irrational numbers.bits numbers.random_state numbers.numbers
    types.types objects.classes objects.class_definition objects.slots objects.protocol objects.generic
    objects.structures streams.streams streams.stream_functions streams.file_streams files.pathnames
    files.wild_pathnames files.logical_pathnames files.files streams.file_stream_functions
    evaluation.universal_time evaluation.environment files.program_files printer.printer printer.pretty
    printer.pprint_dispatch format.format reader.reader reader.tokens reader.readtables reader.reader_functions
    symbols.symbols symbols.package_functions evaluation.declarations evaluation.control evaluation.forms
    tools.documentation tools.describing tools.inspecting tools.apropos tools.disassembling tools.tracing""".split())
"""The modules that define functions of Common Lisp; later ones win where two define a name."""

HELPERS = {
    "objects.class_definition": "slot-spec define-class define-condition",
    "objects.generic": "define-generic define-method",
    "objects.method_combination": "define-short-combination define-long-combination",
    "objects.structures": "structure-slot define-structure unsupplied",
    "types.types": "define-type",
    "printer.printing_support": """pprint-logical-block pprint-pop pprint-list-exhausted print-unreadable-object formatter
        make-fill-pointer-output-stream stream-position with-standard-io-syntax""",
    "streams.file_streams": "with-open-file with-open-stream",
    "collections.list_search": "with-property",
    "evaluation.assertions": "assertion-failed assertion-prompt",
    "evaluation.forms": "define-compiler-macro",
    "evaluation.declarations": "declaim",
    "evaluation.compilation_unit": "with-compilation-unit",
    "evaluation.definitions": "define-function define-macro define-variable define-constant define-symbol-macro",
    "loop.loop_support": "car-of-cons cdr-of-cons end-of-list collect collect-append collect-nconc loop-vector table-entries loop-symbols",
    "evaluation.places_in_source": "source-position",
    "evaluation.places": "define-modifier define-setf-function define-setf-form define-expander",
    "evaluation.expansion_support": """check-shape key-table key-given-p key-value case-failure ask-for-value check-type-failed
        handler-bind handler-case restart-report restart-case restart-bind with-simple-restart
        signal-with-restarts with-condition-restarts hash-table-iterator
        remove-property next-method-exists""",
    "symbols.package_definition": "define-package set-package package-symbols all-symbols package-iterator call-unlocked",
    "tools.tracing": "trace untrace time step",
}


_filled: list = []


def fill():
    """Define the faces. Called by `image.boot`, and by Python code that uses a room without an image; calling it again does nothing."""
    if _filled:
        return
    _filled.append(True)
    for name in MODULES:
        module = importlib.import_module(f"{__package__}.{name}")
        names = " ".join(lisp_name for lisp_name in module.LISP_NAMES.split()
                         if lisp_name in _standard) if hasattr(module, "LISP_NAMES") else ""
        functions = {module: names, **getattr(module, "LISP_FUNCTIONS", {})}
        define_face("COMMON-LISP", functions=functions, variables=getattr(module, "VARIABLES", None))
        for constant in getattr(module, "CONSTANTS", ()):
            sym(constant).constant = True
        for lisp_name, setter in getattr(module, "SETTERS", {}).items():
            sym(lisp_name).setf_function = lispify(setter)
    for name in ("objects.clos_printing", "printer.file_printers"):  # teach the printer about classes, pathnames, streams
        importlib.import_module(f"{__package__}.{name}")
    for name, names in HELPERS.items():
        define_face("CRAMHY", functions={importlib.import_module(f"{__package__}.{name}"): names})
    extension_packages.define_faces()
    python_packages.define_faces()
    COMMON_LISP.locked = True


_standard = set(cl_names.NAMES.split())
