"""The face of the episodes: CRAM-EXECUTION-TRACE (projection-and-events.md C4)."""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import lisp_list
from ...packages.face_definition import define_face
from ...syntax.operator_macros import export
from ....operators import EPISODES
from cramhy_runtime.lisp_core.dispatch.generic_functions import generic
from . import auto_tracing, files
from cramhy_runtime.episodes import knowledge, queries, tracing
from . import macro_support
from cramhy_runtime.episodes.symbols import CET, sym
from cramhy_runtime.episodes.tracing import TracedFluent

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
    traced-fluent timestamp name traced-value"""

traced_value = generic("CRAM-EXECUTION-TRACE::TRACED-VALUE", "(traced-fluent)", documentation="The value that a record of the trace tells.")


def define_faces():
    """Declare the package."""
    define_face(
        "CRAM-EXECUTION-TRACE",
        ["CET"],
        use=["COMMON-LISP", "CRAM-UTILITIES", "CRAM-LANGUAGE-IMPLEMENTATION"],
        functions=FUNCTIONS,
        export=EXPORTED,
        internal="episode-knowledge-end-time",
    )
    files.save_episode_knowledge.__lisp_lambda_list__ = lisp_list(
        CET.intern("DESTINATION"),
        sym("&OPTIONAL"),
        lisp_list(CET.intern("EPISODE"), knowledge.EPISODE),
        sym("&REST"),
        CET.intern("KEY-ARGS"),
    )
    export(EPISODES)
    macro_support.define()


__all__ = ["CET"]


def define():
    """Let Common Lisp see it; called once, when the image is made."""
    traced_value.method(TracedFluent)(lambda record: record.traced_value)
    define_faces()
