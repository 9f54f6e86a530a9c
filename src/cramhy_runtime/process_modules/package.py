"""The faces of the process modules: CRAM-PROCESS-MODULES and CRAM-EXECUTIVE (process-modules.md section 9)."""

from __future__ import annotations

from ..designators import package as _designators  # noqa: F401  these packages use its names
from ..lisp.faces import define_face
from . import asynchronous, executing, executive, macro_support, matching, modules, readers, registry
from . import printing as _printing  # noqa: F401

FUNCTIONS = {
    modules: "pm-run",
    executing: "pm-execute pm-cancel pm-status running-fluent finished-fluent monitor-process-module",
    asynchronous: "on-input on-cancel on-run synchronization-fluent finish-process-module fail-process-module",
    matching: "pm-execute-matching matching-process-module-names matching-available-process-modules",
    registry: "register-process-module process-module-alias get-running-process-module get-running-process-module-name "
              "get-process-module-names get-running-process-module-names wait-for-process-module-running",
    readers: "input cancel caller",
}

EXPORTED = """process-module abstract-process-module asynchronous-process-module def-process-module def-asynchronous-process-module
    with-process-modules-running with-process-module-aliases with-process-module-registered-running on-process-module-started
    on-process-module-finished matching-process-module available-process-module projection-running *process-module-debugger-hook*
    terminate-pm continue-pm feedback priority"""


def define_faces():
    """Declare the packages. Those of CPL and of the designators must exist."""
    define_face("CRAM-PROCESS-MODULES", ["CPM"], use=["CRAM-LANGUAGE", "CRAM-DESIGNATORS"],
                imports={"CRAM-PROLOG": "def-fact-group <- fail", "CPL-IMPL": "name result status"}, functions=FUNCTIONS,
                export=EXPORTED, internal="def-fact-group <- fail")
    define_face("CRAM-EXECUTIVE", ["EXE"], use=["CRAM-LANGUAGE", "CRAM-DESIGNATORS"],
                functions={executive: "perform generic-perform try-reference-designator"},
                export="designator-reference-failure designator-goal-parsing-failure")
    macro_support.define()


define_faces()
