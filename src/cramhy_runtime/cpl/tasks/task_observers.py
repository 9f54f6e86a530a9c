"""Following a plan: hearing of each task in it that starts.

A task keeps itself in the ``record`` of its parent, if that has one (``*record-task-tree*``). A plan that is followed has a `Followed`
there, which calls functions besides. So nothing is asked, and nothing paid, in plans that nobody follows.
"""

from __future__ import annotations

from cramhy_runtime.ground.data import truth
from .tasks import RECORD


class Followed(list):
    """The ``record`` of a plan that is followed: it calls each of ``followers`` with a task that is about to start.

    ``keep``: whether it also is what records are as a rule, the list of all tasks.
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
    """Call ``follower`` with each task of the plan at whose root ``root`` is that starts from now on; never twice for one follower."""
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
    """Call ``follower`` no more."""
    if isinstance(root.record, Followed) and follower in root.record.followers:
        root.record.followers.remove(follower)
