"""The predicates of this room ask about the current episode. Without one they warn, and fail."""

from __future__ import annotations

from cramhy_runtime.episodes.knowledge import current_episode
from cramhy_runtime.episodes.trees import nodes_of
from cramhy_runtime.lisp_core.conditions import SimpleWarning, warn
from cramhy_runtime.lisp_core.packages import sym


def asked_episode(predicate):
    """The current episode. If there is none, warn that ``predicate``, the name of a functor, needs one, and return ``None``."""
    episode = current_episode()
    if episode is None:
        warn(
            SimpleWarning(
                "[PROLOG WARNING] ~s asks an episode, and *EPISODE-KNOWLEDGE* is nil. Write (with-last-episode-knowledge ...) "
                "around the query.",
                sym(predicate),
            )
        )
    return episode


def asked_nodes(predicate):
    """All nodes of the task tree of the current episode, parents before children. Without an episode warn, and return none."""
    episode = asked_episode(predicate)
    root = None if episode is None else episode.tree()
    return [] if root is None else nodes_of(root)
