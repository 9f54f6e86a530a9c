"""The statuses of a task and which may follow which (cpl.md 3.2)."""

from __future__ import annotations

from ..lisp.data import Cons, list_from
from ..lisp.packages import keyword
from ..lisp.types.types import define_type
from .symbols import sym

CREATED, RUNNING, WAITING, SUSPENDED = map(keyword, ("CREATED", "RUNNING", "WAITING", "SUSPENDED"))
SUCCEEDED, FAILED, EVAPORATED = map(keyword, ("SUCCEEDED", "FAILED", "EVAPORATED"))
ALIVE = (CREATED, RUNNING, WAITING, SUSPENDED)
DEAD = (FAILED, SUCCEEDED, EVAPORATED)
DONE = (SUCCEEDED, EVAPORATED)
ALL = (CREATED, RUNNING, SUSPENDED, SUCCEEDED, FAILED, EVAPORATED)
"""Those that occur, the type ``status-indicator``; ``:waiting`` is never given."""

NEXT = {
    CREATED: (RUNNING, EVAPORATED),
    RUNNING: (SUSPENDED, SUCCEEDED, FAILED, EVAPORATED),
    SUSPENDED: (RUNNING, EVAPORATED, FAILED),
}


def status_list(statuses):
    """``statuses`` as a Lisp list."""
    return list_from(statuses)


define_type(sym("CPL-IMPL::STATUS-INDICATOR"), lambda specifier, environment: Cons(sym("MEMBER"), status_list(ALL)),
            "The statuses that a task can have.")
