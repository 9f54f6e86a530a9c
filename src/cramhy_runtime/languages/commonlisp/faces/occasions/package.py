"""The face of occasions and events: CRAM-OCCASIONS-EVENTS (projection-and-events.md B5)."""

from __future__ import annotations

from cramhy_runtime.episodes.tracing import TracedFluent
from ...packages.face_definition import define_face
from cramhy_runtime.lisp_core.dispatch.generic_functions import generic
from cramhy_runtime.occasions import fluent_predicates as _fluent_predicates  # noqa: F401  the predicates come along
from cramhy_runtime.occasions import occasions
from cramhy_runtime.occasions import task_predicates as _task_predicates  # noqa: F401
from cramhy_runtime.occasions.symbols import COE, sym

EXPORTED = """clear-belief fluent fluent-value task-path top-level task goal-task task-status-fluent task-goal task-outcome task-result
    task-error error-type holds occurs task-status duration-includes task-started-at task-created-at task-ended-at subtask subtask+ at
    during event on-event event-timestamp"""


def define_faces():
    """Declare the package. Records of fluents have time stamps as designators have, and one function reads both."""
    COE.shadow("EVENT")
    for symbol in ("CRAM-PROLOG::FAIL", "CPL-IMPL::NAME"):
        COE.shadowing_import(sym(symbol))
    generic("CUT::TIMESTAMP", "(designator)").method(TracedFluent)(lambda record: record.timestamp)
    define_face(
        "CRAM-OCCASIONS-EVENTS",
        ["COE", "OCCASIONS-EVENTS"],
        use=["COMMON-LISP", "CRAM-PROLOG", "CRAM-LANGUAGE-IMPLEMENTATION", "CRAM-DESIGNATORS", "CRAM-UTILITIES"],
        functions={occasions: "assert-occasion retract-occasion holds-occasion"},
        export=EXPORTED,
        imports={"CRAM-EXECUTION-TRACE": "throughout"},
    )


def define():
    """Let Common Lisp see it; called once, when the image is made."""
    define_faces()
