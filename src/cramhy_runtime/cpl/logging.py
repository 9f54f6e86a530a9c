"""The event log of the plan language: what each task does, one line per event, by topic.

Off by default and then free: arguments are computed only if one of an event's tags is active. The line goes to ``*log-output*``
with real time, run time, task, context and text. Source: cpl.md section 10. Tags are keywords; the mask is global, as there.
"""

from __future__ import annotations

import sys

from cramhy_runtime import kernel

from ..lisp.conditions import error
from ..lisp.data import Symbol, list_from, python_list
from ..lisp.packages import keyword
from .current import current_task
from .symbols import sym

TAGS = ("DEBUG FINISH SEND-EVENT RECEIVE-EVENT DEBUGGER PROPAGATE-EVENT JOIN-TASK WAIT-FOR REGISTER-CHILD TEARDOWN EVENT-LOOP "
        "CHANGE-STATUS GC ON-SUSPENSION WITH-PARALLEL-CHILDS FAIL PAR PURSUE TRY-ALL TRY-IN-ORDER WITH-TAGS").split()
DEFAULT = TAGS[:5]
VERBOSE = "PROPAGATE-EVENT JOIN-TASK WAIT-FOR REGISTER-CHILD TEARDOWN".split() + DEFAULT
VERY_VERBOSE = "EVENT-LOOP CHANGE-STATUS GC".split() + VERBOSE
LANGUAGE = "FAIL PAR PURSUE TRY-ALL TRY-IN-ORDER WITH-PARALLEL-CHILDS WITH-TAGS".split()

LOG_OUTPUT = sym("CPL-IMPL::*LOG-OUTPUT*")
RIGHT_MARGIN = sym("CPL-IMPL::*LOG-RIGHT-MARGIN*")
active_tags = set()


def tag_list(names):
    """The names as a Lisp list of keywords."""
    return list_from([keyword(name) for name in names])


def log_event(tag, event):
    """Log ``event()``, a pair (context, text), if one of ``tags`` is active."""
    tags = [tag]
    if active_tags and not active_tags.isdisjoint(tags):
        context, display = event()
        task = current_task()
        name = task.name if task else str(kernel.current().name)
        time = f"{kernel.now():.3f}" if task else "n/a"
        _write(f"{time:<8} , {time:<8} - {shortened(name):<20} > {context:<30} ; {display}\n")


def _write(line):
    stream = LOG_OUTPUT.value
    if hasattr(stream, "write"):
        stream.write(line)
    else:
        sys.stderr.write(line)


def shortened(name, width=20):
    """``name`` cut to ``width`` by replacing its middle with two dots."""
    return name if len(name) <= width else name[:(width - 2) // 2] + ".." + name[-(width - 2) // 2:]


def log_enable(tags):
    """Activate ``tags``, a list of keywords; returns the list of active ones in table order."""
    active_tags.update(_checked(tags))
    return list_active_log_tags()


def log_disable(tags):
    active_tags.difference_update(_checked(tags))
    return list_active_log_tags()


def log_set(tags):
    """Make ``tags`` the active ones."""
    names = _checked(tags)
    active_tags.clear()
    active_tags.update(names)
    return list_active_log_tags()


def _checked(tags):
    for tag in python_list(tags):
        if not isinstance(tag, Symbol) or tag.name not in TAGS:
            error("Do not know about log tag ~S; you probably forgot to adjust DEFINE-LOG-TAGS.", tag)
    return [tag.name for tag in python_list(tags)]


def list_available_log_tags():
    return tag_list(TAGS)


def list_active_log_tags():
    return tag_list(name for name in TAGS if name in active_tags)


def logging_enabled_p(*tags):
    return None if active_tags.isdisjoint(tag.name for tag in tags) else True
