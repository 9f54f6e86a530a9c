"""What the process has used of the machine: processor time and memory, as far as the system tells.

POSIX tells both by ``getrusage``. Elsewhere (Windows, a browser) the module `resource` is missing: `os.times` has the processor time there,
and nothing in Python's library has the memory.
"""

from __future__ import annotations

import os
import sys
from collections import namedtuple

try:
    import resource
except ImportError:
    resource = None


class ProcessorTime(namedtuple("ProcessorTime", "user system")):
    """Seconds that the processor has worked for this process: in its own code, and in the system for it."""

    __slots__ = ()


def processor_time():
    """The `ProcessorTime` until now."""
    if resource is not None:
        used = resource.getrusage(resource.RUSAGE_SELF)
        return ProcessorTime(used.ru_utime, used.ru_stime)
    used = os.times()
    return ProcessorTime(used.user, used.system)


def peak_memory():
    """The most bytes of memory that the process has had so far, or ``None`` where the system does not tell."""
    if resource is None:
        return None
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * (1 if sys.platform == "darwin" else 1024)
