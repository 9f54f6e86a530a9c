"""How episodes are printed, and described."""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import list_from
from cramhy_runtime.lisp_core.printing import define_printer, print_unreadable
from cramhy_runtime.lisp_core.printing import prin1_to_string
from ...tools.describing import describe_facts, describe_object
from cramhy_runtime.episodes.knowledge import EpisodeKnowledge
from cramhy_runtime.episodes.trees import nodes_of


def print_episode(episode, stream):
    """``#<LIVE-EPISODE-KNOWLEDGE PLAN {address}>``"""
    print_unreadable(episode, stream, prin1_to_string(episode.plan_name), type_=True, identity=True)


def describe_episode(episode, stream):
    """Its plan, its times, how many tasks ran, and which fluents were traced."""
    root = episode.tree()
    return describe_facts(
        episode,
        stream,
        "episode",
        [
            ("Plan", episode.plan_name),
            ("Began at", episode.zero_time),
            ("Ended at", episode.end_time),
            ("Tasks", 0 if root is None else len(nodes_of(root))),
            ("Traced fluents", list_from(list(episode.traces))),
        ],
    )


def define():
    """Let Common Lisp see it; called once, when the image is made."""
    define_printer(EpisodeKnowledge, print_episode)
    describe_object.method(EpisodeKnowledge, None)(describe_episode)
