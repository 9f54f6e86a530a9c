"""Events: something happened in the world, and whoever keeps a picture of the world is told.

``(on-event event)`` is a hook: all methods for the event's class and the classes above it run, the most specific one first, in the task
that calls it; there is no queue. ``(clear-belief)`` is the hook by which all pictures are emptied. Source: projection-and-events.md B1.
"""

from __future__ import annotations

from cramhy_runtime.ground.hooks import Hook
from cramhy_runtime.ground.dispatch.generic_functions import generic
from ..utilities.small_functions import current_timestamp
from . import symbols  # noqa: F401  the package must exist

on_event = Hook("CRAM-OCCASIONS-EVENTS::ON-EVENT", "(event)")
clear_belief = Hook("CRAM-OCCASIONS-EVENTS::CLEAR-BELIEF", "()")


class Event:
    """What happened; to be subclassed. ``timestamp``: when, in seconds, by default now."""

    lisp_name = "CRAM-OCCASIONS-EVENTS::EVENT"
    initargs = {"TIMESTAMP": "timestamp"}

    def __init__(self, timestamp=None):
        self.timestamp = current_timestamp() if timestamp is None else timestamp


event_timestamp = generic(
    "CRAM-OCCASIONS-EVENTS::EVENT-TIMESTAMP",
    "(event)",
    documentation="""
When ``event`` happened: seconds, a double-float.""",
)
event_timestamp.method(Event)(lambda event: event.timestamp)
