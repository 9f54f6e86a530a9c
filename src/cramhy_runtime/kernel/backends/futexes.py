"""Room for many waiting threads in the table where Linux looks for the one to wake.

A thread that waits for a lock stands in a table of its process (a futex), in one of a few lists, and to wake it Linux goes through the
list. Since version 6.16 this table has 16 lists on a machine with two processors. With 10,000 parked tasks each list has more than 600
entries, no processor keeps them in its cache, and a hand-over takes 80 us instead of 30 (measured). A process may ask for a larger table.
It does so when it has many threads: a list takes 64 bytes. Older versions share a large table among all processes, and refuse; then, and
on other systems, nothing is done.
"""

from __future__ import annotations

import sys

MANY = 128  # threads, from which on the table is worth its memory
LISTS = 1 << 14
PR_FUTEX_HASH, PR_FUTEX_HASH_SET_SLOTS = 78, 1  # of linux/prctl.h


class Table:
    """The table of this process: `widen` it, once."""

    __slots__ = ("wide",)

    def __init__(self) -> None:
        self.wide = False  # or it was refused, and need not be tried again

    def forget(self) -> None:
        """Begin anew: a forked process has a table of its own."""
        self.wide = False

    def widen(self) -> bool:
        """Ask for `LISTS` lists. Returns whether the process has them now."""
        self.wide = True
        if not sys.platform.startswith("linux"):
            return False
        import ctypes  # takes 5 ms

        try:
            return bool(ctypes.CDLL(None).prctl(PR_FUTEX_HASH, PR_FUTEX_HASH_SET_SLOTS, LISTS, 0, 0) == 0)
        except (AttributeError, OSError):
            return False
