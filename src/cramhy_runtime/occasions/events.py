"""Events: when something happens in the world, all code that keeps beliefs about the world is told.

``(on-event event)`` is a hook: all methods for the event's class and the classes above it run, the most specific first, in the task that
calls it, without a queue. CRAM's branch devel numbers some behind their name: these run before all others, in that order.
``(clear-belief)`` is the hook that makes all code forget its beliefs. Source: projection-and-events.md B1.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.hooks import Hook
from cramhy_runtime.lisp_core.dispatch.generic_functions import generic
from ..utilities.small_functions import current_timestamp
from . import symbols  # noqa: F401  the package must exist

on_event = Hook("CRAM-OCCASIONS-EVENTS::ON-EVENT", "(event)", ordered=True)
clear_belief = Hook("CRAM-OCCASIONS-EVENTS::CLEAR-BELIEF", "()")


class Event:
    """Something that happened; derive classes from it. ``timestamp`` is the time in seconds, by default the present."""

    lisp_name = "CRAM-OCCASIONS-EVENTS::EVENT"
    initargs = {"TIMESTAMP": "timestamp"}

    def __init__(self, timestamp=None):
        self.timestamp = current_timestamp() if timestamp is None else timestamp


event_timestamp = generic(
    "CRAM-OCCASIONS-EVENTS::EVENT-TIMESTAMP",
    "(event)",
    documentation="""
The time at which ``event`` happened: seconds, a double-float.""",
)
event_timestamp.method(Event)(lambda event: event.timestamp)
