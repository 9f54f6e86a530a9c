"""Questions about a task: its status, its result, and its place among the others (cpl.md 3.2).

None of this waits, and none of it changes anything; a dead task answers as well as a living one.
"""

from __future__ import annotations

from itertools import dropwhile

from cramhy_runtime.lisp_core.data import list_from
from cramhy_runtime.lisp_core.dispatch.generic_functions import generic
from cramhy_runtime.utilities.queues import list_queue_contents, make_queue
from ..fluents.operators import fl_funcall
from ..statuses import ALIVE, DEAD, DONE, FAILED, status_list
from .tasks import SAVED_TASKS, AbstractTask

status = generic("CPL-IMPL::STATUS", "(task)", documentation="The fluent of its status. Callbacks on it see each change in order.")
status.method(AbstractTask)(lambda task: task.status_fluent)

result = generic(
    "CPL-IMPL::RESULT",
    "(task)",
    documentation="""
Its values if it succeeded, the condition if it failed, otherwise no values.""",
)


@result.method(AbstractTask)
def _result(task):
    task.claimed = True
    return task.result


task_path = generic("CPL-IMPL::TASK-PATH", "(task)", documentation="Its place in the task tree: a list of path parts, the deepest first.")
task_path.method(AbstractTask)(lambda task: task.path)


def task_alive(task):
    """A fluent that is true while the task is not dead. The true value is the tail of a list, as ``member`` returns it."""
    return _status_net(task, ALIVE)


def task_dead(task):
    """A fluent that is true when the task is dead."""
    return _status_net(task, DEAD)


def _status_net(task, statuses):
    return fl_funcall(lambda now: _member(now, statuses), status(task))


def _member(now, statuses):
    """What ``member`` gives: the list of ``statuses`` from ``now`` on, or nil."""
    return status_list(dropwhile(lambda status: status is not now, statuses))


def task_running_p(task):
    """True while the task is alive, also when it is created or suspended."""
    return True if _now(task) in ALIVE else None


def task_dead_p(task):
    """True when the task has succeeded, failed or was evaporated."""
    return True if _now(task) in DEAD else None


def task_done_p(task):
    """True when the task has succeeded or was evaporated."""
    return True if _now(task) in DONE else None


def task_failed_p(task):
    """True when the task has failed."""
    return True if _now(task) is FAILED else None


def _now(task):
    if not isinstance(task, AbstractTask):
        return status(task).stored
    task.claimed = True
    return task.status


def child_tasks(task):
    """The living children of ``task``, newest first (a Lisp list)."""
    return list_from(list(reversed(task.children)))


def parent_task(task):
    """The parent of ``task``; nil for the root of a plan."""
    return task.parent


def task_constraints(task):
    """The fluents that must be true before ``task`` starts its body (a Lisp list)."""
    return list_from(task.constraints or [])


def list_saved_tasks():
    """The tasks in the queue ``*tasks*``: those that were executed while ``*save-tasks*`` was true, in order of execution."""
    return list_queue_contents(SAVED_TASKS.value)


def clear_saved_tasks():
    """Make ``*tasks*`` a new, empty queue, which is returned."""
    SAVED_TASKS.value = make_queue()
    return SAVED_TASKS.value
