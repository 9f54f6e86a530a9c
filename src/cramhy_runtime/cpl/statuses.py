"""The statuses of a task and which may follow which (cpl.md 3.2)."""

from __future__ import annotations

from ..lisp.data import list_from
from ..lisp.packages import keyword

CREATED, RUNNING, WAITING, SUSPENDED = map(keyword, ("CREATED", "RUNNING", "WAITING", "SUSPENDED"))
SUCCEEDED, FAILED, EVAPORATED = map(keyword, ("SUCCEEDED", "FAILED", "EVAPORATED"))
ALIVE = (CREATED, RUNNING, WAITING, SUSPENDED)
DEAD = (FAILED, SUCCEEDED, EVAPORATED)
DONE = (SUCCEEDED, EVAPORATED)

NEXT = {
    CREATED: (RUNNING, EVAPORATED),
    RUNNING: (SUSPENDED, SUCCEEDED, FAILED, EVAPORATED),
    SUSPENDED: (RUNNING, EVAPORATED, FAILED),
}


def status_list(statuses):
    """``statuses`` as a Lisp list."""
    return list_from(statuses)
