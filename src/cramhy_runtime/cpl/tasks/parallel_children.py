"""``with-parallel-childs``: the parallel form whose end the program itself decides (cpl.md 6.9).

The watcher runs in the task of the form when the status of a child may have changed. It is called once for each child with a change that
it has not been called for. So when children start together it sees the same statuses several times, as in the original. Its first call
comes when all children run and none has begun its body. Law 1 holds here too: when the form ends, in any way, the living children are
evaporated, and the form waits for their death.
"""

from __future__ import annotations

from cramhy_runtime import kernel

from cramhy_runtime.lisp_core.data import list_from
from .ending import end_tasks
from ..logging import active_tags, log
from .pausing import pause
from ..statuses import DEAD, DONE, FAILED


def watch(tasks, watcher):
    """Start ``tasks`` and call ``watcher(running, done, failed)`` after each change, until it leaves by a non-local exit."""
    me = kernel.current()
    changed = {}  # the children with a change that the watcher has not looked at

    def observe(task):
        def note(_):
            changed[task] = True
            me.kernel.unpark(me)

        task.status_fluent.callbacks = {"watcher": note}

    try:
        for task in tasks:
            task.body = _after_a_turn(task.body)
            observe(task)
            task.execute()
        while True:
            while not changed:
                pause(lambda: "a change of its children")
            del changed[next(iter(changed))]
            newest_first = list(reversed(tasks))
            if active_tags:
                log("WITH-PARALLEL-CHILDS", "~{~a~^, ~:_~}", list_from([f"{task.name} {task.status!r}" for task in tasks]))
            watcher(
                list_from([task for task in newest_first if task.status not in DEAD]),
                list_from([task for task in newest_first if task.status in DONE]),
                list_from([task for task in newest_first if task.status is FAILED]),
            )
    finally:
        for task in tasks:
            task.status_fluent.callbacks = None
        end_tasks([task for task in tasks if task.status not in DEAD])


def _after_a_turn(body):
    """``body``, begun when the watcher has had its first look."""

    def begin():
        kernel.yield_()
        return body()

    return begin
