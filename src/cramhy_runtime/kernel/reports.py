"""What the kernel tells people: where tasks are parked, why nothing goes on, and what nobody else heard.

Two hooks, attributes of the package `kernel` that the floors above replace:

* `kernel.describe_frame(frame) -> str or None`: a Python frame in the user's terms; None for a frame that is not the
  user's, then the next outer one is tried.
* `kernel.unhandled(task, exception)`: a task died of an exception and nobody looked, or a callback raised one.
"""

import os
import sys
import traceback

from .tasks import BLOCKED, PARKED

LONGEST_LIST = 30  # tasks

_HERE = os.path.dirname(os.path.abspath(__file__))
_LIBRARY = os.path.dirname(_HERE) + os.sep
_TUTORIALS = _LIBRARY + "tutorials" + os.sep


def of_the_library(file):
    """Whether ``file``, a path, is code of this library, which means nothing to its user; the tutorials in it are the user's."""
    return file.startswith(_LIBRARY) and not file.startswith(_TUTORIALS)


def describe_frame(frame):
    """The default: file, line and function of Python code, but not of this library's own."""
    code = frame.f_code
    if of_the_library(code.co_filename):
        return None
    return f"{code.co_filename}:{frame.f_lineno} in {code.co_name}"


def unhandled(task, exception):
    """The default: a traceback on stderr."""
    print(f"Unhandled exception in task {task.name}:", file=sys.stderr)
    traceback.print_exception(exception, file=sys.stderr)


def hooks():
    """The package, where the hooks are looked up at the time of the report."""
    return sys.modules[__package__]


def where(frame):
    """FRAME or the innermost frame around it that means something to the user, as text; "" if there is none."""
    describe = hooks().describe_frame
    while frame is not None:
        if not frame.f_code.co_filename.startswith(_HERE):
            try:
                text = describe(frame)
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


def abandoned_text(kernel, tasks, why=""):
    """Whose cleanup is given up: of TASKS, each with what it waits for, and WHY."""
    whose = "this task" if len(tasks) == 1 else f"these {len(tasks)} tasks"
    return (f"The cleanup of {whose} was given up.{f' {why}' if why else ''} What it was to stop may still be going on:\n"
            f"{list_of(kernel, tasks)}")


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
