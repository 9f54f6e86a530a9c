"""What the macros of CRAM-EXECUTION-TRACE call, as functions of the package CRAMHY."""

from __future__ import annotations

from ....operators import EPISODES
from ...packages.face_definition import define_face, define_meanings
from . import backends, files
from cramhy_runtime.episodes import knowledge


def define():
    """Enter the functions into CRAMHY."""
    define_meanings(EPISODES, knowledge)
    define_face(
        "CRAMHY",
        functions={
            "with-offline-episode-knowledge": files.with_offline_episode_knowledge,
            "define-episode-store": backends.define_store,
            "define-episode-restore": backends.define_restore,
        },
    )
