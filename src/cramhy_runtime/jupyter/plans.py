"""The tasks of the plans of one cell, those that are dead, too, for the outline below the cell.

A plan tells of each task that starts (``cpl/tasks/task_observers.py``), so an outline of a failure shows the branches that failed, though
a parent forgets its dead children. The newest `MOST` tasks are kept, so a plan may run for ever.
"""

from __future__ import annotations

from collections import deque

from cramhy_runtime.cpl.tasks.task_observers import follow, unfollow
from cramhy_runtime.cpl.tree import finished_plans

from . import outlines

MOST = 200
"""Tasks that are kept of the plans of a cell."""


class Plans:
    """Follows the plans of a session. Its methods are called with the baton."""

    def __init__(self):
        self.roots, self.tasks = deque(maxlen=10), deque(maxlen=MOST)
        self.note = self.tasks.append  # one object for all plans
        finished_plans.observe(self)

    def forget(self):
        """A cell begins: what has run before it is not its own."""
        self.roots.clear()
        self.tasks.clear()

    def lines(self):
        """The report of the plans, `tree_report.Line`s."""
        return outlines.task_lines(self.roots, self.tasks)

    # ---------------------------------------------------------------------------------------- called by the plans themselves

    def begins(self, task, name):
        """A plan with the root ``task`` begins."""
        follow(task, self.note)
        self.roots.append(task)

    def beside(self, task):
        """Tasks that run beside a plan are not shown."""

    def made(self, task):
        """It is told when it starts."""

    def ended(self, task, name):
        """A plan has ended. Its tasks stay until the next cell."""
        unfollow(task, self.note)
