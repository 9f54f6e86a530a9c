"""Whether a large object can be made: a machine that has promised more memory than it has ends the whole process, or stands still.

An object that cannot be made is a STORAGE-CONDITION, as in SBCL, and costs nothing (law 8). Where the system refuses the memory itself,
Python raises a MemoryError, which becomes the same condition (`lisp_core.python_exceptions`).
"""

from __future__ import annotations

import functools
import os

from . import condition_types as types
from .conditions import error

POINTER = 8
"""Bytes of an element of a vector."""
CONS = 80
"""Bytes of an element of a list, with the place in the vector of which the list is made."""
_ALWAYS = 1 << 27
"""Bytes that are never asked about."""
_LARGEST = 4 << 30
"""Bytes that no object takes: filling more stops everything else for seconds. All of SBCL's heap has 8 GB."""


@functools.cache
def most() -> int:
    """The bytes that one object may take: three quarters of the memory of this machine or container, and no more than `_LARGEST`."""
    try:
        found = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    except (AttributeError, ValueError, OSError):
        found = 2 * _LARGEST  # it does not tell
    try:
        with open("/sys/fs/cgroup/memory.max", encoding="ascii") as limit:
            found = min(found, int(limit.read()))
    except (OSError, ValueError):
        pass  # it is not in a container with a limit
    return min(found * 3 // 4, _LARGEST)


def check_room(count: int, each: int = POINTER) -> None:
    """Signal a STORAGE-CONDITION if there is no memory for ``count`` elements of ``each`` bytes."""
    if count * each > _ALWAYS and count * each > most():
        gigabytes = max(count * each >> 30, 1)
        error(
            types.StorageCondition(f"Heap exhausted: {count} elements would take {gigabytes} GB."),
            hint=f"One object can take {max(most() >> 30, 1)} GB here. Is the number right?",
        )
