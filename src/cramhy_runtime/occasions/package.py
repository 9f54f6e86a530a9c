"""The face of occasions and events: CRAM-OCCASIONS-EVENTS (projection-and-events.md B5)."""

from __future__ import annotations

from ..designators import package as _designators  # noqa: F401  these packages are used
from ..episodes import package as _episodes  # noqa: F401
from ..episodes.tracing import TracedFluent
from ..lisp.faces import define_face
from ..lisp.objects.generic import generic
from . import fluent_predicates as _fluent_predicates  # noqa: F401  the predicates come along
from . import occasions
from . import task_predicates as _task_predicates  # noqa: F401
from .symbols import COE, sym

EXPORTED = """clear-belief fluent fluent-value task-path top-level task goal-task task-status-fluent task-goal task-outcome task-result
    task-error error-type holds occurs task-status duration-includes task-started-at task-created-at task-ended-at subtask subtask+ at
    during event on-event event-timestamp"""


def define_faces():
    """Declare the package. Records of fluents have time stamps as designators have, and one function reads both."""
    COE.shadow("EVENT")
    for symbol in ("CRAM-PROLOG::FAIL", "CPL-IMPL::NAME"):
        COE.shadowing_import(sym(symbol))
    generic("CUT::TIMESTAMP", "(designator)").method(TracedFluent)(lambda record: record.timestamp)
    define_face("CRAM-OCCASIONS-EVENTS", ["COE", "OCCASIONS-EVENTS"],
                use=["COMMON-LISP", "CRAM-PROLOG", "CRAM-LANGUAGE-IMPLEMENTATION", "CRAM-DESIGNATORS", "CRAM-UTILITIES"],
                functions={occasions: "assert-occasion retract-occasion holds-occasion"}, export=EXPORTED,
                imports={"CRAM-EXECUTION-TRACE": "throughout"})


define_faces()
