"""The packages COMMON-LISP, COMMON-LISP-USER and CRAMHY: which function each symbol names.

Every module of this room lists its Lisp names in ``LISP_NAMES`` and its setters in ``SETTERS``; here they come together.
"""

from __future__ import annotations

import importlib

from . import cl_names, extension_packages, python_packages
from .faces import define_face, lispify
from .packages import COMMON_LISP, sym

MODULES = tuple("""equality functions lists list_search sequences sequence_change sequence_mapping sequence_search sequence_sort
    strings characters hash_tables arrays array_making arithmetic rounding irrational bits random_state numbers types classes
    class_definition slots protocol generic structures streams stream_functions file_streams pathnames wild_pathnames
    logical_pathnames files file_stream_functions universal_time environment program_files printer pretty pprint_dispatch
    format reader tokens readtables reader_functions symbols package_functions declarations control forms documentation describing
    inspecting apropos disassembling tracing""".split())
"""The modules that define functions of Common Lisp; later ones win where two define a name."""

HELPERS = {
    "class_definition": "slot-spec define-class define-condition",
    "generic": "define-generic define-method",
    "method_combination": "define-short-combination define-long-combination",
    "structures": "structure-slot define-structure unsupplied",
    "types": "define-type",
    "printing_support": """pprint-logical-block pprint-pop pprint-list-exhausted print-unreadable-object formatter
        make-fill-pointer-output-stream stream-position with-standard-io-syntax""",
    "file_streams": "with-open-file with-open-stream",
    "assertions": "assertion-failed assertion-prompt",
    "forms": "define-compiler-macro",
    "declarations": "declaim",
    "compilation_unit": "with-compilation-unit",
    "definitions": "define-function define-macro define-variable define-constant define-symbol-macro",
    "loop_support": "car-of-cons cdr-of-cons end-of-list collect collect-append collect-nconc loop-vector table-entries loop-symbols",
    "places_in_source": "source-position",
    "places": "define-modifier define-setf-function define-setf-form define-expander",
    "expansion_support": """check-shape key-table key-given-p key-value case-failure ask-for-value check-type-failed
        handler-bind handler-case restart-report restart-case restart-bind with-simple-restart
        signal-with-restarts with-condition-restarts hash-table-iterator
        put-property remove-property next-method-exists""",
    "package_definition": "define-package set-package package-symbols all-symbols package-iterator call-unlocked",
    "tracing": "trace untrace time step",
}


def fill():
    """Define the faces; called once, by `image.boot`."""
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
    for name in ("clos_printing", "file_printers"):  # teach the printer about classes, pathnames, streams
        importlib.import_module(f"{__package__}.{name}")
    for name, names in HELPERS.items():
        define_face("CRAMHY", functions={importlib.import_module(f"{__package__}.{name}"): names})
    extension_packages.define_faces()
    python_packages.define_faces()
    COMMON_LISP.locked = True


_standard = set(cl_names.NAMES.split())
