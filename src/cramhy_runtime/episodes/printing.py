"""How episodes are printed, and described."""

from __future__ import annotations

from ..lisp.data import list_from
from ..lisp.printer.printer import define_printer, prin1_to_string, print_unreadable
from ..lisp.tools.describing import describe_facts, describe_object
from .knowledge import EpisodeKnowledge
from .trees import nodes_of


def print_episode(episode, stream):
    """``#<LIVE-EPISODE-KNOWLEDGE PLAN {address}>``"""
    print_unreadable(episode, stream, prin1_to_string(episode.plan_name), type_=True, identity=True)


define_printer(EpisodeKnowledge, print_episode)


@describe_object.method(EpisodeKnowledge, None)
def describe_episode(episode, stream):
    """Its plan, its times, how many tasks ran, and which fluents were traced."""
    root = episode.tree()
    return describe_facts(episode, stream, "episode", [
        ("Plan", episode.plan_name), ("Began at", episode.zero_time), ("Ended at", episode.end_time),
        ("Tasks", 0 if root is None else len(nodes_of(root))), ("Traced fluents", list_from(list(episode.traces)))])
