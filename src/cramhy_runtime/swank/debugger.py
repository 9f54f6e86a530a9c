"""The debugger of SLIME, sldb: on top of the stack that signalled, in the task that failed.

The task waits for calls of the debugger's buffer and carries them out on its own stack, where its restarts and its dynamic bindings are.
Meanwhile other tasks may run: virtual time stands still, and in wall time the turtle goes on. The buffer is left by a restart, or when
somebody ends the task.
"""

from __future__ import annotations

import sys

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.lisp_core.packages import symbol_name
from cramhy_runtime.lisp_core.printing import report_of
from cramhy_runtime.lisp_core.source_places import circumstance
from cramhy_runtime.languages.commonlisp.tools.advice import explanation
from cramhy_runtime.languages.commonlisp.tools.error_reports import condition_type
from cramhy_runtime.session import requests
from cramhy_runtime.session.calls_on_stack import calls_on_stack
from cramhy_runtime.session.requests import Mailbox
from cramhy_runtime.session.session import signalled_here

from .reasons import aborted, reason_of
from .rpcs import Refused
from .wire import Name

FIRST_FRAMES = 40  # that are sent with the condition; the others are sent when somebody wants to see them


class Debugger:
    """One level of the debugger for ``condition`` in ``task``."""

    def __init__(self, connection, condition, task):
        self.connection, self.condition, self.task = connection, condition, task
        self.mailbox = Mailbox()
        self.restarts, self.frames = [], []
        self.work = None  # the call of its buffer that is carried out
        self.covered = False  # whether a debugger on top of this one has ended, and taken the buffer with it

    def run(self):
        """Let the user choose. Returns if there is nobody to ask or no way to go on; then the condition is raised."""
        connection = self.connection
        if connection.closed or kernel.current() is not self.task:
            return
        signalled_here(self.condition)
        self.restarts = conditions.compute_restarts(self.condition)
        self.frames = calls_on_stack(sys._getframe(1), self.condition)
        stack = connection.debuggers.setdefault(self.task.id, [])
        request = requests.request_of()
        asked = stack[-1].work if stack else request.owner if request is not None else None
        if asked is not None:
            asked.debugged = self.condition
        stack.append(self)
        self.level = level = len(stack)
        try:
            connection.send(Name(":debug"), self.task.id, level, *self.told(0, FIRST_FRAMES))
            connection.send(Name(":debug-activate"), self.task.id, level, None)
            self.listen(request)
        finally:
            while stack and stack.pop() is not self:
                pass
            if not stack:
                connection.debuggers.pop(self.task.id, None)
            for work in self.mailbox.messages:
                connection.refuse(work.number, "This debugger has ended.")
            connection.send(Name(":debug-return"), self.task.id, level, None)
            if stack:
                stack[-1].covered = True

    def listen(self, request):
        while not self.connection.closed:
            work = request.wait(self.mailbox) if request is not None else self.mailbox.take()
            self.carry_out(work)
            if self.covered:
                self.covered = False
                self.connection.send(Name(":debug-activate"), self.task.id, self.level, None)

    @circumstance.begins_with
    def carry_out(self, work):
        """Do a call of this debugger's buffer. Leaves by the exit that the call makes, such as a restart."""
        self.work = work
        try:
            completed, value = work.session.with_abort(lambda: work.perform(self), f"Return to level {self.level} of the debugger.")
        except Exception as problem:
            work.failed(problem)
        except conditions.Condition as problem:
            self.connection.refuse(work.number, reason_of(problem))
        except BaseException:
            self.connection.refuse(work.number, "The debugger was left.")
            raise
        else:
            if completed:
                work.answer(value)
            else:
                self.connection.refuse(work.number, aborted(work))

    def told(self, start, end):
        """(condition, restarts, frames from ``start`` to ``end``, calls that wait) for the event ``:debug``."""
        condition = self.condition
        waiting = [number for request, number in self.connection.running.items() if request is requests.request_of(self.task)]
        return (
            (explanation(condition), f"   [Condition of type {condition_type(condition)}]", None),
            [(symbol_name(restart.name) if restart.name is not None else "", report_of(restart)) for restart in self.restarts],
            self.backtrace(start, end),
            waiting,
        )

    def backtrace(self, start, end):
        """The frames from ``start`` to before ``end`` (``None``: all) as Emacs shows them."""
        return [(index, frame.text) for index, frame in enumerate(self.frames)][start:end]

    def frame(self, number):
        """The frame of that number."""
        if not isinstance(number, int) or not 0 <= number < len(self.frames):
            raise Refused(f"There is no frame {number}." if self.frames else "No function of yours was running, so there is no frame.")
        return self.frames[number]
