"""What tests of tasks and operators begin with: a plan, a task made by hand in it, and the statuses that a task goes through."""

from cramhy_runtime import cpl
from cramhy_runtime.cpl.tasks.tasks import Task


def plan(body):
    return cpl.top_level(body)


def started(body, name="child"):
    return Task(body, name).execute()


def statuses_of(task):
    seen = []
    cpl.register_update_callback(task.status_fluent, "watch", seen.append)
    return seen
