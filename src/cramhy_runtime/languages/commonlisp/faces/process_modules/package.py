"""The faces of the process modules: CRAM-PROCESS-MODULES and CRAM-EXECUTIVE (process-modules.md section 9)."""

from __future__ import annotations

from cramhy_runtime.lisp_core.dispatch.open_functions import open_to_methods
from ...packages.face_definition import define_face
from ...syntax.operator_macros import export
from ....operators import PROCESS_MODULES
from cramhy_runtime.process_modules import asynchronous, executing, executive, matching, modules, registry
from . import macro_support, readers

FUNCTIONS = {
    modules: "pm-run",
    executing: "pm-execute pm-cancel pm-status running-fluent finished-fluent monitor-process-module",
    asynchronous: "on-input on-cancel on-run synchronization-fluent finish-process-module fail-process-module",
    matching: "pm-execute-matching matching-process-module-names matching-available-process-modules",
    registry: "register-process-module process-module-alias get-running-process-module get-running-process-module-name "
    "get-process-module-names get-running-process-module-names wait-for-process-module-running",
    readers: "input cancel caller",
}

EXPORTED = """process-module abstract-process-module asynchronous-process-module on-process-module-started on-process-module-finished
    matching-process-module available-process-module projection-running *process-module-debugger-hook* terminate-pm continue-pm
    feedback priority"""


def define_faces():
    """Declare the packages. Those of CPL and of the designators must exist."""
    define_face(
        "CRAM-PROCESS-MODULES",
        ["CPM"],
        use=["CRAM-LANGUAGE", "CRAM-DESIGNATORS"],
        imports={"CRAM-PROLOG": "def-fact-group <- fail", "CPL-IMPL": "name result status"},
        functions=FUNCTIONS,
        generic="input cancel caller",
        export=EXPORTED,
        internal="def-fact-group <- fail",
    )
    define_face(
        "CRAM-EXECUTIVE",
        ["EXE"],
        use=["CRAM-LANGUAGE", "CRAM-DESIGNATORS"],
        functions={executive: "perform generic-perform try-reference-designator call-plan-with-designator-properties"},
        export="designator-reference-failure designator-goal-parsing-failure",
    )
    open_to_methods(
        executive.try_reference_designator,
        "EXE::TRY-REFERENCE-DESIGNATOR",
        method=executive.plain_reference,
        when_opened=executive.reference_through,
    )
    export(PROCESS_MODULES)
    macro_support.define()


def define():
    """Let Common Lisp see it; called once, when the image is made."""
    define_faces()
