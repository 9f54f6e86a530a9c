"""The event log of the plan language: what each task does, one line per event, by topic.

Topics are keywords, the log tags. The set of active tags is global, and empty at first. A line goes to ``*log-output*``. It has the time
(seconds since the plan began, by the clock and by the processor), the task, the kind of event, and the event. Source: cpl.md section
10; the line is the original's to the letter. In virtual time both times are the plan's, so that equal runs log equal lines.

Logging costs nothing when no tag is active: the runtime asks ``if active_tags`` before it logs, and then `log-event` does not
evaluate its arguments.
"""

from __future__ import annotations

import time

from cramhy_runtime.kernel.images import per_image
from cramhy_runtime import kernel

from cramhy_runtime.lisp_core.conditions import CompileError, error
from cramhy_runtime.lisp_core.data import Keyword, list_from, python_list
from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.lisp_core.printing import format_to_string
from cramhy_runtime.lisp_core.packages import keyword
from cramhy_runtime.lisp_core.output import output_stream
from .current import current_task
from .symbols import sym

TAGS = (
    "DEBUG FINISH SEND-EVENT RECEIVE-EVENT DEBUGGER PROPAGATE-EVENT JOIN-TASK WAIT-FOR REGISTER-CHILD TEARDOWN EVENT-LOOP "
    "CHANGE-STATUS GC ON-SUSPENSION WITH-PARALLEL-CHILDS FAIL PAR PURSUE TRY-ALL TRY-IN-ORDER WITH-TAGS"
).split()
DEFAULT = TAGS[:5]
VERBOSE = "PROPAGATE-EVENT JOIN-TASK WAIT-FOR REGISTER-CHILD TEARDOWN".split() + DEFAULT
VERY_VERBOSE = "EVENT-LOOP CHANGE-STATUS GC".split() + VERBOSE
LANGUAGE = "FAIL PAR PURSUE TRY-ALL TRY-IN-ORDER WITH-PARALLEL-CHILDS WITH-TAGS".split()

LOG_OUTPUT = sym("CPL-IMPL::*LOG-OUTPUT*")
RIGHT_MARGIN = sym("CPL-IMPL::*LOG-RIGHT-MARGIN*")
LINE = "~8@A , ~8A - ~20A > ~30@<~?~> ; ~@<~?~:>~%"
EVENT = "#<EVENT :~a~@[ ~s~]>"
NAME_WIDTH = 20

known_tags = per_image(list(TAGS))
active_tags = per_image(set())
"""The names of the active tags. Code that logs asks first whether there are any."""


def tag_list(names):
    """The names as a Lisp list of keywords."""
    return list_from([keyword(name) for name in names])


def log(tag, control, *arguments):
    """Log an event of the runtime, whose kind is its tag. Call this only if there are `active_tags`."""
    if tag in active_tags:
        write_line("~a", (tag,), control, arguments)


def log_sending(kind, task, reason):
    """Log a request to a task. Call this only if there are `active_tags`."""
    log("SEND-EVENT", EVENT + " to ~a", kind, reason, task.name)


def log_event(tags, event):
    """``log-event``: log ``event()`` if one of ``tags``, a Lisp list of keywords, is active.

    ``event()`` returns four things: a format control for the kind of event, its arguments, one for what happened, and its arguments.
    """
    if not active_tags.isdisjoint(tag.name for tag in tags):
        context, context_arguments, display, arguments = event()
        write_line(context, python_list(context_arguments), display, python_list(arguments))


def write_line(context, context_arguments, display, arguments):
    """Write one line: format controls and arguments for the kind of event and for what happened."""
    task = current_task()
    with binding(sym("*PRINT-PRETTY*"), True, sym("*PRINT-RIGHT-MARGIN*"), RIGHT_MARGIN.value):
        line = format_to_string(
            LINE,
            *_times(task),
            shortened(task.name if task else str(kernel.current().name)),
            context,
            list_from(context_arguments),
            display,
            list_from(arguments),
        )
    stream = output_stream(LOG_OUTPUT.value)
    stream.write(line)
    stream.flush()


def _times(task):
    """Seconds since the plan of ``task`` began: by the clock, and of the processor."""
    while task is not None and task.parent is not None:
        task = task.parent
    if task is None or task.started_at is None:
        return "n/a", "n/a"
    passed = kernel.now() - task.started_at
    worked = passed if kernel.active().clock.virtual else time.process_time() - task.processor_time
    return f"{passed:.3f}", f"{worked:.3f}"


def shortened(name, width=NAME_WIDTH):
    """``name`` cut to ``width`` by replacing its middle with two dots."""
    return name if len(name) <= width else name[: (width - 2) // 2] + ".." + name[-(width - 2) // 2 :]


def log_enable(tags):
    """Activate ``tags``, a list of keywords. Returns the active tags in table order. An unknown tag is an error."""
    active_tags.update(_checked(tags))
    return list_active_log_tags()


def log_disable(tags):
    """Make ``tags`` inactive. Returns the tags that are still active, in table order. An unknown tag is an error."""
    active_tags.difference_update(_checked(tags))
    return list_active_log_tags()


def log_set(tags):
    """Make ``tags`` the only active ones. Returns them in table order. An unknown tag is an error."""
    names = _checked(tags)
    active_tags.clear()
    active_tags.update(names)
    return list_active_log_tags()


def _is_known(tag):
    return isinstance(tag, Keyword) and tag.name in known_tags


def _checked(tags):
    for tag in python_list(tags):
        if not _is_known(tag):
            error("Do not know about log tag ~S; you probably forgot to adjust DEFINE-LOG-TAGS.", tag)
    return [tag.name for tag in python_list(tags)]


def check_constant_tags(tags):
    """Signal a compile-time error if one of ``tags``, a Python list, is not a known tag."""
    for tag in tags:
        if not _is_known(tag):
            error(
                CompileError("~S not a known log tag. See DEFINE-LOG-TAGS.", tag),
                hint=f"The log tags are {' '.join(f':{name}' for name in known_tags).lower()}.",
            )


def define_log_tags(tags):
    """``(define-log-tags tag...)``: add keywords to the log tags. Returns the list of all. Other objects than keywords are an error."""
    for tag in python_list(tags):
        if not isinstance(tag, Keyword):
            error("A log tag is a keyword, not ~S.", tag)
        if tag.name not in known_tags:
            known_tags.append(tag.name)
    return list_available_log_tags()


def list_available_log_tags():
    """All tags, in table order."""
    return tag_list(known_tags)


def list_active_log_tags():
    """The active tags, in table order."""
    return tag_list(name for name in known_tags if name in active_tags)


def logging_enabled_p(tags):
    """Whether one of ``tags``, a Lisp list of keywords, is active."""
    return None if active_tags.isdisjoint(tag.name for tag in python_list(tags)) else True
