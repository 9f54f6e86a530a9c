"""``with-parallel-childs``: the parallel form whose end the program decides itself (cpl.md 6.9).

The watcher runs in the task of the form each time that the status of a child may have changed. Law 1 holds here too: whatever
ends the form, the living children are evaporated and awaited.
"""

from __future__ import annotations

from cramhy_runtime import kernel

from ..lisp.data import list_from
from .ending import end_tasks
from .pausing import pause
from .statuses import DEAD, DONE, FAILED


def watch(tasks, watcher):
    """Start ``tasks`` and call ``watcher(running, done, failed)`` after each change, until it leaves by a non-local exit."""
    me = kernel.current()
    changed = False

    def note(_):
        nonlocal changed
        changed = True
        me.kernel.unpark(me)

    try:
        for task in tasks:
            task.status_fluent.callbacks = {"watcher": note}
            task.execute()
        while True:
            while not changed:
                pause(lambda: "a change of its children")
            changed = False
            newest_first = list(reversed(tasks))
            watcher(list_from([task for task in newest_first if task.status not in DEAD]),
                    list_from([task for task in newest_first if task.status in DONE]),
                    list_from([task for task in newest_first if task.status is FAILED]))
    finally:
        for task in tasks:
            task.status_fluent.callbacks = None
        end_tasks([task for task in tasks if task.status not in DEAD])
