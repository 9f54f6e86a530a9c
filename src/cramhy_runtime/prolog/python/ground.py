"""Queries from Python without a plan, a session or a kernel; they work in any of them as well.

Code that a query calls may need a kernel: a lazy list, or a designator, which a task computes. So all queries from Python run inside of
`reasoning`.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from cramhy_runtime import kernel


@contextmanager
def reasoning() -> Iterator[None]:
    """Run the block with a kernel: the active one, or a temporary one."""
    with kernel.at_hand():
        yield
