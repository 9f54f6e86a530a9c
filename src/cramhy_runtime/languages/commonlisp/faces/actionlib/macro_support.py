"""What the macros of ``hy_src/cramhy/actionlib.hy`` expand into: field paths arrive as Lisp lists, values as arguments."""

from __future__ import annotations

from ..ros.macro_support import build_message
from cramhy_runtime.actionlib import server, simple_client
from cramhy_runtime.lisp_core.printing import princ_to_string


def build_goal(client, paths, *values):
    """A goal message for ``client``."""
    return build_message(simple_client.goal_class(client), paths, *values)


def end_goal(state, *result):
    """End the current goal in ``state``; ``result`` is nothing, a message, or field paths and values."""
    return server.end_current(state, _message("result", result))


def tell_feedback(*feedback):
    """Send feedback: nothing, a message, or field paths and values."""
    return server.publish_feedback(_message("feedback", feedback))


def check_left(name):
    """Called at the end of the exec callback ``name``, which has told nobody how its goal ended: an error."""
    server.fell_off_the_end(princ_to_string(name))


def _message(part, arguments):
    if len(arguments) == 1:
        return arguments[0]
    return build_message(server.current_class(part), *arguments) if arguments else None
