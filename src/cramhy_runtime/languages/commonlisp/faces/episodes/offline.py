"""Episodes that were read from a file, and the tasks in their trees.

An `OfflineTask` tells what a task of a plan tells when it is dead, so that every query works on both: its result and status, when it
ran, and its status fluent, which has its last value. Nothing of it can run again.
"""

from __future__ import annotations

from cramhy_runtime.cpl.fluents.fluents import ValueFluent
from cramhy_runtime.cpl.tasks.task_readers import result, status
from cramhy_runtime.lisp_core.printing import define_printer, print_unreadable
from cramhy_runtime.episodes.knowledge import EpisodeKnowledge


class OfflineEpisodeKnowledge(EpisodeKnowledge):
    """The episode in a file: as that of a plan of this session, but for what can only be asked of living tasks."""

    lisp_name = "CRAM-EXECUTION-TRACE::OFFLINE-EPISODE-KNOWLEDGE"
    root = None

    def tree(self):
        return self.root


class OfflineTask:
    """What a file tells of a task: ``name``, ``status``, ``result``, ``path``, ``started_at`` and ``ended_at`` (time stamps, or nil),
    and the ``status_fluent`` of the ``status_name``."""

    lisp_name = "CRAM-EXECUTION-TRACE::OFFLINE-TASK"
    unexecuted = False

    def __init__(self, name, task_status, task_result, path, started_at, ended_at, status_name):
        self.name, self.status, self.result, self.path = name, task_status, task_result, path
        self.started_at, self.ended_at = started_at, ended_at
        self.status_fluent = ValueFluent(status_name, task_status)


def define():
    """Let Common Lisp see it; called once, when the image is made."""
    status.method(OfflineTask)(lambda task: task.status_fluent)
    result.method(OfflineTask)(lambda task: task.result)
    define_printer(OfflineTask, lambda task, stream: print_unreadable(task, stream, f'OFFLINE-TASK "{task.name}"'))
