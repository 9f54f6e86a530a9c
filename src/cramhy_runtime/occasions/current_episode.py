"""Which episode the predicates of this room ask: the current one. Without one they warn, and fail."""

from __future__ import annotations

from cramhy_runtime.episodes.knowledge import current_episode
from cramhy_runtime.episodes.trees import nodes_of
from cramhy_runtime.ground.conditions import SimpleWarning, warn
from cramhy_runtime.ground.packages import sym


def asked_episode(predicate):
    """The current episode, or ``None`` after a warning that ``predicate``, a designator, would need one."""
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
    """All nodes of the task tree of the current episode, parents before children; none, after a warning, without an episode."""
    episode = asked_episode(predicate)
    root = None if episode is None else episode.tree()
    return [] if root is None else nodes_of(root)
