"""Requests: what a user asks for from elsewhere than the prompt, as from Emacs, a notebook or an editor.

Each runs in a task of its own below the main task, beside the prompt, so that several users are served, and one is served while a plan
runs. A request can be interrupted; then the plan below it ends through its cleanup (law 2), as Ctrl-C ends a form at the prompt. An error
in it, or in a task below it, opens the debugger of the one who asked. In virtual time the clock moves while a request runs and stands
still between requests, as at the prompt.
"""

from __future__ import annotations

from collections import deque
from contextlib import ExitStack

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core import conditions

from .session import Interruption

DONE, FAILED, INTERRUPTED = "done", "failed", "interrupted"


class Request:
    """A piece of work that runs as soon as it gets the baton. May be made in the scheduler.

    work: a function of no arguments. finished: called once, with the `Request`, when ``outcome`` is there: `DONE` (then ``result`` is
    what ``work`` has returned), `FAILED` (then ``failure`` is the exception) or `INTERRUPTED`. It must not park. debugger: a function of
    a condition, the debugger of this request. name: what the task tree calls it. owner: for the surface, its own object.
    """

    def __init__(self, work, finished, debugger=None, name="a request", owner=None):
        self.work, self.finished, self.debugger, self.owner = work, finished, debugger, owner
        self.outcome = self.result = self.failure = None
        self.began = False
        self._wanted = None
        self.task = kernel.spawn(self._run, name=name, parent=kernel.active().main)
        self.task.local.request = self
        self.task.when_refused = lambda failure: self._end(FAILED, failure=failure)

    def _run(self):
        self.began = True
        try:
            with ExitStack() as self._wanted:
                self._wanted.enter_context(kernel.time_wanted())
                result = self.work()
        except (kernel.Cancelled, kernel.Abandoned, kernel.Interrupted, SystemExit):
            self._end(INTERRUPTED)
            raise
        except Interruption:
            self._end(INTERRUPTED)
        except BaseException as failure:  # a condition that is no Exception, too
            self._end(FAILED, failure=failure)
        else:
            self._end(DONE, result)

    def _end(self, outcome, result=None, failure=None):
        if self.outcome is None:
            self.outcome, self.result, self.failure = outcome, result, failure
            self.finished(self)

    def interrupt(self):
        """End it through the cleanup of its plans; the second time, abandon the cleanup. May be called in the scheduler."""
        if self.outcome is not None:
            return
        if not self.began:
            self.task.cancel("interrupted")
            self._end(INTERRUPTED)
        elif not self.task.cancelled:
            self.task.cancel("interrupted")
        else:
            for task in kernel.active().tasks:
                if task.cancelled and request_of(task) is self:
                    task.abandon()

    def wait(self, mailbox):
        """The next message of ``mailbox``, for which a task of this request waits in the debugger. Virtual time stands still meanwhile."""
        wanted = self._wanted
        if wanted is not None:
            wanted.close()
        try:
            return mailbox.take()
        finally:
            if wanted is not None:
                wanted.enter_context(kernel.time_wanted())


class Mailbox:
    """Messages of a user for a task that waits for them."""

    def __init__(self):
        self.messages = deque()
        self._waits = None

    def put(self, message):
        """Give ``message`` to the task. May be called in the scheduler."""
        self.messages.append(message)
        if self._waits is not None:
            kernel.unpark(self._waits)

    def take(self):
        """The next message; the current task parks until it is there."""
        while not self.messages:
            self._waits = kernel.current()
            try:
                kernel.park("the user")
            finally:
                self._waits = None
        return self.messages.popleft()


def request_of(task=None):
    """The `Request` that ``task`` (default: the current one) or one above it runs for, or ``None``."""
    task = task or kernel.current()
    while task is not None:
        local = task._local
        if local is not None and (found := getattr(local, "request", None)) is not None:
            return found
        task = task.parent
    return None


def ask_whoever_asked():
    """From now on an error in a task of a request opens the debugger of that request; other tasks keep the debugger that they have."""
    conditions.install_router(_debugger_of_task)


def _debugger_of_task():
    request = request_of()
    return None if request is None else request.debugger
