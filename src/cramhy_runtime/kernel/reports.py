"""Reports for people: where tasks are parked, why the run cannot go on, and unhandled exceptions.

The kernel knows Python frames and exceptions. A `Reporter` describes them in the terms of the floors above; `install_reporter` installs
it. Until then the `PlainReporter` describes them in Python's terms.
"""

from __future__ import annotations

import contextlib
import os
import sys
import threading
from types import CodeType, FrameType
from .typing_names import Any, Protocol

from .tasks import BLOCKED, PARKED

LONGEST_LIST = 30  # tasks

_HERE = os.path.dirname(os.path.abspath(__file__))
_LIBRARY = os.path.dirname(_HERE) + os.sep
_TUTORIALS = _LIBRARY + "tutorials" + os.sep


def of_the_library(file):
    """Whether ``file``, a path, is code of this library, which reports do not show. Its tutorials count as the user's.

    The texts that it writes itself are called ``<..., text 7>`` (``utilities/generated_functions.py``).
    """
    if file.startswith("<"):
        return ", text " in file
    return file.startswith(_LIBRARY) and not file.startswith(_TUTORIALS)


class Named(Protocol):
    """A task, of the kernel or of a floor above."""

    @property
    def name(self) -> str: ...


class Reporter(Protocol):
    """Describes frames and exceptions for people."""

    def describe_frame(self, frame: FrameType) -> str | None:
        """A Python frame in the user's terms, or ``None`` if it is not the user's; then the next outer frame is tried."""
        ...

    def unhandled(self, task: Named, exception: BaseException) -> None:
        """Report ``exception``, which ended ``task`` and was not handled, or which a callback raised."""
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
    """Let ``reporter`` describe frames and failures from now on. Returns the reporter that did so before."""
    before, installed.reporter = installed.reporter, reporter
    return before


def describe_frame(frame: FrameType) -> str | None:
    """``frame`` in the user's terms, or ``None``, from the installed reporter."""
    return installed.reporter.describe_frame(frame)


def unhandled(task: Named, exception: BaseException) -> None:
    """Report an unhandled exception with the installed reporter."""
    installed.reporter.unhandled(task, exception)


def where(frame: Any) -> str:
    """FRAME, or the innermost frame around it that is the user's, as text; "" if there is none."""
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


def place(frame: Any) -> str:
    """As `where`, but code in Python counts as the user's too, whatever the reporter describes; "another place" if there is none."""
    while frame is not None:
        file = frame.f_code.co_filename
        if not (of_the_library(file) or file == contextlib.__file__) and (text := describe_frame(frame) or PLAIN.describe_frame(frame)):
            return text
        frame = frame.f_back
    return "another place"


def waiting_list(kernel):
    """Lines for all tasks that wait, the oldest first: the name, what it waits for, and where."""
    return list_of(kernel, [task for task in kernel.tasks if task.state in (PARKED, BLOCKED)])


def list_of(kernel, tasks):
    """Lines for TASKS: the name, what it waits for or that it computes, and where."""
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


def tell(text: str) -> None:
    """Print TEXT on the process's error output. If that is closed, do nothing."""
    try:
        print(f"cramhy: {text}", file=sys.stderr, flush=True)
    except (OSError, ValueError, AttributeError):  # the terminal was closed, or there is none
        pass


def write_shown(stream, text):
    """Write TEXT to one of Python's streams. Characters that its encoding lacks are written as escapes, such as ``\\u2192``: a pipe of
    Windows has cp1252, and a plan must not end because it prints an arrow."""
    try:
        stream.write(text)
    except UnicodeEncodeError as problem:
        stream.write(text.encode(problem.encoding, "backslashreplace").decode(problem.encoding))


def abandoned_text(kernel, tasks, why=""):
    """The message that the cleanup of TASKS was given up, with what each waits for, and WHY."""
    whose = "this task" if len(tasks) == 1 else f"these {len(tasks)} tasks"
    return (
        f"The cleanup of {whose} was given up.{f' {why}' if why else ''} The work that it should stop may still be going on:\n"
        f"{list_of(kernel, tasks)}"
    )


DO_NOT_SWALLOW = (
    "Catch Exception, not BaseException or everything, or raise again what you have caught, and do not leave a `finally` by return, "
    "break or continue."
)


def swallowing_text(task: Named, place: str) -> str:
    """The message that TASK, at PLACE, swallows every request to end it."""
    return f"The task {task.name}, at {place}, swallows every request to end it.\n{DO_NOT_SWALLOW}"


class Place:
    """What `where` and reporters read of a frame, without its variables. code: of its function. instruction: the frame's ``f_lasti``."""

    __slots__ = ("f_code", "f_lasti")
    f_back = None

    def __init__(self, code: CodeType, instruction: int):
        self.f_code, self.f_lasti = code, instruction

    @property
    def f_lineno(self) -> int:
        """The line of the source at which the frame was."""
        for start, end, line in self.f_code.co_lines():
            if line is not None and start <= self.f_lasti < end:
                return line
        return self.f_code.co_firstlineno


def deadlock_text(kernel):
    """The message of a deadlock."""
    return (
        "Nothing can happen any more: every task waits, and no timer and no outside event can wake one.\n"
        f"{waiting_list(kernel)}\n"
        "Look for the one that should have been woken: a fluent that nobody sets any more, or tasks that wait for each other."
        f"{_threads_text()}"
    )


def _threads_text() -> str:
    """What to do about threads of the user's, for which no plan waits; empty if there are none."""
    names = [
        thread.name
        for thread in threading.enumerate()
        if thread is not threading.main_thread() and not thread.name.startswith(("cramhy", "Dummy-"))  # these are ours
    ]
    if not names:
        return ""
    more = f" and {len(names) - 3} more" if len(names) > 3 else ""
    return (
        f"\nThe program has other threads ({', '.join(names[:3])}{more}). Plans do not wait for threads of Python, and virtual time passes "
        "without them. If one of them was to set the fluent, let a branch of the plan do its work: cpl.run_blocking(work) returns what it "
        "returns, and time stands still meanwhile. Or run the plan in wall time, cpl.run(main, clock='wall'), and open "
        "`with kernel.outside_source():` in it while the thread works."
    )


def time_limit_text(kernel, limit):
    """The message that the time LIMIT (s) was reached."""
    waiting = waiting_list(kernel)
    return (
        f"The run reached its time limit of {limit:g} s.\n"
        + (f"{waiting}\n" if waiting else "")
        + "If the plan needs longer, give a larger limit; else look for the wait that never ends."
    )
