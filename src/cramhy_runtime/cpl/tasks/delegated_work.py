"""Errands: pieces of work that a task does for others, one after the other, as if each had a task of its own.

A process module is one task for its whole life and runs its body once per request. A new task per request would cost two more switches
of the stack and a new stack, half of the time of a short request. So the body is a piece of the module's task, and an errand separates
this piece from the rest. It starts with the dynamic bindings of a new task, so it does not see handlers, restarts and specials of the
module, and with an empty path. Its failure is its result, and a non-local exit cannot leave it. When it ends, tasks and threads that it
started and did not wait for are ended (law 1).

`Errand.end` evaporates the piece, as a `Block` does: cleanup runs once, undisturbed (law 2). Unlike a ``with`` block, an errand can also
be ended while its task is suspended, as a task can; the task is suspended again afterwards.
"""

from __future__ import annotations

from cramhy_runtime.kernel.typing_names import Any

from cramhy_runtime import kernel

from cramhy_runtime.lisp_core.data import NO_VALUES
from .timeouts import Block, BlockEnded, level
from .ending import end_tasks, limit_cleanup
from .pausing import Unwind, obey
from ..statuses import EVAPORATED, RUNNING, SUCCEEDED, SUSPENDED
from ..task_variables import inherited_bindings

_PASSING = (kernel.Cancelled, kernel.Abandoned, kernel.Interrupted, KeyboardInterrupt, SystemExit, Unwind)


class Errand(Block):
    """One piece of work. `run` it once. Any task may call ``end`` at any time."""

    __slots__ = ("children", "threads", "unclaimed", "limit")
    form = "ERRAND"

    def remind(self) -> None:
        if self.kernel_task is not None:
            super().remind()

    def run(self, body: Any, *arguments: Any) -> tuple[Any, Any]:
        """Call ``body(*arguments)``. Returns the status and result that a task with this body would have had.

        Exceptions that end the whole task, or the program, pass. An errand that was ended before it is run does not call ``body``.
        """
        if self.asked:
            return EVAPORATED, NO_VALUES
        self.begin(None)
        task, me = self.task, self.kernel_task
        path, node, outer, handlers = task.path, task.node, me.dynamic, me.handlers
        self.children = tuple(task.children) if task.children else ()
        self.threads, self.unclaimed = task.threads, task.unclaimed
        self.limit = None
        bindings = None if outer is None else inherited_bindings(me, task, task)
        if outer is not None:
            outer.leave()
        me.dynamic, me.handlers = bindings, None
        if bindings is not None:
            bindings.enter()
        task.path = task.node = passing = None
        try:
            result = body(*arguments)
            self.over = True
            status = SUCCEEDED
            if self.asked and not self.delivered:  # at the last moment
                status, result = EVAPORATED, NO_VALUES
        except BaseException as exception:
            self.over = True
            status, result, passing = self._outcome(exception)
        try:
            self._end_strays()
        except BaseException as exception:  # the user gave up waiting for cleanup
            status, result, passing = self._outcome(exception)
        if me.dynamic is not None:
            me.dynamic.leave()
        me.dynamic, me.handlers = outer, handlers
        if outer is not None:
            outer.enter()
        task.path, task.node = path, node
        self.leave()
        if passing is not None:
            raise passing
        return status, result

    def _unwind(self) -> None:
        task, me = self.task, self.kernel_task
        if self.over or self.delivered or level(me) != self.level:
            return
        self._end_children()
        if self.limit is not None:
            self.limit.end()  # of an end that the body swallowed
        task.cleanup_limit = self.limit = limit_cleanup(task)
        if task.status is SUSPENDED:
            task.change_status(RUNNING)
        self.strike()

    def leave(self) -> None:
        if self.limit is not None:
            self.limit.end()
            self.task.cleanup_limit = None
        super().leave()
        if self.task.held:  # it was ended while the task was suspended, or about to be
            self.kernel_task.interject(lambda: obey(self.task))

    def _outcome(self, exception: BaseException) -> tuple[Any, Any, BaseException | None]:
        """(status, result, what is to go on)"""
        reached: BaseException | None = exception
        while isinstance(reached, kernel.WaitEnded) and reached.__context__ is not None:
            reached = reached.__context__  # what was on its way out when the wait in its cleanup was ended
        if isinstance(reached, BlockEnded) and reached.block is self:
            return EVAPORATED, NO_VALUES, None
        if isinstance(reached, _PASSING):
            return EVAPORATED, NO_VALUES, exception
        return (*self.task.outcome(exception), None)

    def _end_children(self) -> None:
        """End the tasks that the body made by hand."""
        if self.task.children:
            strays = [child for child in self.task.children if child.ended is None and child not in self.children]
            if strays:
                end_tasks(strays, "Parent aborted.")

    def _end_strays(self) -> None:
        """End what the body left running, and tell of failures that nobody asked for."""
        task = self.task
        self._end_children()
        if task.threads is not self.threads:
            task.end_threads([thread for thread in task.threads if thread not in self.threads])
            task.threads = self.threads
        if task.unclaimed is not self.unclaimed:
            task.tell_unclaimed([failed for failed in task.unclaimed if failed not in self.unclaimed])
            task.unclaimed = self.unclaimed
