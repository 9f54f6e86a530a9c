"""Following a plan: functions that are called with each task of it that starts.

A task keeps itself in the ``record`` of its parent, if that has one (``*record-task-tree*``). A plan that is followed has a `Followed`
there, which also calls functions. So a plan without followers pays nothing.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import truth
from .tasks import RECORD


class Followed(list):
    """The ``record`` of a plan that is followed: it calls each of ``followers`` with a task that is about to start.

    ``keep`` says whether it also keeps the list of all tasks, as other records do.
    """

    def __init__(self, tasks, keep):
        super().__init__(tasks)
        self.keep = keep
        self.followers = []

    def append(self, task):
        for follower in self.followers:
            follower(task)
        if self.keep:
            super().append(task)


def follow(root, follower):
    """Call ``follower`` with each task that starts from now on in the plan with the root ``root``. A follower is entered only once."""
    before = root.record
    if not isinstance(before, Followed):
        root.record = Followed(before or (), before is not None or truth(RECORD.value))
        living = [root]
        for task in living:  # the plan may be in the middle of its run
            task.record = root.record
            living += task.children
    if follower not in root.record.followers:
        root.record.followers.append(follower)


def unfollow(root, follower):
    """Stop calling ``follower``."""
    if isinstance(root.record, Followed) and follower in root.record.followers:
        root.record.followers.remove(follower)
