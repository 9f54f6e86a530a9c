"""What the kernel tells people: where tasks are parked, why nothing goes on, and what nobody else heard.

The kernel knows Python frames and exceptions. A `Reporter` describes them in the terms of the floors above; `install_reporter` puts it
into use. Until then the `PlainReporter` describes them in Python's terms.
"""

from __future__ import annotations

import os
import sys
from types import FrameType
from .typing_names import Protocol

from .tasks import BLOCKED, PARKED

LONGEST_LIST = 30  # tasks

_HERE = os.path.dirname(os.path.abspath(__file__))
_LIBRARY = os.path.dirname(_HERE) + os.sep
_TUTORIALS = _LIBRARY + "tutorials" + os.sep


def of_the_library(file):
    """Whether ``file``, a path, is code of this library, which means nothing to its user; the tutorials in it are the user's."""
    return file.startswith(_LIBRARY) and not file.startswith(_TUTORIALS)


class Named(Protocol):
    """A task, of the kernel or of a floor above."""

    @property
    def name(self) -> str: ...


class Reporter(Protocol):
    """Describes to people what the kernel knows in Python's terms."""

    def describe_frame(self, frame: FrameType) -> str | None:
        """A Python frame in the user's terms; ``None`` for a frame that is not the user's. Then the next outer one is tried."""
        ...

    def unhandled(self, task: Named, exception: BaseException) -> None:
        """``task`` died of ``exception`` and nobody looked, or a callback raised it."""
        ...


class PlainReporter:
    """Describes frames and failures as Python does."""

    def describe_frame(self, frame: FrameType) -> str | None:
        """File, line and function of Python code, but not of this library's own."""
        code = frame.f_code
        if of_the_library(code.co_filename):
            return None
        return f"{code.co_filename}:{frame.f_lineno} in {code.co_name}"

    def unhandled(self, task: Named, exception: BaseException) -> None:
        """Print a traceback on stderr."""
        print(f"Unhandled exception in task {task.name}:", file=sys.stderr)
        import traceback  # with what it imports it takes 2 ms, and most plans fail in no such way

        traceback.print_exception(exception, file=sys.stderr)


PLAIN = PlainReporter()


class Installed:
    """The reporter that is in use."""

    reporter: Reporter = PLAIN


installed = Installed()


def install_reporter(reporter: Reporter) -> Reporter:
    """Let ``reporter`` describe frames and failures from now on. Returns the one that did so before."""
    before, installed.reporter = installed.reporter, reporter
    return before


def describe_frame(frame: FrameType) -> str | None:
    """``frame`` in the user's terms, or ``None``: what the installed reporter answers."""
    return installed.reporter.describe_frame(frame)


def unhandled(task: Named, exception: BaseException) -> None:
    """Tell of an exception that nobody handled, by the installed reporter."""
    installed.reporter.unhandled(task, exception)


def where(frame):
    """FRAME or the innermost frame around it that means something to the user, as text; "" if there is none."""
    while frame is not None:
        if not frame.f_code.co_filename.startswith(_HERE):
            try:
                text = describe_frame(frame)
            except Exception as broken:
                text = f"(the hook describe_frame failed: {broken!r})"
            if text:
                return text
        frame = frame.f_back
    return ""


def waiting_list(kernel):
    """For each task that waits: its name, what it waits for, and where; the oldest first."""
    return list_of(kernel, [task for task in kernel.tasks if task.state in (PARKED, BLOCKED)])


def list_of(kernel, tasks):
    """For each of TASKS: its name, what it waits for, or that it computes, and where."""
    lines = []
    for task in tasks[:LONGEST_LIST]:
        waits = task.state in (PARKED, BLOCKED)
        line = f"  {task.name} " + (f"waits for {task.describe_why() or 'a wake-up'}" if waits else "computes")
        if place := where(kernel.frame_of(task)):
            line += f"\n      at {place}"
        lines.append(line)
    if len(tasks) > LONGEST_LIST:
        lines.append(f"  and {len(tasks) - LONGEST_LIST} more")
    return "\n".join(lines)


def tell(text):
    """Say TEXT to the user, on the process's error output; where nobody reads that any more nothing is said."""
    try:
        print(f"cramhy: {text}", file=sys.stderr, flush=True)
    except (OSError, ValueError, AttributeError):  # the terminal was closed, or there is none
        pass


def write_shown(stream, text):
    """Write TEXT to one of Python's streams. Signs that its encoding lacks are written as escapes, such as ``\\u2192``: a pipe of Windows
    has cp1252, and a plan does not end because of an arrow that it prints."""
    try:
        stream.write(text)
    except UnicodeEncodeError as problem:
        stream.write(text.encode(problem.encoding, "backslashreplace").decode(problem.encoding))


def abandoned_text(kernel, tasks, why=""):
    """Whose cleanup is given up: of TASKS, each with what it waits for, and WHY."""
    whose = "this task" if len(tasks) == 1 else f"these {len(tasks)} tasks"
    return (
        f"The cleanup of {whose} was given up.{f' {why}' if why else ''} What it was to stop may still be going on:\n"
        f"{list_of(kernel, tasks)}"
    )


def deadlock_text(kernel):
    return (
        "Nothing can happen any more: every task waits, and no timer and no outside event can wake one.\n"
        f"{waiting_list(kernel)}\n"
        "Look for the one that should have been woken: a fluent that nobody sets any more, or tasks that wait for each other."
    )


def time_limit_text(kernel, limit):
    waiting = waiting_list(kernel)
    return (
        f"The run reached its time limit of {limit:g} s.\n"
        + (f"{waiting}\n" if waiting else "")
        + "If the plan needs longer, give a larger limit; else look for the wait that never ends."
    )
