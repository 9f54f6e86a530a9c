"""Episodes: what a plan did, to be looked at while it runs and afterwards. Usable from Python:

    from cramhy_runtime import episodes

    episodes.enable_fluent_tracing()
    cpl.top_level(plan)
    episodes.fluent_changes(robot_pose.name, episodes.last_episode())    # [(value, seconds), ...]

Where the parts are:

* `knowledge`  episodes: the running one, the last one, the last one of a name
* `trees`      the tasks of an episode
* `tracing`    recording what fluents were, when somebody asked for it
* `queries`    what can be asked of an episode
* `symbols`    the Lisp package

Files hold episodes in Lisp's notation, so the Lisp face saves and loads them: ``languages/commonlisp/faces/episodes/files.py``.

Reference: projection-and-events.md part C.
"""

from .knowledge import (
    EpisodeKnowledge,
    current_episode,
    get_top_level_episode_knowledge,
    last_episode,
    with_episode_knowledge,
    with_last_episode_knowledge,
    with_top_level_episode_knowledge,
)
from .queries import fluent_changes
from .tracing import disable_fluent_tracing, durable_copy, enable_fluent_tracing, fluent_tracing_enabled

__all__ = [
    "current_episode", "disable_fluent_tracing", "durable_copy", "enable_fluent_tracing", "EpisodeKnowledge", "fluent_changes",
    "fluent_tracing_enabled", "get_top_level_episode_knowledge", "last_episode", "with_episode_knowledge", "with_last_episode_knowledge",
    "with_top_level_episode_knowledge",
]  # fmt: skip
