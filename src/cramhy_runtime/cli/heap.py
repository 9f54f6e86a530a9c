"""The C library's heap in a session that runs for hours: what was used once and is free again goes back to the system.

glibc gives each thread a heap of its own, and raises by itself the size from which a block is mapped alone. A server, a recorder that
packs its chunks and texts of changing lengths then leave holes that stay: 11 MB after four minutes with a page, a recording and a client.
With these settings the threads share the heap, large blocks are always mapped, and the heap's end is given back.
Source: mallopt(3). Elsewhere nothing is done.
"""

from __future__ import annotations

import os
import sys

_TRIM_THRESHOLD, _MMAP_THRESHOLD, _ARENA_MAX = -1, -3, -8  # of malloc.h
BLOCK = 128 * 1024
"""Bytes from which a block is mapped alone, and from which a free end of the heap is given back: glibc's own values at the start."""
_VARIABLES = ("MALLOC_ARENA_MAX", "MALLOC_MMAP_THRESHOLD_", "MALLOC_TRIM_THRESHOLD_", "GLIBC_TUNABLES")


def keep_small():
    """Set up the heap, unless the user has done so in the environment; whether it was."""
    if sys.platform != "linux" or any(name in os.environ for name in _VARIABLES):
        return False
    try:
        import ctypes

        mallopt = ctypes.CDLL(None).mallopt
    except (ImportError, OSError, AttributeError):  # no ctypes, or another C library
        return False
    return all([mallopt(name, value) for name, value in ((_ARENA_MAX, 1), (_MMAP_THRESHOLD, BLOCK), (_TRIM_THRESHOLD, BLOCK))])
