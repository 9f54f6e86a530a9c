"""The statuses of a task and which may follow which (cpl.md 3.2)."""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import list_from
from cramhy_runtime.lisp_core.packages import keyword

CREATED, RUNNING, WAITING, SUSPENDED = keyword("CREATED"), keyword("RUNNING"), keyword("WAITING"), keyword("SUSPENDED")
SUCCEEDED, FAILED, EVAPORATED = keyword("SUCCEEDED"), keyword("FAILED"), keyword("EVAPORATED")
# Keys of a dict keep their order, as a set does not, and finding one compares no keywords, as a tuple does.
ALIVE = dict.fromkeys((CREATED, RUNNING, WAITING, SUSPENDED))
DEAD = dict.fromkeys((FAILED, SUCCEEDED, EVAPORATED))
DONE = dict.fromkeys((SUCCEEDED, EVAPORATED))
ALL = (CREATED, RUNNING, SUSPENDED, SUCCEEDED, FAILED, EVAPORATED)
"""The statuses that occur, the type ``status-indicator``. No task is ever ``:waiting``."""

NEXT = {
    CREATED: frozenset((RUNNING, EVAPORATED)),
    RUNNING: frozenset((SUSPENDED, SUCCEEDED, FAILED, EVAPORATED)),
    SUSPENDED: frozenset((RUNNING, EVAPORATED, FAILED)),
}


def status_list(statuses):
    """``statuses`` as a Lisp list."""
    return list_from(statuses)
