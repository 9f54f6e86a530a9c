"""What the macros of CRAM-EXECUTION-TRACE call, as functions of the package CRAMHY."""

from __future__ import annotations

from ...packages.face_definition import define_face
from . import backends, files
from cramhy_runtime.episodes import knowledge


def define():
    """Enter the functions into CRAMHY."""
    define_face(
        "CRAMHY",
        functions={
            "with-episode-knowledge": knowledge.with_episode_knowledge,
            "with-last-episode-knowledge": knowledge.with_last_episode_knowledge,
            "with-top-level-episode-knowledge": knowledge.with_top_level_episode_knowledge,
            "with-offline-episode-knowledge": files.with_offline_episode_knowledge,
            "define-episode-store": backends.define_store,
            "define-episode-restore": backends.define_restore,
        },
    )
