"""Messages that are wrong: each gets an answer that says why, and one line in the log. The kernel goes on (law 8).

ipykernel logs a stack and answers nothing where a field of a message is missing or has another type, and where it does not know the kind of
a message. A client would wait for ever. So each message goes through `Guarded.answer` first.
"""

from __future__ import annotations

import inspect
import logging
import sys
from contextlib import suppress
from contextvars import ContextVar
from functools import partial

from ipykernel.kernelbase import Kernel

FIELDS = {
    "execute_request": {"code": str},
    "complete_request": {"code": str, "cursor_pos": int},
    "inspect_request": {"code": str, "cursor_pos": int},
    "is_complete_request": {"code": str},
    "history_request": {"hist_access_type": str},
    "comm_open": {"comm_id": str, "target_name": str},
    "comm_msg": {"comm_id": str},
    "comm_close": {"comm_id": str},
}
"""The fields that a message must have, and their types in Python."""
LOGS = ("Comm", "ipykernel.comm", "tornado.application", "tornado.general", "asyncio")
"""Where the libraries below tell of messages that they do not understand."""
_beside: ContextVar[bool] = ContextVar("beside", default=False)
"""Whether a message, one of a widget, is answered while a cell runs."""
NAMES = {str: "a string", int: "an integer"}


class Wrong(Exception):
    """A message is not what the protocol of Jupyter says."""


def check(kind, content):
    """Raise `Wrong` if the ``content`` of a message of this ``kind`` lacks a field, or if a field has another type."""
    if not isinstance(content, dict):
        raise Wrong(f"The content of {kind} is an object, not {_shown(content)}.")
    for name, wanted in FIELDS.get(kind, {}).items():
        if name not in content:
            raise Wrong(f"{kind} has no field {name}.")
        if not isinstance(content[name], wanted) or isinstance(content[name], bool):
            raise Wrong(f"The field {name} of {kind} is {NAMES[wanted]}, not {_shown(content[name])}.")


def _shown(value):
    text = repr(value)
    return text if len(text) <= 40 else f"{text[:37]}..."


class Handlers(dict):
    """The handlers of a channel, by the kind of message. For an unknown kind `get` gives one that says so."""

    def __init__(self, kernel, handlers):
        super().__init__(handlers)
        self.kernel = kernel

    def get(self, kind, default=None):
        """The handler of messages of this ``kind``: a function of the stream, the client's identity, and the message."""
        handler = super().get(kind) if isinstance(kind, str) else default
        return partial(self.kernel.answer, str(kind), handler)


def one_line(record):
    """A filter of a log: the stack of an exception becomes the text of the exception."""
    if record.exc_info:
        problem = record.exc_info[1] if isinstance(record.exc_info, tuple) else None
        record.msg, record.args = f"{record.getMessage()}: {type(problem).__name__}: {problem}".replace("\n", " "), ()
        record.exc_info = record.exc_text = None
    return True


class Guarded(Kernel):
    """A kernel that answers messages that are wrong, too. ``parent_of_cell``: the message of the cell that runs, or ran last."""

    parent_of_cell: dict

    def guard(self):
        """From now on, all messages are looked at first. To be called when the handlers are in their tables."""
        self.shell_handlers = Handlers(self, self.shell_handlers)
        self.control_handlers = Handlers(self, self.control_handlers)
        self.log.addFilter(one_line)
        terminal = logging.StreamHandler(sys.__stderr__)  # of Jupyter, and not a cell
        for log in map(logging.getLogger, LOGS):
            log.addFilter(one_line)
            log.addHandler(terminal)
            log.propagate = False

    async def answer(self, kind, handler, stream, ident, parent):
        """Let ``handler`` answer a message, or answer that it is wrong."""
        try:
            if handler is None:
                raise Wrong(f"This kernel does not know messages of the kind {_shown(kind)}.")
            check(kind, parent["content"])
            result = handler(stream, ident, parent)
            if inspect.isawaitable(result):
                await result
        except Exception as problem:
            told = str(problem) if isinstance(problem, Wrong) else f"{kind} was not understood: {type(problem).__name__}: {problem}"
            self.log.error("A message was refused. %s", told)
            if kind.endswith("_request"):
                content = {"status": "error", "ename": "WrongMessage", "evalue": told, "traceback": [told]}
                self.session.send(stream, f"{kind.removesuffix('_request')}_reply", content, parent, ident=ident)
        finally:
            if _beside.get():  # ipykernel says nothing of it, and a widget sends its next message when it hears that this one is done
                self._publish_status("busy", "shell", parent)
                self._publish_status("idle", "shell", parent)
                self._publish_status("busy", "shell", self.parent_of_cell)

    async def dispatch_shell(self, msg, *more, **named):
        """A message of the shell channel: what cannot even be read is left, with a line in the log."""
        _beside.set(named.get("concurrent", False))
        try:
            await super().dispatch_shell(msg, *more, **named)
        except Exception as problem:
            self._left("shell", problem)
        self.answered()

    def answered(self):
        """A message of the shell channel has been answered."""

    async def process_control(self, msg):
        """A message of the control channel, as above."""
        try:
            await super().process_control(msg)
        except Exception as problem:
            self._left("control", problem)

    def _left(self, channel, problem):
        self.log.error("A message on the %s channel cannot be read: %s: %s", channel, type(problem).__name__, problem)
        with suppress(Exception):
            self._publish_status("idle", channel)
