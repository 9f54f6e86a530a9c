"""What can be asked of an episode: its times, its tasks, and what its fluents were (projection-and-events.md C1).

Each function takes the episode as last argument; without it, it is about ``*episode-knowledge*``.
"""

from __future__ import annotations

from cramhy_runtime.cpl.tree.task_tree import goal_task_tree_node_p
from cramhy_runtime.lisp_core.conditions import warn
from cramhy_runtime.lisp_core.data import UNSUPPLIED, Cons, lisp_list, list_from
from cramhy_runtime.lisp_core.packages import near_names
from cramhy_runtime.lisp_core.printing import prin1_to_string
from ..utilities.small_functions import current_timestamp
from .knowledge import checked, current_episode
from .symbols import sym
from .tracing import tracing
from .trees import nodes_of, tree_or_error

THROUGHOUT = sym("CRAM-EXECUTION-TRACE::THROUGHOUT")
AFTER_THE_LAST = 0.1
"""Seconds from the last that is known of an episode to its max time."""


def asked(episode):
    """The episode that a query is about."""
    return checked(current_episode() if episode is UNSUPPLIED else episode)


def episode_knowledge_zero_time(episode=UNSUPPLIED):
    """When it began: seconds, a double-float."""
    return asked(episode).zero_time


def episode_knowledge_end_time(episode=UNSUPPLIED):
    """When it ended; nil while it runs."""
    return asked(episode).end_time


def episode_knowledge_max_time(episode=UNSUPPLIED):
    """A time at which everything that is known of the episode is over: 0.1 s after its end and its latest record."""
    episode = asked(episode)
    times = [records[-1].timestamp for records in episode.traces.values() if records]
    if episode.end_time is not None:
        times.append(episode.end_time)
    elif episode.running:
        times.append(current_timestamp())
    return float(round(max(times) + AFTER_THE_LAST, 3)) if times else None


def episode_knowledge_task_tree(episode=UNSUPPLIED):
    """The root node of the tasks that ran; an error if none did."""
    return tree_or_error(asked(episode))


def episode_knowledge_task_list(episode=UNSUPPLIED):
    """All nodes of the task tree, parents before children."""
    return list_from(nodes_of(tree_or_error(asked(episode))))


def episode_knowledge_goal_task_list(episode=UNSUPPLIED):
    """The nodes of the task tree that are goals."""
    return list_from([node for node in nodes_of(tree_or_error(asked(episode))) if goal_task_tree_node_p(node)])


def episode_knowledge_traced_fluent_names(episode=UNSUPPLIED):
    """The names of the traced fluents, in the order of their first records."""
    return list_from(list(asked(episode).traces))


def fluent_changes(name, episode):
    """What the fluent ``name`` was: a Python list of pairs (value, seconds), in order."""
    return [(record.traced_value, record.timestamp) for record in _records(name, episode)]


def fluent_durations(name, episode):
    """What the fluent ``name`` was for how long: a Python list of (value, start, end); the last ends at the max time."""
    records = _records(name, episode)
    ends = [record.timestamp for record in records[1:]]
    ends.append(episode_knowledge_max_time(episode) if records else None)
    return [(record.traced_value, record.timestamp, end) for record, end in zip(records, ends, strict=False)]


def episode_knowledge_fluent_changes(fluent_name, episode=UNSUPPLIED):
    """A list of ``(value . time)``; for a fluent that was not traced a warning and nil."""
    episode = asked(episode)
    _warn_if_unknown(fluent_name, episode)
    return list_from([Cons(value, time) for value, time in fluent_changes(fluent_name, episode)])


def episode_knowledge_fluent_durations(fluent_name, episode=UNSUPPLIED):
    """A list of ``(value throughout start end)``; for a fluent that was not traced a warning and nil."""
    episode = asked(episode)
    _warn_if_unknown(fluent_name, episode)
    return list_from([lisp_list(value, THROUGHOUT, start, end) for value, start, end in fluent_durations(fluent_name, episode)])


def _records(name, episode):
    return episode.traces.get(name, ())


def _warn_if_unknown(name, episode):
    if name in episode.traces:
        return
    known = {prin1_to_string(other): other for other in episode.traces}
    near = near_names(prin1_to_string(name), known, 1)
    if near:
        advice = f"Did you mean {near[0]}?"
    elif known:
        advice = f"Traced were {', '.join(list(known)[:7])}{', ...' if len(known) > 7 else ''}."
    else:
        advice = "Nothing was traced: call (enable-fluent-tracing) before the plan." if not tracing.on else "Nothing was traced."
    warn("No fluent named ~s was traced in this episode. ~a", name, advice)
