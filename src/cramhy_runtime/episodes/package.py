"""The face of the episodes: CRAM-EXECUTION-TRACE (projection-and-events.md C4). The macros are in ``hy_src/cramhy/cet.hy``."""

from __future__ import annotations

from ..cpl import package as _cpl  # noqa: F401  CPL-IMPL:NAME is exported here too
from ..lisp.data import lisp_list
from ..lisp.faces import define_face
from ..lisp.objects.generic import generic
from . import auto_tracing, files, knowledge, macro_support, queries, tracing
from . import printing as _printing  # noqa: F401
from .symbols import CET, sym
from .tracing import TracedFluent

FUNCTIONS = {
    knowledge: "get-top-level-episode-knowledge register-top-level-episode-knowledge",
    queries: "episode-knowledge-zero-time episode-knowledge-max-time episode-knowledge-task-tree episode-knowledge-task-list "
             "episode-knowledge-goal-task-list episode-knowledge-traced-fluent-names episode-knowledge-fluent-changes "
             "episode-knowledge-fluent-durations episode-knowledge-end-time",
    files: "save-episode-knowledge save-last-episode-knowledge load-episode-knowledge",
    tracing: "durable-copy enable-fluent-tracing disable-fluent-tracing fluent-tracing-enabled",
    auto_tracing: "enable-auto-tracing disable-auto-tracing auto-tracing-enabled set-auto-tracing-directory setup-auto-tracing",
}

EXPORTED = """throughout episode-knowledge live-episode-knowledge offline-episode-knowledge *episode-knowledge* *last-episode-knowledge*
    defstore-episode-knowledge-backend defrestore-episode-knowledge-backend with-episode-knowledge with-last-episode-knowledge
    with-top-level-episode-knowledge with-offline-episode-knowledge traced-fluent timestamp name traced-value"""

traced_value = generic("CRAM-EXECUTION-TRACE::TRACED-VALUE", "(traced-fluent)", documentation="The value that a record of the trace tells.")
traced_value.method(TracedFluent)(lambda record: record.traced_value)


def define_faces():
    """Declare the package."""
    define_face("CRAM-EXECUTION-TRACE", ["CET"], use=["COMMON-LISP", "CRAM-UTILITIES", "CRAM-LANGUAGE-IMPLEMENTATION"],
                functions=FUNCTIONS, export=EXPORTED, internal="episode-knowledge-end-time")
    files.save_episode_knowledge.__lisp_lambda_list__ = lisp_list(
        CET.intern("DESTINATION"), sym("&OPTIONAL"), lisp_list(CET.intern("EPISODE"), knowledge.EPISODE), sym("&REST"),
        CET.intern("KEY-ARGS"))
    macro_support.define()


define_faces()

__all__ = ["CET"]
