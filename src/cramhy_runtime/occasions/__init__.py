"""Occasions and events: what a robot believes about the world, and what changes it. From Python:

    from cramhy_runtime import occasions

    occasions.on_event.add(lambda event: ...)            # called with each event
    occasions.holds(lisp_list(CUP_ON_TABLE))             # the binding lists under which an occasion holds, or None

Where the parts are: ``events`` events and their hooks · ``occasions`` goals that hold in the world · ``time_terms`` points and spans of
time · ``fluent_predicates``, ``task_predicates`` fluents and tasks during an episode · ``current_episode`` the episode for these ·
``symbols`` the Lisp package. Reference: projection-and-events.md part B.
"""

from . import fluent_predicates as _fluent_predicates  # noqa: F401
from . import task_predicates as _task_predicates  # noqa: F401
from .events import Event, clear_belief, on_event
from .occasions import holds

__all__ = ["clear_belief", "Event", "holds", "on_event"]
